// Symmetries as complete components of the graph of consistent members (definitions, section 6).
#pragma once

#include <vector>

#include "symmetries/consistency.hpp"

namespace insym {

/// A set of mutually consistent members.
struct Cluster {
    double tolerance = 0;        ///< the largest E_min of its pairs
    std::vector<int> members;    ///< ascending
    std::vector<char> reversed;  ///< for each member: runs backwards, seen from the first
    bool maximal = true;         ///< no later component of the list holds it
};

struct Clustering {
    std::vector<Cluster> clusters;  ///< of two members and more, by tolerance
    std::vector<char> clustered;    ///< for each member: in one of them
    int frustrated = 0;             ///< complete components whose directions do not agree, left out
};

/// Lets the edges enter in order of tolerance, those within `resolution` of the first of a group
/// together, and records every component that is complete after a group, if its tolerance is below
/// `tolerance_max` of all its members. O(edges log edges) plus the size of the output.
Clustering complete_components(std::size_t members, std::vector<Consistency> edges,
                               const std::vector<double>& tolerance_max, double resolution);

}  // namespace insym
