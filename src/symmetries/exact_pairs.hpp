// Mirrors, inversions and half-turns of larger sets: those that are exact and exchange the most pairs.
#pragma once

#include <cstddef>
#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"
#include "symmetries/pairs.hpp"

namespace insym {

/// What detect_exact_pairs gives of one kind.
struct ExactKind {
    SymmetryType type = SymmetryType::mirror;
    std::size_t suggested = 0;  ///< isometries that three pairs or more agree on
    std::size_t kept = 0;
};

struct ExactPairs {
    std::vector<PairCluster> clusters;
    std::vector<ExactKind> kinds;  ///< of those that were asked for
    double share = 0;              ///< of the points that an exact symmetry of any of the kinds moves
};

/// Of each of the `types` M, I and half-turn the `most` isometries that exchange the most pairs to the
/// resolution, three at least. Each pair votes for its mirror and its centre; a half-turn is looked for about
/// the directions that most segments suggest. Where detect_pairs() compares all pairs with all in O(n^3),
/// this takes O(n^2), and memory linear in the pairs that vote, 800,000 at most. Parallel; the same
/// result for any number of threads.
ExactPairs detect_exact_pairs(const PointScene& scene, TypeSet types, std::size_t most, RunMonitor& monitor);

}  // namespace insym
