#include "symmetries/pairs.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "isometry/fit.hpp"
#include "symmetries/clusters.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A second pair whose cross distances with the first match.
struct Match {
    Pair pair;              // as {image of the smaller side, ...}: first is P1's counterpart
    double tolerance = 0;   // E_min of the union
    bool half_turn = false;
    double reach = 0;       // distance of the middles: how well the two fix an axis
};

/// How far the least-squares M, I and half-turn of two pairs leave their points (all four links).
struct TwoPairFit {
    double mirror = 0;
    double inversion = 0;
    double half_turn = 0;
};

/// Two pairs p +- u and q +- v, w = q - p. See fit_pairs() for K, whose eigenvectors give the normal
/// of the best mirror and the axis of the best half-turn.
TwoPairFit fit_two_pairs(const Vector3d& u, const Vector3d& v, const Vector3d& w, int dimension) {
    Matrix3d k = u * u.transpose() + v * v.transpose() - w * w.transpose() / 2;
    const auto larger = [](double a, double b) { return 2 * std::sqrt(std::max({a, b, 0.0})); };
    const double ww = w.squaredNorm() / 4;
    TwoPairFit fit;
    fit.inversion = std::sqrt(4 * ww);
    const auto mirror_along = [&](const Vector3d& n) {
        const double un = u.dot(n), vn = v.dot(n), wn = w.dot(n);
        return larger(u.squaredNorm() - un * un + wn * wn / 4, v.squaredNorm() - vn * vn + wn * wn / 4);
    };
    if (dimension == 2) {
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
        solver.computeDirect(Eigen::Matrix2d(k.topLeftCorner<2, 2>()));
        Vector3d n = Vector3d::Zero();
        n.head<2>() = solver.eigenvectors().col(1);
        fit.mirror = mirror_along(n);
        fit.half_turn = fit.inversion;
        return fit;
    }
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    solver.computeDirect(k);
    fit.mirror = mirror_along(solver.eigenvectors().col(2));
    const Vector3d a = solver.eigenvectors().col(0);
    const double ua = u.dot(a), va = v.dot(a), wa = w.dot(a);
    fit.half_turn = larger(ua * ua + ww - wa * wa / 4, va * va + ww - wa * wa / 4);
    return fit;
}

/// An edge of the graph of pairs, for M and for I (in 2D the half-turn).
struct PairEdge {
    double tolerance;
    Pair first;
    Pair second;
};

/// What the pairs with one first point gave.
struct Findings {
    std::vector<PairEdge> mirror_edges;
    std::vector<PairEdge> central_edges;
    std::vector<Pair> lone_mirrors;  // pairs with three points and more on their own plane
    std::vector<PairCluster> half_turns;
};

/// Looks at one pair after another; one for each thread.
class PairSearch {
public:
    PairSearch(const Scene& scene, TypeSet types) : scene_(scene), types_(types) {}

    void search(const Pair& pair, Findings& out) {
        pair_ = pair;
        a_ = scene_.distances.row(pair.first);
        b_ = scene_.distances.row(pair.second);
        chord_ = a_[index(pair.second)];
        collect_matches(out);
        if (types_.contains(SymmetryType::half_turn) && scene_.dimension() == 3) group_by_axis(out.half_turns);
    }

private:
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    Vector3d at(int i) const { return to_vector(scene_.position(i)); }

    void collect_matches(Findings& out);
    void examine(int q, int image, Findings& out);
    void group_by_axis(std::vector<PairCluster>& out);
    void group_at(double level, std::vector<PairCluster>& out);
    bool exchange(const Pair& p, const Pair& q, double level) const;
    int points_on_axis(const Vector3d& middle, const Vector3d& axis, double reach) const;

    const Scene& scene_;
    TypeSet types_;
    Pair pair_;
    std::span<const double> a_;  // distances to the first point of the pair
    std::span<const double> b_;  // and to the second
    double chord_ = 0;
    std::vector<int> near_first_;
    std::vector<int> near_second_;
    std::vector<int> middle_;  // points at nearly equal distances from both
    std::vector<Match> matches_;
    std::vector<const Match*> usable_;
    std::vector<const Match*> group_;
};

