#include "mesh/mesh_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace insym {
namespace {

/// One side of a triangle.
struct Side {
    int low, high, triangle;
    bool upward;  ///< the triangle runs from low to high
    auto key() const { return std::tie(low, high, triangle); }
};

std::vector<Side> sides_of(const TriangleMesh& mesh) {
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const int a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
    return sides;
}

/// The angle by which the surface turns over the edge of two triangles.
double turn_deg(const TriangleMesh& mesh, const Side& a, const Side& b) {
    const Eigen::Vector3d n = mesh.area_vector(a.triangle);
    // Two triangles that run the same way along the edge do not agree on the outer side.
    const Eigen::Vector3d m = mesh.area_vector(b.triangle) * (a.upward == b.upward ? -1 : 1);
    return std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / std::numbers::pi;
}

}  // namespace

std::vector<MeshEdge> find_edges(const TriangleMesh& mesh, double sharp_angle_deg) {
    const std::vector<Side> sides = sides_of(mesh);
    std::vector<MeshEdge> edges;
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t end = first + 1;
        while (end < sides.size() && sides[end].low == sides[first].low &&
               sides[end].high == sides[first].high)
            ++end;
        MeshEdge edge{{sides[first].low, sides[first].high}, {sides[first].triangle, -1}, true};
        if (end - first == 2) {
            edge.triangles[1] = sides[first + 1].triangle;
            edge.sharp = turn_deg(mesh, sides[first], sides[first + 1]) > sharp_angle_deg;
        }
        edges.push_back(edge);
        first = end;
    }
    return edges;
}

}  // namespace insym
