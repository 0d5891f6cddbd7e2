// Exact shapes: what the detector must list of them, to the last cycle and axis.
//
// Oracle: group theory. The closed forms below (GroupTheory) count elements and closed cycles; a
// brute-force search over all isometries of the set (support/oracle) must agree with them, and then
// judges the detector in any orientation, position, scale, order of points and mirror image.
#include "insym/detect.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "property/support/oracle.hpp"
#include "property/support/pose.hpp"
#include "property/support/results.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {

void PrintTo(const Shape& shape, std::ostream* out) {
    *out << shape.name;
}

namespace {

Problem exact_problem(const Shape& shape) {
    const double unit = diameter(shape.points);
    return {shape.points, std::vector<int>(shape.points.size(), 0), 1e-6 * unit, 1e-4 * unit};
}

/// The closed cycles that the definitions allow: regular, and C2.
std::map<CanonicalCycle, SymmetryType> allowed_cycles(const Shape& shape) {
    const Problem problem = exact_problem(shape);
    auto cycles = exact_closed_cycles(shape.points);
    std::erase_if(cycles, [&](const auto& item) { return !unambiguous(problem, item.first.first, true); });
    return cycles;
}

// --- symmetries of the whole set -------------------------------------------------------------------

/// A permutation and its inverse are one symmetry.
using Permutation = std::vector<int>;

Permutation canonical_permutation(const Permutation& image) {
    Permutation inverse(image.size());
    for (std::size_t k = 0; k < image.size(); ++k)
        inverse[static_cast<std::size_t>(image[k])] = static_cast<int>(k);
    return std::min(image, inverse);
}

struct WholeSymmetry {
    SymmetryType type{};
    std::optional<int> order;  ///< 360 degrees over the angle, where that is whole
    std::set<CanonicalCycle> cycles;
    bool operator==(const WholeSymmetry&) const = default;
};

using WholeSymmetries = std::multimap<Permutation, WholeSymmetry>;

std::set<Sequence> orbits_of(const Permutation& image) {
    std::set<Sequence> orbits;
    std::vector<bool> seen(image.size(), false);
    for (std::size_t k = 0; k < image.size(); ++k) {
        Sequence orbit;
        for (std::size_t i = k; !seen[i]; i = static_cast<std::size_t>(image[i])) {
            seen[i] = true;
            orbit.push_back(static_cast<int>(i));
        }
        if (orbit.size() > 1) orbits.insert(orbit);
    }
    return orbits;
}

std::optional<int> whole_order(double turn) {
    if (turn == 0) return std::nullopt;
    const double order = std::round(1 / turn);
    return std::abs(order * turn - 1) < 1e-6 ? std::optional(static_cast<int>(order)) : std::nullopt;
}

/// Every element of the group that the definitions let the detector see, with its cycles: those of
/// pairs all, the others through the orbits that are allowed cycles of their type.
WholeSymmetries expected_symmetries(const Shape& shape, const std::vector<Element>& group) {
    const auto allowed = allowed_cycles(shape);
    WholeSymmetries expected;
    for (const Element& element : group) {
        const Permutation key = canonical_permutation(element.image);
        if (expected.contains(key)) continue;
        WholeSymmetry whole{element.type, whole_order(element.turn), {}};
        for (const Sequence& orbit : orbits_of(element.image)) {
            const CanonicalCycle cycle = canonical(orbit, true);
            const auto known = allowed.find(cycle);
            const bool pair = is_pair_type(element.type);
            if (pair || (known != allowed.end() && known->second == element.type)) whole.cycles.insert(cycle);
        }
        if (!whole.cycles.empty()) expected.emplace(key, whole);
    }
    return expected;
}

/// Which point each point of a result is taken to, in the shape's indices.
Permutation image_of(const DetectResult& result, const Isometry& isometry, const std::vector<int>& original) {
    const auto& points = result.points.positions;
    Permutation image(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Point to = isometry.apply(points[k]);
        const auto nearest = std::min_element(
            points.begin(), points.end(),
            [&](const Point& a, const Point& b) { return distance(a, to) < distance(b, to); });
        image[static_cast<std::size_t>(original[k])] =
            original[static_cast<std::size_t>(nearest - points.begin())];
    }
    return image;
}

/// The listed symmetries of the whole set; of nested ones with long cycles only the maximal ones.
WholeSymmetries listed_symmetries(const DetectResult& result, const std::vector<int>& original) {
    WholeSymmetries listed;
    for (const Symmetry& symmetry : result.symmetries) {
        if (symmetry.coverage < 1 || !(symmetry.maximal || is_pair_type(symmetry.type))) continue;
        WholeSymmetry whole{symmetry.type, symmetry.order, {}};
        if (symmetry.type == SymmetryType::mirror || symmetry.type == SymmetryType::inversion)
            whole.order = whole_order(symmetry.type == SymmetryType::mirror ? 0 : 0.5);
        for (const Orbit& orbit : symmetry.cycles) {
            Sequence points;
            for (int k : orbit.points) points.push_back(original[static_cast<std::size_t>(k)]);
            whole.cycles.insert(canonical(points, orbit.closed));
        }
        listed.emplace(canonical_permutation(image_of(result, symmetry.isometry, original)), whole);
    }
    return listed;
}

/// The closed cycles of a result against those that are allowed; each has one type.
std::string difference(const std::map<CanonicalCycle, SymmetryType>& allowed, const Summary& summary) {
    for (const auto& [cycle, type] : allowed) {
        const auto listed = summary.cycles.find(cycle);
        const std::string name = text_of(cycle) + " " + std::string(option_letter(type));
        if (listed == summary.cycles.end()) return name + " is not listed";
        if (listed->second.types != std::set{std::string(option_letter(type))})
            return name + " has other types";
    }
    for (const auto& [cycle, facts] : summary.cycles)
        if (cycle.second && !allowed.contains(cycle)) return text_of(cycle) + " is listed, but is no cycle";
    return {};
}

std::string text(const WholeSymmetry& whole) {
    return std::string(option_letter(whole.type)) + " order " +
           (whole.order ? std::to_string(*whole.order) : "none") + " with " +
           std::to_string(whole.cycles.size()) + " cycles";
}

std::string difference(const WholeSymmetries& expected, const WholeSymmetries& listed) {
    for (const auto& [key, whole] : expected) {
        if (listed.count(key) != 1)
            return text(whole) + " is listed " + std::to_string(listed.count(key)) + " times";
        const WholeSymmetry& found = listed.find(key)->second;
        if (!(found == whole)) return text(whole) + " is listed as " + text(found) + ", or with other cycles";
    }
    for (const auto& [key, whole] : listed)
        if (!expected.contains(key)) return text(whole) + " is listed, but is no symmetry of the set";
    return {};
}

// --- closed forms -----------------------------------------------------------------------------------

/// (type, points of the cycle) -> number of cycles.
using CycleCounts = std::map<std::pair<SymmetryType, int>, int>;
/// (type, order or 0 where it is not whole) -> number of isometries, one with its inverse.
using AxisCounts = std::map<std::pair<SymmetryType, int>, int>;

struct Counts {
    int group_order = 0;
    CycleCounts cycles;
    AxisCounts axes;
};

constexpr auto kM = SymmetryType::mirror;
constexpr auto kI = SymmetryType::inversion;
constexpr auto kC2 = SymmetryType::half_turn;
constexpr auto kC = SymmetryType::rotation;
constexpr auto kS = SymmetryType::rotation_reflection;

/// Rings of n points, `rings` of them: for each divisor m >= 3 of n the principal axis has one
/// rotation of order m, whose orbits are n / m polygons in each ring.
void add_ring_rotations(Counts& counts, int n, int rings) {
    for (int m = 3; m <= n; ++m)
        if (n % m == 0) {
            counts.axes[{kC, m}] = 1;
            counts.cycles[{kC, m}] += rings * n / m;
        }
}

/// One rotation-reflection by the angle 2 pi share / whole whose orbits have `length` points.
void add_rotation_reflection(Counts& counts, int share, int whole, int length, int points) {
    counts.cycles[{kS, length}] += points / length;
    ++counts.axes[{kS, whole % share == 0 ? whole / share : 0}];
}

/// Dihedral groups: n half-turns across the principal axis, and its own where n is even.
Counts ring_counts(int group_order, int n) {
    Counts counts{group_order, {}, {}};
    counts.axes[{kC2, 2}] = n + (n % 2 == 0 ? 1 : 0);
    add_ring_rotations(counts, n, 2);
    return counts;
}

/// D_nh: n + 1 mirrors; an inversion where n is even. sigma_h times the turn by 2 pi k / n has order
/// m = n / gcd(n, k) where that is even, else 2 m; k and n - k are inverse, k = n / 2 is I.
Counts prism_counts(int n) {
    Counts counts = ring_counts(4 * n, n);
    counts.axes[{kM, 0}] = n + 1;
    if (n % 2 == 0) counts.axes[{kI, 2}] = 1;
    for (int k = 1; 2 * k < n; ++k) {
        const int m = n / std::gcd(n, k);
        add_rotation_reflection(counts, k, n, m % 2 == 0 ? m : 2 * m, 2 * n);
    }
    return counts;
}

/// D_nd: n mirrors; an inversion where n is odd. The rotation-reflections turn by pi j / n, j odd,
/// and have order 2 n / gcd(n, j), always even; j and 2 n - j are inverse, j = n is I.
Counts antiprism_counts(int n) {
    Counts counts = ring_counts(4 * n, n);
    counts.axes[{kM, 0}] = n;
    if (n % 2 == 1) counts.axes[{kI, 2}] = 1;
    for (int j = 1; j < n; j += 2) add_rotation_reflection(counts, j, 2 * n, 2 * n / std::gcd(n, j), 2 * n);
    return counts;
}

/// D_n: turns only.
Counts twisted_counts(int n) {
    return ring_counts(2 * n, n);
}

/// The plane's D_n: n mirrors, and the half-turn where n is even.
Counts polygon_counts(int n) {
    Counts counts{2 * n, {}, {}};
    counts.axes[{kM, 0}] = n;
    if (n % 2 == 0) counts.axes[{kC2, 2}] = 1;
    add_ring_rotations(counts, n, 1);
    return counts;
}

/// T_d has 4 axes of order 3 and 3 of S_4, 3 half-turns, 6 mirrors; O_h 3 of order 4, 4 of order 3
/// (and of S_6), 3 of S_4, 9 half-turns, 9 mirrors, I; I_h 6 of order 5 (S_10 and its cube), 10 of
/// order 3 (S_6), 15 half-turns, 15 mirrors, I. What C2 takes away:
/// - tetrahedron, octahedron, icosahedron, cube: no triangle is unambiguous, as two on one side share
///   it (the cube's triangles are those of its two tetrahedra, whose fourth corner does as well);
/// - octahedron: an orbit of S_4 is the flat square of C_4, so S_4 is not seen;
/// - dodecahedron: of the 3 orbits of 3 on either side of an axis of order 3, only those of 20
///   triangles (the neighbours of a vertex) stay. Its five cubes give 30 squares and 30 S_4 cycles
///   about axes that are none of the dodecahedron's. Each S_6 has 3 orbits of 6, each S_10 and its
///   cube 2 of 10, each C_5 4 of 5.
/// - grid: counted by brute force only; its whole symmetries are those of O_h that keep a cycle.
Counts solid_counts(const std::string& name) {
    const AxisCounts cubic = {{{kC, 4}, 3}, {{kS, 6}, 4}, {{kC2, 2}, 9}, {{kM, 0}, 9}, {{kI, 2}, 1}};
    const AxisCounts icosahedral = {{{kC, 5}, 6},   {{kS, 6}, 10}, {{kS, 10}, 6}, {{kS, 0}, 6},
                                    {{kC2, 2}, 15}, {{kM, 0}, 15}, {{kI, 2}, 1}};
    if (name == "tetrahedron") return {24, {{{kS, 4}, 3}}, {{{kS, 4}, 3}, {{kC2, 2}, 3}, {{kM, 0}, 6}}};
    if (name == "octahedron") return {48, {{{kC, 4}, 3}, {{kS, 6}, 4}}, cubic};
    if (name == "icosahedron") return {120, {{{kC, 5}, 12}, {{kS, 6}, 20}, {{kS, 10}, 12}}, icosahedral};
    if (name == "dodecahedron") {
        Counts counts = {
            120,
            {{{kC, 3}, 20}, {{kC, 4}, 30}, {{kS, 4}, 30}, {{kC, 5}, 24}, {{kS, 6}, 30}, {{kS, 10}, 24}},
            icosahedral};
        counts.axes[{kC, 3}] = 10;
        return counts;
    }
    Counts counts = {48, {{{kC, 4}, 6}, {{kS, 4}, 6}, {{kS, 6}, 4}}, cubic};  // the cube
    counts.axes[{kS, 4}] = 3;
    if (name == "grid27") {
        counts.cycles = {{{kC, 3}, 8}, {{kC, 4}, 54}, {{kS, 4}, 96}, {{kC, 6}, 4}, {{kS, 6}, 52}};
        counts.axes[{kC, 3}] = 4;
    }
    return counts;
}

Counts counts_of(const Shape& shape) {
    const int n = static_cast<int>(shape.points.size());
    if (shape.name.starts_with("prism")) return prism_counts(n / 2);
    if (shape.name.starts_with("antiprism")) return antiprism_counts(n / 2);
    if (shape.name.starts_with("twisted")) return twisted_counts(n / 2);
    if (shape.name.starts_with("polygon")) return polygon_counts(n);
    return solid_counts(shape.name);
}

std::string text_of(const std::map<std::pair<SymmetryType, int>, int>& counts) {
    std::string text;
    for (const auto& [key, count] : counts)
        text += std::string(option_letter(key.first)) + std::to_string(key.second) + ":" +
                std::to_string(count) + " ";
    return text;
}

class ShapeTest : public ::testing::TestWithParam<Shape> {};
class GroupTheory : public ShapeTest {};
class ExactShape : public ShapeTest {};

}  // namespace

