#include "points/near_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel_for.hpp"

namespace insym {
namespace {

constexpr double kMostCells = 1 << 15;
constexpr std::size_t kBorder = 1;

}  // namespace

NearField::NearField(const std::vector<Point>& positions)
    : cells_(positions, kMostCells, kBorder),
      slack_(std::sqrt(3.0) / 2 * cells_.cell_size() + 1e-5 * cells_.longest_side()),
      distance_(cells_.size(), std::numeric_limits<float>::quiet_NaN()) {
    parallel_for(cells_.count(0) - 2 * kBorder, [&](std::size_t x) { fill_layer(x + kBorder, positions); });
}

void NearField::fill_layer(std::size_t x, const std::vector<Point>& positions) {
    const std::size_t length = cells_.count(2) - 2 * kBorder;
    const auto step = static_cast<float>(cells_.cell_size());
    for (std::size_t y = kBorder; y + kBorder < cells_.count(1); ++y) {
        float* const row = distance_.data() + (x * cells_.count(1) + y) * cells_.count(2) + kBorder;
        std::fill_n(row, length, std::numeric_limits<float>::infinity());
        for (const Point& p : positions) {
            const double dx = p[0] - cells_.middle(x, 0), dy = p[1] - cells_.middle(y, 1);
            const auto square = static_cast<float>(dx * dx + dy * dy);
            const auto first = static_cast<float>(cells_.middle(kBorder, 2) - p[2]);
            for (std::size_t z = 0; z < length; ++z) {
                const float dz = first + step * static_cast<float>(static_cast<int>(z));
                const float here = square + dz * dz;
                row[z] = here < row[z] ? here : row[z];
            }
        }
        for (std::size_t z = 0; z < length; ++z) row[z] = std::sqrt(row[z]);
    }
}

void NearField::images_near(const Isometry& isometry, double reach, std::vector<Near>& out) const {
    const auto least = static_cast<float>(reach - slack_), most = static_cast<float>(reach + slack_);
    out.resize(cells_.points() + 1);
    std::size_t found = 0;
    // Without a branch; the border is neither near nor far.
    cells_.visit_images(isometry, [&](int point, std::size_t cell) {
        out[found] = {point, distance_[cell] <= least};
        found += distance_[cell] > most ? 0 : 1;
    });
    out.resize(found);
}

}  // namespace insym
