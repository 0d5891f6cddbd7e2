#include "points/near_field.hpp"

#include <algorithm>
#include <cmath>

#include "parallel_for.hpp"

namespace insym {

NearField::NearField(const std::vector<Point>& positions) {
    constexpr double kMostCells = 1 << 15;
    if (positions.empty()) return;
    Point top = origin_ = positions.front();
    for (const Point& p : positions)
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k] = std::min(origin_[k], p[k]);
            top[k] = std::max(top[k], p[k]);
        }
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, top[k] - origin_[k]);
    if (!(longest > 0)) longest = 1;
    const auto count = [&](std::size_t k) { return std::floor((top[k] - origin_[k]) / cell_) + 1; };
    cell_ = 1e-3 * longest;
    while (count(0) * count(1) * count(2) > kMostCells) cell_ *= 1.1;
    inverse_cell_ = 1 / cell_;
    for (std::size_t k = 0; k < 3; ++k) count_[k] = count(k);
    // In single precision a distance is off by less than the last term.
    slack_ = std::sqrt(3.0) / 2 * cell_ + 1e-5 * longest;
    distance_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    parallel_for(static_cast<std::size_t>(count_[0]), [&](std::size_t x) { fill_layer(x, positions); });
}

void NearField::fill_layer(std::size_t x, const std::vector<Point>& positions) {
    const auto rows = static_cast<std::size_t>(count_[1]), length = static_cast<std::size_t>(count_[2]);
    for (std::size_t y = 0; y < rows; ++y) {
        float* const row = distance_.data() + (x * rows + y) * length;
        std::fill_n(row, length, std::numeric_limits<float>::infinity());
        for (const Point& p : positions) {
            const double dx = p[0] - middle(x, 0), dy = p[1] - middle(y, 1);
            const auto square = static_cast<float>(dx * dx + dy * dy);
            const auto first = static_cast<float>(middle(0, 2) - p[2]), step = static_cast<float>(cell_);
            for (std::size_t z = 0; z < length; ++z) {
                const float dz = first + step * static_cast<float>(static_cast<int>(z));
                const float here = square + dz * dz;
                row[z] = here < row[z] ? here : row[z];
            }
        }
        for (std::size_t z = 0; z < length; ++z) row[z] = std::sqrt(row[z]);
    }
}

}  // namespace insym
