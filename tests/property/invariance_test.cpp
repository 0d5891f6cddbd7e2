// What the answer must not depend on, and what it must say whatever the input.
//
// Oracles: invariance (the definitions speak of distances only, so pose, scale, order and mirror
// image change nothing), the definitions of labels and of the words for an isometry, determinism.
#include "insym/detect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <ostream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <tbb/global_control.h>

#include "property/support/oracle.hpp"
#include "property/support/pose.hpp"
#include "property/support/results.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {

void PrintTo(const Shape& shape, std::ostream* out) {
    *out << shape.name;
}

namespace {

DetectOptions noisy_options() {
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = 5e-3;
    return options;
}

PointSet without_labels(PointSet points) {
    points.labels.clear();
    return points;
}

std::vector<int> identity_order(std::size_t n) {
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    return order;
}

Summary summary_in_order(const PointSet& input, const std::vector<int>& order, const DetectOptions& options) {
    const DetectResult result = detect(input, options);
    std::vector<int> original = indices_in(result, input.positions);
    for (int& k : original) k = order[static_cast<std::size_t>(k)];
    return summary_of(result, original);
}

/// Detects in the given pose and in a random one; the summaries must be equal.
void check_pose_invariance(const PointSet& points, const DetectOptions& options, bool half_turns) {
    const Pose pose = *any_pose(points.dimension);
    const auto order = shuffled_order(static_cast<int>(points.size()), *rc::gen::arbitrary<std::uint64_t>());
    Summary here = summary_in_order(points, identity_order(points.size()), options);
    Summary there = summary_in_order(placed(points, pose, order), order, options);
    if (!half_turns) {
        here = without_half_turns(here);
        there = without_half_turns(there);
    }
    RC_ASSERT(difference(here, there) == "");
}

/// A generic set: planted orbits under noise, scattered points, labels by orbit.
PointSet any_noisy_set(int dimension) {
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const int orbits = *rc::gen::inRange(1, 5);
    const int scattered = *rc::gen::inRange(0, 12);
    const double noise = *rc::gen::element(1e-5, 1e-4, 5e-4);
    return noisy_set(dimension, orbits, scattered, noise, seed);
}

}  // namespace

// --- pose, scale, order, mirror image ------------------------------------------------------------

RC_GTEST_PROP(Invariance, noisy_sets_in_space, ()) {
    check_pose_invariance(without_labels(any_noisy_set(3)), noisy_options(), false);
}

RC_GTEST_PROP(Invariance, noisy_sets_in_the_plane, ()) {
    check_pose_invariance(without_labels(any_noisy_set(2)), noisy_options(), true);
}

// Half-turns in space are the largest sets of consistent pairs about one axis: the one kind that is no
// connected component, tested apart.
RC_GTEST_PROP(Invariance, half_turns_of_noisy_sets_in_space, ()) {
    check_pose_invariance(without_labels(any_noisy_set(3)), noisy_options(), true);
}

