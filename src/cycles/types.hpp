// Which isometries a cycle can be an orbit of (definitions, section 5).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "isometry/fit.hpp"
#include "scene.hpp"

namespace insym {

/// Names cycles. Holds scratch memory: one for each thread.
class TypeOracle {
public:
    explicit TypeOracle(const Scene& scene) : scene_(scene) {}

    /// The kinds among T, C, Z, S, W whose least-squares ideal cycle reproduces all distances of
    /// the cycle within `eps`, its E_min. Empty for a chain too short for any. O(c^2).
    TypeSet types(std::span<const int> points, bool closed, double eps);

private:
    using Points = std::vector<Eigen::Vector3d>;

    bool close_to(const Points& ideal) const;
    bool near_line();
    bool four_may_be_flat() const;
    void find_plane();
    double flatness_change() const;
    void find_turns();
    bool near_circle(bool closed);
    bool near_zigzag();
    RigidFits fit_step(bool closed) const;
    bool near_helix(const RigidMap& step);

    const Scene& scene_;
    double eps_ = 0;
    Points x_;                  // the cycle's points, relative to their mean
    Points ideal_;              // the candidate's points
    std::vector<double> dist_;  // of x_, row by row
    // In the best plane through the points:
    Eigen::Matrix<double, 3, 2> plane_;
    std::vector<Eigen::Vector2d> flat_;
    std::vector<double> angles_;
    bool one_way_ = false;
    bool alternate_ = false;
    double first_turn_ = 0;
};

}  // namespace insym
