// Options and points that cannot be used, and degenerate ones that can.
//
// Oracle: the contract of detect(): which Error code; a sentence that names the knob.
#include "insym/detect.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "property/support/oracle.hpp"
#include "property/support/results.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Call {
    PointSet points = point_set(cube().points, 3);
    DetectOptions options;
    RunContext context;
};

/// A call that must fail: what is wrong with it, the code, and a word of the sentence.
struct BadCall {
    std::string name;
    ErrorCode code;
    std::string word;
    std::function<void(Call&)> spoil;
};

void PrintTo(const BadCall& bad, std::ostream* out) {
    *out << bad.name;
}

BadCall bad_resolution(const std::string& name, double value) {
    return {std::string("resolution_").append(name), ErrorCode::invalid_option, "resolution",
            [value](Call& call) { call.options.resolution = value; }};
}

BadCall bad_max_tolerance(const std::string& name, double value) {
    return {std::string("max_tolerance_").append(name), ErrorCode::invalid_option, "tolerance",
            [value](Call& call) { call.options.max_tolerance = value; }};
}

BadCall bad_regions(const std::string& name, Regions value, Method method = Method::paper) {
    return {std::string("regions_").append(name), ErrorCode::invalid_option, "regions",
            [value, method](Call& call) {
                call.options.method = method;
                call.options.regions = value;
            }};
}

BadCall bad_coordinate(const std::string& name, double value) {
    return {std::string("coordinate_").append(name), ErrorCode::invalid_input, "",
            [value](Call& call) { call.points.positions[3][1] = value; }};
}

BadCall bad_points(const std::string& name, const std::function<void(PointSet&)>& spoil) {
    return {name, ErrorCode::invalid_input, "", [spoil](Call& call) { spoil(call.points); }};
}

std::vector<BadCall> bad_calls() {
    return {
        bad_resolution("zero", 0),
        bad_resolution("negative", -1e-6),
        bad_resolution("one", 1),
        bad_resolution("nan", kNaN),
        bad_resolution("infinite", kInfinity),
        bad_max_tolerance("below_resolution", 1e-7),
        bad_max_tolerance("above_one", 1.0001),
        bad_max_tolerance("zero", 0),
        bad_max_tolerance("negative", -0.05),
        bad_max_tolerance("nan", kNaN),
        bad_max_tolerance("infinite", kInfinity),
        {"types_empty", ErrorCode::invalid_option, "types", [](Call& call) { call.options.types = {}; }},
        {"threads_negative", ErrorCode::invalid_option, "threads",
         [](Call& call) { call.context.threads = -1; }},
        bad_regions("none", {0, {}}),
        bad_regions("negative", {-3, {}}),
        bad_regions("too_many", {10001, {}}),
        bad_regions("fourth_axis", {2, 3}),
        bad_regions("negative_axis", {2, -1}),
        bad_regions("robust", {2, {}}, Method::robust),
        {"regions_z_in_the_plane", ErrorCode::invalid_option, "regions",
         [](Call& call) {
             call.points = point_set(polygon(6).points, 2);
             call.options.method = Method::paper;
             call.options.regions = {2, 2};
         }},
        bad_coordinate("nan", kNaN),
        bad_coordinate("infinite", kInfinity),
        bad_coordinate("minus_infinite", -kInfinity),
        bad_points("distance_overflows",
                   [](PointSet& p) {
                       p.positions[0] = {1e308, 0, 0};
                       p.positions[1] = {-1e308, 0, 0};
                   }),
        bad_points("square_of_distance_overflows",
                   [](PointSet& p) {
                       p.positions[0] = {1e308, 1e308, 1e308};
                   }),
        bad_points("no_point", [](PointSet& p) { p.positions.clear(); }),
        bad_points("one_point", [](PointSet& p) { p.positions.resize(1); }),
        bad_points("all_equal",
                   [](PointSet& p) {
                       p.positions.assign(8, {1, 2, 3});
                   }),
        bad_points("too_few_labels",
                   [](PointSet& p) {
                       p.labels = {1, 2, 3};
                   }),
        bad_points("too_many_labels", [](PointSet& p) { p.labels.assign(9, 1); }),
        bad_points("too_few_entities", [](PointSet& p) { p.entities.resize(7); }),
        bad_points("dimension_0", [](PointSet& p) { p.dimension = 0; }),
        bad_points("dimension_1", [](PointSet& p) { p.dimension = 1; }),
        bad_points("dimension_4", [](PointSet& p) { p.dimension = 4; }),
    };
}

