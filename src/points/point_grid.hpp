// A uniform grid over a fixed set of points: "which points lie within r of here?"
#pragma once

#include "insym/point_set.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace insym {

/// Immutable after construction; queries are thread-safe. Memory linear in the points. A query
/// costs the number of grid cells that the ball touches plus the points in them; it is made for
/// balls of about the grid's cell or smaller. (nanoflann, a k-d tree, was several times
/// slower for the small balls of the detector, most of which are empty.)
class PointGrid {
public:
    /// `cell` > 0 fixes the size of a cell; 0: about one point in a cell.
    explicit PointGrid(const std::vector<Point>& positions, double cell = 0);

    /// Calls visit(index, distance squared) for every point within `radius` of `p`, cell by cell;
    /// stops as soon as visit returns false.
    template <class Visit>
    void visit_ball(const Point& p, double radius, Visit visit) const {
        int low[3];
        int high[3];
        for (std::size_t k = 0; k < 3; ++k) {
            // Written so that NaN leaves, too.
            if (!(p[k] + radius >= origin_[k] && p[k] - radius <= top_[k])) return;
            low[k] = p[k] - radius <= origin_[k] ? 0 : cell_of(p[k] - radius, k);
            high[k] = p[k] + radius >= top_[k] ? count_[k] - 1 : cell_of(p[k] + radius, k);
        }
        const double limit = radius * radius;
        for (int x = low[0]; x <= high[0]; ++x)
            for (int y = low[1]; y <= high[1]; ++y) {
                const std::int64_t row = (std::int64_t{x} * count_[1] + y) * count_[2];
                const int end = start_[static_cast<std::size_t>(row + high[2] + 1)];
                for (int s = start_[static_cast<std::size_t>(row + low[2])]; s < end; ++s) {
                    const Point& q = sorted_[static_cast<std::size_t>(s)];
                    const double dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
                    const double square = dx * dx + dy * dy + dz * dz;
                    if (square <= limit && !visit(index_[static_cast<std::size_t>(s)], square)) return;
                }
            }
    }

    /// True if a point lies within `radius` of `p`.
    bool any_within(const Point& p, double radius) const {
        bool found = false;
        visit_ball(p, radius, [&](int, double) {
            found = true;
            return false;
        });
        return found;
    }

private:
    int cell_of(double x, std::size_t axis) const {
        const auto c = static_cast<int>((x - origin_[axis]) * inverse_cell_);
        return c < count_[axis] ? c : count_[axis] - 1;
    }

    Point origin_{};
    Point top_{};
    double inverse_cell_ = 0;
    int count_[3] = {1, 1, 1};
    std::vector<int> start_;     // of each cell in sorted_, and the end
    std::vector<int> index_;     // of the sorted points in the input
    std::vector<Point> sorted_;  // by cell
};

}  // namespace insym
