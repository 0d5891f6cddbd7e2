// The orbits of a symmetry: runs of points, the gaps between them, rings of whole order.
#pragma once

#include <vector>

#include "support/support.hpp"

namespace insym {

/// A symmetry as it lies on the points.
struct Pattern {
    Support support;
    std::vector<Orbit> runs;               ///< of two points and more, in the direction of the map
    std::vector<Eigen::Vector3d> missing;  ///< empty places inside orbits (definitions, section 7)
    Evidence evidence;
    double significance = 0;
    int period = 0;  ///< the least power of the map that moves nothing; 0: none
};

/// Lays the links out as runs, joins those that lie on one orbit with empty places between (up to twelve, or
/// once round a ring of whole order), and judges again with the gaps that close. O(links * places looked at).
Pattern trace(const Cloud& cloud, const Significance& significance, const Support& support);

/// The least q up to 200 with q turns of `angle` (radians) whole to within q * `slack`, and the turns made;
/// 0: none.
struct WholeOrder {
    int order = 0;
    int turns = 0;
};
WholeOrder whole_order(double angle, double slack);

/// How well the links of a turn say its angle, in radians.
double angle_slack(const Cloud& cloud, const Support& support, const Motion& motion);

}  // namespace insym
