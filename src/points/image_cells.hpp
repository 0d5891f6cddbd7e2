// The cells of a grid that the images of a fixed set of points fall in, many at a time.
#pragma once

#include "insym/isometry.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace insym {

/// A grid over the box of a set, with a border of cells on either side. In single precision: a place is off
/// by less than 1e-5 of the longest side, and cells are told exactly up to 2^24 of them. Immutable after
/// construction, thread-safe.
class ImageCells {
public:
    /// At most about `most_cells` cells, as small as that allows, but no smaller than a thousandth of the
    /// longest side. `positions` is not empty.
    ImageCells(const std::vector<Point>& positions, double most_cells, int border);

    double cell_size() const { return cell_; }
    double longest_side() const { return longest_; }
    std::size_t count(std::size_t axis) const { return static_cast<std::size_t>(last_[axis]) + 1; }
    std::size_t size() const { return count(0) * count(1) * count(2); }
    std::size_t points() const { return places_[0].size(); }
    /// Of a point, in cells.
    float place(std::size_t point, std::size_t axis) const { return places_[axis][point]; }
    double middle(std::size_t cell, std::size_t axis) const {
        return corner_[axis] + (static_cast<double>(cell) + 0.5) * cell_;
    }

    /// Of a place outside, one of the outermost.
    int cell(float x, float y, float z) const {
        const auto along = [&](float v, std::size_t axis) {
            return static_cast<float>(static_cast<int>(std::min(std::max(v, 0.0F), last_[axis])));
        };
        return static_cast<int>(along(x, 0) * layer_ + along(y, 1) * row_ + along(z, 2));
    }

    /// Calls visit(point, cell of its image) for all points, in order. A few cycles for each.
    template <class Visit>
    void visit_images(const Isometry& isometry, Visit visit) const {
        // The isometry in cells: it takes the corner of cell 0 there.
        const Point image = isometry.apply(corner_);
        float m[3][3], t[3];
        for (std::size_t i = 0; i < 3; ++i) {
            t[i] = static_cast<float>((image[i] - corner_[i]) / cell_);
            for (std::size_t j = 0; j < 3; ++j) m[i][j] = static_cast<float>(isometry.linear[i][j]);
        }
        // All cells of a block first, many at a time.
        constexpr std::size_t kBlock = 256;
        int cells[kBlock];
        for (std::size_t begin = 0; begin < points(); begin += kBlock) {
            const std::size_t block = std::min(kBlock, points() - begin);
            const float *x = places_[0].data() + begin, *y = places_[1].data() + begin,
                        *z = places_[2].data() + begin;
            for (std::size_t i = 0; i < block; ++i)
                cells[i] = cell(m[0][0] * x[i] + m[0][1] * y[i] + m[0][2] * z[i] + t[0],
                                m[1][0] * x[i] + m[1][1] * y[i] + m[1][2] * z[i] + t[1],
                                m[2][0] * x[i] + m[2][1] * y[i] + m[2][2] * z[i] + t[2]);
            for (std::size_t i = 0; i < block; ++i)
                visit(static_cast<int>(begin + i), static_cast<std::size_t>(cells[i]));
        }
    }

private:
    Point corner_{};  // of cell 0
    double longest_ = 0;
    double cell_ = 1;
    std::array<float, 3> last_{0, 0, 0};  // of the cells along each axis
    float row_ = 0;                       // cells of z
    float layer_ = 0;                     // cells of y and z
    std::array<std::vector<float>, 3> places_;
};

}  // namespace insym
