#include "support/support.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace insym {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// next[i]: the point that i is carried to, or -1; square: how far off, squared.
struct Gatherer::Linked {
    explicit Linked(int n)
        : next(static_cast<std::size_t>(n), -1),
          square(static_cast<std::size_t>(n), 0),
          owner(static_cast<std::size_t>(n), -1) {}

    void clear() {
        for (const int i : from) next[static_cast<std::size_t>(i)] = -1;
        for (const int j : to) owner[static_cast<std::size_t>(j)] = -1;
        from.clear();
        to.clear();
        count = looks = 0;
    }

    std::vector<int> next;
    std::vector<double> square;
    std::vector<int> owner;     // of each point: who is carried to it
    std::vector<int> from, to;  // ascending: those with an image; those that were owned
    int count = 0;
    int looks = 0;  // points looked at
};

/// Where points are looked at: in a ball, or everywhere.
struct Gatherer::Region {
    Vector3d center = Vector3d::Zero();
    double radius = std::numeric_limits<double>::infinity();

    bool everywhere() const { return !(radius < std::numeric_limits<double>::infinity()); }
};

struct Gatherer::Judged {
    double significance = 1e9;
    double tolerance = 0;  // where it is most significant
    int hits = 0;
    double wide = 0;  // the tail of the noise included
};

namespace {

/// So much of the significance may go for more links.
constexpr double kTail = 0.8;
constexpr double kFewLinks = 4;

bool improper_kind(SymmetryType type) {
    return type == SymmetryType::mirror || type == SymmetryType::inversion ||
           type == SymmetryType::glide_reflection || type == SymmetryType::rotation_reflection;
}

/// Points that stand for all of a large set.
constexpr int kSample = 128;

/// Links that are needed before a fit means something.
int least_links(SymmetryType type) {
    switch (type) {
        case SymmetryType::mirror:
        case SymmetryType::inversion:
        case SymmetryType::translation:
            return 1;
        case SymmetryType::half_turn:
            return 2;
        default:
            return 3;
    }
}

}  // namespace

double worth(const Support& support, int dimension) {
    return support.significance * (1 - 0.1 * degrees_of_freedom(support.type, dimension));
}

Motion motion_of(const RigidMap& map, bool improper) {
    Motion m;
    Matrix3d turn = map.linear;
    if (improper) {
        // The axis of a rotation-reflection is the direction that is turned round.
        const Matrix3d k = 2 * Matrix3d::Identity() + map.linear + map.linear.transpose();
        m.axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(k).eigenvectors().col(0);
        turn -= 2 * (turn * m.axis) * m.axis.transpose();
    } else {
        const Matrix3d k = 2 * Matrix3d::Identity() - map.linear - map.linear.transpose();
        m.axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(k).eigenvectors().col(0);
    }
    const Vector3d twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
    m.angle = std::atan2(twice_sine.norm(), turn.trace() - 1);
    if (m.axis.dot(twice_sine) < 0) m.axis = -m.axis;
    const double along = m.axis.dot(map.shift);
    m.step = improper ? (map.shift - along * m.axis).norm() : std::abs(along);
    return m;
}