/// A pair (q, image) matches if |P1 q| = |P2 image| and |P2 q| = |P1 image|, each within the cap. One
/// list in order of |P1 q|, the other of |P2 image|, and a window that slides over both.
void PairSearch::collect_matches(Findings& out) {
    const double cap = scene_.max_tolerance;
    near_first_.clear();
    near_second_.clear();
    middle_.clear();
    matches_.clear();
    int on_plane = 0;
    for (const int q : scene_.distances.nearest_first(pair_.first)) {
        const double difference = a_[index(q)] - b_[index(q)];
        if (difference > cap || q == pair_.second) continue;
        near_first_.push_back(q);
        if (difference < -cap) continue;
        middle_.push_back(q);
        // The mirror of the pair alone moves q by |a^2 - b^2| / chord.
        if (std::abs(difference) * (a_[index(q)] + b_[index(q)]) <= scene_.resolution * chord_) ++on_plane;
    }
    for (const int q : scene_.distances.nearest_first(pair_.second))
        if (b_[index(q)] - a_[index(q)] <= cap && q != pair_.first) near_second_.push_back(q);

    bool lone = true;
    std::size_t window = 0;
    for (const int q : near_first_) {
        while (window < near_second_.size() && b_[index(near_second_[window])] < a_[index(q)] - cap) ++window;
        for (std::size_t k = window; k < near_second_.size(); ++k) {
            const int image = near_second_[k];
            if (b_[index(image)] > a_[index(q)] + cap) break;
            if (std::abs(b_[index(q)] - a_[index(image)]) > cap || q == image) continue;
            if (scene_.label(q) != scene_.label(image)) continue;
            // Each pair once: the end that leans more to the first point comes first.
            const double lean = a_[index(q)] - b_[index(q)], other = a_[index(image)] - b_[index(image)];
            if (lean > other || (lean == other && q > image)) continue;
            const std::size_t before = out.mirror_edges.size();
            examine(q, image, out);
            if (out.mirror_edges.size() > before && out.mirror_edges.back().tolerance <= 2 * scene_.resolution)
                lone = false;
        }
    }
    if (types_.contains(SymmetryType::mirror) && lone && on_plane >= 3) out.lone_mirrors.push_back(pair_);
}

/// Decides of which types the union of the pair and (q, image) is.
void PairSearch::examine(int q, int image, Findings& out) {
    const Vector3d p1 = at(pair_.first), p2 = at(pair_.second), q1 = at(q), q2 = at(image);
    const Vector3d u = (p2 - p1) / 2, v = (q2 - q1) / 2, w = (q1 + q2) / 2 - (p1 + p2) / 2;
    const double tolerance = std::max({scene_.resolution, std::abs(a_[index(q)] - b_[index(image)]),
                                       std::abs(b_[index(q)] - a_[index(image)])});
    const TwoPairFit fit = fit_two_pairs(u, v, w, scene_.dimension());
    const double limit = std::min(
        scene_.max_tolerance, 2 * std::min({fit.mirror, fit.inversion, fit.half_turn}) + scene_.resolution);
    const Pair other = {std::min(q, image), std::max(q, image)};
    if (fit.mirror <= limit) {
        // Also towards smaller pairs, so that a lone mirror is known as such; these are dropped later.
        out.mirror_edges.push_back({tolerance, pair_, other});
    }
    const SymmetryType central = scene_.dimension() == 3 ? SymmetryType::inversion : SymmetryType::half_turn;
    if (types_.contains(central) && fit.inversion <= limit && pair_ < other)
        out.central_edges.push_back({tolerance, pair_, other});
    if (fit.half_turn <= limit && scene_.dimension() == 3)
        matches_.push_back({{q, image}, tolerance, true, w.norm()});
}

/// Half-turns: the largest sets of mutually consistent pairs about one axis, at a ladder of tolerances
/// so that an exact axis is not lost in the approximate one around it.
void PairSearch::group_by_axis(std::vector<PairCluster>& out) {
    // Best fixed axes first: those through far middles.
    std::sort(matches_.begin(), matches_.end(), [](const Match& x, const Match& y) {
        return x.reach != y.reach ? x.reach > y.reach : x.pair < y.pair;
    });
    constexpr double kLadder = 10;
    std::size_t last = 0;
    for (double level = scene_.max_tolerance;; level = std::max(level / kLadder, scene_.resolution)) {
        const auto below = [&](const Match& m) { return m.tolerance <= level; };
        const auto count = static_cast<std::size_t>(std::count_if(matches_.begin(), matches_.end(), below));
        if (count == 0) return;
        if (count != last) group_at(level, out);
        last = count;
        if (level <= scene_.resolution) return;
    }
}

