// The tolerances at which distance orbits are told apart (definitions, section 3).
#pragma once

#include "insym/detect.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace insym {

/// The lowest and the highest distance of an orbit.
struct Span {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    bool empty() const { return low > high; }
    double spread() const { return high - low; }
    // Without branches, which would be coin tosses.
    void include(double d) {
        low = d < low ? d : low;
        high = d > high ? d : high;
    }
    void include(const Span& other) {
        low = other.low < low ? other.low : low;
        high = other.high > high ? other.high : high;
    }
};

namespace detail {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Joins classes until the tolerance suffices for all. `ends`: the low and the high ends of spans, each
/// sorted for itself; wherever there is a gap after the i-th place, up to there both are the ends of the same
/// spans.
inline ToleranceInterval join_classes(const Span* ends, std::size_t count, double eps, double limit) {
    while (true) {
        // Neighbours that lie at most eps apart are one class, which may take a larger eps; then it takes
        // another round.
        const double before = eps;
        double least_gap = kInfinity;
        double start = ends[0].low;
        for (std::size_t i = 1; i < count; ++i) {
            const double gap = ends[i].low - ends[i - 1].high;
            const bool apart = gap > eps;
            least_gap = std::min(least_gap, apart ? gap : kInfinity);
            start = apart ? ends[i].low : start;
            eps = std::max(eps, ends[i].high - start);
        }
        if (eps > limit) return {kInfinity, kInfinity};
        if (eps == before) return {eps, least_gap};
    }
}

/// For short chains, by far the most: loops of known length and sorting without branches, which would be coin
/// tosses, of both ends at once. Always in line: the spans are in registers where they come from.
template <std::size_t kCount>
[[gnu::always_inline]] inline ToleranceInterval interval_of_few(const Span* spans, double eps, double limit) {
    using Ends = Eigen::Array2d;
    for (std::size_t i = 0; i < kCount; ++i) eps = std::max(eps, spans[i].spread());
    if (eps > limit) return {kInfinity, kInfinity};
    Ends ends[kCount];
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kCount; ++i) {
        ends[i] = Ends(spans[i].low, spans[i].high);
#pragma GCC unroll 8
        for (std::size_t k = i; k > 0; --k) {
            const Ends smaller = ends[k - 1].min(ends[k]);
            ends[k] = ends[k - 1].max(ends[k]);
            ends[k - 1] = smaller;
        }
    }
    Span sorted[kCount];
    for (std::size_t i = 0; i < kCount; ++i) sorted[i] = {ends[i][0], ends[i][1]};
    return join_classes(sorted, kCount, eps, limit);
}

}  // namespace detail

/// E_min and E_max of the orbits `spans`, none of them empty: the least eps >= `floor` such that
/// every orbit fits in eps and "differs by at most eps" is transitive on all distances, and the
/// least gap between the classes there (infinite with one class). Gives up with
/// min = infinity as soon as E_min is known to exceed `limit`. O(k log k) in the number of spans
/// but for chains of merging classes, O(k^2) at the worst.
ToleranceInterval tolerance_interval(std::span<const Span> spans, double floor,
                                     double limit = std::numeric_limits<double>::infinity());

}  // namespace insym
