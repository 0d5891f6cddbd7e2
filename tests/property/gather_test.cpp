// What a hypothesis gathers from the whole set.
//
// Oracle: what was built: a row of copies of scattered points is a translation, whatever was taken it for.
#include "insym/point_set.hpp"

#include <Eigen/Geometry>
#include <random>

#include <gtest/gtest.h>

#include "points/cloud.hpp"
#include "points/diameter.hpp"
#include "support/support.hpp"

namespace insym::property {
namespace {

using Eigen::Vector3d;

constexpr int kCopies = 9, kPoints = 20;

PointSet row_of_copies(const Vector3d& step) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> within(-1, 1);
    PointSet set;
    set.dimension = 3;
    for (int k = 0; k < kPoints; ++k) {
        const Vector3d p(3 * within(random), within(random), 2 * within(random));
        for (int copy = 0; copy < kCopies; ++copy) {
            const Vector3d q = p + copy * step;
            set.positions.push_back({q.x(), q.y(), q.z()});
        }
    }
    return set;
}

void expect_translation(const Vector3d& step) {
    const PointSet set = row_of_copies(step);
    const double diameter = insym::diameter(set.positions);
    const PointScene scene{set, diameter, 1e-6 * diameter, 0.1 * diameter};
    const Cloud cloud(scene);
    const Significance significance(scene);
    const Gatherer gatherer(cloud, significance, 0.02 * diameter);
    for (const double angle : {1e-9, 1e-6, 1e-4}) {
        Hypothesis h;
        h.type = SymmetryType::rotation;
        h.map.linear = Eigen::AngleAxisd(angle, step.unitOrthogonal()).toRotationMatrix();
        h.map.shift = step;
        h.off = 1e-3;
        h.radius = 4;
        const std::optional<Support> found = gatherer.gather(h, 0);
        ASSERT_TRUE(found) << angle;
        EXPECT_EQ(found->type, SymmetryType::translation) << angle;
        EXPECT_EQ(found->links.size(), static_cast<std::size_t>(kPoints * (kCopies - 1))) << angle;
        EXPECT_LT((found->map.shift - step).norm(), 1e-9) << angle;
    }
}

// The axis of such a turn may come out in any direction, along the row too.
TEST(Gather, ATurnOfNextToNothingOnARowIsItsTranslation) {
    for (const Vector3d& step :
         {Vector3d(2.5, 0, 0), Vector3d(0, 2.5, 0), Vector3d(0, 0, 2.5), Vector3d(1, 2, -1)})
        expect_translation(step);
}

}  // namespace
}  // namespace insym::property
