#include "symmetries/pairs.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "isometry/fit.hpp"
#include "parallel_for.hpp"
#include "points/point_grid.hpp"
#include "symmetries/clusters.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A single pair needs as many fixed points to be listed (definitions, section 6).
constexpr int kLeastForLonePair = 3;

/// Half-turns are looked for at max_tolerance and at steps of this factor below it.
constexpr double kLadder = 10;

/// A later pair whose cross distances with the pair at hand match, as by a half-turn.
struct Match {
    Pair pair;             // in the order of the pair at hand: its first point's counterpart first
    double tolerance = 0;  // E_min of the union
    Vector3d off;          // from the middle of the pair at hand to the middle of this one
    Vector3d half;         // from the middle to the second point
    double axis_gap = 0;   // how well the two fix an axis
};

/// How far the least-squares M, I and half-turn of two pairs leave their points (all four links).
struct TwoPairFit {
    double mirror = 0;
    double inversion = 0;
    double half_turn = 0;
    double axis_gap =
        0;  ///< by how much the best axis of a half-turn beats the next: how well the two fix it

    /// The largest residual of a type that fits as well as any (definitions, section 6).
    double limit(const Scene& scene) const {
        return std::min(scene.max_tolerance, 2 * std::min({mirror, inversion, half_turn}) + scene.resolution);
    }
};

/// Two pairs p +- u and q +- v, w = q - p. See fit_pairs() for K, whose eigenvectors `axes`, least first,
/// give the axis of the best half-turn and the normal of the best mirror.
TwoPairFit residuals(const Vector3d& u, const Vector3d& v, const Vector3d& w, const Matrix3d& axes,
                     int dimension) {
    const auto rejection = [](const Vector3d& x, const Vector3d& n) {
        return (x - n * n.dot(x)).squaredNorm();
    };
    TwoPairFit fit;
    fit.inversion = w.norm();
    const Vector3d n = axes.col(dimension - 1);
    const double across = w.dot(n) * w.dot(n) / 4;
    fit.mirror = 2 * std::sqrt(std::max(rejection(u, n), rejection(v, n)) + across);
    fit.half_turn = fit.inversion;
    if (dimension == 2) return fit;
    const Vector3d a = axes.col(0);
    const double along = std::max(u.dot(a) * u.dot(a), v.dot(a) * v.dot(a));
    fit.half_turn = 2 * std::sqrt(along + rejection(w, a) / 4);
    return fit;
}

/// Eigenvectors of K, least eigenvalue first.
Matrix3d pair_axes(const Matrix3d& k, int dimension) {
    if (dimension == 2) {
        const Eigen::Matrix2d block = k.topLeftCorner<2, 2>();
        Matrix3d axes = Matrix3d::Identity();
        axes.topLeftCorner<2, 2>() = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(block).eigenvectors();
        return axes;
    }
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    solver.computeDirect(k);
    // The direct solution is quick, but cannot tell eigenvectors apart whose eigenvalues are nearly equal, as
    // where the middles of the two pairs nearly meet.
    constexpr double kApart = 1e-4;
    const Vector3d& values = solver.eigenvalues();
    const double size = std::max(std::abs(values[0]), std::abs(values[2]));
    if (std::min(values[1] - values[0], values[2] - values[1]) < kApart * size) solver.compute(k);
    return solver.eigenvectors();
}

TwoPairFit fit_two_pairs(const Scene& scene, const Vector3d& u, const Vector3d& v, const Vector3d& w) {
    const Matrix3d k = u * u.transpose() + v * v.transpose() - w * w.transpose() / 2;
    const Matrix3d axes = pair_axes(k, scene.dimension());
    TwoPairFit fit = residuals(u, v, w, axes, scene.dimension());
    fit.axis_gap = axes.col(1).dot(k * axes.col(1)) - axes.col(0).dot(k * axes.col(0));
    return fit;
}

/// An edge of the graph of pairs, for M and for I (in 2D the half-turn).
struct PairEdge {
    double tolerance;
    Pair first;
    Pair second;
};

