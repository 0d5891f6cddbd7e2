// Least-squares isometries over links P -> sigma(P), free and of each kind (definitions, section 7).
#pragma once

#include "insym/isometry.hpp"
#include "insym/symmetry_type.hpp"

#include <Eigen/Core>
#include <vector>

namespace insym {

/// x -> linear * x + shift. In 2D the third coordinate is carried along as 0.
struct RigidMap {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();

    Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return linear * x + shift; }
};

/// `first`, and `then` on what it gives.
inline RigidMap compose(const RigidMap& then, const RigidMap& first) {
    return {then.linear * first.linear, then(first.shift)};
}

inline RigidMap inverse(const RigidMap& map) {
    return {map.linear.transpose(), -(map.linear.transpose() * map.shift)};
}

/// The map of an isometry in coordinates about `middle`.
RigidMap map_about(const Isometry& isometry, const Eigen::Vector3d& middle);

/// A direction that no part is likely to be aligned with, of length 1 or a hair less: it says which of an
/// isometry and its inverse stands for both, and gives places an order.
inline const Eigen::Vector3d kAskew(0.6120, 0.3532, 0.7075);

/// One link: `from` is to be carried to `to`.
struct Link {
    Eigen::Vector3d from;
    Eigen::Vector3d to;
};

/// What a least-squares fit needs of any number of links; sums of disjoint sets of links add up.
struct LinkSums {
    double count = 0;
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();  ///< sum of from * to^T

    void add(const Link& link);
    LinkSums& operator+=(const LinkSums& other);
    LinkSums reversed() const;
    /// sum of (from - mean) (to - mean)^T
    Eigen::Matrix3d covariance() const;
};

/// The two candidates of the orthogonal Procrustes problem.
struct RigidFits {
    RigidMap proper;
    RigidMap improper;
};

/// Least-squares isometries of either determinant, in E^dimension (Arun, Huang, Blostein 1987;
/// Umeyama 1991). Where the links do not fix the map (all on a line), one of the best.
RigidFits fit_rigid(const LinkSums& sums, int dimension);

/// The least-squares isometry of that very kind: T does not turn, C has no step along its axis, M
/// no step along its plane, Z an exact reflection as its linear part, and so on. For the kinds of
/// pairs (M, I, half-turn) every pair counts in both directions, whichever was given. `links` is
/// not empty. O(number of links).
RigidMap fit_of_type(SymmetryType type, const std::vector<Link>& links, int dimension);

/// The axis of a proper linear map that is not the identity: unit, turning by 0..180 degrees.
Eigen::Vector3d rotation_axis(const Eigen::Matrix3d& linear);

inline Eigen::Vector3d to_vector(const Point& p) {
    return {p[0], p[1], p[2]};
}
inline Point to_point(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace insym
