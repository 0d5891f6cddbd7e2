#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

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

/// What a pair votes for, as a point: a translation's vector, an inversion's centre, a mirror's image of a
/// point far outside (which no plane through the set comes near).
Vector3d ballot_place(SymmetryType type, const Vector3d& a, const Vector3d& b, const Vector3d& outside) {
    if (type == SymmetryType::translation) return (b - a).dot(kAskew) < 0 ? Vector3d(a - b) : Vector3d(b - a);
    const Vector3d middle = (a + b) / 2;
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
    return mix(static_cast<std::uint64_t>(x) + mix(static_cast<std::uint64_t>(y) + mix(static_cast<std::uint64_t>(z))));
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
        const auto anchors = std::clamp<std::size_t>(static_cast<std::size_t>(anchor_share * static_cast<double>(m)),
                                                     std::min<std::size_t>(m, 8), m);
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

struct Cell {
    int count = 0;
    std::size_t first = 0;
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
    for (double size = 2 * reach; size > 8 * cloud.scene().resolution; size /= 5) sizes.push_back(size);
    sizes.push_back(8 * cloud.scene().resolution);

    struct Ranked {
        int votes;
        std::size_t first;
        bool operator<(const Ranked& o) const { return votes != o.votes ? votes > o.votes : first < o.first; }
    };
    std::vector<Hypothesis> out;
    for (const double size : sizes) {
        std::unordered_map<std::uint64_t, Cell> cells;
        cells.reserve(ballots.size());
        const auto at = [&](const Vector3d& p, int k) { return static_cast<std::int64_t>(std::floor(p[k] / size)); };
        for (std::size_t b = 0; b < ballots.size(); ++b) {
            const Vector3d& p = ballots[b].place;
            Cell& cell = cells[key_of(at(p, 0), at(p, 1), at(p, 2))];
            if (cell.count++ == 0) cell.first = b;
        }
        // A vote counts for the cell it is in and for those whose border it is next to.
        std::vector<Ranked> ranked;
        for (const auto& [key, cell] : cells) {
            const Vector3d& p = ballots[cell.first].place;
            int votes = 0, fullest = 0;
            for (std::int64_t x = -1; x <= 1; ++x)
                for (std::int64_t y = -1; y <= 1; ++y)
                    for (std::int64_t z = -1; z <= 1; ++z) {
                        const auto near = cells.find(key_of(at(p, 0) + x, at(p, 1) + y, at(p, 2) + z));
                        if (near == cells.end()) continue;
                        votes += near->second.count;
                        fullest = std::max(fullest, near->second.count);
                    }
            if (votes >= 3 && cell.count == fullest) ranked.push_back({votes, cell.first});
        }
        std::sort(ranked.begin(), ranked.end());
        if (ranked.size() > most) ranked.resize(most);
        for (const Ranked& r : ranked) {
            const Ballot& b = ballots[r.first];
            Hypothesis h;
            h.type = type;
            h.map = map_of(type, cloud[b.from], cloud[b.to], cloud.dimension());
            h.center = (cloud[b.from] + cloud[b.to]) / 2;
            h.radius = (cloud[b.from] - cloud[b.to]).norm() / 2;
            h.from[0] = b.from;
            h.to[0] = b.to;
            out.push_back(h);
        }
    }
    return out;
}

}  // namespace insym
