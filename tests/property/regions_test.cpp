// Method paper region by region: cycles inside slabs, symmetries over all.
//
// Oracle: what is cut off is a set of its own, so a run on each slab alone gives the cycles, less those that
// the definitions word for word call ambiguous (C2) among all points; one slab is the whole.
#include "insym/detect.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "property/support/oracle.hpp"
#include "property/support/results.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {
namespace {

DetectOptions paper_options(Regions regions = {}) {
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = 5e-3;
    options.regions = regions;
    return options;
}

double coordinate(const Point& p, int axis) {
    return p[static_cast<std::size_t>(axis)];
}

/// Which of `count` slabs of equal height each point is in.
std::vector<int> slab_of(const std::vector<Point>& points, int count, int axis) {
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(),
        [&](const Point& a, const Point& b) { return coordinate(a, axis) < coordinate(b, axis); });
    const double bottom = coordinate(*low, axis), height = (coordinate(*high, axis) - bottom) / count;
    std::vector<int> slabs;
    for (const Point& p : points)
        slabs.push_back(std::min(count - 1, static_cast<int>((coordinate(p, axis) - bottom) / height)));
    return slabs;
}

int longest_axis(const std::vector<Point>& points) {
    double longest = 0;
    int best = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const Point& p : points)
            for (const Point& q : points)
                if (const double d = coordinate(p, axis) - coordinate(q, axis); d > longest) {
                    longest = d;
                    best = axis;
                }
    return best;
}

std::set<CanonicalCycle> cycles_of(const DetectResult& result) {
    std::set<CanonicalCycle> cycles;
    for (const Cycle& c : result.cycles) cycles.insert(canonical(c.points, c.closed));
    return cycles;
}

struct Expected {
    std::set<CanonicalCycle> cycles;
    std::set<CanonicalCycle> ambiguous;
};

/// The cycles of the slabs, each searched as a set of its own at the same lengths; those ambiguous in `whole`
/// apart.
Expected expected_cycles(const DetectResult& whole, const std::vector<int>& slabs, int count) {
    Expected expected;
    for (int slab = 0; slab < count; ++slab) {
        std::vector<int> chosen;
        PointSet part;
        part.dimension = whole.points.dimension;
        for (std::size_t i = 0; i < whole.points.size(); ++i)
            if (slabs[i] == slab) {
                chosen.push_back(static_cast<int>(i));
                part.positions.push_back(whole.points.positions[i]);
                if (!whole.points.labels.empty()) part.labels.push_back(whole.points.labels[i]);
            }
        if (part.size() < 2) continue;
        DetectOptions options = paper_options();
        options.resolution = whole.resolution / diameter(part.positions);
        options.max_tolerance = whole.max_tolerance / diameter(part.positions);
        for (const Cycle& c : detect(part, options).cycles) {
            Sequence points;
            for (const int p : c.points) points.push_back(chosen[static_cast<std::size_t>(p)]);
            const bool is_cycle = unambiguous(problem_of(whole), points, c.closed);
            (is_cycle ? expected.cycles : expected.ambiguous).insert(canonical(points, c.closed));
        }
    }
    return expected;
}

/// Two equal rings of five on one axis, one above the other.
PointSet two_fives(double height) {
    std::vector<Point> points;
    for (const double z : {0.0, height})
        for (int k = 0; k < 5; ++k)
            points.push_back({std::cos(0.4 * std::numbers::pi * k), std::sin(0.4 * std::numbers::pi * k), z});
    return point_set(points, 3);
}

}  // namespace

TEST(Regions, one_is_the_whole) {
    for (const int dimension : {2, 3}) {
        const PointSet points = noisy_set(dimension, 4, 20, 1e-4, 11);
        const DetectResult whole = detect(points, paper_options());
        EXPECT_EQ(difference_in_bits(whole, detect(points, paper_options({1, 1}))), "");
        EXPECT_TRUE(whole.diagnostics.empty());
    }
}

TEST(Regions, give_the_cycles_of_each_slab_that_are_unambiguous_among_all_points) {
    std::size_t seen = 0, left_out = 0;
    for (const int dimension : {2, 3})
        for (const std::uint64_t seed : {1, 2, 3})
            for (const int count : {2, 5}) {
                PointSet points = noisy_set(dimension, 6, 30, 1e-4, seed);
                points.labels.clear();  // so that a point of another slab can replace one
                const int axis = seed == 1 ? 1 : longest_axis(points.positions);
                const Regions regions{count, seed == 1 ? std::optional(axis) : std::nullopt};
                const DetectResult result = detect(points, paper_options(regions));
                const std::vector<int> slabs = slab_of(result.points.positions, count, axis);
                const Expected expected = expected_cycles(result, slabs, count);
                EXPECT_EQ(cycles_of(result), expected.cycles);
                for (const Cycle& c : result.cycles)
                    for (const int p : c.points)
                        EXPECT_EQ(slabs[static_cast<std::size_t>(p)],
                                  slabs[static_cast<std::size_t>(c.points[0])]);
                const auto found = violations(result, false);
                EXPECT_TRUE(found.empty()) << found.front();
                ASSERT_EQ(result.diagnostics.size(), 1U);
                EXPECT_EQ(result.diagnostics[0].code, "regions");
                const std::string number = "; " + std::to_string(expected.ambiguous.size()) + " that";
                EXPECT_NE(result.diagnostics[0].message.find(number), std::string::npos)
                    << result.diagnostics[0].message;
                left_out += expected.ambiguous.size();
                seen += result.cycles.size();
            }
    EXPECT_GT(seen, 50U) << "sets without cycles show nothing";
    EXPECT_GT(left_out, 10U) << "nor do sets without ambiguous ones";
}

TEST(Regions, leave_symmetries_over_all_slabs) {
    const DetectResult result = detect(two_fives(4), paper_options({2, {}}));
    EXPECT_TRUE(std::any_of(result.symmetries.begin(), result.symmetries.end(), [](const Symmetry& s) {
        return s.type == SymmetryType::rotation && s.order == 5 && s.cycles.size() == 2;
    }));
}

TEST(Regions, give_the_same_bits_for_any_number_of_threads) {
    const PointSet points = noisy_set(3, 6, 40, 1e-4, 5);
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    EXPECT_EQ(difference_in_bits(detect(points, paper_options({3, {}}), one),
                                 detect(points, paper_options({3, {}}), four)),
              "");
}

TEST(Regions, without_a_point_are_no_hindrance) {
    const DetectResult two = detect(two_fives(4), paper_options({2, 2}));
    const DetectResult many = detect(two_fives(4), paper_options({1000, 2}));
    EXPECT_FALSE(two.cycles.empty());
    EXPECT_EQ(cycles_of(many), cycles_of(two));
}

}  // namespace insym::property
