// Which cycles of one type can belong to one symmetry (definitions, section 6).
#pragma once

#include <array>
#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// Two consistent cycles of a list, and E_min of their union.
struct Consistency {
    double tolerance = 0;
    int first = 0;
    int second = 0;         ///< > first
    bool reversed = false;  ///< the second runs backwards in the union
};

/// The consistent pairs of each type, at the type's value, in order of (first, second).
using ConsistentPairs = std::array<std::vector<Consistency>, kAllSymmetryTypes.size()>;

/// All consistent pairs among `cycles` for each of the wanted `types`. Parallel over the cycles. For each a
/// shell of points about every anchor up to its own, plus the pairs that pass.
ConsistentPairs consistent_cycles(const Scene& scene, const std::vector<Cycle>& cycles, TypeSet types,
                                  RunMonitor& monitor);

}  // namespace insym