/// The kind whose isometry is x -> 2c - x.
SymmetryType central_type(int dimension) {
    return dimension == 3 ? SymmetryType::inversion : SymmetryType::half_turn;
}

/// For each point, as a set of bits: in which of some thousand steps of distance it has another point, give
/// or take max_tolerance. Tells at once of most points that no image can be there; the more, the smaller the
/// tolerance.
class DistanceSteps {
public:
    explicit DistanceSteps(const Scene& scene)
        : n_(scene.size()),
          steps_(std::clamp(static_cast<int>(scene.diameter / (2 * scene.max_tolerance)), 1, 8192)),
          scale_(steps_ / (scene.diameter * (1 + 1e-9))),
          words_((static_cast<std::size_t>(steps_) + 63) / 64),
          bits_(static_cast<std::size_t>(scene.size()) * words_),
          step_(static_cast<std::size_t>(scene.size()) * static_cast<std::size_t>(scene.size())) {
        const double reach = scene.max_tolerance * (1 + 1e-9);
        parallel_for(scene.size(), [&](int i) {
            std::uint64_t* own = bits_.data() + static_cast<std::size_t>(i) * words_;
            std::uint16_t* steps = step_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_);
            for (const double d : scene.distances.row(i)) {
                *steps++ = static_cast<std::uint16_t>(step(d));
                for (int s = step(std::max(0.0, d - reach)); s <= step(d + reach); ++s)
                    own[s / 64] |= std::uint64_t{1} << (s % 64);
            }
        });
    }

    /// Of point i, the step of each other point.
    const std::uint16_t* row(int i) const {
        return step_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_);
    }
    const std::uint64_t* of(int i) const { return bits_.data() + static_cast<std::size_t>(i) * words_; }
    static bool has(const std::uint64_t* bits, unsigned step) {
        return (bits[step / 64] >> (step % 64) & 1) != 0;
    }

private:
    int step(double distance) const { return std::min(static_cast<int>(distance * scale_), steps_ - 1); }

    int n_;
    int steps_;
    double scale_;
    std::size_t words_;
    std::vector<std::uint64_t> bits_;
    std::vector<std::uint16_t> step_;
};

/// A set of places in the plane, hashed to bits: never denies that a place within `reach` of one of them, in
/// both coordinates, is there.
class PlaceBits {
public:
    /// A hair more than `reach`, lest rounding lose a place.
    PlaceBits(double reach, double diameter) : reach_(reach + 1e-12 * diameter), scale_(1 / (2 * reach_)) {}

    void clear() { bits_.fill(0); }
    /// Neither coordinate is below 0.
    void add(double x, double y) {
        // A cell is as wide as the reach both ways: the place's reaches into this one and the one before.
        const std::uint32_t high = sum(cell(x + reach_), cell(y + reach_));
        for (const std::uint32_t s : {high, high - kX, high - kY, high - kX - kY}) {
            const std::uint32_t place = s >> (32 - kLog);
            bits_[place / 64] |= std::uint64_t{1} << (place % 64);
        }
    }
    bool may_have(double x, double y) const {
        const std::uint32_t place = sum(cell(x), cell(y)) >> (32 - kLog);
        return (bits_[place / 64] >> (place % 64) & 1) != 0;
    }

private:
    static constexpr int kLog = 14;
    static constexpr std::uint32_t kX = 0x9E3779B1U, kY = 0x85EBCA77U;

    std::uint32_t cell(double at) const {
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(at * scale_));
    }
    static std::uint32_t sum(std::uint32_t x, std::uint32_t y) { return x * kX + y * kY; }

    double reach_;
    double scale_;
    std::array<std::uint64_t, (std::size_t{1} << kLog) / 64> bits_{};
};

/// What the pairs with one first point gave.
struct Findings {
    std::vector<PairEdge> mirror_edges;
    std::vector<PairEdge> central_edges;
    std::vector<Pair> lone_mirrors;  // pairs that could be listed by themselves
    std::vector<Pair> lone_centres;
    std::vector<PairCluster> half_turns;
};

