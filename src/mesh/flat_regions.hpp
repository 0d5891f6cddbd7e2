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

/// What counts as flat.
struct Flatness {
    double exact;         ///< the largest distance of a triangle from the plane of its neighbours
    double approximate;   ///< the same for all that lies between sharp edges, taken as a whole
    double least_cosine;  ///< of the angle between a triangle of such a whole and its plane
};

/// In the order of their first triangles.
std::vector<FlatRegion> find_flat_regions(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges,
                                          const Flatness& flatness);

}  // namespace insym
