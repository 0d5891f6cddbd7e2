// The longest distance in a point set (definitions, section 1).
#pragma once

#include "insym/point_set.hpp"

#include <vector>

namespace insym {

/// |pq|; the same formula everywhere, so that equal inputs give equal bytes.
double distance(const Point& p, const Point& q);

/// Exact. Near-linear where a few points are far from the centroid, O(n^2) on a sphere.
double diameter(const std::vector<Point>& positions);

}  // namespace insym
