#include <algorithm>
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

using Cell = Eigen::Array<std::int64_t, 3, 1>;

Cell home_of(const Vector3d& place, double size) {
    return (place.array() / size).floor().cast<std::int64_t>();
}

std::uint32_t key_of(const Cell& cell) {
    return static_cast<std::uint32_t>(mixed(mixed(mixed(0, cell[2]), cell[1]), cell[0]) >> 32U);
}

/// Votes by cell: a hash table with open addresses, small, as there are many cells and most hold one vote.
/// Two cells of one key among so many are rare, and would only be tried in vain.
class Cells {
public:
    explicit Cells(std::size_t most) {
        std::size_t size = 16;
        while (size < 2 * most) size *= 2;
        mask_ = size - 1;
        slots_.resize(size);
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
        }
    }
    /// An empty slot where there are no votes.
    const Slot& at(std::uint32_t key) const { return slots_[place(key)]; }

private:
    std::size_t place(std::uint32_t key) const {
        std::size_t k = key & mask_;
        while (slots_[k].count > 0 && slots_[k].key != key) k = (k + 1) & mask_;
        return k;
    }

    std::size_t mask_ = 0;
    std::vector<Slot> slots_;
};

}  // namespace

PointPairs spread_pairs(const Cloud& cloud, std::size_t most) {
    std::map<int, std::vector<int>> classes;
    for (int i = 0; i < cloud.size(); ++i) classes[cloud.label(i)].push_back(i);
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

PointPairs pairs_within(const SearchGroup& group) {
    PointPairs pairs;
    pairs.reserve(group.size() * group.size() / 2);
    for (std::size_t i = 0; i < group.size(); ++i)
        for (std::size_t j = i + 1; j < group.size(); ++j) pairs.emplace_back(group[i], group[j]);
    return pairs;
}

std::vector<Hypothesis> vote(const Cloud& cloud, SymmetryType type, const PointPairs& pairs, double reach,
                             std::size_t most) {
    const Vector3d outside = 2.2 * cloud.radius() * kOutside.normalized();
    const Vector3d far = cloud.dimension() == 2 ? Vector3d(outside.x(), outside.y(), 0) : outside;
    std::vector<Ballot> ballots;
    ballots.reserve(pairs.size());
    for (const auto& [i, j] : pairs) ballots.push_back({ballot_place(type, cloud[i], cloud[j], far), i, j});

    std::vector<double> sizes;
    const double finest = 8 * cloud.scene().resolution;
    double coarse = 2 * reach;
    while (coarse > finest) {
        sizes.push_back(coarse);
        coarse /= 8;
    }
    sizes.push_back(finest);

    struct Ranked {
        int votes;
        int first;
        bool operator<(const Ranked& o) const { return votes != o.votes ? votes > o.votes : first < o.first; }
    };
    std::vector<Hypothesis> out;             // the widest cells first, and last turned round
    std::vector<int> alive(ballots.size());  // those that are not alone in a wider cell
    std::iota(alive.begin(), alive.end(), 0);
    for (const double size : sizes) {
        Cells cells(alive.size());
        std::vector<std::uint32_t> keys;
        keys.reserve(alive.size());
        for (const int b : alive) {
            keys.push_back(key_of(home_of(ballots[static_cast<std::size_t>(b)].place, size)));
            cells.add(keys.back(), b);
        }
        std::vector<Ranked> ranked;
        std::vector<int> company;
        for (std::size_t k = 0; k < alive.size(); ++k) {
            const int b = alive[k];
            const Cells::Slot& own = cells.at(keys[k]);
            const bool leads = own.first == b;  // the others of its cell need not look further
            if (!leads && own.count >= kFewVotes) {
                company.push_back(b);
                continue;
            }
            // A cell is joined with the seven whose borders the vote is nearest to.
            const Vector3d& p = ballots[static_cast<std::size_t>(b)].place;
            const Cell home = home_of(p, size);
            Cell beside;
            for (int axis = 0; axis < 3; ++axis)
                beside[axis] = home[axis] + (p[axis] / size - static_cast<double>(home[axis]) < 0.5 ? -1 : 1);
            int votes = own.count, fullest = own.count;
            for (int corner = 1; corner < 8; ++corner) {
                const auto pick = [&](int axis) {
                    return (corner >> axis & 1) == 0 ? home[axis] : beside[axis];
                };
                const int near = cells.at(key_of({pick(0), pick(1), pick(2)})).count;
                votes += near;
                fullest = std::max(fullest, near);
            }
            if (votes < kFewVotes) continue;
            company.push_back(b);
            if (leads && own.count == fullest) ranked.push_back({votes, b});
        }
        alive = std::move(company);
        std::sort(ranked.begin(), ranked.end());
        if (ranked.size() > most) ranked.resize(most);
        std::reverse(ranked.begin(), ranked.end());
        for (const Ranked& r : ranked) {
            const Ballot& b = ballots[static_cast<std::size_t>(r.first)];
            Hypothesis h;
            h.type = type;
            h.map = map_of(type, cloud[b.from], cloud[b.to], cloud.dimension());
            h.center = (cloud[b.from] + cloud[b.to]) / 2;
            h.radius = (cloud[b.from] - cloud[b.to]).norm() / 2;
            h.off = size / 4;
            h.from[0] = b.from;
            h.to[0] = b.to;
            out.push_back(h);
        }
    }
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace insym