void PairSearch::group_at(double level, std::vector<PairCluster>& out) {
    usable_.clear();
    for (const Match& m : matches_)
        if (m.tolerance <= level) usable_.push_back(&m);
    const Vector3d p = (at(pair_.first) + at(pair_.second)) / 2, u = (at(pair_.second) - at(pair_.first)) / 2;
    std::vector<char> explained(usable_.size(), 0);
    for (std::size_t k = 0; k < usable_.size(); ++k) {
        if (explained[k] != 0) continue;
        const Vector3d q1 = at(usable_[k]->pair.first), q2 = at(usable_[k]->pair.second);
        const Vector3d q = (q1 + q2) / 2, v = (q2 - q1) / 2, w = q - p;
        const Matrix3d matrix = u * u.transpose() + v * v.transpose() - w * w.transpose() / 2;
        const Vector3d axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(matrix).eigenvectors().col(0);
        const Vector3d middle = (p + q) / 2;

        group_.clear();
        bool smaller_exists = false;
        double worst = scene_.resolution;
        const double reach = std::max(2 * level, 2 * scene_.resolution);
        for (std::size_t r = 0; r < usable_.size(); ++r) {
            const Match& match = *usable_[r];
            const Vector3d r1 = at(match.pair.first), r2 = at(match.pair.second);
            const Vector3d off = (r1 + r2) / 2 - middle;
            const double sideways = (off - axis * axis.dot(off)).norm();
            if (r != k && 2 * std::max(sideways, std::abs(axis.dot(r2 - r1)) / 2) > reach) continue;
            // Once a smaller pair is in the set, what else lies about this axis is that pair's to report.
            const bool fits = smaller_exists || std::all_of(group_.begin(), group_.end(), [&](const Match* other) {
                return exchange(other->pair, match.pair, level);
            });
            if (!fits) continue;
            explained[r] = 1;
            if (smaller_exists) continue;
            group_.push_back(&match);
            const auto [low, high] = std::minmax(match.pair.first, match.pair.second);
            smaller_exists = Pair{low, high} < pair_;
        }
        // The set is reported once, from its smallest pair.
        explained[k] = 1;
        if (smaller_exists) continue;
        const int pairs = static_cast<int>(group_.size()) + 1;
        if (pairs < 4 && 2 * pairs + 1 < scene_.size() &&
            pairs + points_on_axis(middle, axis, reach) < 4)
            continue;
        PairCluster cluster{SymmetryType::half_turn, 0, {pair_}, true};
        for (const Match* m : group_) {
            worst = std::max(worst, m->tolerance);
            cluster.pairs.push_back({std::min(m->pair.first, m->pair.second), std::max(m->pair.first, m->pair.second)});
            for (const Match* other : group_) {
                if (other == m) break;
                const auto& d = scene_.distances;
                worst = std::max({worst,
                                  std::abs(d(m->pair.first, other->pair.first) - d(m->pair.second, other->pair.second)),
                                  std::abs(d(m->pair.first, other->pair.second) - d(m->pair.second, other->pair.first))});
            }
        }
        std::sort(cluster.pairs.begin(), cluster.pairs.end());
        cluster.tolerance = worst;
        out.push_back(std::move(cluster));
    }
}

/// Disjoint, and the cross distances match within `level`.
bool PairSearch::exchange(const Pair& p, const Pair& q, double level) const {
    const auto& d = scene_.distances;
    return p.first != q.first && p.first != q.second && p.second != q.first && p.second != q.second &&
           std::abs(d(p.first, q.first) - d(p.second, q.second)) <= level &&
           std::abs(d(p.first, q.second) - d(p.second, q.first)) <= level;
}

/// An upper bound of the fixed points of the half-turn; they are among those between the pair.
int PairSearch::points_on_axis(const Vector3d& middle, const Vector3d& axis, double reach) const {
    int count = 0;
    for (const int q : middle_) {
        const Vector3d off = at(q) - middle;
        if (2 * (off - axis * axis.dot(off)).norm() <= reach) ++count;
    }
    return count;
}