/// Looks for the partners (q, image) of the pairs (P1, P2) with one first point: |P1 q| = |P2 image| and
/// |P2 q| = |P1 image|, each within the cap. Only later points count, so each two pairs meet once.
class PairSearch {
public:
    PairSearch(const Scene& scene, const PointGrid& grid, const DistanceSteps& steps, TypeSet types,
               int first, Findings& out);

    void search(int second);

private:
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    Vector3d at(int i) const { return to_vector(scene_.position(i)); }

    void collect_matches();
    void examine(int q, int image, double tolerance);
    SymmetryType central_type() const { return insym::central_type(scene_.dimension()); }
    bool lone_mirror() const;
    int points_in_own_middle() const;
    void group_by_axis();
    void group_at(double level);
    void report_group(double level, const Vector3d& middle, const Vector3d& axis);
    bool exchange(const Pair& p, const Pair& q, double level) const;
    bool smaller_pair_turns(const Vector3d& middle, const Vector3d& axis, double reach, double level) const;
    int points_on_axis(const Vector3d& middle, const Vector3d& axis, double reach);

    const Scene& scene_;
    const PointGrid& grid_;
    const DistanceSteps& steps_;
    TypeSet types_;
    Findings& out_;
    Pair pair_;
    std::span<const double> a_;  // distances to the first point of the pair
    std::span<const double> b_;  // and to the second

    // The later points, nearest to the first one, and a directory of their distances. They may have another
    // label: each pair is of one label, a symmetry is not.
    std::vector<int> later_;
    std::vector<double> later_a_;
    std::vector<int> directory_;
    double directory_scale_ = 0;

    std::vector<int> possible_;  // points that may have an image, or be one
    PlaceBits places_;           // their distances to the first and the second point
    std::vector<int> between_;   // points at nearly equal distances from both
    bool between_known_ = false;
    std::vector<Match> matches_;
    std::vector<const Match*> usable_;
    std::vector<const Match*> group_;
};

PairSearch::PairSearch(const Scene& scene, const PointGrid& grid, const DistanceSteps& steps, TypeSet types,
                       int first, Findings& out)
    : scene_(scene),
      grid_(grid),
      steps_(steps),
      types_(types),
      out_(out),
      pair_{first, first},
      a_(scene.distances.row(first)),
      places_(scene.max_tolerance, scene.diameter) {
    for (const int q : scene.distances.nearest_first(first))
        if (q > first) later_.push_back(q);
    for (const int q : later_) later_a_.push_back(a_[index(q)]);
    const std::size_t size = later_.size() + 1;
    directory_scale_ = static_cast<double>(size) / (scene.diameter * (1 + 1e-9));
    directory_.assign(size + 1, static_cast<int>(later_.size()));
    for (std::size_t k = later_.size(); k-- > 0;)
        directory_[static_cast<std::size_t>(later_a_[k] * directory_scale_)] = static_cast<int>(k);
    for (std::size_t k = size; k-- > 0;) directory_[k] = std::min(directory_[k], directory_[k + 1]);
    possible_.resize(later_.size());
}

void PairSearch::search(int second) {
    pair_.second = second;
    b_ = scene_.distances.row(second);
    between_known_ = false;
    matches_.clear();
    collect_matches();
    if (types_.contains(SymmetryType::mirror) && lone_mirror()) out_.lone_mirrors.push_back(pair_);
    // A centre fixes one point at most: alone, a pair covers the set only with that point or none.
    if (types_.contains(central_type()) && scene_.size() <= 3 && points_in_own_middle() + 2 == scene_.size())
        out_.lone_centres.push_back(pair_);
    if (types_.contains(SymmetryType::half_turn) && scene_.dimension() == 3) group_by_axis();
}

