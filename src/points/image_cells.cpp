#include "points/image_cells.hpp"

#include <cmath>

namespace insym {

ImageCells::ImageCells(const std::vector<Point>& positions, double most_cells, int border) {
    Point low = positions.front(), top = low;
    for (const Point& p : positions)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            top[k] = std::max(top[k], p[k]);
        }
    for (std::size_t k = 0; k < 3; ++k) longest_ = std::max(longest_, top[k] - low[k]);
    const auto count_of = [&](std::size_t k) {
        return std::floor((top[k] - low[k]) / cell_) + 1 + 2 * border;
    };
    cell_ = longest_ > 0 ? 1e-3 * longest_ : 1;
    while (count_of(0) * count_of(1) * count_of(2) > most_cells) cell_ *= 1.1;
    for (std::size_t k = 0; k < 3; ++k) last_[k] = static_cast<float>(count_of(k) - 1);
    row_ = static_cast<float>(count_of(2));
    layer_ = static_cast<float>(count_of(1) * count_of(2));
    for (std::size_t k = 0; k < 3; ++k) {
        corner_[k] = low[k] - border * cell_;
        for (const Point& p : positions)
            places_[k].push_back(static_cast<float>((p[k] - low[k]) / cell_ + border));
    }
}

}  // namespace insym
