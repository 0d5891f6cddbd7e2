#include "ranking/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "isometry/describe.hpp"
#include "isometry/fit.hpp"

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
      significance_(significance) {}

void Measure::complete(Symmetry& symmetry) const {
    fit(symmetry);
    cover(symmetry);
    symmetry.order = order_of(symmetry);
}

double Measure::significance_of(const Symmetry& symmetry) const {
    Evidence evidence;
    for (const Orbit& orbit : symmetry.cycles) evidence.hits += static_cast<int>(orbit.points.size()) - 1;
    return significance_.log10_false_alarms(symmetry.type, evidence, symmetry.deviation.max);
}

void Measure::fit(Symmetry& symmetry) const {
    std::vector<Link> links;
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

void Measure::cover(Symmetry& symmetry) const {
    // A hair more, so that the point that is farthest off does not miss itself by rounding.
    const double exact_reach = std::max({symmetry.tolerance.min, symmetry.deviation.max, scene_.resolution});
    const double reach = exact_reach + std::max(5e-7 * exact_reach, 1e-5 * scene_.resolution);
    std::vector<char> linked(scene_.points.size(), 0);
    for_each_link(symmetry, [&](int from, int) { linked[static_cast<std::size_t>(from)] = 1; });
    // Most images lie where no point is; where a link ends there is one.
    std::vector<int> near;
    if (reach <= near_.largest_reach()) {
        near_.images_near(symmetry.isometry, near);
    } else {
        near.resize(scene_.points.size());
        std::iota(near.begin(), near.end(), 0);
    }
    int covered = 0;
    symmetry.fixed_points.clear();
    for (const int i : near) {
        const Point& p = scene_.position(i);
        const Point image = symmetry.isometry.apply(p);
        if ((to_vector(image) - to_vector(p)).squaredNorm() <= reach * reach) {
            symmetry.fixed_points.push_back(i);
            ++covered;
        } else if (linked[static_cast<std::size_t>(i)] != 0 || grid_.any_within(image, reach)) {
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