TEST_P(GroupTheory, counts_agree_with_brute_force) {
    const Shape& shape = GetParam();
    const Counts counts = counts_of(shape);
    const auto group = symmetry_group(shape.points, shape.dimension);
    EXPECT_EQ(group.size() + 1, static_cast<std::size_t>(counts.group_order));

    CycleCounts cycles;
    for (const auto& [cycle, type] : allowed_cycles(shape))
        ++cycles[{type, static_cast<int>(cycle.first.size())}];
    EXPECT_EQ(text_of(cycles), text_of(counts.cycles));

    AxisCounts axes;
    for (const auto& [key, whole] : expected_symmetries(shape, group))
        ++axes[{whole.type, whole.order.value_or(0)}];
    EXPECT_EQ(text_of(axes), text_of(counts.axes));
}

TEST_P(ExactShape, closed_cycles_and_whole_symmetries_are_those_of_the_group) {
    const Shape& shape = GetParam();
    const auto cycles = allowed_cycles(shape);
    const auto expected = expected_symmetries(shape, symmetry_group(shape.points, shape.dimension));
    const PointSet points = point_set(shape.points, shape.dimension);

    EXPECT_TRUE(rc::check("in any pose and order", [&] {
        const Pose pose = *any_pose(shape.dimension);
        const auto order =
            shuffled_order(static_cast<int>(points.size()), *rc::gen::arbitrary<std::uint64_t>());
        const PointSet input = placed(points, pose, order);
        const DetectResult result = detect(input, exact_options());
        RC_ASSERT(result.status == RunStatus::complete);
        std::vector<int> original = indices_in(result, input.positions);
        for (int& k : original) k = order[static_cast<std::size_t>(k)];

        RC_ASSERT(difference(cycles, summary_of(result, original)) == "");
        RC_ASSERT(difference(expected, listed_symmetries(result, original)) == "");
    }));
}

// An exact set has no residual: the isometries carry every point onto a point to rounding.
TEST_P(ExactShape, whole_symmetries_deviate_by_rounding_only) {
    const Shape& shape = GetParam();
    const DetectResult result = detect(point_set(shape.points, shape.dimension), exact_options());
    int whole = 0;
    for (const Symmetry& symmetry : result.symmetries) {
        if (symmetry.coverage < 1) continue;
        ++whole;
        EXPECT_LE(symmetry.deviation.max, 1e-9 * result.diameter);
        EXPECT_NEAR(symmetry.tolerance.min, result.resolution, 1e-9 * result.diameter);
    }
    EXPECT_GT(whole, 0);
}

TEST_P(ExactShape, result_follows_the_definitions) {
    const Shape& shape = GetParam();
    const auto found = violations(detect(point_set(shape.points, shape.dimension), exact_options()), true);
    EXPECT_TRUE(found.empty()) << found.size() << " violations, the first: " << found.front();
}

const auto kShapeName = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Shapes, GroupTheory, ::testing::ValuesIn(all_shapes()), kShapeName);
INSTANTIATE_TEST_SUITE_P(Shapes, ExactShape, ::testing::ValuesIn(all_shapes()), kShapeName);

}  // namespace insym::property
