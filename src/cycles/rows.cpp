#include "cycles/rows.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hypotheses/cells.hpp"
#include "hypotheses/generators.hpp"
#include "parallel_for.hpp"
#include "points/cloud.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostVotingPairs = 100'000;
constexpr std::size_t kMostAsked = 64;  // of the vectors that most pairs have
constexpr std::size_t kMostTranslations = 4;
constexpr int kLeastShare = 16;  // one in so many points lies in the rows of a translation

/// A translation is longer than so many resolutions: it leads on, though it may be met two beside its end.
constexpr double kShortest = 16;

/// So near to the middle, in |t|, are the copies of a link that stand for all of them: one or two, and two or
/// three to start from.
constexpr double kNearest = 0.5;
constexpr double kStarts = 1;

/// What a translation does to the points.
struct Carried {
    Vector3d vector;
    std::vector<int> next, previous;  // of each point, or -1
    int in_rows = 0;                  // of three and more

    int after(int i) const { return next[static_cast<std::size_t>(i)]; }
    int before(int i) const { return previous[static_cast<std::size_t>(i)]; }
    bool in_row(int i) const {
        const int n = after(i), p = before(i);
        return (n >= 0 && (p >= 0 || after(n) >= 0)) || (p >= 0 && before(p) >= 0);
    }
};

Carried carried_by(const Cloud& cloud, const Vector3d& vector) {
    const auto n = static_cast<std::size_t>(cloud.size());
    Carried out{vector, std::vector<int>(n, -1), std::vector<int>(n, -1)};
    for (int i = 0; i < cloud.size(); ++i) {
        double square = 0;
        const int j = cloud.nearest(cloud[i] + vector, cloud.label(i), 2 * cloud.scene().resolution, square);
        if (j < 0 || j == i) continue;
        out.next[static_cast<std::size_t>(i)] = j;
        out.previous[static_cast<std::size_t>(j)] = i;
    }
    for (int i = 0; i < cloud.size(); ++i) out.in_rows += out.in_row(i) ? 1 : 0;
    return out;
}

/// A whole multiple of the other, in either direction?
bool is_multiple(const Vector3d& vector, const Vector3d& of, double resolution) {
    const double times = std::round(vector.dot(of) / of.squaredNorm());
    return (vector - times * of).norm() <= 4 * resolution * std::max(1.0, std::abs(times));
}

/// The vectors that most pairs have; of multiples the one with the most.
std::vector<Vector3d> suggested(const Cloud& cloud) {
    SearchGroup all(static_cast<std::size_t>(cloud.size()));
    std::iota(all.begin(), all.end(), 0);
    const PointPairs pairs = spread_pairs(cloud, all, kMostVotingPairs);
    const double resolution = cloud.scene().resolution;
    const auto vector = [&](std::size_t k) {
        return ballot_place(SymmetryType::translation, cloud[pairs[k].first], cloud[pairs[k].second], {});
    };
    const Vector3d off = off_borders(2 * resolution);
    std::vector<Ranked> cells =
        full_cells(pairs.size(), 2 * resolution, [&](std::size_t k) -> Vector3d { return vector(k) + off; });
    keep_fullest(cells, kMostAsked);
    std::vector<Vector3d> out;
    for (const Ranked& r : cells) {
        const Vector3d v = vector(static_cast<std::size_t>(r.first));
        if (v.norm() > kShortest * resolution &&
            std::none_of(out.begin(), out.end(),
                         [&](const Vector3d& other) { return is_multiple(v, other, resolution); }))
            out.push_back(v);
    }
    return out;
}

/// All translations that make rows.
std::vector<Carried> translations_of(const Cloud& cloud) {
    const std::vector<Vector3d> vectors = suggested(cloud);
    std::vector<Carried> out(vectors.size());
    parallel_for(out.size(), [&](std::size_t k) { out[k] = carried_by(cloud, vectors[k]); });
    std::erase_if(out, [&](const Carried& c) { return c.in_rows == 0; });
    return out;
}

/// Those that carry enough, most points first, of equal ones the shortest; no multiples of them, and no part
/// of equals.
std::vector<Carried> best_of(std::vector<Carried> all, const Cloud& cloud) {
    const double resolution = cloud.scene().resolution;
    std::erase_if(all, [&](const Carried& c) { return c.in_rows * kLeastShare < cloud.size(); });
    const auto rank = [&](const Carried& c) {
        return std::pair(-c.in_rows, std::round(c.vector.norm() / (4 * resolution)));
    };
    std::stable_sort(all.begin(), all.end(),
                     [&](const Carried& a, const Carried& b) { return rank(a) < rank(b); });
    std::vector<Carried> out;
    for (Carried& c : all)
        if (std::none_of(out.begin(), out.end(), [&](const Carried& better) {
                return is_multiple(c.vector, better.vector, resolution);
            }))
            out.push_back(std::move(c));
    std::size_t kept = std::min(out.size(), kMostTranslations);
    while (kept > 0 && kept < out.size() && rank(out[kept - 1]) == rank(out[kept])) --kept;
    out.resize(kept);
    return out;
}

/// Among the chosen ones, or -1.
int place_of(const Carried& c, const std::vector<Carried>& chosen) {
    const auto found = std::find_if(chosen.begin(), chosen.end(),
                                    [&](const Carried& other) { return other.vector == c.vector; });
    return found == chosen.end() ? -1 : static_cast<int>(found - chosen.begin());
}

Point point_of(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

double along(const Point& t, const Point& from, const Point& to) {
    return t[0] * (to[0] - from[0]) + t[1] * (to[1] - from[1]) + t[2] * (to[2] - from[2]);
}

}  // namespace

