// Where a set has points at all: "is there surely none near here?", quickly, for the images of the whole set.
#pragma once

#include "insym/isometry.hpp"

#include <cstdint>
#include <vector>

#include "points/image_cells.hpp"

namespace insym {

/// Marks the cells of a fine grid that hold a point, and those around them. Immutable after construction,
/// thread-safe. At most 2^22 cells, a bit each.
class NearCells {
public:
    /// `positions` is not empty.
    explicit NearCells(const std::vector<Point>& positions);

    /// Up to this distance the question may be asked.
    double largest_reach() const { return largest_reach_; }

    /// Sets `out` to the points, ascending, but those that the isometry takes to where no point lies within
    /// largest_reach(). In single precision, which the reach allows for. O(points), a few cycles for each.
    void images_near(const Isometry& isometry, std::vector<int>& out) const;

private:
    ImageCells cells_;  // of which the outermost are empty
    double largest_reach_ = 0;
    std::vector<std::uint64_t> bits_;
};

}  // namespace insym
