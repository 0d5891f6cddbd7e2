// Where to look for the partners of a cycle: few points, so that each cycle passes through one of them.
#pragma once

#include "insym/detect.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace insym {

/// A link of a cycle, in one of its two directions, that starts at the cycle's anchor.
struct AnchoredLink {
    int to = 0;
    int cycle = 0;
    bool reversed = false;  ///< the link belongs to the cycle read backwards
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

    /// All that start at an anchor, by end, cycle and direction.
    std::span<const AnchoredLink> links(int place) const {
        const auto k = static_cast<std::size_t>(place);
        return {links_.data() + start_[k], start_[k + 1] - start_[k]};
    }
    /// Those of them that end at `to`.
    std::span<const AnchoredLink> links(int place, int to) const;

    /// Whether there are any; O(1).
    bool has_link(int place, int to) const {
        const auto bit = static_cast<std::size_t>(to);
        return (ends_[static_cast<std::size_t>(place) * words_ + bit / 64] >> (bit % 64) & 1U) != 0;
    }

private:
    void choose(const std::vector<Cycle>& cycles, int points);
    void collect_links(const std::vector<Cycle>& cycles);

    std::vector<int> points_;
    std::vector<int> place_;  // of each cycle's anchor in points_
    std::vector<AnchoredLink> links_;
    std::vector<std::size_t> start_;   // of each anchor's in links_, and the end
    std::size_t words_ = 0;            // of ends_ for each anchor
    std::vector<std::uint64_t> ends_;  // a bit for each point
};

}  // namespace insym
