#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>

#include "hypotheses/generators.hpp"
#include "parallel_for.hpp"

namespace insym {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RigidMap carry(const std::array<Vector3d, 3>& from, const std::array<Vector3d, 3>& to, bool improper) {
    const auto frame = [](const std::array<Vector3d, 3>& t, double sign) {
        Matrix3d f;
        const Vector3d x = (t[1] - t[0]).normalized();
        const Vector3d z = x.cross(t[2] - t[0]).normalized();
        f << x, z.cross(x), sign * z;
        return f;
    };
    RigidMap map;
    map.linear = frame(to, improper ? -1 : 1) * frame(from, 1).transpose();
    map.shift = (to[0] + to[1] + to[2]) / 3 - map.linear * ((from[0] + from[1] + from[2]) / 3);
    return map;
}

bool before(const Candidate& x, const Candidate& y) {
    if (x.rank != y.rank) return x.rank < y.rank;
    return x.points != y.points ? x.points < y.points : x.type < y.type;
}

namespace {

std::vector<Point> positions(const Cloud& cloud, const SearchGroup& group) {
    std::vector<Point> out;
    out.reserve(group.size());
    for (const int i : group) out.push_back(to_point(cloud[i]));
    return out;
}

std::vector<char> within(const SearchGroup& group, const Focus& focus) {
    std::vector<char> out;
    out.reserve(group.size());
    for (const int i : group) out.push_back(in(focus, i) ? 1 : 0);
    return out;
}

/// The reach at which so many events are expected, if each takes `exponent` lengths that agree by chance.
double affordable(double expected_per_reach, double budget, double exponent, double reach) {
    return std::min(reach, std::pow(budget / expected_per_reach, 1 / exponent));
}

/// The best of many candidates: no more than twice `most` are kept at a time.
class BestCandidates {
public:
    explicit BestCandidates(std::size_t most) : most_(most) {}

    void add(const Candidate& candidate) {
        if (candidate.rank > worst_) return;
        found_.push_back(candidate);
        if (found_.size() >= 2 * most_ + 1000) cut();
    }

    /// In any order.
    std::vector<Candidate> kept() {
        cut();
        return std::move(found_);
    }

private:
    void cut() {
        if (found_.size() <= most_) return;
        const auto end = found_.begin() + static_cast<std::ptrdiff_t>(most_);
        std::nth_element(found_.begin(), end, found_.end(), before);
        worst_ = end->rank;
        found_.resize(most_);
    }

    std::size_t most_;
    double worst_ = std::numeric_limits<double>::infinity();
    std::vector<Candidate> found_;
};

/// A search is made in so many parts at once, each with candidates of its own.
constexpr int kParts = 4;

/// What is best in all parts of a search that is begun as `search` each time and run by `run`.
template <class Search, class Run>
std::vector<Candidate> best_of_parts(const Search& search, std::size_t most, const Run& run) {
    std::vector<Search> parts(kParts, search);
    parallel_for(kParts, [&](int part) { run(parts[static_cast<std::size_t>(part)], part); });
    BestCandidates best(most);
    for (Search& part : parts)
        for (const Candidate& c : part.best().kept()) best.add(c);
    return best.kept();
}

/// A turn about the circle through three points.
bool ring_through(const Vector3d& a, const Vector3d& b, const Vector3d& c, Vector3d& center, Vector3d& axis) {
    const Vector3d u = a - b, v = c - b;
    axis = u.cross(v);
    const double area = axis.squaredNorm();
    if (!(area > 1e-8 * u.squaredNorm() * v.squaredNorm())) return false;
    center = b + (axis.cross(u) * v.squaredNorm() + v.cross(axis) * u.squaredNorm()) / (2 * area);
    axis.normalize();
    return true;
}

/// A turn that takes three points on; false where they are (nearly) in a row.
bool ring_map(const Vector3d& a, const Vector3d& b, const Vector3d& c, RigidMap& map, double& radius) {
    Vector3d center, axis;
    if (!ring_through(a, b, c, center, axis)) return false;
    const Vector3d u = a - center, v = b - center;
    radius = u.norm();
    // Rodrigues' formula, without the angle.
    const double scale = 1 / std::sqrt(u.squaredNorm() * v.squaredNorm());
    const double cosine = u.dot(v) * scale, sine = u.cross(v).dot(axis) * scale;
    map.linear = (1 - cosine) * axis * axis.transpose();
    map.linear.diagonal().array() += cosine;
    const Vector3d across = sine * axis;
    map.linear(0, 1) -= across.z(), map.linear(1, 0) += across.z();
    map.linear(0, 2) += across.y(), map.linear(2, 0) -= across.y();
    map.linear(1, 2) -= across.x(), map.linear(2, 1) += across.x();
    map.shift = center - map.linear * center;
    return true;
}

class ChainSearch {
public:
    ChainSearch(const GroupDistances& group, double reach, double effort, std::size_t most)
        : cloud_(group.cloud),
          group_(group.group),
          in_focus_(group.in_focus),
          distances_(group.distances),
          reach_(reach),
          best_(most) {
        const double n = distances_.size(), diameter = cloud_.scene().diameter;
        three_ = affordable(1.5 * n * n * n / diameter, 6e4 * effort, 1, reach);
        four_ = affordable(27 * n * n * n * n / std::pow(diameter, 3), 1e4 * effort, 3, reach);
        three_ = std::max(three_, 2 * cloud_.scene().resolution);
        four_ = std::max(four_, 2 * cloud_.scene().resolution);
    }

