#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "hypotheses/generators.hpp"
#include "hypotheses/places.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kFewVotes = 3;  // chance does as well with less

/// What a pair votes for, as a point: a translation's vector, an inversion's centre, a mirror's image of a
/// point far outside (which no plane through the set comes near).
Vector3d ballot_place(SymmetryType type, const Vector3d& a, const Vector3d& b, const Vector3d& outside) {
    if (type == SymmetryType::translation) return (b - a).dot(kAskew) < 0 ? Vector3d(a - b) : Vector3d(b - a);
    Vector3d middle = (a + b) / 2;
    if (type == SymmetryType::inversion || type == SymmetryType::half_turn) return middle;
    const Vector3d normal = b - a;
    const double square = normal.squaredNorm();
    if (!(square > 0)) return middle;  // too small a set for squares
    return outside - normal * (2 * normal.dot(outside - middle) / square);
}

RigidMap map_of(SymmetryType type, const Vector3d& a, const Vector3d& b, int dimension) {
    return fit_of_type(type, {{a, b}}, dimension);
}

/// A cell of the space of isometries, and the side of each axis on which the next one is nearer.
class Cell {
public:
    Cell(const Vector3d& place, double size) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = place[static_cast<Eigen::Index>(axis)] / size;
            auto low = static_cast<std::int64_t>(at);  // a call of floor takes longer
            if (at < static_cast<double>(low)) --low;
            sum_ += static_cast<std::uint64_t>(low) * kFactors[axis];
            beside_[axis] = at - static_cast<double>(low) < 0.5 ? 0 - kFactors[axis] : kFactors[axis];
        }
    }

    std::uint32_t key() const { return key_of(sum_); }

    /// Of the seven cells whose borders are nearest: `corner` 1 to 7, a bit for each axis.
    std::uint32_t key_beside(unsigned corner) const {
        std::uint64_t there = sum_;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((corner >> axis & 1U) != 0) there += beside_[axis];
        return key_of(there);
    }

private:
    static constexpr std::array<std::uint64_t, 3> kFactors{0xD1B54A32D192ED03ULL, 0xAEF17502108EF2D9ULL,
                                                           0x9FB21C651E98DF25ULL};
    static std::uint32_t key_of(std::uint64_t sum) {
        return static_cast<std::uint32_t>(mixed(sum, 0) >> 32U);
    }

    std::uint64_t sum_ = 0;
    std::array<std::uint64_t, 3> beside_{};
};

/// Votes by cell: a hash table with open addresses. Most cells beside a cell are empty, which a small set of
/// bits tells without a look at the table. Two cells of one key among so many are rare, and would only be
/// tried in vain.
class Cells {
public:
    explicit Cells(std::size_t most) {
        std::size_t size = 16;
        while (size < 2 * most) size *= 2;
        mask_ = size - 1;
        slots_.resize(size);
        filled_.resize(size / 8);
    }

    struct Slot {
        std::uint32_t key = 0;
        int count = 0;
        int first = 0;  // of the ballots
    };

    void add(std::uint32_t key, int ballot) {
        Slot& s = slots_[place(key)];
        if (s.count++ == 0) {
            s.key = key;
            s.first = ballot;
            filled_[word(key)] |= bit(key);
        }
    }
    /// Starts to fetch what add and at of this key will look at: the table is larger than a cache.
    void expect(std::uint32_t key) const { __builtin_prefetch(&slots_[key & mask_], 1); }

    /// An empty slot where there are no votes.
    const Slot& at(std::uint32_t key) const { return slots_[place(key)]; }
    int count(std::uint32_t key) const { return (filled_[word(key)] & bit(key)) != 0 ? at(key).count : 0; }

private:
    std::size_t place(std::uint32_t key) const {
        std::size_t k = key & mask_;
        while (slots_[k].count > 0 && slots_[k].key != key) k = (k + 1) & mask_;
        return k;
    }
    std::size_t word(std::uint32_t key) const { return (key >> 6U) & (filled_.size() - 1); }
    static std::uint64_t bit(std::uint32_t key) { return std::uint64_t{1} << (key & 63U); }

    std::size_t mask_ = 0;
    std::vector<Slot> slots_;
    std::vector<std::uint64_t> filled_;
};

/// The votes of one kind, counted.
class Count {
public:
    Count(const Cloud& cloud, SymmetryType type, const PointPairs& pairs)
        : cloud_(cloud),
          type_(type),
          pairs_(pairs),
          outside_(2.2 * cloud.radius() * kOutside.normalized()),
          alive_(pairs.size()) {
        if (cloud.dimension() == 2) outside_.z() = 0;
        std::iota(alive_.begin(), alive_.end(), 0);
    }

