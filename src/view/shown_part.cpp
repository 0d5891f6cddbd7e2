#include "view/shown_part.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace insym {

DetectResult shown_part(const DetectResult& result, int limit) {
    DetectResult part;
    part.status = result.status;
    part.options = result.options;
    part.points = result.points;
    part.diameter = result.diameter;
    part.resolution = result.resolution;
    part.max_tolerance = result.max_tolerance;
    part.merged_points = result.merged_points;
    const std::size_t count = limit == 0
                                  ? result.symmetries.size()
                                  : std::min(result.symmetries.size(), static_cast<std::size_t>(limit));
    part.symmetries.assign(result.symmetries.begin(),
                           result.symmetries.begin() + static_cast<std::ptrdiff_t>(count));
    part.group = result.group;
    part.stats = result.stats;
    part.timing = result.timing;
    part.diagnostics = result.diagnostics;
    return part;
}

Point middle_of(const DetectResult& result, const Tessellation& model) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Point low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar}, middle{};
    const auto add = [&](const Point& p) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    };
    std::for_each(result.points.positions.begin(), result.points.positions.end(), add);
    std::for_each(model.vertices.begin(), model.vertices.end(), add);
    for (std::size_t k = 0; k < 3; ++k) middle[k] = low[k] <= high[k] ? low[k] / 2 + high[k] / 2 : 0;
    return middle;
}

}  // namespace insym
