#include "ranking/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "isometry/describe.hpp"
#include "isometry/fit.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

template <class Visit>
void for_each_link(const Symmetry& symmetry, Visit visit) {
    for (const Orbit& orbit : symmetry.cycles) {
        const std::size_t c = orbit.points.size();
        for (std::size_t k = 0; k + (orbit.closed ? 0 : 1) < c; ++k)
            visit(orbit.points[k], orbit.points[k + 1 < c ? k + 1 : 0]);
    }
}

}  // namespace

Measure::Measure(const PointScene& scene, const Significance& significance)
    : scene_(scene),
      grid_(scene.points.positions),
      near_(scene.points.positions),
      significance_(significance) {
    Point low = scene.points.positions.front(), high = low;
    double farthest = 0;
    for (const Point& p : scene.points.positions)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
            farthest = std::max(farthest, std::abs(p[k]));
        }
    for (const double x : {low[0], high[0]})
        for (const double y : {low[1], high[1]})
            for (const double z : {low[2], high[2]}) corners_.push_back({x, y, z});
    rounding_ = 1e-14 * farthest;
}

void Measure::complete(Symmetry& symmetry) const {
    fit(symmetry);
    cover(symmetry);
    symmetry.order = order_of(symmetry);
}

void Measure::complete_all(std::span<Symmetry* const> symmetries) const {
    // With so many to a point the field takes less than it spares.
    constexpr std::size_t kForEachPoint = 16;
    std::optional<NearField> field;
    if (symmetries.size() > kForEachPoint * scene_.points.size()) field.emplace(scene_.points.positions);
    std::vector<std::pair<std::uint64_t, Symmetry*>> keys(symmetries.size());
    parallel_for(symmetries.size(), [&](std::size_t k) {
        fit(*symmetries[k]);
        keys[k] = {fingerprint(symmetries[k]->isometry), symmetries[k]};
    });
    std::sort(keys.begin(), keys.end());
    std::vector<Symmetry*> sorted;
    std::vector<std::size_t> start;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (k == 0 || keys[k].first != keys[k - 1].first) start.push_back(k);
        sorted.push_back(keys[k].second);
    }
    start.push_back(keys.size());
    parallel_for(start.size() - 1, [&](std::size_t k) {
        const std::span<Symmetry* const> alike(sorted.data() + start[k], start[k + 1] - start[k]);
        cover_alike(alike, field ? &*field : nullptr);
        for (Symmetry* s : alike) s->order = order_of(*s);
    });
}

double Measure::significance_of(const Symmetry& symmetry) const {
    Evidence evidence;
    for (const Orbit& orbit : symmetry.cycles) evidence.hits += static_cast<int>(orbit.points.size()) - 1;
    return significance_.log10_false_alarms(symmetry.type, evidence, symmetry.deviation.max);
}

void Measure::fit(Symmetry& symmetry) const {
    std::size_t count = 0;
    for (const Orbit& orbit : symmetry.cycles) count += orbit.points.size();
    std::vector<Link> links;
    links.reserve(count);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for_each_link(symmetry, [&](int from, int to) {
        links.push_back({to_vector(scene_.position(from)), to_vector(scene_.position(to))});
        middle += (links.back().from + links.back().to) / 2;
    });
    middle /= static_cast<double>(links.size());
    // Fitted near the origin: a part far from it loses no digits.
    for (Link& l : links) {
        l.from -= middle;
        l.to -= middle;
    }
    RigidMap map = fit_of_type(symmetry.type, links, scene_.dimension());
    map.shift += middle - map.linear * middle;
    symmetry.isometry = describe(symmetry.type, map, middle, scene_.dimension());

    double sum = 0, worst = 0;
    for_each_link(symmetry, [&](int from, int to) {
        const Point image = symmetry.isometry.apply(scene_.position(from));
        const double square = (to_vector(image) - to_vector(scene_.position(to))).squaredNorm();
        sum += square;
        worst = std::max(worst, square);
    });
    symmetry.deviation = {std::sqrt(sum / static_cast<double>(links.size())), std::sqrt(worst)};
}

/// A hair more, so that the point that is farthest off does not miss itself by rounding.
double Measure::reach_of(const Symmetry& symmetry) const {
    const double exact = std::max({symmetry.tolerance.min, symmetry.deviation.max, scene_.resolution});
    return exact + std::max(5e-7 * exact, 1e-5 * scene_.resolution);
}

/// The same for isometries that differ by a rounding; others at worst share a cover that is not theirs to
/// share.
std::uint64_t Measure::fingerprint(const Isometry& isometry) const {
    constexpr double kSteps = 1e4;
    std::uint64_t hash = 0;
    const auto add = [&](double x) {
        hash = (hash ^ static_cast<std::uint64_t>(std::llround(kSteps * x))) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29U;
    };
    for (const auto& row : isometry.linear)
        for (const double x : row) add(x);
    const Point image = isometry.apply(corners_.front());
    for (std::size_t k = 0; k < 3; ++k) add((image[k] - corners_.front()[k]) / scene_.diameter);
    return hash;
}

