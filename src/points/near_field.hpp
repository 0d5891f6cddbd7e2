// How far the nearest point is, all over the box of a set, roughly: "is there one within this reach?",
// without a search.
#pragma once

#include "insym/isometry.hpp"

#include <cstddef>
#include <vector>

#include "points/image_cells.hpp"

namespace insym {

/// The distance from the middle of each cell of a grid to the nearest point. Immutable after construction,
/// thread-safe. Memory: 32,768 cells of 4 bytes, about. Time: cells * points, so it is for small sets that
/// are asked very often.
class NearField {
public:
    /// `positions` is not empty.
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

    ImageCells cells_;
    double slack_ = 0;             // half the diagonal of a cell, and the rounding
    std::vector<float> distance_;  // NaN in the border, about which nothing is said
};

}  // namespace insym
