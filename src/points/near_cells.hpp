// Where a set has points at all: "is there surely none near here?", quickly, for the images of the whole set.
#pragma once

#include "insym/isometry.hpp"

#include <cstdint>
#include <vector>

namespace insym {

/// Marks the cells of a fine grid that hold a point, and those around them. Immutable after construction,
/// thread-safe. At most 2^22 cells, a bit each.
class NearCells {
public:
    explicit NearCells(const std::vector<Point>& positions);

    /// Up to this distance the question may be asked.
    double largest_reach() const { return largest_reach_; }

    /// Sets `out` to the points, ascending, but those that the isometry takes to where no point lies within
    /// largest_reach(). In single precision, which the reach allows for. O(points), a few cycles for each.
    void images_near(const Isometry& isometry, std::vector<int>& out) const;

private:
    int cell(float x, float y, float z) const;

    std::vector<float> x_, y_, z_;  // of the points, in cells
    Point origin_{};
    double largest_reach_ = 0;
    double cell_ = 1;
    float last_[3] = {0, 0, 0};  // of the cells along each axis, which are empty, as are the first
    float row_ = 0;              // cells of z
    float layer_ = 0;            // cells of y and z
    std::vector<std::uint64_t> bits_;
};

}  // namespace insym
