// The symmetries of the whole set as a point group, and its name.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "points/cloud.hpp"

namespace insym {

/// Names a finite group of orthogonal maps of E^dimension (the identity included or not). In the plane the
/// Schoenflies symbols are Cn and Dn.
struct GroupName {
    std::string schoenflies;
    std::string hermann_mauguin;
};
GroupName name_group(const std::vector<Eigen::Matrix3d>& elements, int dimension);

/// The largest group of listed symmetries that take every point to a point or to an empty slot; C1 where
/// there is none. The slots that complete the set are added to `missing` of the symmetries that need them.
/// O(elements^2 n).
PointGroup point_group(const Cloud& cloud, std::vector<Symmetry>& symmetries);

}  // namespace insym
