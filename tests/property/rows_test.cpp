// Cycles of sets with rows, where `auto` leaves out what follows from others and a translation.
//
// Oracles: the search from all seeds (a tolerance above ten resolutions asks for it), of whose symmetries
// each must be T^i f T^j, with a listed f and whole i and j; and what was planted.
#include "insym/detect.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "cycles/regions.hpp"
#include "points/diameter.hpp"
#include "property/support/pose.hpp"
#include "property/support/results.hpp"

namespace insym::property {
namespace {

DetectOptions paper(std::optional<double> max_tolerance) {
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = max_tolerance;
    return options;
}

DetectOptions cycles_only(std::optional<double> max_tolerance) {
    DetectOptions options = paper(max_tolerance);
    options.types = {};
    for (const SymmetryType type : kAllSymmetryTypes)
        if (!is_pair_type(type)) options.types.insert(type);
    return options;
}

bool tells_of_rows(const DetectResult& result) {
    return std::any_of(result.diagnostics.begin(), result.diagnostics.end(),
                       [](const Diagnostic& d) { return d.code == "rows"; });
}

/// Copies of a part at 0, 1, 2 ... along x, in turns on one side or mirrored on both: a square that x does
/// not meet at a right angle, and odd points.
PointSet row_of_parts(int copies, int odd_points, bool both_sides, std::mt19937_64& random) {
    std::vector<Point> part;
    const double height = uniform(random, 0.4, 0.9), turn = uniform(random, 0.1, 1);
    for (int k = 0; k < 4; ++k) {
        const double angle = turn + k * std::numbers::pi / 2;
        part.push_back({0.2 * std::cos(angle), 1 + 0.2 * std::sin(angle), height});
    }
    for (; odd_points > 0; --odd_points)
        part.push_back({uniform(random, -0.3, 0.3), uniform(random, 0.3, 1.7), uniform(random, 0.2, 1.3)});
    PointSet points;
    for (int k = 0; k < copies; ++k)
        for (const Point& p : part) {
            points.positions.push_back({p[0] + k, p[1], p[2]});
            if (both_sides) points.positions.push_back({p[0] + k, -p[1], p[2]});
        }
    return points;
}

Isometry inverse(const Isometry& f) {
    Isometry g;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) g.linear[r][c] = f.linear[c][r];
    const Point moved = g.apply(f.translation);
    for (std::size_t r = 0; r < 3; ++r) g.translation[r] = -moved[r];
    return g;
}

/// f = T^i g T^j for whole i and j, T the step along x?
bool is_product(const Isometry& f, const Isometry& g, int copies) {
    constexpr double kTurn = 1e-5,
                     kShift = 1e-4;  // several resolutions: parts of a turned square can be near a row
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(f.linear[r][c] - g.linear[r][c]) > kTurn) return false;
    for (int j = -copies; j <= copies; ++j) {
        Point rest{};
        for (std::size_t r = 0; r < 3; ++r)
            rest[r] = f.translation[r] - g.translation[r] - j * g.linear[r][0];
        const double off = std::hypot(rest[0] - std::round(rest[0]), rest[1], rest[2]);
        if (off <= kShift && std::abs(rest[0]) <= copies + 0.5) return true;
    }
    return false;
}

std::string points_of(const DetectResult& result, const Symmetry& s) {
    std::ostringstream out;
    for (const int i : s.cycles.at(0).points) {
        const Point& p = result.points.positions[static_cast<std::size_t>(i)];
        out << " (" << p[0] << ' ' << p[1] << ' ' << p[2] << ')';
    }
    return out.str();
}

/// The first exact symmetry of `complete` that no symmetry of `cut` gives together with T.
std::string missing(const DetectResult& complete, const DetectResult& cut, int copies) {
    std::vector<Isometry> known{Isometry{}};
    for (const Symmetry& s : cut.symmetries) {
        known.push_back(s.isometry);
        known.push_back(inverse(s.isometry));
    }
    for (const Symmetry& s : complete.symmetries)
        if (s.tolerance.min <= complete.resolution &&
            std::none_of(known.begin(), known.end(),
                         [&](const Isometry& g) { return is_product(s.isometry, g, copies); }))
            return std::string(option_letter(s.type)) + " of " + std::to_string(s.cycles.size()) +
                   " cycles, rank " + std::to_string(s.id) + points_of(complete, s);
    return {};
}

/// The longest list of cycles of a turn by a quarter.
std::size_t most_cycles_of_quarter_turns(const DetectResult& result) {
    std::size_t most = 0;
    for (const Symmetry& s : result.symmetries)
        if (s.type == SymmetryType::rotation && s.order == 4) most = std::max(most, s.cycles.size());
    return most;
}

}  // namespace

