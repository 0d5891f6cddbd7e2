// The words for an isometry: axis, angle, step, plane, centre (definitions, section 7).
#pragma once

#include <optional>

#include "isometry/fit.hpp"

namespace insym {

/// `map`, which is exactly of kind `type`, with its geometric elements. Points on an axis or plane
/// are those nearest to `near`, so that they lie within the part they belong to.
Isometry describe(SymmetryType type, const RigidMap& map, const Eigen::Vector3d& near, int dimension);

}  // namespace insym