    /// The fullest cells of this size, the fullest last. What was alone in a wider cell is not asked again.
    /// `joined`: with the cells beside, as what votes for the same may stand on either side of a border.
    void fullest(double size, bool joined, std::size_t most, std::vector<Hypothesis>& out) {
        std::vector<Ranked> ranked = joined ? count_joined(size) : count(size);
        if (ranked.size() > most) {
            std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(most),
                             ranked.end());
            ranked.resize(most);
        }
        std::sort(ranked.rbegin(), ranked.rend());
        for (const Ranked& r : ranked) out.push_back(hypothesis(r.first, size));
    }

private:
    struct Ranked {
        int votes;
        int first;
        bool operator<(const Ranked& o) const { return votes != o.votes ? votes > o.votes : first < o.first; }
    };

    struct Vote {
        std::uint32_t key;
        int ballot;
    };

    /// Votes in parts by their cells, which can be counted each by itself, in a table that a cache holds.
    struct Parts {
        static constexpr std::size_t kParts = 16, kRun = 8192;
        std::vector<Vote> votes;  // runs of the ballots in their order, each run by parts
        std::vector<std::array<std::size_t, kParts + 1>> starts;  // of the parts of each run

        template <class Visit>
        void visit(std::size_t part, Visit visit) const {
            for (const auto& start : starts)
                for (std::size_t k = start[part]; k < start[part + 1]; ++k) visit(votes[k]);
        }
        std::size_t size(std::size_t part) const {
            std::size_t sum = 0;
            for (const auto& start : starts) sum += start[part + 1] - start[part];
            return sum;
        }
    };

    Parts parts(double size) const {
        Parts out;
        out.votes.resize(alive_.size());
        out.starts.resize((alive_.size() + Parts::kRun - 1) / Parts::kRun);
        const auto part_of = [](std::uint32_t key) { return key >> 28U; };
        parallel_for(out.starts.size(), [&](std::size_t run) {
            const std::size_t begin = run * Parts::kRun, end = std::min(begin + Parts::kRun, alive_.size());
            std::array<std::uint32_t, Parts::kRun> keys;
            auto& start = out.starts[run];
            start.fill(0);
            for (std::size_t k = begin; k < end; ++k) {
                keys[k - begin] = Cell(place(alive_[k]), size).key();
                ++start[part_of(keys[k - begin]) + 1];
            }
            start[0] = begin;
            std::partial_sum(start.begin(), start.end(), start.begin());
            auto next = start;
            for (std::size_t k = begin; k < end; ++k)
                out.votes[next[part_of(keys[k - begin])]++] = {keys[k - begin], alive_[k]};
        });
        return out;
    }

    std::vector<Ranked> count(double size) const {
        const Parts all = parts(size);
        std::array<std::vector<Ranked>, Parts::kParts> ranked;
        parallel_for(Parts::kParts, [&](std::size_t part) { ranked[part] = count_part(all, part); });
        std::vector<Ranked> out;
        for (const std::vector<Ranked>& r : ranked) out.insert(out.end(), r.begin(), r.end());
        return out;
    }

    /// Most cells hold too few votes, which a small table of counts tells.
    static std::vector<Ranked> count_part(const Parts& all, std::size_t part) {
        std::size_t places = 16;
        while (places < 4 * all.size(part)) places *= 2;
        std::vector<std::uint8_t> votes(places, 0);
        all.visit(part, [&](const Vote& vote) {
            std::uint8_t& v = votes[vote.key & (places - 1)];
            v = static_cast<std::uint8_t>(std::min(v + 1, kFewVotes));
        });
        std::vector<Vote> left;
        all.visit(part, [&](const Vote& vote) {
            if (votes[vote.key & (places - 1)] >= kFewVotes) left.push_back(vote);
        });
        Cells cells(left.size());
        for (const Vote& vote : left) cells.add(vote.key, vote.ballot);
        std::vector<Ranked> ranked;
        for (const Vote& vote : left) {
            const Cells::Slot& own = cells.at(vote.key);
            if (own.first == vote.ballot && own.count >= kFewVotes)
                ranked.push_back({own.count, vote.ballot});
        }
        return ranked;
    }

    std::vector<Ranked> count_joined(double size) {
        Cells cells(alive_.size());
        std::vector<std::uint32_t> keys;
        keys.reserve(alive_.size());
        for (const int b : alive_) keys.push_back(Cell(place(b), size).key());
        constexpr std::size_t kAhead = 16;
        const auto expect = [&](std::size_t k) {
            if (k < keys.size()) cells.expect(keys[k]);
        };
        for (std::size_t k = 0; k < keys.size(); ++k) {
            expect(k + kAhead);
            cells.add(keys[k], alive_[k]);
        }
        std::vector<Ranked> ranked;
        std::vector<int> company;
        for (std::size_t k = 0; k < alive_.size(); ++k) {
            expect(k + kAhead);
            const int b = alive_[k];
            const Cells::Slot& own = cells.at(keys[k]);
            const bool leads = own.first == b;  // the others of its cell need not look further
            if (!leads && own.count >= kFewVotes) {
                company.push_back(b);
                continue;
            }
            // A cell is joined with the seven whose borders the vote is nearest to.
            const Cell home(place(b), size);
            int votes = own.count, fullest = own.count;
            for (unsigned corner = 1; corner < 8; ++corner) {
                const int near = cells.count(home.key_beside(corner));
                votes += near;
                fullest = std::max(fullest, near);
            }
            if (votes < kFewVotes) continue;
            company.push_back(b);
            if (leads && own.count == fullest) ranked.push_back({votes, b});
        }
        alive_ = std::move(company);
        return ranked;
    }

    /// Where in the space of isometries.
    Vector3d place(int ballot) const {
        const auto& [from, to] = pairs_[static_cast<std::size_t>(ballot)];
        return ballot_place(type_, cloud_[from], cloud_[to], outside_);
    }

    Hypothesis hypothesis(int ballot, double size) const {
        const auto& [from, to] = pairs_[static_cast<std::size_t>(ballot)];
        Hypothesis h;
        h.type = type_;
        h.map = map_of(type_, cloud_[from], cloud_[to], cloud_.dimension());
        h.center = (cloud_[from] + cloud_[to]) / 2;
        h.radius = (cloud_[from] - cloud_[to]).norm() / 2;
        h.off = size / 4;
        h.from[0] = from;
        h.to[0] = to;
        return h;
    }

    const Cloud& cloud_;
    SymmetryType type_;
    const PointPairs& pairs_;  // the ballots
    Vector3d outside_;
    std::vector<int> alive_;  // those that are not alone in a wider cell
};

}  // namespace