    /// Every kParts-th point from `part` as B.
    void run(int part) {
        const int n = static_cast<int>(group_.size());
        const double slack = std::max(three_, four_);
        for (int b = part; b < n; b += kParts) {
            if (!of_focus(b)) continue;
            const auto order = distances_.nearest_first(b);
            for (std::size_t i = 0; i < order.size(); ++i)
                for (std::size_t j = i + 1; j < order.size(); ++j) {
                    const double low = distances_(b, order[i]), high = distances_(b, order[j]);
                    if (high - low > slack) break;
                    triple(order[i], b, order[j]);
                }
        }
    }

    BestCandidates& best() { return best_; }

private:
    const Vector3d& at(int i) const { return cloud_[group_[static_cast<std::size_t>(i)]]; }
    bool of_focus(int i) const { return in_focus_[static_cast<std::size_t>(i)] != 0; }

    void triple(int a, int b, int c) {
        const double step = distances_(a, b);
        if (std::abs(step - distances_(b, c)) <= three_) ring(a, b, c);
        if (std::abs(step - distances_(b, c)) > four_) return;
        const double across = distances_(a, c);
        // A straight row is a translation's.
        if (across > 2 * step * (1 - 1e-4)) return;
        distances_.visit_shell(b, across - four_, across + four_, [&](int d, double) {
            for (const auto& [x, y] : {std::pair(a, c), std::pair(c, a)}) {
                const bool twice = of_focus(y);  // a chain is met from both of its inner points
                if (d != x && d != y && std::abs(distances_(y, d) - step) <= four_ && (x < d || !twice))
                    four(x, b, y, d);
            }
            return true;
        });
    }

    void ring(int a, int b, int c) {
        RigidMap map;
        double radius = 0;
        if (!ring_map(at(a), at(b), at(c), map, radius)) return;
        // One more point of the ring, at either end or one step beyond; a triangle is whole as it is. Its
        // third side says how far the turn is from a third: it shrinks by one and a half times as much.
        double fourth = std::abs(distances_(a, c) - distances_(a, b)) / 1.5;
        const bool triangle = fourth <= three_;
        if (!triangle) {
            const int label = cloud_.label(group_.front());
            double ignored = 0;
            const Vector3d next = map(at(c));
            const Vector3d before = map.linear.transpose() * (at(a) - map.shift);
            const double near = std::max(3 * three_, reach_ / 2);
            double square = near * near;
            bool more = false;
            for (const Vector3d& place : {next, before, map(next)})
                if (cloud_.nearest(place, label, std::sqrt(square), ignored) >= 0) {
                    square = std::min(square, ignored);
                    more = true;
                }
            if (!more) return;
            fourth = std::sqrt(square);
        }
        const double off = std::max(std::abs(distances_(a, b) - distances_(b, c)), floor());
        const auto n = static_cast<double>(group_.size());
        const double beyond = std::max(fourth, floor()) / cloud_.scene().diameter;
        // As many rings as good are there by chance.
        add(SymmetryType::rotation, {a, b, c, -1}, radius,
            4 * n * n * n * off / cloud_.scene().diameter *
                (triangle ? beyond : 20 * n * beyond * beyond * beyond));
    }

    double floor() const { return cloud_.scene().resolution; }

