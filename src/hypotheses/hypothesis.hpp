// An isometry that a few points suggest.
#pragma once

#include <array>
#include <vector>

#include "isometry/fit.hpp"

namespace insym {

/// Coordinates are those of the Cloud (about the middle of the set).
struct Hypothesis {
    SymmetryType type = SymmetryType::screw;  ///< screw, rotation_reflection: any proper, improper isometry
    RigidMap map;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the points that suggest it
    double radius = 0;                                 ///< how far these are from there
    double off = 0;                                    ///< how far the points are from agreeing
    std::array<int, 4> from{{-1, -1, -1, -1}};         ///< the links that suggest it
    std::array<int, 4> to{{-1, -1, -1, -1}};
};

}  // namespace insym