std::vector<std::pair<SymmetryType, RigidMap>> simpler_kinds(SymmetryType type, const RigidMap& map,
                                                             const Vector3d& center, double radius,
                                                             double slack, int dimension) {
    std::vector<std::pair<SymmetryType, RigidMap>> out;
    const auto about_center = [&](SymmetryType kind, const Matrix3d& linear) {
        RigidMap m;
        m.linear = linear;
        m.shift = map(center) - linear * center;
        out.emplace_back(kind, m);
    };
    const bool improper = improper_kind(type);
    const Motion m = motion_of(map, improper);
    const double turn = m.angle * radius;
    const double half = (std::numbers::pi - m.angle) * radius;
    const Matrix3d mirror = Matrix3d::Identity() - 2 * m.axis * m.axis.transpose();
    if (improper) {
        if (type == SymmetryType::rotation_reflection) {
            if (half <= slack && dimension == 3) about_center(SymmetryType::inversion, -Matrix3d::Identity());
            if (turn <= slack) about_center(SymmetryType::glide_reflection, mirror);
        }
        if ((type == SymmetryType::rotation_reflection && turn <= slack && m.step <= slack) ||
            (type == SymmetryType::glide_reflection && m.step <= slack)) {
            RigidMap plain;
            plain.linear = mirror;
            plain.shift = m.axis * m.axis.dot(map(center) - mirror * center);
            out.emplace_back(SymmetryType::mirror, plain);
        }
        return out;
    }
    if (type == SymmetryType::translation || type == SymmetryType::half_turn) return out;
    if (turn <= slack) about_center(SymmetryType::translation, Matrix3d::Identity());
    if (m.step <= slack) {
        if (half <= slack) {
            Matrix3d turned = 2 * m.axis * m.axis.transpose() - Matrix3d::Identity();
            if (dimension == 2) turned = Vector3d(-1, -1, 1).asDiagonal();
            about_center(SymmetryType::half_turn, turned);
        }
        if (type == SymmetryType::screw && turn > slack) {
            RigidMap flat = map;
            flat.shift -= m.axis * m.axis.dot(map.shift);
            out.emplace_back(SymmetryType::rotation, flat);
        }
    }
    return out;
}

Gatherer::Gatherer(const Cloud& cloud, const Significance& significance, double reach)
    : cloud_(cloud), significance_(significance) {
    double level = cloud.scene().resolution;
    while (level < reach * (1 - 1e-9)) {
        levels_.push_back(level);
        level *= std::numbers::sqrt2;
    }
    levels_.push_back(std::max(reach, cloud.scene().resolution));
}

bool Gatherer::whole(const Support& support) const {
    constexpr double kShareOfGap = 0.08;
    const double reach = std::max(kShareOfGap * cloud_.gap(), cloud_.scene().resolution);
    return support.tolerance <= reach && carried(support, reach) == cloud_.size();
}

int Gatherer::carried(const Support& support, double reach) const {
    std::vector<char> in(static_cast<std::size_t>(cloud_.size()), 0);
    for (const auto& [from, to] : support.links)
        in[static_cast<std::size_t>(from)] = in[static_cast<std::size_t>(to)] = 1;
    int count = 0;
    // Two points on the axis that a rotation-reflection swaps are no link of it, but carried.
    const bool swaps = support.type == SymmetryType::rotation_reflection;
    for (int i = 0; i < cloud_.size(); ++i) {
        const Vector3d image = support.map(cloud_[i]);
        double ignored = 0;
        if (in[static_cast<std::size_t>(i)] != 0 || (image - cloud_[i]).norm() <= reach ||
            (swaps && cloud_.nearest(image, cloud_.label(i), reach, ignored) >= 0))
            ++count;
    }
    return count;
}

double Gatherer::share_carried(const RigidMap& map, double reach) const {
    const int n = cloud_.size(), looks = std::min(n, kSample);
    int count = 0;
    for (int k = 0; k < looks; ++k) {
        const auto i = static_cast<int>(std::int64_t{k} * n / looks);
        double ignored = 0;
        if (cloud_.nearest(map(cloud_[i]), cloud_.label(i), reach, ignored) >= 0) ++count;
    }
    return count / static_cast<double>(looks);
}

