// A tessellation with normals: smooth over faces and gentle edges, sharp elsewhere.
#pragma once

#include "insym/point_set.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace insym {

/// Vertices as pictures need them: one for each position and normal. Single precision, which pictures have.
struct ShadedMesh {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;            ///< of unit length
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< those with an area, in the order of the input
    std::vector<std::int64_t> faces;                      ///< of each triangle, as Tessellation::faces
};

/// Positions are taken relative to `origin`, so that single precision does for models far from zero.
ShadedMesh shade(const Tessellation& tessellation, const Point& origin);

}  // namespace insym
