#include "symmetries/exact_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "hypotheses/cells.hpp"
#include "hypotheses/generators.hpp"
#include "isometry/fit.hpp"
#include "parallel_for.hpp"
#include "points/cloud.hpp"
#include "symmetries/axis_directions.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMostVotingPairs = 800'000;
constexpr std::size_t kMostOfALevel = 200'000;  // of pairs at one height

/// Half-turns are looked for about so many directions.
constexpr std::size_t kDirections = 64;
/// Half as many of sets with more points, in which each takes long.
constexpr int kManyPoints = 1000;

/// An isometry and how many pairs suggest it.
struct Suggestion {
    int votes;
    RigidMap map;
};

struct Suggestions {
    std::vector<Suggestion> best;  // most votes first
    std::size_t all = 0;
};

RigidMap half_turn_about(const Vector3d& direction, const Vector3d& place) {
    const Matrix3d turn = 2 * direction * direction.transpose() - Matrix3d::Identity();
    return {turn, place - turn * place};
}

class ExactSearch {
public:
    ExactSearch(const PointScene& scene, std::size_t most)
        : scene_(scene), cloud_(scene), most_(most), pairs_(all_pairs()) {}

    /// The `most` with the most pairs.
    std::vector<PairCluster> clusters(SymmetryType type, ExactKind& kind) const;

private:
    PointPairs all_pairs() const {
        SearchGroup all(static_cast<std::size_t>(cloud_.size()));
        std::iota(all.begin(), all.end(), 0);
        return spread_pairs(cloud_, all, kMostVotingPairs);
    }

    std::size_t wanted() const { return most_ + most_ / 4; }  // a vote is not a pair yet
    double cell() const { return 2 * scene_.resolution; }
    Vector3d middle(const std::pair<int, int>& p) const { return (cloud_[p.first] + cloud_[p.second]) / 2; }

    Suggestions by_votes(SymmetryType type) const;
    Suggestions half_turns() const;
    Suggestions half_turns_along(const Vector3d& direction) const;
    PointPairs level_pairs(const Vector3d& direction) const;
    PairCluster gather(SymmetryType type, const RigidMap& map) const;
    double tolerance(const std::vector<Pair>& pairs, double deviation) const;

    const PointScene& scene_;
    Cloud cloud_;
    std::size_t most_;
    PointPairs pairs_;
};

/// Mirrors and centres: each pair has its own.
Suggestions ExactSearch::by_votes(SymmetryType type) const {
    const Vector3d outside = outside_of(cloud_), off = off_borders(cell());
    std::vector<Ranked> cells = full_cells(pairs_.size(), cell(), [&](std::size_t k) -> Vector3d {
        return ballot_place(type, cloud_[pairs_[k].first], cloud_[pairs_[k].second], outside) + off;
    });
    Suggestions out{{}, cells.size()};
    keep_fullest(cells, wanted());
    for (const Ranked& r : cells) {
        const auto& [from, to] = pairs_[static_cast<std::size_t>(r.first)];
        out.best.push_back({r.votes, fit_of_type(type, {{cloud_[from], cloud_[to]}}, cloud_.dimension())});
    }
    return out;
}

/// Pairs at one height along a direction: half-turns about it can exchange no others.
PointPairs ExactSearch::level_pairs(const Vector3d& direction) const {
    std::vector<std::pair<double, int>> heights;
    heights.reserve(static_cast<std::size_t>(cloud_.size()));
    for (int i = 0; i < cloud_.size(); ++i) heights.emplace_back(direction.dot(cloud_[i]), i);
    std::sort(heights.begin(), heights.end());
    PointPairs out;
    for (std::size_t k = 0; k < heights.size();) {
        SearchGroup level{heights[k].second};
        for (++k; k < heights.size() && heights[k].first - heights[k - 1].first <= scene_.resolution / 4; ++k)
            level.push_back(heights[k].second);
        const PointPairs pairs = spread_pairs(cloud_, level, kMostOfALevel);
        out.insert(out.end(), pairs.begin(), pairs.end());
    }
    return out;
}

/// The axes along `direction` are the middles of these pairs as seen along it.
Suggestions ExactSearch::half_turns_along(const Vector3d& direction) const {
    const PointPairs pairs = level_pairs(direction);
    const auto place = [&](std::size_t k) -> Vector3d {
        const Vector3d m = middle(pairs[k]);
        return m - direction * direction.dot(m);
    };
    const Vector3d off = off_borders(cell());
    std::vector<Ranked> cells =
        full_cells(pairs.size(), cell(), [&](std::size_t k) -> Vector3d { return place(k) + off; });
    Suggestions out{{}, cells.size()};
    keep_fullest(cells, wanted());
    for (const Ranked& r : cells)
        out.best.push_back({r.votes, half_turn_about(direction, place(static_cast<std::size_t>(r.first)))});
    return out;
}

