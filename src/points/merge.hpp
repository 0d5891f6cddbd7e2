// Points closer than the resolution are one point (definitions, section 1).
#pragma once

#include "insym/point_set.hpp"

namespace insym {

/// `points` with each point that lies within `resolution` of an earlier kept one of the same label
/// left out. The order of the others is kept. O(n log n) for well-spread points.
PointSet merge_equal_points(const PointSet& points, double resolution);

}  // namespace insym
