#include "symmetries/anchors.hpp"

#include <algorithm>
#include <numeric>
#include <queue>

namespace insym {
namespace {

/// The points of a cycle that have a link in either direction: not the ends of an open one.
std::span<const int> inner_points(const Cycle& cycle) {
    const std::span<const int> all(cycle.points);
    return cycle.closed ? all : all.subspan(1, all.size() - 2);
}

}  // namespace

Anchors::Anchors(const std::vector<Cycle>& cycles, int points)
    : place_(cycles.size(), -1), words_each_((static_cast<std::size_t>(points) + 63) / 64) {
    choose(cycles, points);
    collect_links(cycles);
    index_ends();
}

void Anchors::choose(const std::vector<Cycle>& cycles, int points) {
    std::vector<std::vector<int>> through(static_cast<std::size_t>(points));
    for (std::size_t c = 0; c < cycles.size(); ++c)
        for (const int p : inner_points(cycles[c]))
            through[static_cast<std::size_t>(p)].push_back(static_cast<int>(c));
    // So many cycles without an anchor pass through each point; what the queue says may be too high.
    std::vector<int> left;
    std::priority_queue<std::pair<int, int>> queue;
    for (int p = 0; p < points; ++p) {
        left.push_back(static_cast<int>(through[static_cast<std::size_t>(p)].size()));
        if (left.back() > 0) queue.emplace(left.back(), p);
    }
    while (!queue.empty()) {
        const auto [said, p] = queue.top();
        queue.pop();
        const int now = left[static_cast<std::size_t>(p)];
        if (now == 0) continue;
        if (now < said) {
            queue.emplace(now, p);
            continue;
        }
        for (const int c : through[static_cast<std::size_t>(p)]) {
            int& place = place_[static_cast<std::size_t>(c)];
            if (place >= 0) continue;
            place = size();
            for (const int q : inner_points(cycles[static_cast<std::size_t>(c)]))
                --left[static_cast<std::size_t>(q)];
        }
        points_.push_back(p);
    }
}

/// In order of anchor and end, and, as they come, of cycle and direction.
void Anchors::collect_links(const std::vector<Cycle>& cycles) {
    std::vector<AnchoredLink> links;
    links.reserve(2 * cycles.size());
    for (std::size_t c = 0; c < cycles.size(); ++c) {
        const std::vector<int>& p = cycles[c].points;
        const auto at = static_cast<std::size_t>(std::find(p.begin(), p.end(), point(place_[c])) - p.begin());
        const int cycle = static_cast<int>(c);
        links.push_back({p[(at + 1) % p.size()], cycle, false, cycles[c].types});
        links.push_back({p[(at + p.size() - 1) % p.size()], cycle, true, cycles[c].types});
    }
    const std::size_t ends = 64 * words_each_;
    const auto bin = [&](const AnchoredLink& link) {
        return static_cast<std::size_t>(place_of(link.cycle)) * ends + static_cast<std::size_t>(link.to);
    };
    std::vector<std::size_t> next(points_.size() * ends + 1, 0);
    for (const AnchoredLink& link : links) ++next[bin(link) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    links_.resize(links.size());
    for (const AnchoredLink& link : links) links_[next[bin(link)]++] = link;
}

void Anchors::index_ends() {
    words_.resize(points_.size() * words_each_ + 1);
    for (std::size_t k = 0; k < links_.size(); ++k) {
        const AnchoredLink& link = links_[k];
        Word& word = words_[word_of(place_of(link.cycle), link.to)];
        const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(link.to) % 64U);
        if ((word.bits & bit) == 0) start_.push_back(k);
        word.bits |= bit;
    }
    start_.push_back(links_.size());
    for (std::size_t w = 1; w < words_.size(); ++w)
        words_[w].ends_before = words_[w - 1].ends_before + std::popcount(words_[w - 1].bits);
}

}  // namespace insym