Measure::Cover Measure::cover_of(const Isometry& isometry, double reach) const {
    const double farthest = std::min(4 * reach, near_.largest_reach());
    Cover out{isometry, 0, {}, 0, farthest};
    // Within the reach or not: so far may it be less or more.
    const auto within = [&](double distance) {
        if (distance <= reach)
            out.least_reach = std::max(out.least_reach, distance);
        else
            out.most_reach = std::min(out.most_reach, distance);
        return distance <= reach;
    };
    std::vector<int> near;
    near_.images_near(isometry, near);
    for (const int i : near) {
        const Point image = isometry.apply(scene_.position(i));
        double nearest = farthest * farthest;
        grid_.visit_ball(image, farthest, [&](int, double square) {
            nearest = std::min(nearest, square);
            return true;
        });
        if (within(std::sqrt(nearest))) ++out.covered;
        if (within((to_vector(image) - to_vector(scene_.position(i))).norm())) out.fixed_points.push_back(i);
    }
    return out;
}

/// Where the isometries differ by so little, all over the box, that no distance crosses the reach.
bool Measure::same_cover(const Cover& cover, const Symmetry& symmetry) const {
    double apart = 0;
    for (const Point& corner : corners_)
        apart = std::max(
            apart,
            (to_vector(cover.isometry.apply(corner)) - to_vector(symmetry.isometry.apply(corner))).norm());
    const double reach = reach_of(symmetry), slack = apart + rounding_;
    return cover.least_reach + slack <= reach && reach <= cover.most_reach - slack;
}

void Measure::cover_alike(std::span<Symmetry* const> symmetries, const NearField* field) const {
    std::optional<Cover> shared;
    for (Symmetry* s : symmetries) {
        if (symmetries.size() > 1 && !(shared && same_cover(*shared, *s)) &&
            reach_of(*s) < near_.largest_reach())
            shared = cover_of(s->isometry, reach_of(*s));
        if (!shared || !same_cover(*shared, *s)) {
            cover(*s, field);
            continue;
        }
        s->fixed_points = shared->fixed_points;
        s->coverage = static_cast<double>(shared->covered) / scene_.size();
    }
}

/// Of which points may the image have a point within the reach? Of most it lies where none is.
void Measure::find_near(const Isometry& isometry, double reach, const NearField* field,
                        std::vector<NearField::Near>& out) const {
    if (field != nullptr) {
        field->images_near(isometry, reach, out);
        return;
    }
    thread_local std::vector<int> near;
    if (reach <= near_.largest_reach()) {
        near_.images_near(isometry, near);
    } else {
        near.resize(scene_.points.size());
        std::iota(near.begin(), near.end(), 0);
    }
    out.clear();
    for (const int i : near) out.push_back({i, false});
}

void Measure::cover(Symmetry& symmetry, const NearField* field) const {
    const double reach = reach_of(symmetry);
    thread_local std::vector<char> linked;
    thread_local std::vector<NearField::Near> near;
    linked.assign(scene_.points.size(), 0);
    // Where a link ends there is one.
    for_each_link(symmetry, [&](int from, int) { linked[static_cast<std::size_t>(from)] = 1; });
    find_near(symmetry.isometry, reach, field, near);
    int covered = 0;
    symmetry.fixed_points.clear();
    for (const auto& [i, surely] : near) {
        const Point& p = scene_.position(i);
        const Point image = symmetry.isometry.apply(p);
        if ((to_vector(image) - to_vector(p)).squaredNorm() <= reach * reach) {
            symmetry.fixed_points.push_back(i);
            ++covered;
        } else if (surely || linked[static_cast<std::size_t>(i)] != 0 || grid_.any_within(image, reach)) {
            ++covered;
        }
    }
    symmetry.coverage = static_cast<double>(covered) / scene_.size();
}

/// 360 degrees over the angle, where taking it as whole moves no point of the longest run by more than
/// the tolerance that the symmetry needs anyway.
std::optional<int> Measure::order_of(const Symmetry& symmetry) const {
    if (symmetry.type == SymmetryType::half_turn) return 2;
    if (symmetry.type != SymmetryType::rotation && symmetry.type != SymmetryType::rotation_reflection)
        return std::nullopt;
    const double angle = symmetry.isometry.angle_deg;
    if (!(angle > 0)) return std::nullopt;
    const double order = std::round(360 / angle);
    if (order < 2 || order > 1e6) return std::nullopt;

    const Point axis_point =
        symmetry.isometry.axis ? symmetry.isometry.axis->point : *symmetry.isometry.center;
    const Eigen::Vector3d direction =
        symmetry.isometry.axis ? to_vector(symmetry.isometry.axis->direction) : Eigen::Vector3d::UnitZ();
    double radius = 0;
    std::size_t longest = 0;
    for (const Orbit& orbit : symmetry.cycles) {
        longest = std::max(longest, orbit.points.size());
        for (const int p : orbit.points) {
            const Eigen::Vector3d spoke = to_vector(scene_.position(p)) - to_vector(axis_point);
            radius = std::max(radius, (spoke - direction * direction.dot(spoke)).norm());
        }
    }
    constexpr double kRadians = 3.14159265358979323846 / 180;
    const double slip = std::abs(angle - 360 / order) * kRadians * radius * static_cast<double>(longest);
    const double reach = std::max({symmetry.tolerance.min, symmetry.deviation.max, scene_.resolution});
    if (slip > reach) return std::nullopt;
    return static_cast<int>(order);
}

}  // namespace insym
