// Triangles with shared vertices, as the stages of this folder see them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace insym {

struct TriangleMesh {
    std::vector<Eigen::Vector3d> vertices;
    std::vector<std::array<int, 3>> triangles;

    const Eigen::Vector3d& corner(int triangle, int i) const {
        return vertices[static_cast<std::size_t>(
            triangles[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(i)])];
    }
    /// Twice the area, along the normal.
    Eigen::Vector3d area_vector(int triangle) const {
        return (corner(triangle, 1) - corner(triangle, 0)).cross(corner(triangle, 2) - corner(triangle, 0));
    }
};

/// The diagonal of the box around the vertices.
double box_diagonal(const std::vector<Eigen::Vector3d>& vertices);

/// What the file holds, each triangle with vertices of its own where the format has it so.
/// Throws Error(cannot_read).
TriangleMesh load_mesh(const std::string& path);

/// The mesh with vertices nearer than `distance` made one, in the order of their first use, and without the
/// triangles that this leaves without area.
TriangleMesh weld(const TriangleMesh& mesh, double distance);

}  // namespace insym