void Gatherer::link(SymmetryType type, const RigidMap& map, double reach, const Region& region,
                    Linked& out) const {
    out.clear();
    const auto look = [&](int i) {
        ++out.looks;
        double square = 0;
        const int j = cloud_.nearest(map(cloud_[i]), cloud_.label(i), reach, square);
        if (j < 0 || j == i) return;
        int& owner = out.owner[static_cast<std::size_t>(j)];
        if (owner >= 0) {
            // Both ways the nearest: the one that comes closer stays.
            if (out.square[static_cast<std::size_t>(owner)] <= square) return;
            out.next[static_cast<std::size_t>(owner)] = -1;
            --out.count;
        } else {
            out.to.push_back(j);
        }
        owner = i;
        out.next[static_cast<std::size_t>(i)] = j;
        out.square[static_cast<std::size_t>(i)] = square;
        out.from.push_back(i);
        ++out.count;
    };
    if (region.everywhere()) {
        for (int i = 0; i < cloud_.size(); ++i) look(i);
    } else {
        cloud_.grid().visit_ball(to_point(region.center), region.radius, [&](int i, double) {
            look(i);
            return true;
        });
        std::sort(out.from.begin(), out.from.end());
    }
    // A pair runs both ways, and nothing else does. A ball about the middle of pairs holds both ends.
    const bool pairs = is_pair_type(type);
    for (const int i : out.from) {
        const int j = out.next[static_cast<std::size_t>(i)];
        if (j < 0) continue;
        const bool back = out.next[static_cast<std::size_t>(j)] == i;
        if (pairs ? back : !back) continue;
        out.next[static_cast<std::size_t>(i)] = -1;
        --out.count;
        if (!pairs) {
            out.next[static_cast<std::size_t>(j)] = -1;
            --out.count;
        }
    }
}

Gatherer::Judged Gatherer::judge(SymmetryType type, const Linked& linked, double reach) const {
    std::vector<int> hits(levels_.size(), 0);
    const auto level_of = [&](double square) {
        const double distance = std::sqrt(square);
        return static_cast<std::size_t>(std::lower_bound(levels_.begin(), levels_.end() - 1, distance) -
                                        levels_.begin());
    };
    const auto next = [&](int i) { return linked.next[static_cast<std::size_t>(i)]; };
    const auto square = [&](int i) { return linked.square[static_cast<std::size_t>(i)]; };
    for (const int i : linked.from)
        if (next(i) >= 0) ++hits[level_of(square(i))];
    // The last link of a closed orbit says nothing new.
    std::vector<char> seen(linked.next.size(), 0);
    for (const int start : linked.from) {
        if (seen[static_cast<std::size_t>(start)] != 0 || next(start) < 0) continue;
        double worst = 0;
        int i = start;
        do {
            seen[static_cast<std::size_t>(i)] = 1;
            worst = std::max(worst, square(i));
            i = next(i);
        } while (seen[static_cast<std::size_t>(i)] == 0 && next(i) >= 0);
        if (i == start) --hits[level_of(worst)];
    }
    Judged best;
    std::vector<Judged> all;
    int sum = 0;
    for (std::size_t l = 0; l < levels_.size() && levels_[l] <= reach * (1 + 1e-9); ++l) {
        sum += hits[l];
        if (sum == 0 || (l > 0 && hits[l] == 0)) continue;
        const double s = significance_.log10_false_alarms(type, {sum, 0, 0}, levels_[l]);
        all.push_back({s, levels_[l], sum});
        if (s < best.significance) best = all.back();
    }
    // The best level cuts off the tail of the noise: links that cost little belong to it as well.
    Judged wide = best;
    const double bound = std::max(kTail * best.significance, best.significance + kFewLinks);
    for (const Judged& j : all)
        if (j.tolerance > best.tolerance && j.hits > wide.hits && j.significance <= bound) wide = j;
    best.hits = wide.hits;
    best.wide = wide.tolerance;
    return best;
}

/// The links of no more than `tolerance`; and those of up to twice as much that alone keep an orbit from
/// closing: they count for nothing, but without them the last step of a ring would be lost to noise.
std::vector<std::pair<int, int>> Gatherer::links_within(const Linked& linked, double tolerance) {
    const double limit = tolerance * tolerance * (1 + 1e-9);
    const auto next = [&](int i) { return linked.next[static_cast<std::size_t>(i)]; };
    const auto square = [&](int i) { return linked.square[static_cast<std::size_t>(i)]; };
    const auto in = [&](int i) { return next(i) >= 0 && square(i) <= limit; };
    const auto closes = [&](int i) {
        if (next(i) < 0 || square(i) > 4 * limit) return false;
        int k = next(i);
        while (k != i && in(k)) k = next(k);
        return k == i;
    };
    std::vector<std::pair<int, int>> links;
    links.reserve(linked.from.size());
    for (const int i : linked.from)
        if (in(i) || closes(i)) links.emplace_back(i, next(i));
    return links;
}

