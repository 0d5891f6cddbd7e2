#include "points/near_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
    const auto count_of = [&](std::size_t k) {
        return std::floor((top[k] - origin_[k]) / cell_) + 1 + 2 * static_cast<double>(kBorder);
    };
    cell_ = 1e-3 * longest;
    while (count_of(0) * count_of(1) * count_of(2) > kMostCells) cell_ *= 1.1;
    for (std::size_t k = 0; k < 3; ++k) last_[k] = static_cast<float>(count_of(k) - 1);
    // In single precision a place is off by less than the last term.
    slack_ = std::sqrt(3.0) / 2 * cell_ + 1e-5 * longest;
    for (const Point& p : positions) {
        const auto place = [&](std::size_t k) {
            return static_cast<float>((p[k] - origin_[k]) / cell_ + static_cast<double>(kBorder));
        };
        x_.push_back(place(0));
        y_.push_back(place(1));
        z_.push_back(place(2));
    }
    distance_.assign(count(0) * count(1) * count(2), std::numeric_limits<float>::quiet_NaN());
    parallel_for(count(0) - 2 * kBorder, [&](std::size_t x) { fill_layer(x + kBorder, positions); });
}

void NearField::fill_layer(std::size_t x, const std::vector<Point>& positions) {
    const std::size_t length = count(2) - 2 * kBorder;
    const auto step = static_cast<float>(cell_);
    for (std::size_t y = kBorder; y + kBorder < count(1); ++y) {
        float* const row = distance_.data() + (x * count(1) + y) * count(2) + kBorder;
        std::fill_n(row, length, std::numeric_limits<float>::infinity());
        for (const Point& p : positions) {
            const double dx = p[0] - middle(x, 0), dy = p[1] - middle(y, 1);
            const auto square = static_cast<float>(dx * dx + dy * dy);
            const auto first = static_cast<float>(middle(kBorder, 2) - p[2]);
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
    // The isometry in cells: it takes the corner of cell 0 there.
    Point corner = origin_;
    for (double& c : corner) c -= static_cast<double>(kBorder) * cell_;
    const Point image = isometry.apply(corner);
    float m[3][3], t[3];
    for (std::size_t i = 0; i < 3; ++i) {
        t[i] = static_cast<float>((image[i] - corner[i]) / cell_);
        for (std::size_t j = 0; j < 3; ++j) m[i][j] = static_cast<float>(isometry.linear[i][j]);
    }
    const auto least = static_cast<float>(reach - slack_), most = static_cast<float>(reach + slack_);
    const auto row = static_cast<float>(count(2)), layer = static_cast<float>(count(1) * count(2));
    // Many cells at a time first, then what is in them, without a branch.
    constexpr std::size_t kBlock = 256;
    int cells[kBlock];
    out.resize(x_.size() + 1);
    std::size_t found = 0;
    for (std::size_t begin = 0; begin < x_.size(); begin += kBlock) {
        const std::size_t block = std::min(kBlock, x_.size() - begin);
        const float *x = x_.data() + begin, *y = y_.data() + begin, *z = z_.data() + begin;
        const auto along = [&](float v, std::size_t axis) {
            return static_cast<float>(static_cast<int>(std::min(std::max(v, 0.0F), last_[axis])));
        };
        for (std::size_t i = 0; i < block; ++i)
            cells[i] =
                static_cast<int>(along(m[0][0] * x[i] + m[0][1] * y[i] + m[0][2] * z[i] + t[0], 0) * layer +
                                 along(m[1][0] * x[i] + m[1][1] * y[i] + m[1][2] * z[i] + t[1], 1) * row +
                                 along(m[2][0] * x[i] + m[2][1] * y[i] + m[2][2] * z[i] + t[2], 2));
        for (std::size_t i = 0; i < block; ++i) {
            const float distance = distance_[static_cast<std::size_t>(cells[i])];
            out[found] = {static_cast<int>(begin + i), distance <= least};
            found += distance > most ? 0 : 1;  // in the border neither
        }
    }
    out.resize(found);
}

}  // namespace insym
