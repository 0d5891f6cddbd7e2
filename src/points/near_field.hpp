// How far the nearest point is, all over the box of a set, roughly: "is there one within this reach?",
// without a search.
#pragma once

#include "insym/isometry.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace insym {

/// The distance from the middle of each cell of a grid to the nearest point. Immutable after construction,
/// thread-safe. Memory: 32,768 cells of 4 bytes, about. Time: cells * points, so it is for small sets that
/// are asked very often.
class NearField {
public:
    explicit NearField(const std::vector<Point>& positions);

    /// A point whose image may have a point of the set within the reach, or surely has one.
    struct Near {
        int point = 0;
        bool surely = false;
    };
    /// Sets `out` to those points, ascending. In single precision, which the cells allow for. O(points), a
    /// few cycles for each.
    void images_near(const Isometry& isometry, double reach, std::vector<Near>& out) const;

private:
    void fill_layer(std::size_t x, const std::vector<Point>& positions);
    /// The middle of a cell, the border counted.
    double middle(std::size_t cell, std::size_t axis) const {
        return origin_[axis] + (static_cast<double>(cell) - static_cast<double>(kBorder) + 0.5) * cell_;
    }
    std::size_t count(std::size_t axis) const { return static_cast<std::size_t>(last_[axis]) + 1; }

    static constexpr std::size_t kBorder = 1;  // cells outside on either side, about which nothing is said

    Point origin_{};
    double cell_ = 1;
    double slack_ = 0;                    // half the diagonal of a cell, and the rounding
    std::array<float, 3> last_{0, 0, 0};  // of the cells along each axis
    std::vector<float> x_, y_, z_;        // of the points, in cells
    std::vector<float> distance_;         // NaN in the border
};

}  // namespace insym
