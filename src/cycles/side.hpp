// The sides of a plane on which the fifth points of a chain lie (definitions, section 4).
#pragma once

#include <array>

#include "scene.hpp"

namespace insym {

/// On which side of the plane of three points, from the first, does `point` lie: 0 or 2; 1 is in it. In 2D
/// all are.
inline int side_of(const PointScene& scene, const std::array<int, 3>& plane, int point) {
    const auto from_first = [&](int i) {
        const Point& a = scene.position(plane[0]);
        const Point& p = scene.position(i);
        return Point{p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    };
    const Point u = from_first(plane[1]), v = from_first(plane[2]), w = from_first(point);
    const Point normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double volume = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2];
    return scene.dimension() == 2 || volume == 0 ? 1 : volume > 0 ? 2 : 0;
}

}  // namespace insym
