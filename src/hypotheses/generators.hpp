// Where method `robust` looks: isometries that pairs, chains and frames of points suggest.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "hypotheses/hypothesis.hpp"
#include "points/cloud.hpp"
#include "points/distances.hpp"
#include "run_monitor.hpp"

namespace insym {

/// Points that are looked at all with all: those of one label, or a part of many.
using SearchGroup = std::vector<int>;

/// Of `points`, every class of equal labels that is small enough. Of a larger one: its points farthest out
/// (mates under a symmetry of the whole stand there together), overlapping neighbourhoods, and points whose
/// neighbours lie alike, as those of the copies of one part do. In all about n^1.2 points.
std::vector<SearchGroup> search_groups(const Cloud& cloud, const SearchGroup& points, std::size_t most);

/// Pairs of one label among `points`: all of them, or those of the points of some with all, spread over the
/// set, and of neighbours in the order of their distance from the middle.
using PointPairs = std::vector<std::pair<int, int>>;
PointPairs spread_pairs(const Cloud& cloud, const SearchGroup& points, std::size_t most);

/// Of each point, whether it is one of those that a suggestion must rest on. Empty: it may rest on any.
using Focus = std::vector<char>;

inline bool in(const Focus& focus, int point) {
    return focus.empty() || focus[static_cast<std::size_t>(point)] != 0;
}

/// All pairs of a group with a point of the focus.
PointPairs pairs_within(const SearchGroup& group, const Focus& focus);

/// Translations, inversions (half-turns in the plane) and mirrors: each pair is a vote for one of each. Votes
/// are counted in cells of several sizes up to `reach`; the fullest `most` cells of each size come back,
/// the smallest cells first, and the fullest of each size. Time and memory linear in the pairs.
std::vector<Hypothesis> vote(const Cloud& cloud, SymmetryType type, const PointPairs& pairs, double reach,
                             std::size_t most);

/// A group with the distances of its points, which go by their place in it; in their order about those of the
/// focus.
struct GroupDistances {
    const Cloud& cloud;
    const SearchGroup& group;
    std::vector<char> in_focus;  // each point of the group
    Distances distances;

    GroupDistances(const Cloud& of, const SearchGroup& points, const Focus& focus);
};

/// A chain of points, or two pairs, that may be carried into one another. Small, as there are many.
struct Candidate {
    double rank = 0;  ///< the lower, the less likely by chance
    SymmetryType type = SymmetryType::screw;
    /// rotation of three points A, B, C (the last is -1); half-turn: A, A', B, B'; else A to B to C to D.
    std::array<int, 4> points{{-1, -1, -1, -1}};
};

/// In the order of their ranks; of equal ones by their points.
bool before(const Candidate& x, const Candidate& y);

/// Half-turns from two pairs A, A' and B, B' with |AB| = |A'B'| and |AB'| = |A'B|. The `most` that agree
/// best, in any order. The first pair has a point of the focus. About `looks` pairs of pairs are looked at,
/// and at least four for each pair.
std::vector<Candidate> half_turns(const GroupDistances& group, double reach, double looks, std::size_t most);

/// Rotations from three points A, B, C with |AB| = |BC|, one of whose neighbours on the ring is there; every
/// other kind from four with |AB| = |BC| = |CD| and |AC| = |BD|. The `most` that chance explains least, in
/// any order. Of a large group `reach` is lowered until chance gives about 60,000 of three and 10,000 of
/// four, each times `effort`. B, or C of four, is of the focus.
std::vector<Candidate> chains(const GroupDistances& group, double reach, double effort, std::size_t most);

struct Agreed {
    std::vector<Candidate> candidates;
    std::size_t agreeing = 0;  ///< the first so many stand for more than one
};

/// Candidates that say the same isometry to the resolution are one: the best of them stays, and what most of
/// them say comes first; the others follow, the best first. O(candidates), and to sort what is left.
Agreed agreeing_first(const Cloud& cloud, const std::vector<Candidate>& candidates);

/// How far its distances are from agreeing; at least the resolution but for half-turns.
double disagreement(const Cloud& cloud, const Candidate& candidate);

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
