// Polygons of a mesh file into triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace insym {

/// The triangles of a flat polygon, in the same sense round, by clipping ears; where it is none, as many
/// anyway. O(n^2) for outlines that are not contrived.
std::vector<std::array<int, 3>> triangulate(const std::vector<Eigen::Vector3d>& vertices,
                                            std::vector<int> polygon);

}  // namespace insym
