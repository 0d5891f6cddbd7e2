// The expansion of cycles (definitions, section 4) and the tables that it and what follows look things up in.
//
// Oracles: chains of five in tables about their seed against one chain of four after the other, with nothing
// stored (only the time may differ); brute force over all points for distances in order, shells and fields of
// distances; straight chains, which have no turn, in any pose.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "cycles/detect_cycles.hpp"
#include "cycles/types.hpp"
#include "points/diameter.hpp"
#include "points/near_field.hpp"
#include "points/shells.hpp"
#include "property/support/pose.hpp"

namespace insym::property {
namespace {

using Random = std::mt19937_64;

/// Scattered points, some on a grid, so that ends tie, and some on rings; of one label or of two.
PointSet some_points(int dimension, Random& random) {
    PointSet set;
    set.dimension = dimension;
    const int count = 10 + static_cast<int>(uniform(random, 0, 25));
    const int kind = static_cast<int>(uniform(random, 0, 3));
    const double turn = uniform(random, 0, 1);
    for (int i = 0; i < count; ++i) {
        Point p{};
        if (kind == 1) {
            p = {std::floor(uniform(random, 0, 5)), std::floor(uniform(random, 0, 4)),
                 std::floor(uniform(random, 0, 3))};
        } else if (kind == 2) {
            const double angle = turn + 2 * std::numbers::pi * (i % 7) / 7;
            p = {std::cos(angle), std::sin(angle), 0.3 * (i / 7)};
        } else {
            p = {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
        }
        if (dimension == 2) p[2] = 0;
        if (std::find(set.positions.begin(), set.positions.end(), p) == set.positions.end())
            set.positions.push_back(p);
    }
    if (uniform(random, 0, 1) < 0.3)
        for (std::size_t i = 0; i < set.positions.size(); ++i)
            set.labels.push_back(static_cast<int>(uniform(random, 0, 2)));
    return set;
}

std::vector<std::tuple<std::vector<int>, bool, TypeSet, double, double>> listed(
    const CycleSearchResult& result) {
    std::vector<std::tuple<std::vector<int>, bool, TypeSet, double, double>> all;
    for (const Cycle& c : result.cycles)
        all.emplace_back(c.points, c.closed, c.types, c.tolerance.min, c.tolerance.max);
    return all;
}

RC_GTEST_PROP(Expansion, tables_find_what_one_chain_of_four_after_the_other_finds, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const PointSet points = some_points(*rc::gen::element(2, 3, 3), random);
    RC_PRE(points.size() >= 4);
    const double length = diameter(points.positions);
    const double share = std::pow(10.0, uniform(random, -3, std::log10(0.05)));
    const Distances distances(points.positions);
    const Scene scene{{points, length, 1e-6 * length, share * length}, distances};
    const RunContext context;
    RunMonitor monitor(context);
    const auto cycles = [&](std::size_t most_stored) {
        CycleSearch how;
        how.most_stored = most_stored;
        return detect_cycles(scene, how, monitor);
    };
    const CycleSearchResult in_tables = cycles(CycleSearch{}.most_stored), one_by_one = cycles(0);
    RC_CLASSIFY(in_tables.cycles.empty(), "no cycle");
    RC_ASSERT(in_tables.seeds == one_by_one.seeds);
    RC_ASSERT(listed(in_tables) == listed(one_by_one));
}

RC_GTEST_PROP(Distances, in_order_are_those_of_the_matrix, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    PointSet points = some_points(3, random);
    // As many equally far from one point as make a crowded step of the directory.
    const int ring = *rc::gen::inRange(0, 60);
    for (int i = 0; i < ring; ++i) {
        const double angle = 2 * std::numbers::pi * i / ring;
        points.positions.push_back({7 + std::cos(angle), std::sin(angle), 5});
    }
    points.positions.push_back({7, 0, 5});
    const Distances distances(points.positions);
    const int n = distances.size();
    for (int i = 0; i < n; ++i) {
        std::vector<std::pair<double, int>> want;
        for (int p = 0; p < n; ++p)
            if (p != i) want.emplace_back(distances(i, p), p);
        std::sort(want.begin(), want.end());
        const auto order = distances.nearest_first(i);
        for (std::size_t k = 0; k < order.size(); ++k) RC_ASSERT(order[k] == want[k].second);
        const double low = i % 2 == 0 ? uniform(random, -1, 3) : want.front().first;
        const double high = i % 3 == 0 ? low + uniform(random, 0, 2) : want[want.size() / 2].first;
        std::vector<std::pair<double, int>> shell;
        distances.visit_shell(i, low, high, [&](int p, double d) {
            shell.emplace_back(d, p);
            return true;
        });
        std::erase_if(want, [&](const auto& w) { return w.first < low || w.first > high; });
        RC_ASSERT(shell == want);
    }
}

RC_GTEST_PROP(Shells, keep_the_points_at_that_distance, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const PointSet points = some_points(3, random);
    const Distances distances(points.positions);
    const Shells shells(distances);
    RC_ASSERT(shells.stored());
    const int n = distances.size();
    for (int i = 0; i < n; ++i) {
        // Also such that points lie on its borders.
        const double low = i % 2 == 0 ? uniform(random, -0.1, 1) : distances(i, (i + 1) % n);
        const double high = i % 3 == 0 ? low + uniform(random, 0, 0.5) : distances(i, (i + 2) % n);
        Shells::Set set{};
        for (int p = 0; p < n; ++p)
            if ((p + i) % 5 != 0) set[static_cast<std::size_t>(p) / 64] |= std::uint64_t{1} << (p % 64);
        std::vector<int> want, have;
        for (int p = 0; p < n; ++p)
            if ((p + i) % 5 != 0 && p != i && low <= distances(i, p) && distances(i, p) <= high)
                want.push_back(p);
        RC_ASSERT(shells.keep(i, low, high, set) == !want.empty());
        Shells::visit(set, [&](int p) { have.push_back(p); });
        RC_ASSERT(have == want);
    }
}

RC_GTEST_PROP(NearField, says_nothing_wrong_about_any_image, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    PointSet points = some_points(3, random);
    const Pose pose = *any_pose(3);
    for (Point& p : points.positions) p = pose.apply(p);
    const double length = diameter(points.positions);
    const NearField field(points.positions);
    Isometry isometry;
    const Pose motion = *any_pose(3);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) isometry.linear[i][j] = motion.turn[i][j];
    const Point there = isometry.apply(points.positions.front());
    for (std::size_t i = 0; i < 3; ++i)
        isometry.translation[i] = points.positions.back()[i] - there[i] + uniform(random, -0.1, 0.1) * length;
    const double reach = uniform(random, 0, 0.2) * length;
    std::vector<NearField::Near> near;
    field.images_near(isometry, reach, near);
    std::vector<int> said(points.positions.size(), 0);  // surely not
    for (const auto& [i, surely] : near) said[static_cast<std::size_t>(i)] = surely ? 2 : 1;
    for (std::size_t i = 0; i < said.size(); ++i) {
        const Point image = isometry.apply(points.positions[i]);
        double nearest = INFINITY;
        for (const Point& p : points.positions)
            nearest = std::min(nearest, std::hypot(image[0] - p[0], image[1] - p[1], image[2] - p[2]));
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] =
                std::minmax_element(points.positions.begin(), points.positions.end(),
                                    [&](const Point& a, const Point& b) { return a[k] < b[k]; });
            inside = inside && (*low)[k] < image[k] && image[k] < (*high)[k];
        }
        // Nor too little: a cell is small.
        if (inside && std::abs(nearest - reach) > 0.1 * length) RC_ASSERT(said[i] != 1);
        if (said[i] == 0) RC_ASSERT(nearest > reach);
        if (said[i] == 2) RC_ASSERT(nearest <= reach);
    }
}

RC_GTEST_PROP(Types, three_points_on_a_line_make_no_turn, ()) {
    // One step back and another forth beside a line: without a turn in its first three it is no zigzag.
    const Pose pose = *any_pose(3);
    PointSet points;
    for (const Point& p :
         std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0.01, 0, 0}, {1, 0.02, 0}, {0.01, 0.02, 0}})
        points.positions.push_back(pose.apply(p));
    const double length = diameter(points.positions);
    const Distances distances(points.positions);
    const Scene scene{{points, length, 1e-6 * length, 0.05 * length}, distances};
    TypeOracle types(scene);
    const std::vector<int> chain{0, 1, 2, 3, 4};
    RC_ASSERT(types.types(chain, false, 0.03 * length).empty());
}

}  // namespace
}  // namespace insym::property