    void four(int a, int b, int c, int d) {
        const double off = std::max({std::abs(distances_(a, b) - distances_(b, c)),
                                     std::abs(distances_(b, c) - distances_(c, d)),
                                     std::abs(distances_(a, c) - distances_(b, d)), floor()});
        const double chance =
            std::pow(static_cast<double>(group_.size()), 4) * 27 * std::pow(off / cloud_.scene().diameter, 3);
        const double radius = std::max(distances_(a, c), distances_(a, d)) / 2;
        const bool plane = cloud_.dimension() == 2;
        add(plane ? SymmetryType::rotation : SymmetryType::screw, {a, b, c, d}, radius, chance);
        add(plane ? SymmetryType::glide_reflection : SymmetryType::rotation_reflection, {a, b, c, d}, radius,
            chance);
    }

    /// The least of a chance first, and short steps before long ones.
    void add(SymmetryType type, std::array<int, 4> chain, double radius, double chance) {
        for (int& i : chain)
            if (i >= 0) i = group_[static_cast<std::size_t>(i)];
        best_.add({chance * (1 + 0.1 * radius / cloud_.radius()), type, chain});
    }

    const Cloud& cloud_;
    const SearchGroup& group_;
    const std::vector<char>& in_focus_;
    const Distances& distances_;
    double reach_;
    double three_ = 0;
    double four_ = 0;
    BestCandidates best_;
};

/// Along the axis of the half-turn that swaps A, A' and B, B'; as long as it is known well.
Vector3d half_turn_axis(const Cloud& cloud, const std::array<int, 4>& points) {
    const Vector3d &a = cloud[points[0]], &mate = cloud[points[1]], &b = cloud[points[2]],
                   &other = cloud[points[3]];
    const Vector3d u = (a - mate) / 2, v = (b - other) / 2;
    // The axis goes through both middles, and across both pairs: the better known of the two.
    const Vector3d along = (b + other - a - mate) / 2, across = u.cross(v) / std::max(u.norm(), v.norm());
    return along.norm() > across.norm() ? along : across;
}

/// Half-turns as pairs of pairs. A is any point, its mate of the focus; B is one of a sample.
class HalfTurnSearch {
public:
    HalfTurnSearch(const GroupDistances& group, double reach, std::size_t most)
        : cloud_(group.cloud),
          group_(group.group),
          in_focus_(group.in_focus),
          distances_(group.distances),
          best_(most) {
        const double n = distances_.size();
        slack_ = affordable(9 * n * n * n * n / 8 / std::pow(cloud_.scene().diameter, 2), 1e4, 2, reach);
        slack_ = std::max(slack_, 2 * cloud_.scene().resolution);
    }

    /// Every kParts-th point from `part` as A'.
    void run(int part, double looks) {
        const int n = static_cast<int>(group_.size());
        const int picks = std::max(4, std::min(n, static_cast<int>(looks / n / n)));
        all_ = picks == n;
        // What is looked up at random is of the mate.
        for (int mate = part; mate < n; mate += kParts) {
            if (!of_focus(mate)) continue;
            for (int a = 0; a < n; ++a) {
                if (a == mate || (a > mate && of_focus(a))) continue;
                for (int k = 0; k < picks; ++k) {
                    const int b = all_ ? k : pick(a, mate, k, picks);
                    if (b != a && b != mate) partner(a, mate, b);
                }
            }
        }
    }

    BestCandidates& best() { return best_; }

private:
    bool of_focus(int i) const { return in_focus_[static_cast<std::size_t>(i)] != 0; }

    /// Half of them near A's mate, as what turns about an axis there is often together, half anywhere.
    int pick(int a, int mate, int k, int picks) const {
        if (k < picks / 2) return distances_.nearest_first(mate)[static_cast<std::size_t>(k)];
        const int n = distances_.size();
        return static_cast<int>((std::int64_t{k} * n + std::int64_t{7} * a + mate) / picks) % n;
    }

    void partner(int a, int mate, int b) {
        const double same = distances_(a, b), cross = distances_(mate, b);
        // Where all points are B in turn a pair is met from both of its ends: the one nearer to A will do.
        const auto nearer = [&](double to_a, double to_mate) { return to_a <= to_mate + slack_; };
        if (all_ && !nearer(same, cross)) return;
        distances_.visit_shell(mate, same - slack_, same + slack_, [&](int other, double to_mate) {
            const double to_a = distances_(a, other);
            if (other == a || other == b || other == mate || std::abs(to_a - cross) > slack_) return true;
            if (!all_ || other > b)
                add(a, mate, b, other);
            else if (!nearer(to_a, to_mate))
                add(a, mate, other, b);
            return true;
        });
    }