void PairSearch::collect_matches() {
    const double cap = scene_.max_tolerance;
    // The image is as far from the first point as q is from the second, and the other way round. Stored
    // without a branch, which would be a coin toss.
    const std::uint64_t* from_first = steps_.of(pair_.first);
    const std::uint64_t* from_second = steps_.of(pair_.second);
    const std::uint16_t* to_first = steps_.row(pair_.first);
    const std::uint16_t* to_second = steps_.row(pair_.second);
    std::size_t possible = 0;
    for (int q = pair_.first + 1; q < scene_.size(); ++q) {
        const bool may_match =
            DistanceSteps::has(from_first, to_second[q]) & DistanceSteps::has(from_second, to_first[q]);
        possible_[possible] = q;
        possible += may_match ? 1 : 0;
    }
    // Of q and its image one leans to the first point: q; the other one to the second.
    places_.clear();
    for (std::size_t l = 0; l < possible; ++l) {
        const double a = a_[index(possible_[l])], b = b_[index(possible_[l])];
        if (a - b >= -cap) places_.add(a, b);
    }
    for (std::size_t l = 0; l < possible; ++l) {
        const int q = possible_[l];
        const double a = a_[index(q)], b = b_[index(q)];
        if (a - b > cap || !places_.may_have(b, a) || q == pair_.second) continue;
        std::size_t k = static_cast<std::size_t>(
            directory_[static_cast<std::size_t>(std::max(0.0, b - cap) * directory_scale_)]);
        for (; k < later_.size() && later_a_[k] <= b + cap; ++k) {
            const int image = later_[k];
            const double other_b = b_[index(image)];
            if (later_a_[k] < b - cap || std::abs(a - other_b) > cap || image == q || image == pair_.second ||
                scene_.label(image) != scene_.label(q))
                continue;
            const double lean = a - b, other_lean = later_a_[k] - other_b;
            if (lean > other_lean || (lean == other_lean && q > image)) continue;
            examine(q, image,
                    std::max({scene_.resolution, std::abs(a - other_b), std::abs(b - later_a_[k])}));
        }
    }
}

/// Decides of which types the union of the pair and (q, image) is.
void PairSearch::examine(int q, int image, double tolerance) {
    const Vector3d p1 = at(pair_.first), p2 = at(pair_.second), q1 = at(q), q2 = at(image);
    const Vector3d u = (p2 - p1) / 2, v = (q2 - q1) / 2, w = (q1 + q2) / 2 - (p1 + p2) / 2;
    const TwoPairFit fit = fit_two_pairs(scene_, u, v, w);
    const double limit = fit.limit(scene_);
    const Pair other = {std::min(q, image), std::max(q, image)};
    if (types_.contains(SymmetryType::mirror) && fit.mirror <= limit)
        out_.mirror_edges.push_back({tolerance, pair_, other});
    if (types_.contains(central_type()) && fit.inversion <= limit)
        out_.central_edges.push_back({tolerance, pair_, other});
    if (fit.half_turn <= limit && scene_.dimension() == 3)
        matches_.push_back({{q, image}, tolerance, w, v, fit.axis_gap});
}

/// Does the mirror of the pair alone leave enough points in place to be listed? It moves q by
/// |a^2 - b^2| / |P1 P2|, which is no less than |a - b|.
bool PairSearch::lone_mirror() const {
    const auto enough = [&](int fixed) { return fixed >= kLeastForLonePair || fixed + 2 >= scene_.size(); };
    // Of most pairs so few points are at nearly equal distances that the steps tell, many at a time.
    const std::uint16_t *first = steps_.row(pair_.first), *second = steps_.row(pair_.second);
    std::uint16_t near = 0;
    for (int q = 0; q < scene_.size(); ++q)
        near = static_cast<std::uint16_t>(near + (static_cast<std::uint16_t>(first[q] - second[q] + 1) <= 2));
    if (!enough(near)) return false;
    const double limit = scene_.resolution * a_[index(pair_.second)];
    int fixed = 0;
    for (std::size_t q = 0; q < a_.size(); ++q)
        fixed += std::abs((a_[q] - b_[q]) * (a_[q] + b_[q])) <= limit ? 1 : 0;
    return enough(fixed);
}

