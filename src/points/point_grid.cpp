#include "points/point_grid.hpp"

#include <algorithm>

namespace insym {

PointGrid::PointGrid(const std::vector<Point>& positions, double cell) {
    if (positions.empty()) {
        start_.assign(2, 0);
        return;
    }
    origin_ = top_ = positions.front();
    for (const Point& p : positions)
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k] = std::min(origin_[k], p[k]);
            top_[k] = std::max(top_[k], p[k]);
        }
    Point extent{};
    for (std::size_t k = 0; k < 3; ++k) extent[k] = top_[k] - origin_[k];
    const double longest = *std::max_element(extent.begin(), extent.end());

    // Start from the asked or a fine cell and coarsen until there are at most about 16n cells.
    const auto n = static_cast<double>(positions.size());
    double size = cell > 0 ? cell : longest / std::max(1.0, n);
    const auto cells = [&](double s) {
        double product = 1;
        for (double e : extent) product *= std::floor(e / s) + 1;
        return product;
    };
    if (!(size > 0)) size = 1;
    while (cells(size) > 16 * n + 8) size *= 1.25;
    inverse_cell_ = 1 / size;
    for (std::size_t k = 0; k < 3; ++k) count_[k] = static_cast<int>(std::floor(extent[k] / size)) + 1;

    std::vector<std::int64_t> home(positions.size());
    start_.assign(static_cast<std::size_t>(std::int64_t{count_[0]} * count_[1] * count_[2]) + 1, 0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Point& p = positions[i];
        home[i] =
            (std::int64_t{cell_of(p[0], 0)} * count_[1] + cell_of(p[1], 1)) * count_[2] + cell_of(p[2], 2);
        ++start_[static_cast<std::size_t>(home[i]) + 1];
    }
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<int> next(start_.begin(), start_.end() - 1);
    index_.resize(positions.size());
    sorted_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(home[i])]++);
        index_[at] = static_cast<int>(i);
        sorted_[at] = positions[i];
    }
}

}  // namespace insym
