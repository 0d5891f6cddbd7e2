#include "view/shaded_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "isometry/fit.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Edges that turn by less are smooth: circles of 24 sides and more are.
constexpr double kCreaseCosine = 0.82;  // 35 degrees

struct Facet {
    Vector3d area, normal;  ///< the first as long as twice the area; the second of length 1, or 0
};

Facet facet_of(const Tessellation& model, const std::array<int, 3>& triangle) {
    const auto corner = [&](std::size_t i) {
        return to_vector(model.vertices[static_cast<std::size_t>(triangle[i])]);
    };
    const Vector3d area = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    return {area, area.normalized()};
}

/// With one vertex for each position, so that normals go on over seams and from face to face.
Tessellation welded(const Tessellation& model) {
    Tessellation result;
    result.faces = model.faces;
    std::map<Point, int> known;
    std::vector<int> vertex_of;
    for (const Point& p : model.vertices) {
        const auto [place, is_new] = known.try_emplace(p, static_cast<int>(result.vertices.size()));
        if (is_new) result.vertices.push_back(p);
        vertex_of.push_back(place->second);
    }
    result.triangles = model.triangles;
    for (auto& triangle : result.triangles)
        for (int& v : triangle) v = vertex_of[static_cast<std::size_t>(v)];
    return result;
}

std::array<float, 3> in_single(const Vector3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

ShadedMesh shade(const Tessellation& tessellation, const Point& origin) {
    const Tessellation model = welded(tessellation);
    std::vector<Facet> facets;
    facets.reserve(model.triangles.size());
    std::vector<std::vector<std::size_t>> around(model.vertices.size());
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
        facets.push_back(facet_of(model, model.triangles[t]));
        for (const int v : model.triangles[t]) around[static_cast<std::size_t>(v)].push_back(t);
    }
    ShadedMesh mesh;
    std::map<std::pair<int, std::array<float, 3>>, std::uint32_t> known;  // vertex and normal
    const auto corner = [&](int v, const Facet& facet) {
        Vector3d sum(0, 0, 0);
        for (const std::size_t t : around[static_cast<std::size_t>(v)])
            if (facets[t].normal.dot(facet.normal) >= kCreaseCosine) sum += facets[t].area;
        const std::array<float, 3> normal =
            in_single(sum.squaredNorm() > 0 ? sum.normalized() : facet.normal);
        const auto [place, is_new] = known.try_emplace({v, normal}, mesh.positions.size());
        if (is_new) {
            mesh.positions.push_back(
                in_single(to_vector(model.vertices[static_cast<std::size_t>(v)]) - to_vector(origin)));
            mesh.normals.push_back(normal);
        }
        return place->second;
    };
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
        if (!(facets[t].normal.squaredNorm() > 0)) continue;
        const auto& [a, b, c] = model.triangles[t];
        mesh.triangles.push_back({corner(a, facets[t]), corner(b, facets[t]), corner(c, facets[t])});
        mesh.faces.push_back(t < model.faces.size() ? model.faces[t] : 0);
    }
    return mesh;
}

ShadedMesh part_of(const ShadedMesh& mesh, const std::vector<std::size_t>& triangles) {
    ShadedMesh part;
    std::unordered_map<std::uint32_t, std::uint32_t> known;
    for (const std::size_t t : triangles) {
        std::array<std::uint32_t, 3> corners = mesh.triangles[t];
        for (std::uint32_t& v : corners) {
            const auto [place, is_new] = known.try_emplace(v, part.positions.size());
            if (is_new) {
                part.positions.push_back(mesh.positions[v]);
                part.normals.push_back(mesh.normals[v]);
            }
            v = place->second;
        }
        part.triangles.push_back(corners);
    }
    return part;
}

ShadedMesh half(const ShadedMesh& mesh, const Vector3f& normal, float offset) {
    ShadedMesh cut;
    cut.positions = mesh.positions;
    cut.normals = mesh.normals;
    const auto height = [&](std::uint32_t v) {
        return normal.dot(Vector3f(cut.positions[v].data())) - offset;
    };
    const auto crossing = [&](std::uint32_t a, std::uint32_t b) {
        const float share = height(a) / (height(a) - height(b));
        for (auto* values : {&cut.positions, &cut.normals}) {
            const Vector3f from((*values)[a].data()), to((*values)[b].data());
            const Vector3f between = from + share * (to - from);
            values->push_back({between.x(), between.y(), between.z()});
        }
        return static_cast<std::uint32_t>(cut.positions.size() - 1);
    };
    for (const auto& triangle : mesh.triangles) {
        if (std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return height(v) <= 0; }))
            continue;
        std::vector<std::uint32_t> corners;  // three or four, in order
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = triangle[k], next = triangle[(k + 1) % 3];
            if (height(v) >= 0) corners.push_back(v);
            if (height(v) * height(next) < 0) corners.push_back(crossing(v, next));
        }
        for (std::size_t k = 2; k < corners.size(); ++k)
            cut.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
    std::vector<std::size_t> all(cut.triangles.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return part_of(cut, all);
}

}  // namespace insym
