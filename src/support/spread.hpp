// The largest spread of an orbit or cross orbit of a symmetry (definitions, sections 2 and 6).
#pragma once

#include <vector>

#include "scene.hpp"

namespace insym {

/// Exact, at least the resolution; O(points of the orbits squared). Where every link is met within
/// `deviation` and that is too little to show, the resolution at once.
double spread(const PointScene& scene, const std::vector<Orbit>& orbits, double deviation);

}  // namespace insym
