#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "hypotheses/generators.hpp"
#include "hypotheses/places.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Ballot {
    Vector3d place;  // where in the space of isometries
    int from, to;
};

constexpr int kFewVotes = 3;  // chance does as well with less

/// What a pair votes for, as a point: a translation's vector, an inversion's centre, a mirror's image of a
/// point far outside (which no plane through the set comes near).
Vector3d ballot_place(SymmetryType type, const Vector3d& a, const Vector3d& b, const Vector3d& outside) {
    if (type == SymmetryType::translation) return (b - a).dot(kAskew) < 0 ? Vector3d(a - b) : Vector3d(b - a);
    Vector3d middle = (a + b) / 2;
    if (type == SymmetryType::inversion || type == SymmetryType::half_turn) return middle;
    const Vector3d normal = (b - a).normalized();
    return outside - 2 * normal * normal.dot(outside - middle);
}

RigidMap map_of(SymmetryType type, const Vector3d& a, const Vector3d& b, int dimension) {
    return fit_of_type(type, {{a, b}}, dimension);
}

/// A cell of the space of isometries, and the side of each axis on which the next one is nearer.
class Cell {
public:
    Cell(const Vector3d& place, double size) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = place[static_cast<Eigen::Index>(axis)] / size, low = std::floor(at);
            sum_ += static_cast<std::uint64_t>(static_cast<std::int64_t>(low)) * kFactors[axis];
            beside_[axis] = at - low < 0.5 ? 0 - kFactors[axis] : kFactors[axis];
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
        : cloud_(cloud), type_(type), alive_(pairs.size()) {
        const Vector3d outside = 2.2 * cloud.radius() * kOutside.normalized();
        const Vector3d far = cloud.dimension() == 2 ? Vector3d(outside.x(), outside.y(), 0) : outside;
        ballots_.reserve(pairs.size());
        for (const auto& [i, j] : pairs)
            ballots_.push_back({ballot_place(type, cloud[i], cloud[j], far), i, j});
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
        for (const Ranked& r : ranked)
            out.push_back(hypothesis(ballots_[static_cast<std::size_t>(r.first)], size));
    }

private:
    struct Ranked {
        int votes;
        int first;
        bool operator<(const Ranked& o) const { return votes != o.votes ? votes > o.votes : first < o.first; }
    };

    std::vector<std::uint32_t> keys(double size) const {
        std::vector<std::uint32_t> out;
        out.reserve(alive_.size());
        for (const int b : alive_) out.push_back(Cell(place(b), size).key());
        return out;
    }

    /// Most cells hold too few votes, which a small table of counts tells.
    std::vector<Ranked> count(double size) {
        const std::vector<std::uint32_t> all = keys(size);
        std::size_t places = 16;
        while (places < 4 * all.size()) places *= 2;
        std::vector<std::uint8_t> votes(places, 0);
        for (const std::uint32_t key : all) {
            std::uint8_t& v = votes[key & (places - 1)];
            v = static_cast<std::uint8_t>(std::min(v + 1, kFewVotes));
        }
        std::vector<std::pair<std::uint32_t, int>> left;  // cell and ballot
        for (std::size_t k = 0; k < all.size(); ++k)
            if (votes[all[k] & (places - 1)] >= kFewVotes) left.emplace_back(all[k], alive_[k]);
        Cells cells(left.size());
        for (const auto& [key, ballot] : left) cells.add(key, ballot);
        std::vector<Ranked> ranked;
        alive_.clear();
        for (const auto& [key, ballot] : left) {
            alive_.push_back(ballot);
            const Cells::Slot& own = cells.at(key);
            if (own.first == ballot && own.count >= kFewVotes) ranked.push_back({own.count, ballot});
        }
        return ranked;
    }

    std::vector<Ranked> count_joined(double size) {
        Cells cells(alive_.size());
        const std::vector<std::uint32_t> keys = this->keys(size);
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

    const Vector3d& place(int ballot) const { return ballots_[static_cast<std::size_t>(ballot)].place; }

    Hypothesis hypothesis(const Ballot& b, double size) const {
        Hypothesis h;
        h.type = type_;
        h.map = map_of(type_, cloud_[b.from], cloud_[b.to], cloud_.dimension());
        h.center = (cloud_[b.from] + cloud_[b.to]) / 2;
        h.radius = (cloud_[b.from] - cloud_[b.to]).norm() / 2;
        h.off = size / 4;
        h.from[0] = b.from;
        h.to[0] = b.to;
        return h;
    }

    const Cloud& cloud_;
    SymmetryType type_;
    std::vector<Ballot> ballots_;
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
    for (auto& [label, members] : classes) {
        const std::size_t m = members.size();
        // With an anchor at either end of a share 1 - (1 - a)^2 of the pairs.
        const double anchor_share = share >= 1 ? 1 : share / 2;
        const auto anchors = std::clamp<std::size_t>(
            static_cast<std::size_t>(anchor_share * static_cast<double>(m)), std::min<std::size_t>(m, 8), m);
        std::stable_sort(members.begin(), members.end(),
                         [&](int a, int b) { return cloud[a].squaredNorm() < cloud[b].squaredNorm(); });
        std::vector<char> anchor(m, 0);
        for (std::size_t k = 0; k < anchors; ++k) anchor[(k * m + m / 2) / anchors] = 1;
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = i + 1; j < m; ++j) {
                // Mates under a symmetry of the whole stand side by side in this order.
                if (anchor[i] == 0 && anchor[j] == 0 && j > i + 3) {
                    if (share < 0.1) {
                        // The next anchor.
                        while (j + 1 < m && anchor[j + 1] == 0) ++j;
                    }
                    continue;
                }
                pairs.emplace_back(members[i], members[j]);
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
