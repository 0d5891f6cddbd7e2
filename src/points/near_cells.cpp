#include "points/near_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace insym {
namespace {

constexpr double kMostCells = 1 << 22;
constexpr double kCellsForEach = 512;  // point; of 27 cells about each then hardly a twentieth are near
constexpr int kBorder = 2;  // cells outside on either side: one that may be near and one that is not

}  // namespace

NearCells::NearCells(const std::vector<Point>& positions) {
    if (positions.empty()) return;
    Point top = origin_ = positions.front();
    for (const Point& p : positions)
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k] = std::min(origin_[k], p[k]);
            top[k] = std::max(top[k], p[k]);
        }
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, top[k] - origin_[k]);

    // From a cell so small that a rounding may not cross it to as many cells as are allowed.
    const auto count = [&](std::size_t k) {
        return std::floor((top[k] - origin_[k]) / cell_) + 1 + 2 * kBorder;
    };
    cell_ = longest > 0 ? 1e-3 * longest : 1;
    const double most = std::min(kMostCells, kCellsForEach * static_cast<double>(positions.size()) + 4096);
    while (count(0) * count(1) * count(2) > most) cell_ *= 1.1;
    for (std::size_t k = 0; k < 3; ++k) last_[k] = static_cast<float>(count(k) - 1);
    row_ = static_cast<float>(count(2));
    layer_ = static_cast<float>(count(1) * count(2));
    largest_reach_ = cell_ - 1e-5 * longest;

    bits_.assign(static_cast<std::size_t>(count(0) * count(1) * count(2)) / 64 + 1, 0);
    for (const Point& p : positions) {
        const auto place = [&](std::size_t k) {
            return static_cast<float>((p[k] - origin_[k]) / cell_ + kBorder);
        };
        x_.push_back(place(0));
        y_.push_back(place(1));
        z_.push_back(place(2));
        for (const float dx : {-1.0F, 0.0F, 1.0F})
            for (const float dy : {-1.0F, 0.0F, 1.0F})
                for (const float dz : {-1.0F, 0.0F, 1.0F}) {
                    const auto at =
                        static_cast<std::size_t>(cell(x_.back() + dx, y_.back() + dy, z_.back() + dz));
                    bits_[at / 64] |= std::uint64_t{1} << (at % 64);
                }
    }
}

/// Outside, one of the last cells, which are never near. Exact up to 2^24 cells.
inline int NearCells::cell(float x, float y, float z) const {
    const auto along = [&](float v, int axis) {
        return static_cast<float>(static_cast<int>(std::min(std::max(v, 0.0F), last_[axis])));
    };
    return static_cast<int>(along(x, 0) * layer_ + along(y, 1) * row_ + along(z, 2));
}

void NearCells::images_near(const Isometry& isometry, std::vector<int>& out) const {
    // The isometry in cells: it takes the corner of cell 0 there.
    Point corner = origin_;
    for (double& c : corner) c -= kBorder * cell_;
    const Point image = isometry.apply(corner);
    float m[3][3], t[3];
    for (std::size_t i = 0; i < 3; ++i) {
        t[i] = static_cast<float>((image[i] - corner[i]) / cell_);
        for (std::size_t j = 0; j < 3; ++j) m[i][j] = static_cast<float>(isometry.linear[i][j]);
    }
    // All cells of a block first, many at a time, then the bits, without a branch.
    constexpr std::size_t kBlock = 256;
    int cells[kBlock];
    out.resize(x_.size() + 1);
    std::size_t count = 0;
    for (std::size_t begin = 0; begin < x_.size(); begin += kBlock) {
        const std::size_t block = std::min(kBlock, x_.size() - begin);
        const float *x = x_.data() + begin, *y = y_.data() + begin, *z = z_.data() + begin;
        for (std::size_t i = 0; i < block; ++i)
            cells[i] = cell(m[0][0] * x[i] + m[0][1] * y[i] + m[0][2] * z[i] + t[0],
                            m[1][0] * x[i] + m[1][1] * y[i] + m[1][2] * z[i] + t[1],
                            m[2][0] * x[i] + m[2][1] * y[i] + m[2][2] * z[i] + t[2]);
        for (std::size_t i = 0; i < block; ++i) {
            const auto at = static_cast<std::size_t>(cells[i]);
            out[count] = static_cast<int>(begin + i);
            count += bits_[at / 64] >> (at % 64) & 1U;
        }
    }
    out.resize(count);
}

}  // namespace insym