int PairSearch::points_in_own_middle() const {
    const Vector3d middle = (at(pair_.first) + at(pair_.second)) / 2;
    int count = 0;
    grid_.visit_ball(to_point(middle), scene_.resolution / 2, [&](int, double) { return ++count > 0; });
    return count;
}

/// Half-turns: the largest sets of mutually consistent pairs about one axis, at a ladder of tolerances
/// so that an exact axis is not lost in the approximate one around it.
void PairSearch::group_by_axis() {
    // Best fixed axes first: those through far middles, or across chords of different directions.
    std::sort(matches_.begin(), matches_.end(), [](const Match& x, const Match& y) {
        return x.axis_gap != y.axis_gap ? x.axis_gap > y.axis_gap : x.pair < y.pair;
    });
    std::size_t last = 0;
    for (double level = scene_.max_tolerance;; level = std::max(level / kLadder, scene_.resolution)) {
        usable_.clear();
        for (const Match& m : matches_)
            if (m.tolerance <= level) usable_.push_back(&m);
        if (usable_.empty()) return;
        if (usable_.size() != last) group_at(level);
        last = usable_.size();
        if (level <= scene_.resolution) return;
    }
}

void PairSearch::group_at(double level) {
    const Vector3d p = (at(pair_.first) + at(pair_.second)) / 2, u = (at(pair_.second) - at(pair_.first)) / 2;
    std::vector<char> explained(usable_.size(), 0);
    for (std::size_t k = 0; k < usable_.size(); ++k) {
        if (explained[k] != 0) continue;
        const Vector3d &v = usable_[k]->half, &w = usable_[k]->off;
        const Matrix3d matrix = u * u.transpose() + v * v.transpose() - w * w.transpose() / 2;
        const Vector3d axis = pair_axes(matrix, 3).col(0);

        group_ = {usable_[k]};
        explained[k] = 1;
        for (std::size_t r = 0; r < usable_.size(); ++r) {
            const Match& match = *usable_[r];
            // The half-turn moves the points of a pair off by twice its middle's way off the axis, and by
            // twice the chord's share along it.
            // An axis fitted to two pairs may be off by as much again as the pairs are.
            if (std::abs(axis.dot(match.half)) > level) continue;
            const Vector3d off = match.off - w / 2;
            const double along = axis.dot(off);
            if (off.squaredNorm() - along * along > level * level || r == k) continue;
            const bool fits = std::all_of(group_.begin(), group_.end(), [&](const Match* m) {
                return exchange(m->pair, match.pair, level);
            });
            if (!fits) continue;
            explained[r] = 1;
            group_.push_back(usable_[r]);
        }
        report_group(level, p + w / 2, axis);
    }
}

/// The pair at hand and group_ as one set, if it could be listed and no smaller pair reports it.
void PairSearch::report_group(double level, const Vector3d& middle, const Vector3d& axis) {
    const int pairs = static_cast<int>(group_.size()) + 1;
    const bool may_cover = 2 * pairs + 1 >= scene_.size();
    if (pairs < 4 && !may_cover && pairs + points_on_axis(middle, axis, level) < 4) return;
    if (smaller_pair_turns(middle, axis, level, level)) return;
    PairCluster cluster{SymmetryType::half_turn, scene_.resolution, {pair_}, true};
    const auto& d = scene_.distances;
    for (const Match* m : group_) {
        const Pair& p = m->pair;
        cluster.pairs.push_back({std::min(p.first, p.second), std::max(p.first, p.second)});
        cluster.tolerance = std::max(cluster.tolerance, m->tolerance);
        for (const Match* other : group_) {
            if (other == m) break;
            const Pair& q = other->pair;
            cluster.tolerance =
                std::max({cluster.tolerance, std::abs(d(p.first, q.first) - d(p.second, q.second)),
                          std::abs(d(p.first, q.second) - d(p.second, q.first))});
        }
    }
    std::sort(cluster.pairs.begin(), cluster.pairs.end());
    out_.half_turns.push_back(std::move(cluster));
}

