#include "view/shaded_mesh.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace insym {
namespace {

using Vector = std::array<double, 3>;

/// Edges that turn by less are smooth: circles of 24 sides and more are.
constexpr double kCreaseCosine = 0.82;  // 35 degrees

Vector difference(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Facet {
    Vector area{}, normal{};  ///< the first as long as twice the area; the second of length 1, or 0
};

Facet facet_of(const Tessellation& model, const std::array<int, 3>& triangle) {
    const auto corner = [&](std::size_t i) -> const Point& {
        return model.vertices[static_cast<std::size_t>(triangle[i])];
    };
    Facet facet;
    facet.area = cross(difference(corner(1), corner(0)), difference(corner(2), corner(0)));
    if (const double length = std::sqrt(dot(facet.area, facet.area)); length > 0)
        for (std::size_t k = 0; k < 3; ++k) facet.normal[k] = facet.area[k] / length;
    return facet;
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

std::array<float, 3> unit(const Vector& v, const Vector& otherwise) {
    const double length = std::sqrt(dot(v, v));
    std::array<float, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
        result[k] = static_cast<float>(length > 0 ? v[k] / length : otherwise[k]);
    return result;
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
        Vector sum{};
        for (const std::size_t t : around[static_cast<std::size_t>(v)])
            if (dot(facets[t].normal, facet.normal) >= kCreaseCosine)
                for (std::size_t k = 0; k < 3; ++k) sum[k] += facets[t].area[k];
        const std::array<float, 3> normal = unit(sum, facet.normal);
        const auto [place, is_new] = known.try_emplace({v, normal}, mesh.positions.size());
        if (is_new) {
            const Vector p = difference(model.vertices[static_cast<std::size_t>(v)], origin);
            mesh.positions.push_back(
                {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
            mesh.normals.push_back(normal);
        }
        return place->second;
    };
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
        if (!(dot(facets[t].normal, facets[t].normal) > 0)) continue;
        const auto& [a, b, c] = model.triangles[t];
        mesh.triangles.push_back({corner(a, facets[t]), corner(b, facets[t]), corner(c, facets[t])});
        mesh.faces.push_back(t < model.faces.size() ? model.faces[t] : 0);
    }
    return mesh;
}

}  // namespace insym