    void add(int a, int mate, int b, int other) {
        const auto id = [&](int i) { return group_[static_cast<std::size_t>(i)]; };
        const std::array<int, 4> points{id(a), id(mate), id(b), id(other)};
        if (!(half_turn_axis(cloud_, points).norm() > 4 * slack_)) return;
        const double off =
            std::max({std::abs(distances_(a, b) - distances_(mate, other)),
                      std::abs(distances_(a, other) - distances_(mate, b)), cloud_.scene().resolution});
        best_.add({off, SymmetryType::half_turn, points});
    }

    const Cloud& cloud_;
    const SearchGroup& group_;
    const std::vector<char>& in_focus_;
    const Distances& distances_;
    bool all_ = true;  // points are B in turn
    double slack_ = 0;
    BestCandidates best_;
};

Hypothesis half_turn_of(const Cloud& cloud, const std::array<int, 4>& points) {
    const Vector3d &a = cloud[points[0]], &mate = cloud[points[1]], &b = cloud[points[2]],
                   &other = cloud[points[3]];
    const Vector3d axis = half_turn_axis(cloud, points).normalized();
    Hypothesis h;
    h.type = SymmetryType::half_turn;
    h.map.linear = 2 * axis * axis.transpose() - Matrix3d::Identity();
    h.center = (a + mate + b + other) / 4;
    h.map.shift = h.center - h.map.linear * h.center;
    h.radius = std::max({(a - mate).norm(), (b - other).norm(), (a + mate - b - other).norm() / 2}) / 2;
    h.from = {points[0], points[2], -1, -1};
    h.to = {points[1], points[3], -1, -1};
    return h;
}

}  // namespace

GroupDistances::GroupDistances(const Cloud& of, const SearchGroup& points, const Focus& focus)
    : cloud(of), group(points), in_focus(within(points, focus)), distances(positions(of, points), in_focus) {}

std::vector<Candidate> chains(const GroupDistances& group, double reach, double effort, std::size_t most) {
    if (group.group.size() < 3) return {};
    return best_of_parts(ChainSearch(group, reach, effort, most), most,
                         [](ChainSearch& search, int part) { search.run(part); });
}

std::vector<Candidate> half_turns(const GroupDistances& group, double reach, double looks, std::size_t most) {
    if (group.group.size() < 4 || group.cloud.dimension() == 2) return {};
    return best_of_parts(HalfTurnSearch(group, reach, most), most,
                         [&](HalfTurnSearch& search, int part) { search.run(part, looks); });
}

double disagreement(const Cloud& cloud, const Candidate& candidate) {
    const std::array<int, 4>& ids = candidate.points;
    const auto apart = [&](std::size_t i, std::size_t j) { return (cloud[ids[i]] - cloud[ids[j]]).norm(); };
    if (candidate.type == SymmetryType::half_turn)
        return std::max(std::abs(apart(0, 2) - apart(1, 3)), std::abs(apart(0, 3) - apart(1, 2)));
    double off = std::max(std::abs(apart(0, 1) - apart(1, 2)), cloud.scene().resolution);
    if (ids[3] >= 0)
        off = std::max({off, std::abs(apart(1, 2) - apart(2, 3)), std::abs(apart(0, 2) - apart(1, 3))});
    return off;
}

Hypothesis hypothesis_of(const Cloud& cloud, const Candidate& candidate) {
    const std::array<int, 4>& ids = candidate.points;
    Hypothesis h;
    if (candidate.type == SymmetryType::half_turn) {
        h = half_turn_of(cloud, ids);
        h.off = disagreement(cloud, candidate);
        return h;
    }
    h.type = candidate.type;
    h.off = disagreement(cloud, candidate);
    const auto at = [&](std::size_t k) -> const Vector3d& { return cloud[ids[k]]; };
    const std::size_t length = ids[3] < 0 ? 3 : 4;
    if (length == 3) {
        double radius = 0;
        ring_map(at(0), at(1), at(2), h.map, radius);
    } else {
        h.map = carry({at(0), at(1), at(2)}, {at(1), at(2), at(3)}, is_improper(h.type, cloud.dimension()));
    }
    for (std::size_t k = 0; k < length; ++k) h.center += at(k) / static_cast<double>(length);
    for (std::size_t k = 0; k < length; ++k) h.radius = std::max(h.radius, (at(k) - h.center).norm());
    for (std::size_t k = 0; k + 1 < length; ++k) {
        h.from[k] = ids[k];
        h.to[k] = ids[k + 1];
    }
    return h;
}

namespace {

/// How many points of its label are as far from the centre as each point; 0 near the centre. O(n log n).
std::vector<std::size_t> shell_sizes(const Cloud& cloud, const Vector3d& center, double reach) {
    std::map<int, std::vector<double>> radii;
    const auto radius = [&](int i) { return (cloud[i] - center).norm(); };
    for (int i = 0; i < cloud.size(); ++i) radii[cloud.label(i)].push_back(radius(i));
    for (auto& [label, sorted] : radii) std::sort(sorted.begin(), sorted.end());
    std::vector<std::size_t> sizes(static_cast<std::size_t>(cloud.size()), 0);
    for (int i = 0; i < cloud.size(); ++i) {
        if (radius(i) <= 2 * reach) continue;
        const std::vector<double>& sorted = radii[cloud.label(i)];
        sizes[static_cast<std::size_t>(i)] =
            static_cast<std::size_t>(std::upper_bound(sorted.begin(), sorted.end(), radius(i) + reach) -
                                     std::lower_bound(sorted.begin(), sorted.end(), radius(i) - reach));
    }
    return sizes;
}

/// Of points on one line: its mirror, and the inversion, in the middle.
std::vector<Hypothesis> turned_round(const Cloud& cloud, const Vector3d& center, const Vector3d& along,
                                     double reach) {
    Hypothesis h;
    h.type = SymmetryType::mirror;
    h.map.linear = Matrix3d::Identity() - 2 * along * along.transpose() / along.squaredNorm();
    h.map.shift = center - h.map.linear * center;
    h.off = reach;
    std::vector<Hypothesis> out{h};
    h.type = cloud.dimension() == 2 ? SymmetryType::half_turn : SymmetryType::inversion;
    h.map.linear = -Matrix3d::Identity();
    if (cloud.dimension() == 2) h.map.linear(2, 2) = 1;
    h.map.shift = center - h.map.linear * center;
    out.push_back(h);
    return out;
}

}  // namespace

std::vector<Hypothesis> frames(const Cloud& cloud, const Vector3d& center, double reach, std::size_t most) {
    const int n = cloud.size();
    const auto radius = [&](int i) { return (cloud[i] - center).norm(); };
    const auto shell = [&](int p) {
        std::vector<int> out;
        for (int i = 0; i < n; ++i)
            if (cloud.label(i) == cloud.label(p) && std::abs(radius(i) - radius(p)) <= reach)
                out.push_back(i);
        return out;
    };
    // The point whose shell is smallest, and the second, across from it, likewise.
    int first = -1, second = -1;
    std::size_t least = 0;
    const std::vector<std::size_t> sizes = shell_sizes(cloud, center, reach);
    for (int i = 0; i < n; ++i) {
        const std::size_t size = sizes[static_cast<std::size_t>(i)];
        if (size > 0 && (first < 0 || size < least)) {
            first = i;
            least = size;
        }
    }
    if (first < 0) return {};
    const Vector3d p = cloud[first] - center;
    double best = 0;
    for (int i = 0; i < n; ++i) {
        const std::size_t size = sizes[static_cast<std::size_t>(i)];
        if (size == 0) continue;
        const double sine = (cloud[i] - center).normalized().cross(p.normalized()).norm();
        if (sine / static_cast<double>(size) > best) {
            best = sine / static_cast<double>(size);
            second = i;
        }
    }
    if (second < 0 || best * static_cast<double>(n) < 0.05) return turned_round(cloud, center, p, reach);
    std::vector<Hypothesis> out;
    const double apart = (cloud[first] - cloud[second]).norm();
    const std::vector<int> firsts = shell(first), seconds = shell(second);
    for (const int f : firsts)
        for (const int s : seconds) {
            if (f == s || std::abs((cloud[f] - cloud[s]).norm() - apart) > 2 * reach) continue;
            for (const bool improper : {false, true}) {
                Hypothesis h;
                h.type = improper ? SymmetryType::rotation_reflection : SymmetryType::screw;
                if (cloud.dimension() == 2)
                    h.type = improper ? SymmetryType::glide_reflection : SymmetryType::rotation;
                h.map = carry({center, cloud[first], cloud[second]}, {center, cloud[f], cloud[s]}, improper);
                if (cloud.dimension() == 2 && h.map.linear(2, 2) < 0) continue;
                h.map.shift = center - h.map.linear * center;
                h.center = center;
                h.off = reach;
                out.push_back(h);
                if (out.size() >= most) return out;
            }
        }
    return out;
}

}  // namespace insym
