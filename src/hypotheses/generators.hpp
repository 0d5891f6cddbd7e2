// Where method `robust` looks: isometries that pairs, chains and frames of points suggest.
#pragma once

#include <array>
#include <vector>

#include "hypotheses/hypothesis.hpp"
#include "run_monitor.hpp"
#include "support/cloud.hpp"

namespace insym {

/// Points of one label that are looked at all with all: a whole class, or a part of a large one.
using SearchGroup = std::vector<int>;

/// Every class of equal labels that is small enough, and overlapping neighbourhoods of the larger ones, so
/// that what is near and what covers the whole is met. O(n) groups' points for a fixed `most`.
std::vector<SearchGroup> search_groups(const Cloud& cloud, std::size_t most);

/// Translations, inversions and mirrors: each pair of points is a vote for one of each. Votes are counted in
/// cells of several sizes up to `reach`; the fullest `most` cells of each size come back, fullest first.
/// Time and memory linear in `most_pairs`.
std::vector<Hypothesis> vote(const Cloud& cloud, SymmetryType type, double reach, std::size_t most_pairs,
                             std::size_t most);

/// A chain of points, or two pairs, that may be carried into one another. Small, as there are many.
struct Candidate {
    double rank = 0;  ///< the lower, the less likely by chance
    SymmetryType type = SymmetryType::screw;
    /// rotation of three points A, B, C (the last is -1); half-turn: A, A', B, B'; else A to B to C to D.
    std::array<int, 4> points{{-1, -1, -1, -1}};
};

/// Half-turns from two pairs A, A' and B, B' with |AB| = |A'B'| and |AB'| = |A'B|. The `most` that agree
/// best, best first.
std::vector<Candidate> half_turns(const Cloud& cloud, const SearchGroup& group, double reach,
                                  std::size_t most);

/// Rotations from three points A, B, C with |AB| = |BC|, one of whose neighbours on the ring is there; every
/// other kind from four with |AB| = |BC| = |CD| and |AC| = |BD|. The `most` that chance explains least, best
/// first.
std::vector<Candidate> chains(const Cloud& cloud, const SearchGroup& group, double reach, std::size_t most);

/// The isometry that a candidate stands for.
Hypothesis hypothesis_of(const Cloud& cloud, const Candidate& candidate);

/// Isometries that leave `center` in place, from the images of two points of the smallest shells about it:
/// every symmetry of the whole set is among them if that is its centre.
std::vector<Hypothesis> frames(const Cloud& cloud, const Eigen::Vector3d& center, double reach,
                               std::size_t most);

/// The isometry of either determinant that carries triangle abc to def.
RigidMap carry(const std::array<Eigen::Vector3d, 3>& from, const std::array<Eigen::Vector3d, 3>& to,
               bool improper);

}  // namespace insym
