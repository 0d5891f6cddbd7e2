// The edges of a mesh: which triangles meet in them and how sharply.
#pragma once

#include <array>
#include <vector>

#include "mesh/triangle_mesh.hpp"

namespace insym {

struct MeshEdge {
    std::array<int, 2> vertices{};   ///< the lesser first
    std::array<int, 2> triangles{};  ///< the second is -1 at a border and where three or more meet
    bool sharp = false;
};

/// In the order of their vertices. Borders and edges of three or more triangles are sharp.
std::vector<MeshEdge> find_edges(const TriangleMesh& mesh, double sharp_angle_deg);

}  // namespace insym
