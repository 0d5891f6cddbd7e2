// Flat regions: sets of adjoining triangles in one plane that are a face of the part by themselves.
#pragma once

#include <vector>

#include "mesh/mesh_edges.hpp"

namespace insym {

struct FlatRegion {
    Eigen::Vector3d centroid;
    double area = 0;
    std::vector<int> triangles;
};

/// In the order of their first triangles. `flatness`: the largest distance to the plane.
std::vector<FlatRegion> find_flat_regions(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges,
                                          double flatness);

}  // namespace insym