// A ring of an S_6 under noise of 1e-3: three half-turns exchange all its points, with tolerances of
// 0.0019, 0.0030 and 0.0030 of the diameter, in whatever order the points are given.
TEST(Invariance, half_turns_of_six_points_in_every_order) {
    PointSet points;
    points.positions = {{-0.620652, 0.939855, -0.034579},  {-1.127645, -0.064762, 0.040753},
                        {-0.509298, -1.006131, -0.038161}, {0.618954, -0.945019, 0.033153},
                        {1.128312, 0.066922, -0.034859},   {0.505239, 1.007660, 0.038475}};
    DetectOptions options = noisy_options();
    options.types = {};
    options.types.insert(SymmetryType::half_turn);
    auto order = identity_order(points.size());
    int lost = 0;
    do {
        const DetectResult result = detect(placed(points, {}, order), options);
        const auto whole =
            std::count_if(result.symmetries.begin(), result.symmetries.end(),
                          [](const Symmetry& s) { return s.coverage == 1.0 && s.cycles.size() == 3; });
        lost += whole == 3 ? 0 : 1;
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(lost, 0) << "orders of 720 without all three";
}

RC_GTEST_PROP(Invariance, labelled_noisy_sets, ()) {
    PointSet points = any_noisy_set(*rc::gen::element(2, 3));
    for (int& label : points.labels) label %= 3;
    check_pose_invariance(points, noisy_options(), false);
}

class InvarianceOfExactShapes : public ::testing::TestWithParam<Shape> {};

// Exact shapes are full of ties: every cycle, open ones too, must be found from every order.
TEST_P(InvarianceOfExactShapes, in_any_pose_and_order) {
    const PointSet points = point_set(GetParam().points, GetParam().dimension);
    EXPECT_TRUE(rc::check("pose", [&] { check_pose_invariance(points, exact_options(), true); }));
}

INSTANTIATE_TEST_SUITE_P(Shapes, InvarianceOfExactShapes, ::testing::ValuesIn(all_shapes()),
                         [](const auto& test) { return test.param.name; });

// --- labels ------------------------------------------------------------------------------------------

RC_GTEST_PROP(Labels, a_cycle_never_mixes_labels, ()) {
    PointSet points = any_noisy_set(*rc::gen::element(2, 3));
    for (int& label : points.labels) label = *rc::gen::element(-7, 0, 5);
    const DetectResult result = detect(points, noisy_options());
    const auto label_of = [&](int k) { return result.points.labels[static_cast<std::size_t>(k)]; };
    const auto is_pure = [&](const auto& cycle) {
        return std::all_of(cycle.points.begin(), cycle.points.end(),
                           [&](int k) { return label_of(k) == label_of(cycle.points.front()); });
    };
    RC_ASSERT(std::all_of(result.cycles.begin(), result.cycles.end(), is_pure));
    for (const Symmetry& symmetry : result.symmetries)
        RC_ASSERT(std::all_of(symmetry.cycles.begin(), symmetry.cycles.end(), is_pure));
    const auto found = violations(result, true);
    RC_ASSERT(found.empty());
}

RC_GTEST_PROP(Labels, their_names_do_not_matter, ()) {
    PointSet points = any_noisy_set(*rc::gen::element(2, 3));
    PointSet renamed = points;
    for (int& label : renamed.labels) label = 1000 - 77 * label;
    const auto order = identity_order(points.size());
    RC_ASSERT(difference(summary_in_order(points, order, noisy_options()),
                         summary_in_order(renamed, order, noisy_options())) == "");
}

RC_GTEST_PROP(Labels, one_label_is_none, ()) {
    PointSet points = any_noisy_set(*rc::gen::element(2, 3));
    points.labels.assign(points.size(), 42);
    const auto order = identity_order(points.size());
    RC_ASSERT(difference(summary_in_order(points, order, noisy_options()),
                         summary_in_order(without_labels(points), order, noisy_options())) == "");
}

namespace {

std::set<CanonicalCycle> cycles_in(const DetectResult& result, const std::vector<int>& original) {
    std::set<CanonicalCycle> cycles;
    for (const auto& [cycle, facts] : summary_of(result, original).cycles) cycles.insert(cycle);
    return cycles;
}

/// The cycles of the points of one label alone, with the lengths that hold for the whole set.
std::set<CanonicalCycle> cycles_of_label(const PointSet& all, int label, const DetectResult& whole) {
    std::vector<int> members;
    PointSet part{all.dimension, {}, {}, {}};
    for (std::size_t k = 0; k < all.size(); ++k)
        if (all.labels[k] == label) {
            members.push_back(static_cast<int>(k));
            part.positions.push_back(all.positions[k]);
        }
    if (part.size() < 3) return {};
    const double unit = diameter(part.positions);
    DetectOptions options;
    options.method = Method::paper;
    options.resolution = whole.resolution / unit;
    options.max_tolerance = std::min(1.0, whole.max_tolerance / unit);
    const DetectResult result = detect(part, options);
    std::vector<int> original = indices_in(result, part.positions);
    for (int& k : original) k = members[static_cast<std::size_t>(k)];
    return cycles_in(result, original);
}

}  // namespace

// Labels are no part of a distance: C1 to C3 see only points of the cycle's own label.
RC_GTEST_PROP(Labels, cycles_are_those_of_each_label_alone, ()) {
    PointSet points = any_noisy_set(*rc::gen::element(2, 3));
    for (int& label : points.labels) label %= 2;
    const DetectResult whole = detect(points, noisy_options());
    std::set<CanonicalCycle> alone;
    for (int label : {0, 1}) alone.merge(cycles_of_label(points, label, whole));
    RC_ASSERT(cycles_in(whole, indices_in(whole, points.positions)) == alone);
}

// --- the definitions hold for any input -----------------------------------------------------------------

RC_GTEST_PROP(AnySet, result_follows_the_definitions, ()) {
    const PointSet points = without_labels(any_noisy_set(*rc::gen::element(2, 3)));
    const auto found = violations(detect(points, noisy_options()), true);
    RC_ASSERT((found.empty() ? "" : found.front()) == std::string());
}

RC_GTEST_PROP(AnySet, only_the_types_asked_for_are_listed, ()) {
    const PointSet points = without_labels(any_noisy_set(*rc::gen::element(2, 3)));
    const SymmetryType wanted =
        *rc::gen::elementOf(std::vector<SymmetryType>(kAllSymmetryTypes.begin(), kAllSymmetryTypes.end()));
    DetectOptions options = noisy_options();
    const DetectResult all = detect(points, options);
    options.types = {};
    options.types.insert(wanted);
    const DetectResult some = detect(points, options);
    const auto count = [&](const DetectResult& result) {
        return std::count_if(result.symmetries.begin(), result.symmetries.end(),
                             [&](const Symmetry& s) { return s.type == wanted; });
    };
    RC_ASSERT(count(some) == static_cast<std::ptrdiff_t>(some.symmetries.size()));
    RC_ASSERT(count(some) == count(all));
}

// --- words for an isometry ----------------------------------------------------------------------------

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Rotation by `degrees` about a unit direction (Rodrigues).
Matrix turn_about(const Point& direction, double degrees) {
    const double half = degrees * std::numbers::pi / 360;
    return rotation_of({std::cos(half), std::sin(half) * direction[0], std::sin(half) * direction[1],
                        std::sin(half) * direction[2]});
}

double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Point sum(const Point& a, double factor, const Point& b) {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

Point turned(const Matrix& turn, const Point& centre, const Point& p) {
    const Point from = sum(p, -1, centre);
    return {centre[0] + dot(turn[0], from), centre[1] + dot(turn[1], from), centre[2] + dot(turn[2], from)};
}

Point mirrored_at(const Plane& plane, const Point& p) {
    return sum(p, -2 * dot(plane.normal, sum(p, -1, plane.point)), plane.normal);
}

/// The image of p after the words alone, but for the step (its direction is not in the words).
Point image_in_words(SymmetryType type, const Isometry& words, const Point& p) {
    switch (type) {
        case SymmetryType::mirror:
        case SymmetryType::glide_reflection:
            return mirrored_at(words.plane.value(), p);
        case SymmetryType::inversion:
            return sum(sum({}, 2, words.center.value()), -1, p);
        case SymmetryType::translation:
            return p;
        case SymmetryType::rotation_reflection:
            return mirrored_at(
                words.plane.value(),
                turned(turn_about(words.axis.value().direction, words.angle_deg), words.center.value(), p));
        default:
            break;
    }
    if (words.dimension == 3)
        return turned(turn_about(words.axis.value().direction, words.angle_deg), words.axis.value().point, p);
    // In the plane the words give no sense of rotation: take the matrix's.
    const double sense = words.linear[1][0] < 0 ? -1 : 1;
    return turned(turn_about({0, 0, sense}, words.angle_deg), words.center.value(), p);
}

/// How far words and matrix are apart, over points around the origin at the scale of the set.
double disagreement(const Symmetry& symmetry, double unit) {
    double worst = 0;
    for (const Point& p : {Point{0, 0, 0}, Point{unit, 0, 0}, Point{0, unit, 0}, Point{0, 0, unit}}) {
        if (symmetry.isometry.dimension == 2 && p[2] != 0) continue;
        const Point rest =
            sum(symmetry.isometry.apply(p), -1, image_in_words(symmetry.type, symmetry.isometry, p));
        worst = std::max(worst, std::abs(std::sqrt(dot(rest, rest)) - std::abs(symmetry.isometry.step)));
    }
    return worst;
}

}  // namespace

RC_GTEST_PROP(Words, say_what_the_matrix_does, ()) {
    const PointSet points = without_labels(any_noisy_set(*rc::gen::element(2, 3)));
    const DetectResult result = detect(points, noisy_options());
    for (const Symmetry& symmetry : result.symmetries)
        RC_ASSERT(disagreement(symmetry, result.diameter) <= 1e-7 * result.diameter);
}

// --- determinism -----------------------------------------------------------------------------------------

namespace {

/// More workers than cores, so that threads really interleave on any machine.
class Determinism : public ::testing::Test {
private:
    tbb::global_control workers_{tbb::global_control::max_allowed_parallelism, 8};
};

DetectResult detect_with_threads(const PointSet& points, int threads) {
    RunContext context;
    context.threads = threads;
    return detect(points, noisy_options(), context);
}

}  // namespace

TEST_F(Determinism, any_number_of_threads_gives_the_same_bits) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const PointSet points = noisy_set(seed % 2 == 0 ? 2 : 3, 6, 25, 2e-4, seed);
        const DetectResult one = detect_with_threads(points, 1);
        EXPECT_FALSE(one.cycles.empty());
        for (int threads : {2, 4, 0}) {
            const DetectResult many = detect_with_threads(points, threads);
            EXPECT_EQ(difference_in_bits(one, many), "") << threads << " threads, seed " << seed;
        }
    }
}

