// The points as method `robust` works on them: about their middle, with an index.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "isometry/fit.hpp"
#include "points/point_grid.hpp"
#include "scene.hpp"

namespace insym {

/// Immutable; queries are thread-safe.
class Cloud {
public:
    explicit Cloud(const PointScene& scene);

    int size() const { return static_cast<int>(points_.size()); }
    int dimension() const { return scene_.dimension(); }
    int label(int i) const { return scene_.label(i); }
    const Eigen::Vector3d& operator[](int i) const { return points_[static_cast<std::size_t>(i)]; }
    const Eigen::Vector3d& middle() const { return middle_; }  ///< in the input's coordinates
    double radius() const { return radius_; }                  ///< of the farthest point from the middle
    const PointScene& scene() const { return scene_; }
    const PointGrid& grid() const { return grid_; }

    double gap() const { return gap_; }  ///< the least distance between two points

    /// Ascending, of the nearest other points of its label; what there is not stays as it is.
    void nearest_distances(int i, std::span<double> out) const;

    /// The nearest point to `place` with this label within `reach`, or -1; `square` is its distance squared.
    int nearest(const Eigen::Vector3d& place, int label, double reach, double& square) const;

private:
    const PointScene& scene_;
    Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
    double radius_ = 0;
    double gap_ = 0;
    std::vector<Eigen::Vector3d> points_;
    PointGrid grid_;
};

}  // namespace insym
