#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "hypotheses/generators.hpp"
#include "points/distances.hpp"

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

namespace {

std::vector<Point> positions(const Cloud& cloud, const SearchGroup& group) {
    std::vector<Point> out;
    out.reserve(group.size());
    for (const int i : group) out.push_back(to_point(cloud[i]));
    return out;
}

/// The reach at which so many events are expected, if each takes `exponent` lengths that agree by chance.
double affordable(double expected_per_reach, double budget, double exponent, double reach) {
    return std::min(reach, std::pow(budget / expected_per_reach, 1 / exponent));
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

class ChainSearch {
public:
    ChainSearch(const Cloud& cloud, const SearchGroup& group, double reach)
        : cloud_(cloud), group_(group), distances_(positions(cloud, group)), reach_(reach) {
        const auto n = static_cast<double>(group.size());
        three_ = affordable(1.5 * n * n * n / cloud.scene().diameter, 6e4, 1, reach);
        four_ = affordable(27 * n * n * n * n / std::pow(cloud.scene().diameter, 3), 1e4, 3, reach);
        three_ = std::max(three_, 2 * cloud.scene().resolution);
        four_ = std::max(four_, 2 * cloud.scene().resolution);
    }

    std::vector<Hypothesis> run(std::size_t most) {
        const int n = static_cast<int>(group_.size());
        const double slack = std::max(three_, four_);
        for (int b = 0; b < n; ++b) {
            const auto order = distances_.nearest_first(b);
            for (std::size_t i = 0; i < order.size(); ++i)
                for (std::size_t j = i + 1; j < order.size(); ++j) {
                    const double low = distances_(b, order[i]), high = distances_(b, order[j]);
                    if (high - low > slack) break;
                    triple(order[i], b, order[j]);
                }
        }
        std::stable_sort(found_.begin(), found_.end(),
                         [](const Sized& x, const Sized& y) { return x.rank < y.rank; });
        if (found_.size() > most) found_.resize(most);
        std::vector<Hypothesis> out;
        out.reserve(found_.size());
        for (Sized& s : found_) out.push_back(s.hypothesis);
        return out;
    }

private:
    struct Sized {
        double rank;
        Hypothesis hypothesis;
    };

    const Vector3d& at(int i) const { return cloud_[group_[static_cast<std::size_t>(i)]]; }

    void triple(int a, int b, int c) {
        const double step = distances_(a, b);
        if (std::abs(step - distances_(b, c)) <= three_) ring(a, b, c);
        if (std::abs(step - distances_(b, c)) > four_) return;
        const double across = distances_(a, c);
        // A straight row is a translation's.
        if (across > 2 * step * (1 - 1e-4)) return;
        for (const auto& [x, y] : {std::pair(a, c), std::pair(c, a)})
            distances_.visit_shell(y, step - four_, step + four_, [&, x = x, y = y](int d, double) {
                if (d != b && d != x && std::abs(distances_(b, d) - across) <= four_ && x < d)
                    four(x, b, y, d);
                return true;
            });
    }

    void ring(int a, int b, int c) {
        Vector3d center, axis;
        if (!ring_through(at(a), at(b), at(c), center, axis)) return;
        const Vector3d u = at(a) - center, v = at(b) - center;
        const double angle = std::atan2(u.cross(v).dot(axis), u.dot(v));
        const double radius = u.norm();
        RigidMap map;
        map.linear = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
        map.shift = center - map.linear * center;
        // One more point of the ring, at either end or one step beyond; a triangle is whole as it is.
        constexpr double kThird = 2.0943951023931953;
        const bool triangle = std::abs(std::abs(angle) - kThird) * radius <= three_;
        double fourth = std::abs(std::abs(angle) - kThird) * radius;
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
        Hypothesis h;
        h.type = SymmetryType::rotation;
        h.map = map;
        const double off = std::max(std::abs(distances_(a, b) - distances_(b, c)), floor());
        const auto n = static_cast<double>(group_.size());
        const double beyond = std::max(fourth, floor()) / cloud_.scene().diameter;
        // As many rings as good are there by chance.
        add(h, {a, b, c}, off,
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
        for (const bool improper : {false, true}) {
            Hypothesis h;
            h.type = improper ? SymmetryType::rotation_reflection : SymmetryType::screw;
            if (cloud_.dimension() == 2)
                h.type = improper ? SymmetryType::glide_reflection : SymmetryType::rotation;
            h.map = carry({at(a), at(b), at(c)}, {at(b), at(c), at(d)}, improper);
            if (cloud_.dimension() == 2 && (h.map.linear(2, 2) < 0)) continue;
            add(h, {a, b, c, d}, off, chance);
        }
    }

    /// The least of a chance first, and short steps before long ones.
    void add(Hypothesis& h, std::initializer_list<int> chain, double off, double chance) {
        const auto count = static_cast<double>(chain.size());
        for (const int i : chain) h.center += at(i) / count;
        for (const int i : chain) h.radius = std::max(h.radius, (at(i) - h.center).norm());
        std::size_t k = 0;
        for (auto it = chain.begin(); it + 1 != chain.end(); ++it, ++k) {
            h.from[k] = group_[static_cast<std::size_t>(*it)];
            h.to[k] = group_[static_cast<std::size_t>(*(it + 1))];
        }
        h.off = off;
        found_.push_back({chance * (1 + 0.1 * h.radius / cloud_.radius()), h});
    }

    const Cloud& cloud_;
    const SearchGroup& group_;
    const Distances distances_;
    double reach_;
    double three_ = 0;
    double four_ = 0;
    std::vector<Sized> found_;
};

/// Half-turns as pairs of pairs. A's mates are all points; B is one of a sample, nearest first.
class HalfTurnSearch {
public:
    HalfTurnSearch(const Cloud& cloud, const SearchGroup& group, double reach)
        : cloud_(cloud), group_(group), distances_(positions(cloud, group)) {
        const auto n = static_cast<double>(group.size());
        slack_ = affordable(9 * n * n * n * n / 8 / std::pow(cloud.scene().diameter, 2), 1e4, 2, reach);
        slack_ = std::max(slack_, 2 * cloud.scene().resolution);
    }

    std::vector<Hypothesis> run(std::size_t most) {
        const int n = static_cast<int>(group_.size());
        const int picks = std::max(4, std::min(n, static_cast<int>(4e6 / n / n)));
        for (int a = 0; a < n && found_.size() < 50 * most; ++a)
            for (int mate = a + 1; mate < n; ++mate)
                for (int k = 0; k < picks; ++k) {
                    const int b =
                        picks == n ? k
                                   : static_cast<int>((static_cast<long>(k) * n + a * 7 + mate) / picks) % n;
                    if (b != a && b != mate) partner(a, mate, b);
                }
        std::stable_sort(found_.begin(), found_.end(),
                         [](const Hypothesis& x, const Hypothesis& y) { return x.off < y.off; });
        if (found_.size() > most) found_.resize(most);
        return std::move(found_);
    }

private:
    const Vector3d& at(int i) const { return cloud_[group_[static_cast<std::size_t>(i)]]; }

    void partner(int a, int mate, int b) {
        const double same = distances_(a, b), cross = distances_(mate, b);
        distances_.visit_shell(mate, same - slack_, same + slack_, [&](int other, double) {
            if (other != a && other != b && other != mate && (other > b || distances_.size() > 200) &&
                std::abs(distances_(a, other) - cross) <= slack_)
                add(a, mate, b, other);
            return true;
        });
    }

    void add(int a, int mate, int b, int other) {
        const Vector3d p = (at(a) + at(mate)) / 2, q = (at(b) + at(other)) / 2;
        const Vector3d u = (at(a) - at(mate)) / 2, v = (at(b) - at(other)) / 2;
        // The axis goes through both middles, and across both pairs: the better known of the two.
        const Vector3d along = q - p, across = u.cross(v) / std::max(u.norm(), v.norm());
        Vector3d axis = along.norm() > across.norm() ? along : across;
        if (!(axis.norm() > 4 * slack_)) return;
        axis.normalize();
        Hypothesis h;
        h.type = SymmetryType::half_turn;
        h.map.linear = 2 * axis * axis.transpose() - Matrix3d::Identity();
        h.center = (p + q) / 2;
        h.map.shift = h.center - h.map.linear * h.center;
        h.radius = std::max({u.norm(), v.norm(), along.norm() / 2});
        const auto id = [&](int i) { return group_[static_cast<std::size_t>(i)]; };
        h.off = std::max(std::abs(distances_(a, b) - distances_(mate, other)),
                         std::abs(distances_(a, other) - distances_(mate, b)));
        h.from = {id(a), id(b), -1, -1};
        h.to = {id(mate), id(other), -1, -1};
        found_.push_back(h);
    }

    const Cloud& cloud_;
    const SearchGroup& group_;
    const Distances distances_;
    double slack_ = 0;
    std::vector<Hypothesis> found_;
};

}  // namespace

std::vector<Hypothesis> chains(const Cloud& cloud, const SearchGroup& group, double reach, std::size_t most) {
    if (group.size() < 3) return {};
    return ChainSearch(cloud, group, reach).run(most);
}

std::vector<Hypothesis> half_turns(const Cloud& cloud, const SearchGroup& group, double reach,
                                   std::size_t most) {
    if (group.size() < 4 || cloud.dimension() == 2) return {};
    return HalfTurnSearch(cloud, group, reach).run(most);
}

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
    std::vector<std::vector<int>> shells;
    for (int i = 0; i < n; ++i) shells.push_back(radius(i) > 2 * reach ? shell(i) : std::vector<int>());
    for (int i = 0; i < n; ++i) {
        const std::size_t size = shells[static_cast<std::size_t>(i)].size();
        if (size > 0 && (first < 0 || size < least)) {
            first = i;
            least = size;
        }
    }
    if (first < 0) return {};
    const Vector3d p = cloud[first] - center;
    double best = 0;
    for (int i = 0; i < n; ++i) {
        const std::size_t size = shells[static_cast<std::size_t>(i)].size();
        if (size == 0) continue;
        const double sine = (cloud[i] - center).normalized().cross(p.normalized()).norm();
        if (sine / static_cast<double>(size) > best) {
            best = sine / static_cast<double>(size);
            second = i;
        }
    }
    if (second < 0 || best * static_cast<double>(n) < 0.05) return {};
    std::vector<Hypothesis> out;
    const double apart = (cloud[first] - cloud[second]).norm();
    for (const int f : shells[static_cast<std::size_t>(first)])
        for (const int s : shells[static_cast<std::size_t>(second)]) {
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
