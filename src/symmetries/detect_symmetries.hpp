// From cycles and pairs to symmetries (definitions, section 6).
#pragma once

#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"
#include "symmetries/exact_pairs.hpp"

namespace insym {

struct SymmetrySearchResult {
    std::vector<Symmetry> symmetries;    ///< type, cycles, tolerance and `maximal` set; the rest empty
    int frustrated = 0;                  ///< components without a common direction, left out
    std::vector<ExactKind> exact_kinds;  ///< what was cut off the symmetries of pairs, if they were cut
};

/// All symmetries of the wanted `types`: single cycles, complete components of consistent cycles, and
/// clusters of pairs (those that could be listed). Unless `most_exact` is 0, of a set of which most points
/// have exact mates only the exact clusters of pairs, so many of each kind. Stops early, with what it has,
/// when `monitor` says so.
SymmetrySearchResult detect_symmetries(const Scene& scene, const std::vector<Cycle>& cycles, TypeSet types,
                                       std::size_t most_exact, RunMonitor& monitor);

}  // namespace insym
