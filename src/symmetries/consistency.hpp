// Which cycles of one type can belong to one symmetry (definitions, section 6).
#pragma once

#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// Two consistent members of a list, and E_min of their union.
struct Consistency {
    double tolerance = 0;
    int first = 0;
    int second = 0;         ///< > first
    bool reversed = false;  ///< the second runs backwards in the union
};

/// All consistent pairs among `members`, cycles that all have type `type`, in order of (first,
/// second). Parallel over the first. O(members x distinct end links), plus the pairs that pass.
std::vector<Consistency> consistent_cycles(const Scene& scene, const std::vector<const Cycle*>& members,
                                           SymmetryType type, RunMonitor& monitor);

}  // namespace insym
