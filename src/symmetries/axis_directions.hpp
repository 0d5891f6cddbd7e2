// Directions of the axes about which half-turns may exchange many pairs.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "points/cloud.hpp"

namespace insym {

/// The `most` directions that most segments suggest, best first. A half-turn that exchanges P1, P2 and Q1, Q2
/// carries the segment P1 Q1 to P2 Q2: these are equally long, and the sum of the two lies along its axis. So
/// an axis with k pairs is suggested k (k - 1) times, less where segments are alike. Of sets of more than 128
/// points the outermost are asked, among which the mates under a symmetry of the whole are together. O(n)
/// beyond that.
std::vector<Eigen::Vector3d> axis_directions(const Cloud& cloud, std::size_t most);

}  // namespace insym
