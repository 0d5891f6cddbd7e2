#include "cycles/regions.hpp"

#include <algorithm>
#include <tuple>

#include <tbb/enumerable_thread_specific.h>

#include "cycles/chain.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

struct Extent {
    double low = 0;
    double high = 0;
    double length() const { return high - low; }
};

double coordinate(const PointScene& scene, int i, int axis) {
    return scene.position(i)[static_cast<std::size_t>(axis)];
}

Extent extent(const PointScene& scene, int axis) {
    Extent e{coordinate(scene, 0, axis), coordinate(scene, 0, axis)};
    for (int i = 1; i < scene.size(); ++i) {
        e.low = std::min(e.low, coordinate(scene, i, axis));
        e.high = std::max(e.high, coordinate(scene, i, axis));
    }
    return e;
}

int longest_axis(const PointScene& scene) {
    int longest = 0;
    for (int axis = 1; axis < scene.dimension(); ++axis)
        if (extent(scene, axis).length() > extent(scene, longest).length()) longest = axis;
    return longest;
}

PointSet part_of(const PointSet& all, const std::vector<int>& chosen) {
    PointSet part;
    part.dimension = all.dimension;
    for (const int i : chosen) {
        part.positions.push_back(all.positions[static_cast<std::size_t>(i)]);
        if (!all.labels.empty()) part.labels.push_back(all.labels[static_cast<std::size_t>(i)]);
    }
    return part;
}

/// The cycles of one slab, with the indices of all points. As `slab` ascends, canonical stays canonical.
CycleSearchResult search_slab(const Scene& scene, const std::vector<int>& slab, const CycleSearch& how,
                              RunMonitor& monitor) {
    const PointSet points = part_of(scene.points, slab);
    const Distances distances(points.positions);
    const PointScene part{points, scene.diameter, scene.resolution, scene.max_tolerance};
    CycleSearchResult found = detect_cycles({part, distances}, how, monitor);
    for (Cycle& cycle : found.cycles)
        for (int& p : cycle.points) p = slab[static_cast<std::size_t>(p)];
    return found;
}

/// Drops what is ambiguous among all points; says how many.
std::size_t drop_ambiguous(const Scene& scene, std::vector<Cycle>& cycles) {
    const Fourths fourths(scene);
    tbb::enumerable_thread_specific<ChainOracle> oracles([&] { return ChainOracle(scene, fourths); });
    std::vector<char> ambiguous(cycles.size());  // not of bits: written by several threads
    parallel_for(cycles.size(), [&](std::size_t k) {
        const Cycle& c = cycles[k];
        ambiguous[k] = oracles.local().unambiguous(c.points, c.closed, c.tolerance.min) ? 0 : 1;
    });
    std::vector<Cycle> kept;
    for (std::size_t k = 0; k < cycles.size(); ++k)
        if (ambiguous[k] == 0) kept.push_back(std::move(cycles[k]));
    cycles.swap(kept);
    return kept.size() - cycles.size();
}

}  // namespace

std::vector<std::vector<int>> slabs(const PointScene& scene, int count, int axis) {
    const Extent e = extent(scene, axis);
    std::vector<std::vector<int>> result(static_cast<std::size_t>(count));
    for (int i = 0; i < scene.size(); ++i) {
        const double share = e.length() > 0 ? (coordinate(scene, i, axis) - e.low) / e.length() : 0;
        const int place = std::min(count - 1, static_cast<int>(share * count));
        result[static_cast<std::size_t>(place)].push_back(i);
    }
    return result;
}

RegionSearchResult detect_cycles_in_regions(const Scene& scene, const Regions& regions,
                                            const CycleSearch& how, RunMonitor& monitor) {
    RegionSearchResult result;
    result.axis = regions.axis.value_or(longest_axis(scene));
    if (regions.count == 1) {
        result.search = detect_cycles(scene, how, monitor);
        return result;
    }
    CycleSearch in_slab = how;
    in_slab.most_chains = 0;
    result.search.max_tolerance = scene.max_tolerance;
    std::vector<Cycle>& cycles = result.search.cycles;
    for (const std::vector<int>& slab : slabs(scene, regions.count, result.axis)) {
        if (slab.size() < 3) continue;
        CycleSearchResult found = search_slab(scene, slab, in_slab, monitor);
        result.search.seeds += found.seeds;
        result.search.superfluous_seeds += found.superfluous_seeds;
        result.search.translations += found.translations;
        std::move(found.cycles.begin(), found.cycles.end(), std::back_inserter(cycles));
    }
    std::sort(cycles.begin(), cycles.end(), [](const Cycle& a, const Cycle& b) {
        return std::tie(a.points, a.closed) < std::tie(b.points, b.closed);
    });
    result.ambiguous = drop_ambiguous(scene, cycles);
    return result;
}

}  // namespace insym
