// From cycles and pairs to symmetries (definitions, section 6).
#pragma once

#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

struct SymmetrySearchResult {
    std::vector<Symmetry> symmetries;  ///< type, cycles, tolerance and `maximal` set; the rest empty
    int frustrated = 0;                ///< components without a common direction, left out
};

/// All symmetries of the wanted `types`: single cycles, complete components of consistent cycles, and
/// clusters of pairs (those that could be listed). Stops early, with what it has, when `monitor` says so.
SymmetrySearchResult detect_symmetries(const Scene& scene, const std::vector<Cycle>& cycles, TypeSet types,
                                       RunMonitor& monitor);

}  // namespace insym
