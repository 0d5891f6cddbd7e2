// Which points stand for the others once the exact symmetries are known.
//
// Oracle: what was built: a row of copies of scattered points, whose translation carries each point to its
// copies.
#include "support/representatives.hpp"

#include "insym/point_set.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "points/diameter.hpp"

namespace insym::property {
namespace {

constexpr int kCopies = 12, kPoints = 20, kScattered = 30;

/// Copies of scattered points in a row along x, copy by copy, and points that are of none.
struct Row {
    PointSet set;
    PointScene scene;
    Cloud cloud;
    Support translation;

    Row() : set(made()), scene(scene_of(set)), cloud(scene) {
        translation.type = SymmetryType::translation;
        translation.significance = -100;
        for (int i = 0; i + kPoints < kCopies * kPoints; ++i) translation.links.emplace_back(i, i + kPoints);
    }

    static PointSet made() {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> within(0, 1);
        std::vector<Point> pattern(kPoints);
        for (Point& p : pattern) p = {within(random), 3 * within(random), within(random)};
        PointSet out;
        out.dimension = 3;
        for (int copy = 0; copy < kCopies; ++copy)
            for (const Point& p : pattern) out.positions.push_back({p[0] + copy, p[1], p[2]});
        for (int k = 0; k < kScattered; ++k)
            out.positions.push_back({12 * within(random), 5 + within(random), within(random)});
        return out;
    }
    static PointScene scene_of(const PointSet& set) {
        const double diameter = insym::diameter(set.positions);
        return {set, diameter, 1e-6 * diameter, 0.1 * diameter};
    }
    std::vector<int> everything() const {
        std::vector<int> all;
        for (int i = 0; i < cloud.size(); ++i) all.push_back(i);
        return all;
    }
};

TEST(Representatives, AQuarterOfEachOrbitAtItsEndsAndWhatIsOfNone) {
    const Row row;
    std::vector<int> expected;
    for (int i = 0; i < row.cloud.size(); ++i) {
        const int copy = i / kPoints;
        // Three of twelve: both ends, and of the next two the first.
        if (copy <= 1 || copy >= kCopies - 1) expected.push_back(i);
    }
    EXPECT_EQ(representatives(row.cloud, {row.translation}, 4, Stay::outer), expected);
}

TEST(Representatives, OrTheOnesInTheMiddle) {
    const Row row;
    std::vector<int> expected;
    for (int i = 0; i < row.cloud.size(); ++i) {
        const int copy = i / kPoints;
        // Three of twelve: the two in the middle, and of the next two the first; and what is scattered.
        if ((copy >= kCopies / 2 - 2 && copy <= kCopies / 2) || copy >= kCopies) expected.push_back(i);
    }
    EXPECT_EQ(representatives(row.cloud, {row.translation}, 4, Stay::inner), expected);
}

TEST(Representatives, WhatIsNotExactOrNotSureStandsForNothing) {
    Row row;
    row.translation.tolerance = 1e-3;
    EXPECT_EQ(representatives(row.cloud, {row.translation}, 4, Stay::outer), row.everything());
    row.translation.tolerance = 0;
    row.translation.significance = -1;
    EXPECT_EQ(representatives(row.cloud, {row.translation}, 4, Stay::outer), row.everything());
    EXPECT_EQ(representatives(row.cloud, {}, 4, Stay::outer), row.everything());
}

}  // namespace
}  // namespace insym::property
