// A distance-preserving map of the plane or of space, and the words that describe it.
#pragma once

#include "insym/point_set.hpp"

#include <array>
#include <optional>

namespace insym {

/// A line: a point on it and a unit direction.
struct Axis {
    Point point{};
    Point direction{};
};

/// A plane (a line in 2D): a point on it and a unit normal.
struct Plane {
    Point point{};
    Point normal{};
};

/// x -> linear * x + translation, described by its geometric elements.
///
/// `linear` is orthogonal to rounding. In 2D only the upper left 2x2 block and the first two
/// coordinates of everything else are used; the rest is the identity. Which of the optional
/// elements are present follows from the type (definitions, section 7):
///   T, Z: `axis` along the step, `step`;  C, W, S: `axis` and `angle_deg` (S: also `plane` and `center`);
///   in 2D C has `center` in place of `axis`;  M, Z: `plane`;  I: `center`.
struct Isometry {
    int dimension = 3;
    std::array<std::array<double, 3>, 3> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Point translation{};

    double angle_deg = 0;  ///< turn about the axis, 0..180; 0 for T, Z and M, 180 for I in words
    double step = 0;       ///< length moved along the axis (W), in the plane (Z) or in all (T); >= 0
    std::optional<Axis> axis;
    std::optional<Plane> plane;
    std::optional<Point> center;

    Point apply(const Point& p) const {
        Point q = translation;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) q[i] += linear[i][j] * p[j];
        return q;
    }
};

}  // namespace insym