Suggestions ExactSearch::half_turns() const {
    const std::size_t most = cloud_.size() > kManyPoints ? kDirections / 2 : kDirections;
    const std::vector<Vector3d> directions = axis_directions(cloud_, most);
    std::vector<Suggestions> along(directions.size());
    parallel_for(directions.size(), [&](std::size_t d) { along[d] = half_turns_along(directions[d]); });
    Suggestions out;
    for (Suggestions& s : along) {
        out.all += s.all;
        out.best.insert(out.best.end(), s.best.begin(), s.best.end());
    }
    std::stable_sort(out.best.begin(), out.best.end(),
                     [](const Suggestion& a, const Suggestion& b) { return a.votes > b.votes; });
    out.best.resize(std::min(out.best.size(), wanted()));
    return out;
}

/// All pairs that the map exchanges, each point's image the nearest of its label and the other way round,
/// refitted once.
PairCluster ExactSearch::gather(SymmetryType type, const RigidMap& map) const {
    std::vector<int> image(static_cast<std::size_t>(cloud_.size()));
    double square = 0;
    for (int i = 0; i < cloud_.size(); ++i)
        image[static_cast<std::size_t>(i)] =
            cloud_.nearest(map(cloud_[i]), cloud_.label(i), 2 * scene_.resolution, square);
    std::vector<Link> links;
    std::vector<Pair> pairs;
    for (int i = 0; i < cloud_.size(); ++i) {
        const int j = image[static_cast<std::size_t>(i)];
        if (j <= i || image[static_cast<std::size_t>(j)] != i) continue;
        pairs.push_back({i, j});
        links.push_back({cloud_[i], cloud_[j]});
    }
    PairCluster out{type, scene_.resolution, {}, true};
    if (links.empty()) return out;
    const RigidMap fitted = fit_of_type(type, links, cloud_.dimension());
    double deviation = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double off = (fitted(links[k].from) - links[k].to).norm();
        if (off > scene_.resolution) continue;
        deviation = std::max(deviation, off);
        out.pairs.push_back(pairs[k]);
    }
    out.tolerance = tolerance(out.pairs, deviation);
    return out;
}

/// E_min: no two corresponding distances differ by more than twice the deviation.
double ExactSearch::tolerance(const std::vector<Pair>& pairs, double deviation) const {
    double out = scene_.resolution;
    if (2 * deviation <= out) return out;
    const auto distance = [&](int i, int j) { return (cloud_[i] - cloud_[j]).norm(); };
    for (std::size_t k = 0; k < pairs.size(); ++k)
        for (std::size_t l = 0; l < k; ++l) {
            const Pair &p = pairs[k], &q = pairs[l];
            out = std::max({out, std::abs(distance(p.first, q.first) - distance(p.second, q.second)),
                            std::abs(distance(p.first, q.second) - distance(p.second, q.first))});
        }
    return out;
}

std::vector<PairCluster> ExactSearch::clusters(SymmetryType type, ExactKind& kind) const {
    const bool about_axes = type == SymmetryType::half_turn && cloud_.dimension() == 3;
    const Suggestions suggestions = about_axes ? half_turns() : by_votes(type);
    std::vector<PairCluster> out(suggestions.best.size());
    parallel_for(out.size(), [&](std::size_t k) { out[k] = gather(type, suggestions.best[k].map); });
    std::erase_if(out, [](const PairCluster& c) { return c.pairs.size() < kFewVotes; });
    std::sort(out.begin(), out.end(), [](const PairCluster& a, const PairCluster& b) {
        if (a.pairs.size() != b.pairs.size()) return a.pairs.size() > b.pairs.size();
        return std::tie(a.pairs, a.tolerance) < std::tie(b.pairs, b.tolerance);
    });
    out.erase(std::unique(out.begin(), out.end(),
                          [](const PairCluster& a, const PairCluster& b) { return a.pairs == b.pairs; }),
              out.end());
    if (out.size() > most_) out.resize(most_);
    kind = {type, suggestions.all, out.size()};
    return out;
}

double share_moved(const std::vector<std::vector<PairCluster>>& clusters, int points) {
    std::vector<char> moved(static_cast<std::size_t>(points), 0);
    for (const std::vector<PairCluster>& of_a_kind : clusters)
        for (const PairCluster& c : of_a_kind)
            for (const Pair& p : c.pairs)
                moved[static_cast<std::size_t>(p.first)] = moved[static_cast<std::size_t>(p.second)] = 1;
    return static_cast<double>(std::count(moved.begin(), moved.end(), 1)) / points;
}

}  // namespace

ExactPairs detect_exact_pairs(const PointScene& scene, TypeSet types, std::size_t most, RunMonitor& monitor) {
    std::vector<SymmetryType> kinds{SymmetryType::mirror, SymmetryType::half_turn};
    if (scene.dimension() == 3) kinds.push_back(SymmetryType::inversion);
    monitor.begin_stage("pairs", kinds.size());
    const ExactSearch search(scene, most);
    std::vector<std::vector<PairCluster>> clusters(kinds.size());
    std::vector<ExactKind> found(kinds.size());
    parallel_for(kinds.size(), [&](std::size_t k) {
        if (!monitor.should_stop()) clusters[k] = search.clusters(kinds[k], found[k]);
        monitor.advance();
    });
    ExactPairs out;
    out.share = share_moved(clusters, scene.size());
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        if (!types.contains(kinds[k])) continue;
        out.kinds.push_back(found[k]);
        std::move(clusters[k].begin(), clusters[k].end(), std::back_inserter(out.clusters));
    }
    return out;
}

}  // namespace insym
