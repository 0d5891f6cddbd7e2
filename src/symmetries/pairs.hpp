// Symmetries of pairs of points: mirrors, inversions and half-turns (definitions, section 6).
#pragma once

#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// Two points that an involution exchanges; first < second.
struct Pair {
    int first = 0;
    int second = 0;
    friend auto operator<=>(const Pair&, const Pair&) = default;
};

/// Mutually consistent pairs of one type.
struct PairCluster {
    SymmetryType type = SymmetryType::mirror;
    double tolerance = 0;     ///< E_min
    std::vector<Pair> pairs;  ///< ascending
    bool maximal = true;
};

/// The clusters of pairs of the `types` M, I and half-turn that could be listed: coverage 1, or
/// pairs + fixed points >= 4, which the caller checks exactly. Parallel; the same result for any number of
/// threads. O(n^3) with a small constant, memory linear in the pairs that are consistent.
std::vector<PairCluster> detect_pairs(const Scene& scene, TypeSet types, RunMonitor& monitor);

}  // namespace insym
