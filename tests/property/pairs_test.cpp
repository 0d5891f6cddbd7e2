// Symmetries of pairs, complete or not: mirrors, inversions and half-turns of exact point sets.
//
// Oracle: brute force. Every plane, centre and axis that pairs of points propose is tried, and all pairs
// that it exchanges are gathered; definitions, section 6, says which of these sets are listed.
#include "insym/detect.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "property/support/oracle.hpp"
#include "property/support/pose.hpp"
#include "property/support/results.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {

void PrintTo(const Shape& shape, std::ostream* out) {
    *out << shape.name;
}

namespace {

using Eigen::Vector3d;
using PairSet = std::set<std::pair<int, int>>;
using Listed = std::multiset<std::pair<SymmetryType, PairSet>>;

/// x -> linear * x + shift.
struct Involution {
    Eigen::Matrix3d linear;
    Vector3d shift;

    static Involution about(const Eigen::Matrix3d& linear, const Vector3d& fixed) {
        return {linear, fixed - linear * fixed};
    }
};

class BruteForce {
public:
    explicit BruteForce(const PointSet& points)
        : dimension_(points.dimension),
          labels_(points.labels.empty() ? std::vector<int>(points.size(), 0) : points.labels) {
        for (const Point& p : points.positions) x_.emplace_back(p[0], p[1], p[2]);
        reach_ = 1e-9 * diameter(points.positions);
    }

    Listed search() {
        const int n = static_cast<int>(x_.size());
        for (int i = 0; i < n; ++i)
            for (int j = i + 1; j < n; ++j) {
                propose_mirror_and_centre(i, j);
                if (dimension_ == 3) propose_axes(i, j);
            }
        return {found_.begin(), found_.end()};
    }

private:
    const Vector3d& at(int k) const { return x_[static_cast<std::size_t>(k)]; }
    Vector3d middle(int i, int j) const { return (at(i) + at(j)) / 2; }

    void propose_mirror_and_centre(int i, int j) {
        const Vector3d normal = (at(j) - at(i)).normalized();
        const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
        keep(SymmetryType::mirror, Involution::about(one - 2 * normal * normal.transpose(), middle(i, j)), 1);
        Eigen::Matrix3d central = -one;
        if (dimension_ == 2) central(2, 2) = 1;
        keep(dimension_ == 2 ? SymmetryType::half_turn : SymmetryType::inversion,
             Involution::about(central, middle(i, j)), 1);
    }

    /// The axes that (i, j) and a second pair fix together.
    void propose_axes(int i, int j) {
        const int n = static_cast<int>(x_.size());
        const Vector3d u = at(j) - at(i);
        for (int k = i + 1; k < n; ++k)
            for (int l = k + 1; l < n; ++l) {
                if (k == j || l == j) continue;
                const Vector3d v = at(l) - at(k);
                Vector3d axis = middle(k, l) - middle(i, j);
                if (axis.norm() <= reach_) axis = u.cross(v);  // zero where all four lie on a line
                if (axis.norm() <= 1e-9 * u.norm() * v.norm()) continue;
                axis.normalize();
                if (std::abs(axis.dot(u)) > reach_ || std::abs(axis.dot(v)) > reach_) continue;
                const Eigen::Matrix3d turn = 2 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
                keep(SymmetryType::half_turn, Involution::about(turn, middle(i, j)), 2);
            }
    }

    /// Gathers the pairs that the map exchanges, and keeps them if the definitions list them.
    void keep(SymmetryType type, const Involution& map, std::size_t least_pairs) {
        PairSet pairs;
        std::size_t fixed = 0;
        const int n = static_cast<int>(x_.size());
        for (int p = 0; p < n; ++p) {
            const Vector3d image = map.linear * at(p) + map.shift;
            for (int q = 0; q < n; ++q) {
                if ((at(q) - image).norm() > reach_) continue;
                if (q == p) ++fixed;
                if (q > p && labels_[static_cast<std::size_t>(p)] == labels_[static_cast<std::size_t>(q)])
                    pairs.emplace(p, q);
            }
        }
        const bool covers = 2 * pairs.size() + fixed == x_.size();
        if (pairs.size() >= least_pairs && (covers || pairs.size() + fixed >= 4)) found_.emplace(type, pairs);
    }