class BadInput : public ::testing::TestWithParam<BadCall> {};

}  // namespace

TEST_P(BadInput, throws_a_typed_error_that_speaks) {
    Call call;
    GetParam().spoil(call);
    try {
        detect(call.points, call.options, call.context);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), GetParam().code) << error.what();
        EXPECT_THAT(std::string(error.what()), ::testing::HasSubstr(GetParam().word));
        EXPECT_THAT(std::string(error.what()), ::testing::HasSubstr(" "));
    }
}

INSTANTIATE_TEST_SUITE_P(Calls, BadInput, ::testing::ValuesIn(bad_calls()),
                         [](const auto& test) { return test.param.name; });

// --- degenerate, but good -----------------------------------------------------------------------------

namespace {

/// Detects and checks that the result is whole and follows the definitions.
DetectResult good(const PointSet& points, const DetectOptions& options = exact_options()) {
    const DetectResult result = detect(points, options);
    EXPECT_EQ(result.status, RunStatus::complete);
    const auto found = violations(result, true);
    EXPECT_TRUE(found.empty()) << found.size() << " violations, the first: " << found.front();
    return result;
}

PointSet row(int n, int dimension) {
    PointSet points;
    points.dimension = dimension;
    for (int k = 0; k < n; ++k) points.positions.push_back({0.5 * k, dimension == 3 ? 0.25 * k : 0.0, 0});
    return points;
}

}  // namespace

TEST(GoodInput, two_points) {
    for (int dimension : {2, 3}) {
        const DetectResult result = good(row(2, dimension));
        EXPECT_TRUE(result.cycles.empty());
    }
}

// A row of n points is one open cycle, T, in either dimension; it holds all of them.
TEST(GoodInput, points_on_a_line) {
    for (int dimension : {2, 3})
        for (int n : {4, 5, 9}) {
            const DetectResult result = good(row(n, dimension));
            const auto is_row = [n](const Cycle& c) {
                return !c.closed && static_cast<int>(c.points.size()) == n &&
                       c.types.contains(SymmetryType::translation);
            };
            EXPECT_EQ(std::count_if(result.cycles.begin(), result.cycles.end(), is_row), 1) << n;
        }
}

TEST(GoodInput, points_in_a_plane_of_space) {
    PointSet points = point_set(polygon(7).points, 3);
    const DetectResult result = good(points);
    ASSERT_EQ(result.cycles.size(), 1U);
    EXPECT_TRUE(result.cycles[0].closed);
    EXPECT_TRUE(result.cycles[0].types.contains(SymmetryType::rotation));
}

TEST(GoodInput, equal_points_are_merged_and_counted) {
    PointSet points = point_set(cube().points, 3);
    points.positions.push_back(points.positions[2]);
    points.positions.push_back(points.positions[5]);
    const DetectResult result = good(points);
    EXPECT_EQ(result.merged_points, 2);
    EXPECT_EQ(result.points.size(), 8U);
    EXPECT_FALSE(result.diagnostics.empty());
}

TEST(GoodInput, widest_and_narrowest_options) {
    DetectOptions options;
    options.max_tolerance = 1;
    good(point_set(prism(4).points, 3), options);
    options.max_tolerance = options.resolution;
    good(point_set(prism(4).points, 3), options);
}

TEST(GoodInput, tiny_and_huge_coordinates) {
    for (double scale : {1e-150, 1e-30, 1e30, 1e150}) {
        PointSet points = point_set(cube().points, 3);
        for (Point& p : points.positions)
            for (double& x : p) x *= scale;
        EXPECT_EQ(good(points).cycles.size(), 16U) << scale;  // 6 squares, 6 of S_4, 4 of S_6
    }
}

}  // namespace insym::property