/// Disjoint, and the cross distances match within `level`.
bool PairSearch::exchange(const Pair& p, const Pair& q, double level) const {
    const auto& d = scene_.distances;
    return p.first != q.first && p.first != q.second && p.second != q.first && p.second != q.second &&
           std::abs(d(p.first, q.first) - d(p.second, q.second)) <= level &&
           std::abs(d(p.first, q.second) - d(p.second, q.first)) <= level;
}

/// Is there a pair with a smaller first point about this axis? Then the axis is that pair's to report.
bool PairSearch::smaller_pair_turns(const Vector3d& middle, const Vector3d& axis, double reach,
                                    double level) const {
    const std::uint64_t *from_first = steps_.of(pair_.first), *from_second = steps_.of(pair_.second);
    const std::uint16_t *to_first = steps_.row(pair_.first), *to_second = steps_.row(pair_.second);
    for (int r = 0; r < pair_.first; ++r) {
        if (!DistanceSteps::has(from_first, to_second[r]) || !DistanceSteps::has(from_second, to_first[r]))
            continue;
        const Vector3d off = at(r) - middle;
        const Vector3d image = middle + 2 * axis * axis.dot(off) - off;
        bool found = false;
        grid_.visit_ball(to_point(image), reach, [&](int s, double) {
            const Pair smaller{r, s};
            found = s != r && scene_.label(s) == scene_.label(r) && exchange(smaller, pair_, level);
            return !found;
        });
        if (found) return true;
    }
    return false;
}

/// An upper bound of the fixed points of the half-turn; they are among those between the pair.
int PairSearch::points_on_axis(const Vector3d& middle, const Vector3d& axis, double reach) {
    if (!between_known_) {
        between_.clear();
        const double limit = scene_.max_tolerance;
        for (std::size_t q = 0; q < a_.size(); ++q)
            if (std::abs(a_[q] - b_[q]) <= 2 * limit) between_.push_back(static_cast<int>(q));
        between_known_ = true;
    }
    return static_cast<int>(std::count_if(between_.begin(), between_.end(), [&](int q) {
        const Vector3d off = at(q) - middle;
        return 2 * (off - axis * axis.dot(off)).norm() <= reach;
    }));
}

/// Clusters of one of the types whose single pair fixes the isometry. `lone`: pairs that would do by
/// themselves, listed if no edge of the lowest level takes them up.
void cluster_edges(const Scene& scene, SymmetryType type, const std::vector<PairEdge>& edges,
                   const std::vector<Pair>& lone, std::vector<PairCluster>& out) {
    // Number the pairs that occur, in order.
    constexpr int kUnknown = -1;
    const auto n = static_cast<std::size_t>(scene.size());
    std::vector<int> numbers(n * n, kUnknown);
    const auto number = [&](const Pair& p) -> int& {
        return numbers[static_cast<std::size_t>(p.first) * n + static_cast<std::size_t>(p.second)];
    };
    for (const PairEdge& e : edges) number(e.first) = number(e.second) = 0;
    std::vector<std::size_t> keys;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        if (numbers[k] == kUnknown) continue;
        numbers[k] = static_cast<int>(keys.size());
        keys.push_back(k);
    }

    std::vector<Consistency> graph;
    graph.reserve(edges.size());
    std::vector<char> exact(keys.size(), 0);
    for (const PairEdge& e : edges) {
        const int first = number(e.first), second = number(e.second);
        graph.push_back({e.tolerance, first, second, false});
        if (e.tolerance <= 2 * scene.resolution)
            exact[static_cast<std::size_t>(first)] = exact[static_cast<std::size_t>(second)] = 1;
    }
    const std::vector<double> no_limit(keys.size(), std::numeric_limits<double>::infinity());
    const Clustering clustering =
        complete_components(keys.size(), std::move(graph), no_limit, scene.resolution);
    for (const Cluster& c : clustering.clusters) {
        PairCluster cluster{type, c.tolerance, {}, c.maximal};
        for (const int m : c.members) {
            const std::size_t k = keys[static_cast<std::size_t>(m)];
            cluster.pairs.push_back({static_cast<int>(k / n), static_cast<int>(k % n)});
        }
        out.push_back(std::move(cluster));
    }
    for (const Pair& p : lone) {
        const bool known = number(p) != kUnknown;
        const auto at = static_cast<std::size_t>(known ? number(p) : 0);
        if (known && exact[at] != 0) continue;
        out.push_back({type, scene.resolution, {p}, !known || clustering.clustered[at] == 0});
    }
}