    int dimension_;
    std::vector<int> labels_;
    double reach_ = 0;
    std::vector<Vector3d> x_;
    std::set<std::pair<SymmetryType, PairSet>> found_;
};

Listed listed_by(const DetectResult& result, const std::vector<int>& original) {
    Listed listed;
    for (const Symmetry& symmetry : result.symmetries) {
        if (!is_pair_type(symmetry.type)) continue;
        PairSet pairs;
        for (const Orbit& orbit : symmetry.cycles) {
            const int a = original[static_cast<std::size_t>(orbit.points.at(0))];
            const int b = original[static_cast<std::size_t>(orbit.points.at(1))];
            pairs.emplace(std::min(a, b), std::max(a, b));
        }
        listed.emplace(symmetry.type, pairs);
    }
    return listed;
}

std::string text(const std::pair<SymmetryType, PairSet>& item) {
    std::string text(option_letter(item.first));
    for (const auto& [a, b] : item.second)
        text.append(" ").append(std::to_string(a)).append("-").append(std::to_string(b));
    return text;
}

std::string difference(const Listed& expected, const Listed& listed) {
    for (const auto& item : expected)
        if (listed.count(item) != 1)
            return text(item) + " is listed " + std::to_string(listed.count(item)) + " times";
    for (const auto& item : listed)
        if (!expected.contains(item)) return text(item) + " is listed, but should not be";
    return {};
}

std::string difference_in_any_order(const PointSet& points, const Listed& expected) {
    const Pose pose = *any_pose(points.dimension);
    const auto order = shuffled_order(static_cast<int>(points.size()), *rc::gen::arbitrary<std::uint64_t>());
    const PointSet input = placed(points, pose, order);
    const DetectResult result = detect(input, exact_options());
    std::vector<int> original = indices_in(result, input.positions);
    for (int& k : original) k = order[static_cast<std::size_t>(k)];
    return difference(expected, listed_by(result, original));
}

/// Random pairs that one involution exchanges, points that it leaves in place, and scattered points.
PointSet planted_involution(SymmetryType type, int pairs, int fixed, int scattered, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    PointSet points;
    const auto any = [&random] {
        return Point{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    };
    const auto signs = type == SymmetryType::mirror      ? Point{1, 1, -1}
                       : type == SymmetryType::half_turn ? Point{-1, -1, 1}
                                                         : Point{-1, -1, -1};
    for (int k = 0; k < pairs; ++k) {
        const Point p = any();
        points.positions.push_back(p);
        points.positions.push_back({signs[0] * p[0], signs[1] * p[1], signs[2] * p[2]});
    }
    for (int k = 0; k < fixed; ++k) {
        Point p = any();
        for (std::size_t i = 0; i < 3; ++i)
            if (signs[i] < 0) p[i] = 0;
        points.positions.push_back(p);
        if (type == SymmetryType::inversion) break;  // one point at the centre
    }
    for (int k = 0; k < scattered; ++k) points.positions.push_back(any());
    return points;
}

class ExactShapePairs : public ::testing::TestWithParam<Shape> {};

}  // namespace

TEST_P(ExactShapePairs, are_those_of_brute_force_and_each_is_listed_once) {
    const PointSet points = point_set(GetParam().points, GetParam().dimension);
    const Listed expected = BruteForce(points).search();
    ASSERT_FALSE(expected.empty());
    EXPECT_TRUE(rc::check("in any pose and order",
                          [&] { RC_ASSERT(difference_in_any_order(points, expected) == ""); }));
}

INSTANTIATE_TEST_SUITE_P(Shapes, ExactShapePairs, ::testing::ValuesIn(all_shapes()),
                         [](const auto& test) { return test.param.name; });

RC_GTEST_PROP(IncompletePairs, are_those_of_brute_force_and_each_is_listed_once, ()) {
    const SymmetryType type =
        *rc::gen::element(SymmetryType::mirror, SymmetryType::inversion, SymmetryType::half_turn);
    const PointSet points = planted_involution(type, *rc::gen::inRange(1, 7), *rc::gen::inRange(0, 5),
                                               *rc::gen::inRange(0, 9), *rc::gen::arbitrary<std::uint64_t>());
    RC_PRE(points.size() > 1U);
    RC_ASSERT(difference_in_any_order(points, BruteForce(points).search()) == "");
}

// A pair is of one label, a symmetry is not: pairs of all labels make one mirror, centre or half-turn.
RC_GTEST_PROP(LabelledPairs, are_those_of_brute_force_and_each_is_listed_once, ()) {
    const SymmetryType type =
        *rc::gen::element(SymmetryType::mirror, SymmetryType::inversion, SymmetryType::half_turn);
    const int pairs = *rc::gen::inRange(1, 7);
    PointSet points = planted_involution(type, pairs, *rc::gen::inRange(0, 5), *rc::gen::inRange(0, 9),
                                         *rc::gen::arbitrary<std::uint64_t>());
    RC_PRE(points.size() > 1U);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) points.labels.push_back(i / 2 % 3);
    RC_ASSERT(difference_in_any_order(points, BruteForce(points).search()) == "");
}

// Oracle: points in one place with labels of their own are as good as apart. Each point of a shape is there
// three times; the pairs of every symmetry of the shape are then there three times, too.
RC_GTEST_PROP(LabelledPairs, coincident_points_of_different_labels_stay_apart, ()) {
    const int pairs = *rc::gen::inRange(2, 6);
    const PointSet once = planted_involution(SymmetryType::mirror, pairs, 2, *rc::gen::inRange(0, 5),
                                             *rc::gen::arbitrary<std::uint64_t>());
    PointSet thrice;
    for (int label = 0; label < 3; ++label)
        for (const Point& p : once.positions) {
            thrice.positions.push_back(p);
            thrice.labels.push_back(label);
        }
    const DetectResult result = detect(thrice, exact_options());
    RC_ASSERT(result.points.size() == thrice.size());
    const auto is_planted = [&](const Symmetry& s) {
        return s.type == SymmetryType::mirror && s.cycles.size() == 3 * static_cast<std::size_t>(pairs);
    };
    RC_ASSERT(std::any_of(result.symmetries.begin(), result.symmetries.end(), is_planted));
    for (const Symmetry& s : result.symmetries)
        RC_ASSERT(std::isfinite(s.significance) && std::isfinite(s.deviation.max));
}

}  // namespace insym::property