RigidMap Gatherer::refit(SymmetryType type, const std::vector<std::pair<int, int>>& pairs,
                         const RigidMap& old) const {
    std::vector<Link> links;
    links.reserve(pairs.size());
    for (const auto& [from, to] : pairs) links.push_back({cloud_[from], cloud_[to]});
    if (static_cast<int>(links.size()) < least_links(type)) return old;
    if (type != SymmetryType::rotation || cloud_.dimension() == 2)
        return fit_of_type(type, links, cloud_.dimension());
    // Near enough while searching; the exact fit of a turn without a step comes at the end.
    RigidMap map = fit_of_type(SymmetryType::screw, links, cloud_.dimension());
    const Motion motion = motion_of(map, false);
    // The links of a translation turn round no axis that there could be no step along; nor do those of a turn
    // far below any of whole order that is looked for.
    constexpr double kTurns = 1e-3;
    if (motion.angle > kTurns) map.shift -= motion.axis * motion.axis.dot(map.shift);
    return map;
}

/// How many of a sample of all points are carried to points, beyond twice what chance gives.
double Gatherer::sampled(const Hypothesis& h, const RigidMap& map, double reach) const {
    const int n = cloud_.size();
    int hits = 0;
    double ignored = 0;
    for (int k = 0; k < kSample; ++k)
        hits += carries(h, map, static_cast<int>(std::int64_t{k} * n / kSample), reach, ignored) ? 1 : 0;
    return hits - 2 * kSample * significance_.background().chance(reach);
}

/// The same is more for the largest reach than for `near`.
bool Gatherer::widens(const Hypothesis& h, const RigidMap& map, double near) const {
    const int n = cloud_.size();
    int more = 0;
    double square = 0;
    for (int k = 0; k < kSample; ++k)
        if (carries(h, map, static_cast<int>(std::int64_t{k} * n / kSample), reach(), square) &&
            square > near * near)
            ++more;
    const Background& background = significance_.background();
    return more > 2 * kSample * (background.chance(reach()) - background.chance(near));
}

/// A point that does not suggest the hypothesis itself. `square`: how far off, squared.
bool Gatherer::carries(const Hypothesis& h, const RigidMap& map, int i, double reach, double& square) const {
    const int j = cloud_.nearest(map(cloud_[i]), cloud_.label(i), reach, square);
    if (j < 0 || j == i) return false;
    const bool own = std::find(h.from.begin(), h.from.end(), i) != h.from.end() ||
                     (is_pair_type(h.type) && std::find(h.to.begin(), h.to.end(), i) != h.to.end());
    return !own;
}

/// A cheap look first: one more link near the points of the hypothesis, or more of a sample of all than
/// chance would link. Most hypotheses are a chance and end here.
bool Gatherer::promising(const Hypothesis& h, double reach) const {
    if (cloud_.size() <= kSample || h.from[0] < 0) return true;
    int looks = 0;
    bool near = false;
    double ignored = 0;
    cloud_.grid().visit_ball(to_point(h.center), 2 * h.radius, [&](int i, double) {
        near = carries(h, h.map, i, reach, ignored);
        return !near && ++looks < kSample;
    });
    return near || sampled(h, h.map, reach) > 0;
}

/// A hypothesis from near points is inaccurate far away: refit it on a wider neighbourhood at a time, twice
/// as wide or, where it is met well, up to eight times.
/// In a large set most end within one: where a neighbourhood has no more links than the one before, nor a
/// sample of all points, but by chance, nothing farther off is looked at.
Gatherer::Region Gatherer::grow(const Hypothesis& h, double reach, RigidMap& map, Linked& linked) const {
    constexpr int kFew = 300;  // to look at so many is cheap
    constexpr double kSure = 4;
    const bool large = cloud_.size() > kFew;
    const bool exact = h.type == SymmetryType::translation || h.type == SymmetryType::inversion;
    if (!(h.radius > 0) || (exact && !large)) return {};
    const double far = cloud_.radius() + h.center.norm();
    Region region{h.center, 2 * h.radius};
    const double chance = 2 * significance_.background().chance(reach);
    int before = -1;
    double wider = 2;
    for (; region.radius < far; region.radius *= wider) {
        link(h.type, map, reach, region, linked);
        const bool ended = before >= 0 && linked.count - before <= chance * linked.looks;
        if (large && ended && sampled(h, map, reach) < kSure) return region;
        before = linked.count;
        if (linked.count < least_links(h.type)) continue;
        const Judged judged = judge(h.type, linked, reach);
        map = refit(h.type, links_within(linked, judged.tolerance), map);
        // What is off by a tenth of the reach here is so by two tenths at twice the distance.
        wider = std::clamp(reach / (2 * judged.tolerance), 2.0, 4.0);
    }
    return {};
}