PointPairs spread_pairs(const Cloud& cloud, const SearchGroup& points, std::size_t most) {
    std::map<int, std::vector<int>> classes;
    for (const int i : points) classes[cloud.label(i)].push_back(i);
    double total = 0;
    for (const auto& [label, members] : classes)
        total += static_cast<double>(members.size()) * static_cast<double>(members.size() - 1) / 2;
    const double share = std::min(1.0, static_cast<double>(most) / std::max(1.0, total));
    PointPairs pairs;
    pairs.reserve(static_cast<std::size_t>(std::min(total, 1.1 * static_cast<double>(most))));
    for (auto& [label, members] : classes) {
        const std::size_t m = members.size();
        std::stable_sort(members.begin(), members.end(),
                         [&](int a, int b) { return cloud[a].squaredNorm() < cloud[b].squaredNorm(); });
        if (share >= 1) {
            for (std::size_t i = 0; i < m; ++i)
                for (std::size_t j = i + 1; j < m; ++j) pairs.emplace_back(members[i], members[j]);
            continue;
        }
        // With an anchor at either end of a share 1 - (1 - a)^2 of the pairs.
        const auto anchors = std::clamp<std::size_t>(
            static_cast<std::size_t>(share / 2 * static_cast<double>(m)), std::min<std::size_t>(m, 8), m);
        std::vector<std::size_t> anchor;
        for (std::size_t k = 0; k < anchors; ++k) anchor.push_back((k * m + m / 2) / anchors);
        auto next = anchor.begin();
        for (std::size_t i = 0; i < m; ++i) {
            // Mates under a symmetry of the whole stand side by side in this order.
            constexpr std::size_t kBeside = 3;
            const bool with_all = next != anchor.end() && *next == i;
            const std::size_t beside = with_all ? m : std::min(m, i + kBeside + 1);
            for (std::size_t j = i + 1; j < beside; ++j) pairs.emplace_back(members[i], members[j]);
            if (with_all) ++next;
            for (auto a = std::lower_bound(next, anchor.end(), beside); a != anchor.end(); ++a)
                pairs.emplace_back(members[i], members[*a]);
        }
    }
    return pairs;
}

PointPairs pairs_within(const SearchGroup& group, const Focus& focus) {
    PointPairs pairs;
    pairs.reserve(group.size() * group.size() / 2);
    for (std::size_t i = 0; i < group.size(); ++i)
        for (std::size_t j = i + 1; j < group.size(); ++j)
            if (in(focus, group[i]) || in(focus, group[j])) pairs.emplace_back(group[i], group[j]);
    return pairs;
}

std::vector<Hypothesis> vote(const Cloud& cloud, SymmetryType type, const PointPairs& pairs, double reach,
                             std::size_t most) {
    Count count(cloud, type, pairs);
    std::vector<Hypothesis> out;  // the widest cells first, and last turned round
    const double finest = 8 * cloud.scene().resolution;
    double size = 2 * reach;
    while (size > finest) {
        count.fullest(size, true, most, out);
        size /= 8;
    }
    // What is exact is much smaller than a cell; what is not came up in wider ones.
    count.fullest(finest, false, most, out);
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace insym