RC_GTEST_PROP(Rows, all_that_is_left_out_follows_from_what_is_listed, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    const int copies = *rc::gen::inRange(13, 19);
    const PointSet points = row_of_parts(copies, 5, *rc::gen::arbitrary<bool>(), random);
    const DetectResult cut = detect(points, paper(*rc::gen::element<std::optional<double>>({}, 1e-5)));
    RC_ASSERT(tells_of_rows(cut));
    const DetectResult complete = detect(points, cycles_only(2e-5));
    RC_ASSERT(!tells_of_rows(complete));
    RC_ASSERT(missing(complete, cut, copies) == "");
}

RC_GTEST_PROP(Rows, cycles_are_some_of_those_from_all_seeds, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    const PointSet points = row_of_parts(*rc::gen::inRange(13, 19), 5, *rc::gen::arbitrary<bool>(), random);
    const Distances distances(points.positions);
    const double length = diameter(points.positions);
    const Scene scene{{points, length, 1e-6 * length, 1e-5 * length}, distances};
    const RunContext context;
    RunMonitor monitor(context);
    const Regions regions{*rc::gen::element(1, 2), 1};  // slabs along y: each side has rows of its own
    const auto search = [&](SeedChoice seeds) {
        CycleSearch how;
        how.seeds = seeds;
        return detect_cycles_in_regions(scene, regions, how, monitor).search;
    };
    const CycleSearchResult some = search(SeedChoice::needed), all = search(SeedChoice::all);
    RC_ASSERT(some.superfluous_seeds > 0U && all.superfluous_seeds == 0U);
    RC_ASSERT(some.cycles.size() < all.cycles.size());
    RC_ASSERT(some.seeds + some.superfluous_seeds >= all.seeds);
    const auto before = [](const Cycle& a, const Cycle& b) {
        return std::tie(a.points, a.closed) < std::tie(b.points, b.closed);
    };
    RC_ASSERT(
        std::includes(all.cycles.begin(), all.cycles.end(), some.cycles.begin(), some.cycles.end(), before));
}

RC_GTEST_PROP(Rows, pose_and_order_change_nothing, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    const PointSet points = row_of_parts(*rc::gen::inRange(11, 15), 6, *rc::gen::arbitrary<bool>(), random);
    const auto order = shuffled_order(static_cast<int>(points.size()), *rc::gen::arbitrary<std::uint64_t>());
    const PointSet moved = placed(points, *any_pose(3), order);
    // No chance beyond what is exact: of copies of what is rough, rounding says which replaces which (C2).
    const DetectResult a = detect(points, cycles_only(1e-6)), b = detect(moved, cycles_only(1e-6));
    RC_ASSERT(tells_of_rows(a));
    std::vector<int> same(points.size());
    std::iota(same.begin(), same.end(), 0);
    RC_ASSERT(difference(summary_of(a, same), summary_of(b, order)) == "");
}

RC_GTEST_PROP(Rows, one_thread_and_two_give_the_same_bits, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    const PointSet points = row_of_parts(12, 6, *rc::gen::arbitrary<bool>(), random);
    RunContext one, two;
    one.threads = 1;
    two.threads = 2;
    RC_ASSERT(difference_in_bits(detect(points, paper({}), one), detect(points, paper({}), two)) == "");
}

// Theorem: a square grid of 11 x 11 points has a turn by a quarter about its middle, of 30 cycles of four; so
// has a cross of four arms of 26 points. Rows along one side must not hide it, as the turn takes them to
// those along the other.
TEST(Rows, KeepTheQuarterTurnThatExchangesThem) {
    for (const int dimension : {2, 3}) {
        PointSet grid, cross;
        grid.dimension = cross.dimension = dimension;
        for (int x = -5; x <= 5; ++x)
            for (int y = -5; y <= 5; ++y) grid.positions.push_back({1.0 * x, 1.0 * y, 0});
        for (int r = 1; r <= 26; ++r)
            for (const auto& [x, y] : {std::pair{r, 0}, {0, r}, {-r, 0}, {0, -r}})
                cross.positions.push_back({1.0 * x, 1.0 * y, 0});
        for (const auto& [points, cycles] : {std::pair{&grid, 30U}, {&cross, 26U}}) {
            const DetectResult result = detect(*points, cycles_only(1e-5));
            EXPECT_TRUE(tells_of_rows(result));
            EXPECT_EQ(most_cycles_of_quarter_turns(result), cycles) << dimension << "D";
        }
    }
}

}  // namespace insym::property
