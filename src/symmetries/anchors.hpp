// Where to look for the partners of a cycle: few points, so that each cycle passes through one of them.
#pragma once

#include "insym/detect.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace insym {

/// A link of a cycle, in one of its two directions, that starts at the cycle's anchor.
struct AnchoredLink {
    int to = 0;
    int cycle = 0;
    bool reversed = false;  ///< the link belongs to the cycle read backwards
    TypeSet types;          ///< of the cycle
};

/// Every cycle is given one of its points that have a link in either direction, its anchor. The point of most
/// cycles comes first, then that of most of the rest, and so on: greedily, so that few points serve all, and
/// most cycles have one of the first. Immutable after construction.
class Anchors {
public:
    /// `points`: how many there are in the set.
    Anchors(const std::vector<Cycle>& cycles, int points);

    int size() const { return static_cast<int>(points_.size()); }
    /// The place of the cycle's anchor, from 0.
    int place_of(int cycle) const { return place_[static_cast<std::size_t>(cycle)]; }
    int point(int place) const { return points_[static_cast<std::size_t>(place)]; }

    /// How many points the links from an anchor end at.
    int ends(int place) const { return first_end(place + 1) - first_end(place); }

    /// Calls visit(to, links) for each point at which links from the anchor end.
    template <class Visit>
    void visit_ends(int place, Visit visit) const {
        for (int e = first_end(place); e < first_end(place + 1); ++e)
            visit(links_of(e).front().to, links_of(e));
    }

    /// The links from the anchor to a point, by cycle and direction; O(1).
    std::span<const AnchoredLink> links(int place, int to) const {
        const Word& word = words_[word_of(place, to)];
        const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(to) % 64U);
        if ((word.bits & bit) == 0) return {};
        return links_of(word.ends_before + std::popcount(word.bits & (bit - 1)));
    }

    /// Which of the points from 64 w on are ends of links from the anchor.
    std::uint64_t end_bits(int place, int w) const { return words_[word_of(place, 64 * w)].bits; }
    int words() const { return static_cast<int>(words_each_); }

private:
    /// Which of 64 points are ends of links from an anchor.
    struct Word {
        std::uint64_t bits = 0;
        int ends_before = 0;
    };

    void choose(const std::vector<Cycle>& cycles, int points);
    void collect_links(const std::vector<Cycle>& cycles);
    void index_ends();

    std::size_t word_of(int place, int point) const {
        return static_cast<std::size_t>(place) * words_each_ + static_cast<std::size_t>(point) / 64;
    }
    int first_end(int place) const { return words_[word_of(place, 0)].ends_before; }
    std::span<const AnchoredLink> links_of(int end) const {
        const std::size_t first = start_[static_cast<std::size_t>(end)];
        return {links_.data() + first, start_[static_cast<std::size_t>(end) + 1] - first};
    }

    std::vector<int> points_;
    std::vector<int> place_;           // of each cycle's anchor in points_
    std::vector<AnchoredLink> links_;  // by anchor, end, cycle and direction
    std::vector<std::size_t> start_;   // of each anchor's each end in links_, and the end of all
    std::size_t words_each_ = 0;
    std::vector<Word> words_;  // of each anchor, and one more
};

}  // namespace insym
