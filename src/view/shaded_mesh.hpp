// A tessellation with normals: smooth over faces and gentle edges, sharp elsewhere.
#pragma once

#include "insym/point_set.hpp"

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace insym {

/// Vertices as pictures need them: one for each position and normal. Single precision, which pictures have.
struct ShadedMesh {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;            ///< of unit length
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< those with an area, in the order of the input
    std::vector<std::int64_t> faces;  ///< of each triangle, as Tessellation::faces; or empty
};

/// Positions are taken relative to `origin`, so that single precision does for models far from zero.
ShadedMesh shade(const Tessellation& tessellation, const Point& origin);

/// These triangles of a mesh, with the vertices that they need.
ShadedMesh part_of(const ShadedMesh& mesh, const std::vector<std::size_t>& triangles);

/// What lies on the side of `normal` of the plane normal · p = offset; triangles across it are cut.
ShadedMesh half(const ShadedMesh& mesh, const Eigen::Vector3f& normal, float offset);

}  // namespace insym
