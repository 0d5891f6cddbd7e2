// Cycle detection by point expansion (definitions, section 4; the paper's section 4).
#pragma once

#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// Which seeds a search starts from.
enum class SeedChoice {
    all,
    needed,  ///< not those that follow from others and a translation of many points (class Rows)
};

struct CycleSearch {
    SeedChoice seeds = SeedChoice::all;
    /// With more chains of four points the tolerance is lowered, a fifth at a time and not below ten
    /// resolutions, until there are no more; 0: never.
    std::size_t most_chains = 0;
    /// Of the ends of chains of four, kept in memory, 32 bytes each with what is known of them; with more,
    /// all are made anew when asked for. Only time and memory depend on it, and less of both is needed with
    /// them.
    std::size_t most_stored = std::size_t{1} << 28;
};

struct CycleSearchResult {
    double max_tolerance = 0;  ///< up to which was searched
    std::size_t seeds = 0;     ///< near-isosceles triangles that satisfy C1, where the search started
    std::size_t superfluous_seeds = 0;  ///< near-isosceles triangles that were left out
    std::size_t translations = 0;       ///< from which those follow
    std::vector<Cycle> cycles;          ///< in canonical form and order
};

/// All cycles of three points and more that branch out from the chosen seeds. Parallel over the apexes of
/// the seeds; the same result for any number of threads. Stops early, with the cycles found so far,
/// when `monitor` says so; advances its stage twice for each point.
CycleSearchResult detect_cycles(const Scene& scene, const CycleSearch& search, RunMonitor& monitor);

}  // namespace insym
