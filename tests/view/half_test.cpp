// Oracle: a cut changes no area. The two halves of a mesh have the area of the whole, and each lies on its
// own side; the triangles of a part are those of the mesh.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "view/shaded_mesh.hpp"
#include "view/solids.hpp"

namespace insym {
namespace {

using Eigen::Vector3f;

ShadedMesh solid() {
    ShadedMesh mesh;
    add_sphere({0.3F, -0.2F, 0.1F}, 1, mesh);
    add_tube({-1, 0, 0}, {1.5F, 0.5F, 0.7F}, 0.25F, mesh);
    return mesh;
}

Vector3f corner(const ShadedMesh& mesh, std::size_t triangle, std::size_t k) {
    return Vector3f(mesh.positions.at(mesh.triangles.at(triangle).at(k)).data());
}

double area(const ShadedMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        sum +=
            (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0)).norm() /
            2.0;
    return sum;
}

/// The least height over the plane.
float lowest(const ShadedMesh& mesh, const Vector3f& normal, float offset) {
    float least = 0;
    for (const auto& p : mesh.positions) least = std::min(least, normal.dot(Vector3f(p.data())) - offset);
    return least;
}

TEST(Half, TwoMakeTheWhole) {
    const ShadedMesh mesh = solid();
    for (int turn = 0; turn < 12; ++turn) {
        const float angle = static_cast<float>(turn) * std::numbers::pi_v<float> / 6;
        const Vector3f normal = Vector3f(std::cos(angle), std::sin(angle), 0.4F).normalized();
        for (const float offset : {-3.0F, -0.3F, 0.0F, 0.45F, 3.0F}) {
            const ShadedMesh above = half(mesh, normal, offset), below = half(mesh, -normal, -offset);
            EXPECT_NEAR(area(above) + area(below), area(mesh), 1e-4 * area(mesh));
            EXPECT_GE(lowest(above, normal, offset), -1e-6F);
            EXPECT_GE(lowest(below, -normal, -offset), -1e-6F);
        }
    }
}

// Corners on the plane are no reason to cut: nothing without an area comes out.
TEST(Half, OfATriangleWithASideInThePlane) {
    ShadedMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.triangles = {{0, 1, 2}};
    EXPECT_EQ(half(mesh, Vector3f::UnitY(), 0).triangles.size(), 1U);
    EXPECT_TRUE(half(mesh, -Vector3f::UnitY(), 0).triangles.empty());
}

TEST(PartOf, HasTheTrianglesAndNoOtherVertices) {
    const ShadedMesh mesh = solid();
    const std::vector<std::size_t> chosen = {3, 4, 40};
    const ShadedMesh part = part_of(mesh, chosen);
    ASSERT_EQ(part.triangles.size(), chosen.size());
    for (std::size_t t = 0; t < chosen.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corner(part, t, k), corner(mesh, chosen[t], k));
    EXPECT_LE(part.positions.size(), 9U);
    EXPECT_EQ(part.normals.size(), part.positions.size());
}

}  // namespace
}  // namespace insym
