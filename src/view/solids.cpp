#include "view/solids.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>

namespace insym {
namespace {

using Eigen::Vector3f;
constexpr float kTurn = 2 * std::numbers::pi_v<float>;

std::array<float, 3> array_of(const Vector3f& v) {
    return {v.x(), v.y(), v.z()};
}

struct Vertex {
    Vector3f position, normal;
};

/// Two triangles for each cell of a grid of rows x columns cells.
void add_grid(int rows, int columns, const std::function<Vertex(float, float)>& at, ShadedMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
            const Vertex vertex = at(static_cast<float>(i) / static_cast<float>(rows),
                                     static_cast<float>(j) / static_cast<float>(columns));
            mesh.positions.push_back(array_of(vertex.position));
            mesh.normals.push_back(array_of(vertex.normal.normalized()));
        }
    const auto width = static_cast<std::uint32_t>(columns) + 1;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const std::uint32_t a =
                first + static_cast<std::uint32_t>(i) * width + static_cast<std::uint32_t>(j);
            // At a pole or a tip one of the two has no area.
            if (mesh.positions[a] != mesh.positions[a + 1]) mesh.triangles.push_back({a, a + 1, a + width});
            if (mesh.positions[a + width] != mesh.positions[a + width + 1])
                mesh.triangles.push_back({a + 1, a + width + 1, a + width});
        }
}

}  // namespace

std::pair<Vector3f, Vector3f> square_to(const Vector3f& normal) {
    const Vector3f other = std::abs(normal.z()) < 0.9F ? Vector3f::UnitZ() : Vector3f::UnitX();
    const Vector3f u = other.cross(normal).normalized();
    return {u, normal.cross(u).normalized()};
}

void add_sphere(const Vector3f& centre, float radius, ShadedMesh& mesh) {
    add_grid(
        8, 12,
        [&](float i, float j) {
            const float polar = i * kTurn / 2, turn = j * kTurn;
            const Vector3f normal(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                  std::cos(polar));
            return Vertex{centre + radius * normal, normal};
        },
        mesh);
}

void add_tube(const Vector3f& from, const Vector3f& to, float radius, ShadedMesh& mesh) {
    const Vector3f along = to - from;
    if (!(along.norm() > 0)) return;
    const auto [u, v] = square_to(along.normalized());
    const Vector3f a = u, b = v;
    add_grid(
        1, 8,
        [&](float i, float j) {
            const Vector3f normal = std::cos(j * kTurn) * a + std::sin(j * kTurn) * b;
            return Vertex{from + i * along + radius * normal, normal};
        },
        mesh);
}

void add_dashes(const Vector3f& from, const Vector3f& to, float radius, float dash, ShadedMesh& mesh) {
    const int count = std::max(1, static_cast<int>(std::lround((to - from).norm() / (1.6F * dash))));
    const Vector3f step = (to - from) / static_cast<float>(count);
    for (int i = 0; i < count; ++i) {
        const Vector3f start = from + static_cast<float>(i) * step;
        add_tube(start, start + 0.62F * step, radius, mesh);
    }
}

void add_cone(const Vector3f& tip, const Vector3f& along, float length, ShadedMesh& mesh) {
    if (!(along.norm() > 0)) return;
    const Vector3f d = along.normalized();
    const auto [u, v] = square_to(d);
    const Vector3f a = u, b = v;
    constexpr float kSlope = 0.4F;
    const auto around = [&](float j) -> Vector3f {
        return std::cos(j * kTurn) * a + std::sin(j * kTurn) * b;
    };
    add_grid(
        1, 16,
        [&](float i, float j) {
            const Vector3f out = around(j);
            return Vertex{tip - i * length * d + i * kSlope * length * out, out + kSlope * d};
        },
        mesh);
    add_grid(
        1, 16,
        [&](float i, float j) {
            return Vertex{tip - length * d + (1 - i) * kSlope * length * around(j), -d};
        },
        mesh);
}

void add_ring(const Vector3f& centre, const Vector3f& normal, float radius, float thickness,
              ShadedMesh& mesh) {
    const auto [u, v] = square_to(normal.normalized());
    const Vector3f a = u, b = v, n = normal.normalized();
    add_grid(
        24, 6,
        [&](float i, float j) {
            const Vector3f out = std::cos(i * kTurn) * a + std::sin(i * kTurn) * b;
            const Vector3f tube = std::cos(j * kTurn) * out + std::sin(j * kTurn) * n;
            return Vertex{centre + radius * out + thickness * tube, tube};
        },
        mesh);
}

void add_sheet(const std::array<Vector3f, 4>& corners, ShadedMesh& mesh) {
    const Vector3f right = corners[1] - corners[0], up = corners[3] - corners[0];
    add_grid(
        1, 1,
        [&](float i, float j) {
            return Vertex{corners[0] + i * up + j * right, right.cross(up)};
        },
        mesh);
}

}  // namespace insym
