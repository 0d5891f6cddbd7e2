// Oracle: the definition of labels: entities have one label where they are of one sort and no gap of more
// than the tolerance parts their values; numbers follow the values. Known answers, and changes that must not
// matter.
#include "insym/entity_labels.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace insym {
namespace {

Entity hole(double radius, double area = 100) {
    Entity entity{EntityKind::face, 1, "cylinder"};
    entity.role = EntityRole::hole;
    entity.radius = radius;
    entity.area = area;
    return entity;
}

Entity line(double length) {
    Entity entity{EntityKind::edge, 1, "line"};
    entity.length = length;
    return entity;
}

TEST(EntityLabels, SizesAreToldApartAndRoundingIsNot) {
    const std::vector<Entity> entities = {hole(3.2), hole(3.3), hole(3.2000001), line(5), hole(3.2, 120), {}};
    EXPECT_EQ(label_entities(entities), (std::vector{2, 4, 2, 1, 3, 0}));
    EXPECT_EQ(label_entities(entities, {LabelBy::entity, 0.05}), (std::vector{2, 2, 2, 1, 3, 0}));
    EXPECT_EQ(label_entities(entities, {LabelBy::entity, 0}), (std::vector{2, 5, 4, 1, 3, 0}));
    EXPECT_EQ(label_entities(entities, {LabelBy::kind}), (std::vector{2, 2, 2, 1, 2, 0}));
    EXPECT_TRUE(label_entities(entities, {LabelBy::none}).empty());
}

TEST(EntityLabels, RoleAndGeometryPart) {
    Entity boss = hole(3);
    boss.role = EntityRole::boss;
    Entity cone = hole(3);
    cone.geometry = "cone";
    const std::vector<int> labels = label_entities({hole(3), boss, cone, hole(3)});
    EXPECT_EQ(labels[0], labels[3]);
    EXPECT_NE(labels[0], labels[1]);
    EXPECT_NE(labels[0], labels[2]);
    EXPECT_NE(labels[1], labels[2]);
}

// Any order of the entities gives each the same label; so does a scale other than 1, as the tolerance is a
// share.
TEST(EntityLabels, OrderAndScaleDoNotMatter) {
    std::mt19937 random(7);
    std::lognormal_distribution<double> any(0, 2);
    std::vector<Entity> entities;
    for (int i = 0; i < 200; ++i)
        entities.push_back(i % 2 == 0 ? line(any(random)) : hole(any(random), any(random)));
    const std::vector<int> labels = label_entities(entities);
    EXPECT_GT(*std::max_element(labels.begin(), labels.end()), 20);

    std::vector<std::size_t> order(entities.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Entity> others;
    for (const std::size_t i : order) {
        others.push_back(entities[i]);
        for (auto* value : {&others.back().radius, &others.back().length, &others.back().area})
            if (*value) **value *= 1024;
    }
    const std::vector<int> again = label_entities(others);
    for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(again[k], labels[order[k]]) << k;
}

TEST(EntityLabels, ToleranceOutOfRange) {
    for (const double bad : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(label_entities({}, {LabelBy::entity, bad}), Error) << bad;
}

}  // namespace
}  // namespace insym