Rows::Rows(const Scene& scene) : points_(&scene.points) {
    const Cloud cloud(scene);
    const std::vector<Carried> all = translations_of(cloud);
    const std::vector<Carried> chosen = best_of(all, cloud);
    places_.resize(static_cast<std::size_t>(scene.size()) * chosen.size());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const Carried& c = chosen[k];
        const double length = c.vector.norm();
        translations_.push_back({point_of(c.vector), length * length, 4 * scene.resolution * length, {}});
        for (const Carried& other : all)
            if (std::abs(other.vector.norm() - length) <= 4 * scene.resolution &&
                !is_multiple(other.vector, c.vector, scene.resolution))
                translations_.back().mates.push_back({point_of(other.vector), place_of(other, chosen)});
        const auto height = [&](int i) { return c.vector.dot(cloud[i]); };
        for (int first = 0; first < scene.size(); ++first) {
            if (!c.in_row(first) || c.before(first) >= 0) continue;
            int last = first;
            while (c.after(last) >= 0) last = c.after(last);
            const double low = height(first), high = height(last);
            for (int i = first; i >= 0; i = c.after(i))
                places_[static_cast<std::size_t>(i) * chosen.size() + k] = {
                    height(i), (low + high) / 2, low, high, first, c.after(i) >= 0, c.before(i) >= 0};
        }
    }
}

bool Rows::superfluous(int a, int b, int c) const {
    for (std::size_t k = 0; k < translations_.size(); ++k) {
        const Seen s = seen(k, a, b, c);
        if (s.a.row < 0 || s.b.row < 0 || s.c.row < 0) continue;
        const double first = s.b.height - s.a.height, second = s.c.height - s.b.height;
        const auto mates = [&](auto is) { return std::any_of(s.t.mates.begin(), s.t.mates.end(), is); };
        const auto exchanged = [&](const Mate& mate) { return may_exchange(mate, a, b, c); };
        const auto may_as_well = [&](const Mate& mate) {
            return exchanged(mate) && advances_alike(s.t, mate, a, b, c);
        };
        bool found = false;
        if (std::abs(first - second) <= s.t.slack) {
            const bool longer = std::abs(first) > s.t.square + s.t.slack;
            found = longer && (first > 0 ? s.a.ahead && s.c.behind : s.a.behind && s.c.ahead) &&
                    !mates(may_as_well);
        } else if (std::abs(first + second) <= s.t.slack) {
            found = off_middle(s) && !mates(may_as_well);
        } else {
            found = is_copy(s, kNearest) && !mates(exchanged);
        }
        if (found) return true;
    }
    return false;
}

bool Rows::repeats(int a, int b, int c) const {
    for (std::size_t k = 0; k < translations_.size(); ++k) {
        const Seen s = seen(k, a, b, c);
        if (s.a.row < 0 || s.a.row != s.c.row || s.b.row < 0) continue;
        if (std::abs(s.c.height - s.a.height) > 2 * s.t.square + s.t.slack) continue;
        if (std::abs(2 * s.b.height - s.a.height - s.c.height) <= s.t.slack && is_copy(s, kStarts))
            return true;
    }
    return false;
}

/// Can an isometry that takes A to B and B to C take rows along t to rows of the mate, or those to these?
/// Then two of the points at least lie in rows of both.
bool Rows::may_exchange(const Mate& mate, int a, int b, int c) const {
    if (mate.place < 0) return true;
    const auto in_row = [&](int i) { return place(i, static_cast<std::size_t>(mate.place)).row >= 0; };
    return in_row(b) && (in_row(a) || in_row(c));
}

/// If it does, the second link advances along the one as the first does along the other, up to the sign.
bool Rows::advances_alike(const Translation& t, const Mate& mate, int a, int b, int c) const {
    const auto& p = points_->positions;
    const Point &from = p[static_cast<std::size_t>(a)], &apex = p[static_cast<std::size_t>(b)],
                &to = p[static_cast<std::size_t>(c)];
    const auto alike = [&](double x, double y) { return std::abs(std::abs(x) - std::abs(y)) <= t.slack; };
    return alike(along(t.vector, from, apex), along(mate.vector, apex, to)) ||
           alike(along(mate.vector, from, apex), along(t.vector, apex, to));
}

/// Are the middles of both links on one side of those of the rows, and is the point there that the one
/// nearest to them has in the place of B?
bool Rows::off_middle(const Seen& s) {
    const double first = s.b.height + s.a.height - s.b.middle - s.a.middle;
    const double second = s.b.height + s.c.height - s.b.middle - s.c.middle;
    const double least = s.t.square / 2 + s.t.slack;
    if (std::abs(first) <= least || std::abs(second) <= least || (first > 0) != (second > 0)) return false;
    const double there = s.b.height - std::round(first / s.t.square) * s.t.square;
    return there >= s.b.low - s.t.slack && there <= s.b.high + s.t.slack;
}

/// Is the middle of neither link, each of which can be the middle one of a chain of four, so near to those of
/// the rows, and does a translation bring it nearer?
bool Rows::is_copy(const Seen& s, double near) {
    const auto far = [&](const Place& from, const Place& to) {
        const double off = (from.height + to.height - from.middle - to.middle) / 2;
        if (std::abs(off) <= near * s.t.square + s.t.slack) return false;
        return off > 0 ? s.a.behind && s.b.behind && s.c.behind : s.a.ahead && s.b.ahead && s.c.ahead;
    };
    return far(s.a, s.b) && far(s.b, s.c);
}

}  // namespace insym