bool holds_all(const PairCluster& large, const PairCluster& small) {
    return large.pairs.size() >= small.pairs.size() &&
           std::includes(large.pairs.begin(), large.pairs.end(), small.pairs.begin(), small.pairs.end());
}

/// Of the sets that one pair reports, the largest: a set inside another counts only at a lower tolerance,
/// and is then not maximal.
void keep_largest(std::vector<PairCluster>& sets) {
    std::sort(sets.begin(), sets.end(), [](const PairCluster& a, const PairCluster& b) {
        if (a.pairs.front() != b.pairs.front()) return a.pairs.front() < b.pairs.front();
        if (a.pairs.size() != b.pairs.size()) return a.pairs.size() > b.pairs.size();
        return std::tie(a.tolerance, a.pairs) < std::tie(b.tolerance, b.pairs);
    });
    std::vector<PairCluster> kept;
    std::size_t group = 0;  // where the sets of the pair at hand begin in kept
    for (PairCluster& set : sets) {
        if (group < kept.size() && kept[group].pairs.front() != set.pairs.front()) group = kept.size();
        bool useful = true;
        for (std::size_t k = group; k < kept.size() && useful; ++k) {
            if (!holds_all(kept[k], set)) continue;
            set.maximal = false;
            useful = set.tolerance * kLadder <= kept[k].tolerance;
        }
        if (useful) kept.push_back(std::move(set));
    }
    sets.swap(kept);
}

}  // namespace

std::vector<PairCluster> detect_pairs(const Scene& scene, TypeSet types, RunMonitor& monitor) {
    std::vector<PairCluster> clusters;
    const SymmetryType central = central_type(scene.dimension());
    const bool wanted = types.contains(SymmetryType::mirror) || types.contains(SymmetryType::half_turn) ||
                        types.contains(central);
    if (!wanted) return clusters;

    const int n = scene.size();
    const PointGrid grid(scene.points.positions);
    const DistanceSteps steps(scene);
    std::vector<Findings> findings(static_cast<std::size_t>(n));
    monitor.begin_stage("pairs", static_cast<std::size_t>(n));
    parallel_for(n, [&](int i) {
        PairSearch search(scene, grid, steps, types, i, findings[static_cast<std::size_t>(i)]);
        for (int j = i + 1; j < n && !monitor.should_stop(); ++j)
            if (scene.label(i) == scene.label(j)) search.search(j);
        monitor.advance();
    });
    if (monitor.should_stop()) return clusters;

    Findings all;
    const auto append = [](auto& to, auto& from) {
        std::move(from.begin(), from.end(), std::back_inserter(to));
    };
    for (Findings& f : findings) {
        append(all.mirror_edges, f.mirror_edges);
        append(all.central_edges, f.central_edges);
        append(all.lone_mirrors, f.lone_mirrors);
        append(all.lone_centres, f.lone_centres);
        append(all.half_turns, f.half_turns);
        f = Findings{};
    }
    std::vector<PairCluster> mirrors, centres;
    parallel_for(3, [&](int kind) {
        if (kind == 0 && types.contains(SymmetryType::mirror))
            cluster_edges(scene, SymmetryType::mirror, all.mirror_edges, all.lone_mirrors, mirrors);
        if (kind == 1 && types.contains(central))
            cluster_edges(scene, central, all.central_edges, all.lone_centres, centres);
        if (kind == 2) keep_largest(all.half_turns);
    });
    append(clusters, mirrors);
    append(clusters, centres);
    append(clusters, all.half_turns);
    return clusters;
}

}  // namespace insym
