// Cycle detection by point expansion (definitions, section 4; the paper's section 4).
#pragma once

#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

struct CycleSearchResult {
    std::size_t seeds = 0;      ///< near-isosceles triangles that satisfy C1
    std::vector<Cycle> cycles;  ///< in canonical form and order
};

/// All cycles of three points and more that branch out from the seeds. Parallel over the apexes of
/// the seeds; the same result for any number of threads. Stops early, with the cycles found so far,
/// when `monitor` says so; advances its stage twice for each point.
CycleSearchResult detect_cycles(const Scene& scene, RunMonitor& monitor);

}  // namespace insym
