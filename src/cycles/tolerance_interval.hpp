// The tolerances at which distance orbits are told apart (definitions, section 3).
#pragma once

#include "insym/detect.hpp"

#include <limits>
#include <span>

namespace insym {

/// The lowest and the highest distance of an orbit.
struct Span {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    bool empty() const { return low > high; }
    double spread() const { return high - low; }
    void include(double d) {
        if (d < low) low = d;
        if (d > high) high = d;
    }
    void include(const Span& other) {
        if (other.low < low) low = other.low;
        if (other.high > high) high = other.high;
    }
};

/// E_min and E_max of the orbits `spans`, none of them empty: the least eps >= `floor` such that
/// every orbit fits in eps and "differs by at most eps" is transitive on all distances, and the
/// least gap between the classes there (infinite with one class). Reorders `spans`. Gives up with
/// min = infinity as soon as E_min is known to exceed `limit`. O(k log k) in the number of spans
/// but for chains of merging classes, O(k^2) at the worst.
ToleranceInterval tolerance_interval(std::span<Span> spans, double floor,
                                     double limit = std::numeric_limits<double>::infinity());

}  // namespace insym
