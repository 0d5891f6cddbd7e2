#include "symmetries/detect_symmetries.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

#include "parallel_for.hpp"
#include "symmetries/clusters.hpp"
#include "symmetries/consistency.hpp"
#include "symmetries/pairs.hpp"

namespace insym {
namespace {

constexpr std::array kCycleTypes = {SymmetryType::rotation, SymmetryType::translation,
                                    SymmetryType::glide_reflection, SymmetryType::rotation_reflection,
                                    SymmetryType::screw};

Symmetry from_cycle(SymmetryType type, const Cycle& cycle, bool maximal) {
    Symmetry symmetry;
    symmetry.type = type;
    symmetry.cycles = {{cycle.points, cycle.closed}};
    symmetry.tolerance = cycle.tolerance;
    symmetry.maximal = maximal;
    return symmetry;
}

Symmetry from_cluster(SymmetryType type, const Cluster& cluster, const std::vector<const Cycle*>& members) {
    Symmetry symmetry;
    symmetry.type = type;
    symmetry.maximal = cluster.maximal;
    symmetry.tolerance = {cluster.tolerance, std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < cluster.members.size(); ++k) {
        const Cycle& cycle = *members[static_cast<std::size_t>(cluster.members[k])];
        Orbit orbit{cycle.points, cycle.closed};
        if (cluster.reversed[k] != 0) std::reverse(orbit.points.begin(), orbit.points.end());
        symmetry.cycles.push_back(std::move(orbit));
        symmetry.tolerance.max = std::min(symmetry.tolerance.max, cycle.tolerance.max);
    }
    return symmetry;
}

/// `pairs`: the consistent ones of the type, by their places among all cycles.
SymmetrySearchResult of_type(const std::vector<Cycle>& cycles, SymmetryType type,
                             std::vector<Consistency> pairs, double resolution) {
    SymmetrySearchResult result;
    std::vector<const Cycle*> members;
    std::vector<int> place(cycles.size(), -1);
    for (std::size_t c = 0; c < cycles.size(); ++c)
        if (cycles[c].types.contains(type)) {
            place[c] = static_cast<int>(members.size());
            members.push_back(&cycles[c]);
        }
    for (Consistency& pair : pairs) {
        pair.first = place[static_cast<std::size_t>(pair.first)];
        pair.second = place[static_cast<std::size_t>(pair.second)];
    }

    std::vector<double> tolerance_max;
    tolerance_max.reserve(members.size());
    for (const Cycle* c : members) tolerance_max.push_back(c->tolerance.max);
    const Clustering clustering =
        complete_components(members.size(), std::move(pairs), tolerance_max, resolution);
    result.frustrated = clustering.frustrated;
    result.symmetries.reserve(members.size() + clustering.clusters.size());
    for (std::size_t m = 0; m < members.size(); ++m)
        result.symmetries.push_back(from_cycle(type, *members[m], clustering.clustered[m] == 0));
    for (const Cluster& c : clustering.clusters) result.symmetries.push_back(from_cluster(type, c, members));
    return result;
}

Symmetry from_pairs(const PairCluster& cluster) {
    Symmetry symmetry;
    symmetry.type = cluster.type;
    symmetry.maximal = cluster.maximal;
    symmetry.tolerance = {cluster.tolerance, std::numeric_limits<double>::infinity()};
    symmetry.cycles.reserve(cluster.pairs.size());
    for (const Pair& p : cluster.pairs) symmetry.cycles.push_back({{p.first, p.second}, true});
    return symmetry;
}

bool has_pair_type(TypeSet types) {
    return std::any_of(kAllSymmetryTypes.begin(), kAllSymmetryTypes.end(),
                       [&](SymmetryType type) { return is_pair_type(type) && types.contains(type); });
}

/// A set of which so many points have exact mates is drawn, not measured: what is rough besides is taken for
/// chance.
std::vector<PairCluster> clusters_of_pairs(const Scene& scene, TypeSet types, std::size_t most_exact,
                                           RunMonitor& monitor, SymmetrySearchResult& result) {
    constexpr double kDrawn = 0.25;
    if (most_exact > 0 && has_pair_type(types)) {
        ExactPairs exact = detect_exact_pairs(scene, types, most_exact, monitor);
        if (exact.share >= kDrawn) {
            result.exact_kinds = std::move(exact.kinds);
            return std::move(exact.clusters);
        }
    }
    return detect_pairs(scene, types, monitor);
}

}  // namespace

SymmetrySearchResult detect_symmetries(const Scene& scene, const std::vector<Cycle>& cycles, TypeSet types,
                                       std::size_t most_exact, RunMonitor& monitor) {
    SymmetrySearchResult result;
    ConsistentPairs consistent = consistent_cycles(scene, cycles, types, monitor);
    std::array<SymmetrySearchResult, kCycleTypes.size()> parts;
    parallel_for(parts.size(), [&](std::size_t k) {
        const SymmetryType type = kCycleTypes[k];
        if (types.contains(type))
            parts[k] = of_type(cycles, type, std::move(consistent[static_cast<std::size_t>(type)]),
                               scene.resolution);
    });
    std::size_t count = 0;
    for (const SymmetrySearchResult& part : parts) count += part.symmetries.size();
    result.symmetries.reserve(count);
    for (SymmetrySearchResult& part : parts) {
        result.frustrated += part.frustrated;
        std::move(part.symmetries.begin(), part.symmetries.end(), std::back_inserter(result.symmetries));
    }
    const std::vector<PairCluster> pairs = clusters_of_pairs(scene, types, most_exact, monitor, result);
    const std::size_t before = result.symmetries.size();
    result.symmetries.resize(before + pairs.size());
    parallel_for(pairs.size(), [&](std::size_t k) { result.symmetries[before + k] = from_pairs(pairs[k]); });
    return result;
}

}  // namespace insym