/// Clusters of one of the types whose single pair fixes the isometry.
void cluster_edges(const Scene& scene, SymmetryType type, const std::vector<PairEdge>& edges,
                   std::vector<PairCluster>& out) {
    std::vector<Pair> pairs;
    pairs.reserve(2 * edges.size());
    for (const PairEdge& e : edges) {
        pairs.push_back(e.first);
        pairs.push_back(e.second);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    const auto id = [&](const Pair& p) {
        return static_cast<int>(std::lower_bound(pairs.begin(), pairs.end(), p) - pairs.begin());
    };
    std::vector<Consistency> graph;
    graph.reserve(edges.size());
    for (const PairEdge& e : edges) graph.push_back({e.tolerance, id(e.first), id(e.second), false});
    const std::vector<double> no_limit(pairs.size(), std::numeric_limits<double>::infinity());
    const Clustering clustering = complete_components(pairs.size(), std::move(graph), no_limit, scene.resolution);
    for (const Cluster& c : clustering.clusters) {
        PairCluster cluster{type, c.tolerance, {}, c.maximal};
        for (const int m : c.members) cluster.pairs.push_back(pairs[static_cast<std::size_t>(m)]);
        out.push_back(std::move(cluster));
    }
}

/// Equal sets once, the lower tolerance; sets inside another one are not maximal.
void tidy_half_turns(std::vector<PairCluster>& sets) {
    std::sort(sets.begin(), sets.end(), [](const PairCluster& a, const PairCluster& b) {
        return std::tie(a.pairs, a.tolerance) < std::tie(b.pairs, b.tolerance);
    });
    sets.erase(std::unique(sets.begin(), sets.end(),
                           [](const PairCluster& a, const PairCluster& b) { return a.pairs == b.pairs; }),
               sets.end());
    // A set is reported from its smallest pair, so sets that hold it mostly share that pair.
    for (std::size_t i = 0; i < sets.size(); ++i)
        for (std::size_t j = i; j-- > 0 && sets[j].pairs.front() == sets[i].pairs.front();) {
            const auto& small = sets[i].pairs.size() < sets[j].pairs.size() ? i : j;
            const auto& large = small == i ? j : i;
            if (std::includes(sets[large].pairs.begin(), sets[large].pairs.end(), sets[small].pairs.begin(),
                              sets[small].pairs.end()))
                sets[small].maximal = false;
        }
}

}  // namespace

std::vector<PairCluster> detect_pairs(const Scene& scene, TypeSet types, RunMonitor& monitor) {
    std::vector<PairCluster> clusters;
    const SymmetryType central = scene.dimension() == 3 ? SymmetryType::inversion : SymmetryType::half_turn;
    const bool wanted = types.contains(SymmetryType::mirror) || types.contains(SymmetryType::half_turn) ||
                        types.contains(central);
    if (!wanted) return clusters;

    const int n = scene.size();
    std::vector<Findings> findings(static_cast<std::size_t>(n));
    monitor.begin_stage("pairs", static_cast<std::size_t>(n));
    tbb::parallel_for(0, n, [&](int i) {
        PairSearch search(scene, types);
        for (int j = i + 1; j < n && !monitor.should_stop(); ++j)
            if (scene.label(i) == scene.label(j)) search.search({i, j}, findings[static_cast<std::size_t>(i)]);
        monitor.advance();
    });
    if (monitor.should_stop()) return clusters;

    std::vector<PairEdge> mirror_edges, central_edges;
    std::vector<PairCluster> half_turns;
    for (Findings& f : findings) {
        for (const PairEdge& e : f.mirror_edges)
            if (e.first < e.second) mirror_edges.push_back(e);
        central_edges.insert(central_edges.end(), f.central_edges.begin(), f.central_edges.end());
        for (const Pair& p : f.lone_mirrors) clusters.push_back({SymmetryType::mirror, scene.resolution, {p}, true});
        std::move(f.half_turns.begin(), f.half_turns.end(), std::back_inserter(half_turns));
        f = Findings{};
    }
    if (types.contains(SymmetryType::mirror)) cluster_edges(scene, SymmetryType::mirror, mirror_edges, clusters);
    if (types.contains(central)) cluster_edges(scene, central, central_edges, clusters);
    tidy_half_turns(half_turns);
    std::move(half_turns.begin(), half_turns.end(), std::back_inserter(clusters));
    return clusters;
}

}  // namespace insym
