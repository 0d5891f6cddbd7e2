#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "hypotheses/generators.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A direction that no part is likely to be aligned with.
const Vector3d kAskew = Vector3d(0.6120, 0.3532, 0.7075).normalized();

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

std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto mix = [](std::uint64_t h) {
        h ^= h >> 31;
        h *= 0x9E3779B97F4A7C15ULL;
        return h ^ (h >> 29);
    };
    return mix(static_cast<std::uint64_t>(x) +
               mix(static_cast<std::uint64_t>(y) + mix(static_cast<std::uint64_t>(z))));
}

/// Pairs of one label: all of them, or those of the points farthest out with all, and of neighbours in line.
std::vector<std::pair<int, int>> pairs_of(const Cloud& cloud, std::size_t most) {
    std::map<int, std::vector<int>> classes;
    for (int i = 0; i < cloud.size(); ++i) classes[cloud.label(i)].push_back(i);
    double total = 0;
    for (const auto& [label, members] : classes)
        total += static_cast<double>(members.size()) * static_cast<double>(members.size() - 1) / 2;
    const double share = std::min(1.0, static_cast<double>(most) / std::max(1.0, total));
    std::vector<std::pair<int, int>> pairs;
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

/// Votes by cell: a hash table with open addresses, as there are many cells and most hold one vote.
class Cells {
public:
    explicit Cells(std::size_t most) {
        std::size_t size = 16;
        while (size < 2 * most) size *= 2;
        mask_ = size - 1;
        slots_.resize(size);
    }

    struct Slot {
        std::uint64_t key = 0;
        int count = 0;
        int first = 0;  // of the ballots
    };

    void add(std::uint64_t key, int ballot) {
        Slot& s = slots_[place(key)];
        if (s.count++ == 0) {
            s.key = key;
            s.first = ballot;
        }
    }
    /// An empty slot where there are no votes.
    const Slot& at(std::uint64_t key) const { return slots_[place(key)]; }
    const std::vector<Slot>& slots() const { return slots_; }

private:
    std::size_t place(std::uint64_t key) const {
        std::size_t k = key & mask_;
        while (slots_[k].count > 0 && slots_[k].key != key) k = (k + 1) & mask_;
        return k;
    }

    std::size_t mask_ = 0;
    std::vector<Slot> slots_;
};

}  // namespace

std::vector<Hypothesis> vote(const Cloud& cloud, SymmetryType type, double reach, std::size_t most_pairs,
                             std::size_t most) {
    const Vector3d outside = 2.2 * cloud.radius() * Vector3d(0.31, 0.74, 0.597).normalized();
    const Vector3d far = cloud.dimension() == 2 ? Vector3d(outside.x(), outside.y(), 0) : outside;
    std::vector<Ballot> ballots;
    for (const auto& [i, j] : pairs_of(cloud, most_pairs))
        ballots.push_back({ballot_place(type, cloud[i], cloud[j], far), i, j});

    std::vector<double> sizes;
    const double finest = 8 * cloud.scene().resolution;
    double coarse = 2 * reach;
    while (coarse > finest) {
        sizes.push_back(coarse);
        coarse /= 5;
    }
    sizes.push_back(8 * cloud.scene().resolution);

    struct Ranked {
        int votes;
        std::size_t first;
        bool operator<(const Ranked& o) const { return votes != o.votes ? votes > o.votes : first < o.first; }
    };
    std::vector<Hypothesis> out;
    std::vector<int> alive(ballots.size());  // those that are not alone in a wider cell
    std::iota(alive.begin(), alive.end(), 0);
    for (const double size : sizes) {
        Cells cells(alive.size());
        const auto home_of = [&](const Vector3d& p) {
            return Eigen::Array<std::int64_t, 3, 1>((p.array() / size).floor().cast<std::int64_t>());
        };
        for (const int b : alive) {
            const auto home = home_of(ballots[static_cast<std::size_t>(b)].place);
            cells.add(key_of(home[0], home[1], home[2]), b);
        }
        std::vector<Ranked> ranked;
        std::vector<int> company;
        for (const int b : alive) {
            // A cell is joined with the seven whose borders the vote is nearest to.
            const Vector3d& p = ballots[static_cast<std::size_t>(b)].place;
            const auto home = home_of(p);
            Eigen::Array<std::int64_t, 3, 1> beside;
            for (int k = 0; k < 3; ++k)
                beside[k] = home[k] + (p[k] / size - static_cast<double>(home[k]) < 0.5 ? -1 : 1);
            const Cells::Slot& own = cells.at(key_of(home[0], home[1], home[2]));
            int votes = own.count, fullest = own.count;
            for (int corner = 1; corner < 8; ++corner) {
                const auto pick = [&](int k) { return (corner >> k & 1) == 0 ? home[k] : beside[k]; };
                const Cells::Slot& near = cells.at(key_of(pick(0), pick(1), pick(2)));
                votes += near.count;
                fullest = std::max(fullest, near.count);
            }
            if (votes < kFewVotes) continue;
            company.push_back(b);
            if (own.first == b && own.count == fullest)
                ranked.push_back({votes, static_cast<std::size_t>(b)});
        }
        alive = std::move(company);
        std::sort(ranked.begin(), ranked.end());
        if (ranked.size() > most) ranked.resize(most);
        for (const Ranked& r : ranked) {
            const Ballot& b = ballots[r.first];
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
    return out;
}

}  // namespace insym
