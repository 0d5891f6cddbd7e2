#include "points/merge.hpp"

#include "points/point_grid.hpp"

namespace insym {

PointSet merge_equal_points(const PointSet& points, double resolution) {
    const PointGrid grid(points.positions);
    const auto label = [&](std::size_t i) { return points.labels.empty() ? 0 : points.labels[i]; };
    std::vector<char> kept(points.size(), 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!kept[i]) continue;
        grid.visit_ball(points.positions[i], resolution, [&](int other, double) {
            const auto j = static_cast<std::size_t>(other);
            if (j > i && label(j) == label(i)) kept[j] = 0;
            return true;
        });
    }

    PointSet merged;
    merged.dimension = points.dimension;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!kept[i]) continue;
        merged.positions.push_back(points.positions[i]);
        if (!points.labels.empty()) merged.labels.push_back(points.labels[i]);
        if (!points.entities.empty()) merged.entities.push_back(points.entities[i]);
    }
    return merged;
}

}  // namespace insym