TEST_F(Determinism, exact_ties_give_the_same_bits_on_any_number_of_threads) {
    const PointSet points = point_set(grid27().points, 3);
    const DetectResult one = detect_with_threads(points, 1);
    for (int threads : {2, 4, 4, 4})
        EXPECT_EQ(difference_in_bits(one, detect_with_threads(points, threads)), "");
}

TEST_F(Determinism, calls_at_once_do_not_disturb_each_other) {
    constexpr std::size_t kCalls = 4;
    std::vector<PointSet> inputs;
    std::vector<DetectResult> alone;
    for (std::size_t k = 0; k < kCalls; ++k) {
        inputs.push_back(noisy_set(k % 2 == 0 ? 3 : 2, 6, 25, 2e-4, 100 + k));
        alone.push_back(detect_with_threads(inputs[k], 1));
    }
    std::vector<DetectResult> together(kCalls);
    std::vector<std::thread> callers;
    for (std::size_t k = 0; k < kCalls; ++k)
        callers.emplace_back([&, k] { together[k] = detect_with_threads(inputs[k], 2); });
    for (std::thread& caller : callers) caller.join();
    for (std::size_t k = 0; k < kCalls; ++k) EXPECT_EQ(difference_in_bits(alone[k], together[k]), "");
}

}  // namespace insym::property