std::optional<Support> Gatherer::settle(SymmetryType type, RigidMap map, double reach, double worst,
                                        const Region& region, Linked& linked) const {
    constexpr int kRounds = 5;
    std::vector<std::pair<int, int>> last;
    Support best;
    best.type = type;
    best.map = map;
    best.significance = 1e9;
    for (int round = 0; round < kRounds; ++round) {
        link(type, map, reach, region, linked);
        const Judged judged = judge(type, linked, reach);
        std::vector<std::pair<int, int>> links = links_within(linked, judged.wide);
        // One pair says as much however wide it was met.
        if (judged.significance < best.significance ||
            (judged.significance == best.significance && judged.wide < best.tolerance)) {
            best.type = type;
            best.map = map;
            best.tolerance = judged.wide;
            best.significance = judged.significance;
            best.hits = judged.hits;
            best.links = links;
        }
        // What chance alone would do is not worth another look.
        if (judged.significance > worst + 4 || links == last) break;
        const RigidMap better = refit(type, links, map);
        last = std::move(links);
        // No link would change but by chance.
        constexpr double kStill = 0.1;
        if ((better.linear - map.linear).norm() * cloud_.radius() + (better.shift - map.shift).norm() <
            kStill * cloud_.scene().resolution)
            break;
        map = better;
    }
    if (best.significance > worst) return std::nullopt;
    best.map = refit(type, best.links, best.map);
    return best;
}

std::optional<Support> Gatherer::gather(const Hypothesis& hypothesis, double worst) const {
    // What its points agree on so well is not looked for much farther off.
    constexpr double kLever = 12;
    const double near = std::min(reach(), std::max(kLever * hypothesis.off, 8 * cloud_.scene().resolution));
    if (!promising(hypothesis, near)) return std::nullopt;
    const bool central = hypothesis.from[0] < 0;
    const double kept = central ? std::numeric_limits<double>::infinity() : worst;
    RigidMap map = hypothesis.map;
    Linked linked(cloud_.size());
    const Region region = grow(hypothesis, near, map, linked);
    std::optional<Support> best = settle(hypothesis.type, map, near, kept + 3, region, linked);
    if (!best) return std::nullopt;
    const bool few = cloud_.size() <= 2 * kSample;
    double looked = near;
    if (near < reach() && (few || widens(hypothesis, best->map, near))) {
        const auto wider = settle(best->type, best->map, reach(), kept + 3, region, linked);
        if (wider && wider->significance < best->significance) best = wider;
        looked = reach();
    }
    Vector3d center = Vector3d::Zero();
    for (const auto& [from, to] : best->links)
        center += cloud_[from] / static_cast<double>(best->links.size());
    double radius = 0;
    for (const auto& [from, to] : best->links) radius = std::max(radius, (cloud_[from] - center).norm());
    double slack = 4 * best->tolerance;
    if (best->links.empty()) {
        // A pair of points that change places links nothing but as a half-turn, a mirror or an inversion.
        radius = cloud_.radius();
        slack = hypothesis.off;
    }
    for (const auto& [type, plain] :
         simpler_kinds(best->type, best->map, center, radius, slack, cloud_.dimension())) {
        const auto other = settle(type, plain, looked, kept, region, linked);
        if (other && worth(*other, cloud_.dimension()) <= worth(*best, cloud_.dimension())) best = other;
    }
    if (best->links.empty()) return std::nullopt;
    if (best->significance > worst && !(central && whole(*best))) return std::nullopt;
    return best;
}

}  // namespace insym
