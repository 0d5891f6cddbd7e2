// The paper's own remedy for large sets: cycles are searched region by region.
#pragma once

#include <vector>

#include "cycles/detect_cycles.hpp"
#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

struct RegionSearchResult {
    CycleSearchResult search;
    int axis = 0;               ///< the slabs are stacked along it: 0, 1, 2 are x, y, z
    std::size_t ambiguous = 0;  ///< cycles left out, as a point of another slab can replace one of theirs
};

/// The points of each of `regions.count` slabs of equal height, each slab in ascending order. The lowest
/// coordinate of a slab belongs to it; the highest of all to the last. `axis`: 0, 1 or 2.
std::vector<std::vector<int>> slabs(const PointScene& scene, int count, int axis);

/// The cycles that detect_cycles finds in each slab by itself, in canonical form and order, less those that
/// are ambiguous among all points (C2; C3 is asked of the slab alone). One slab gives what detect_cycles
/// gives; of more none lowers the tolerance. Cost: the squares of the sizes of the slabs in place of n^2, and
/// a shell of points for each point of a cycle.
RegionSearchResult detect_cycles_in_regions(const Scene& scene, const Regions& regions,
                                            const CycleSearch& how, RunMonitor& monitor);

}  // namespace insym
