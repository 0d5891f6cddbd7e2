// How far the nearest point is, all over the box of a set, roughly: "is there one within this reach?",
// without a search.
#pragma once

#include "insym/point_set.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace insym {

/// The distance from the middle of each cell of a grid to the nearest point. Immutable after construction,
/// thread-safe. Memory: 32,768 cells of 4 bytes, about. Time: cells * points, so it is for small sets that
/// are asked very often.
class NearField {
public:
    explicit NearField(const std::vector<Point>& positions);

    /// Between which distances the nearest point to `p` is. Anything outside the box.
    struct Bounds {
        double low = 0;
        double high = std::numeric_limits<double>::infinity();
    };
    Bounds nearest(const Point& p) const {
        std::size_t cell = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double place = (p[k] - origin_[k]) * inverse_cell_;
            if (!(place >= 0 && place < count_[k])) return {};
            cell = cell * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(place);
        }
        const double middle = distance_[cell];
        return {middle - slack_, middle + slack_};
    }

private:
    void fill_layer(std::size_t x, const std::vector<Point>& positions);
    double middle(std::size_t cell, std::size_t axis) const {
        return origin_[axis] + (static_cast<double>(cell) + 0.5) * cell_;
    }

    Point origin_{};
    double cell_ = 1;
    double inverse_cell_ = 1;
    double slack_ = 0;  // half the diagonal of a cell, and the rounding
    std::array<double, 3> count_{1, 1, 1};
    std::vector<float> distance_;
};

}  // namespace insym
