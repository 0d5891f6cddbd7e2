#include "ranking/rank.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace insym {
namespace {

std::size_t moved_points(const Symmetry& s) {
    std::size_t sum = 0;
    for (const Orbit& orbit : s.cycles) sum += orbit.points.size();
    return sum;
}

bool cycles_before(const Symmetry& a, const Symmetry& b) {
    return std::lexicographical_compare(a.cycles.begin(), a.cycles.end(), b.cycles.begin(), b.cycles.end(),
                                        [](const Orbit& x, const Orbit& y) { return x.points < y.points; });
}

}  // namespace

void rank(std::vector<Symmetry>& symmetries) {
    // Their places are sorted, which are quicker to move.
    std::vector<std::size_t> order(symmetries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        const Symmetry &a = symmetries[i], &b = symmetries[j];
        if (a.significance != b.significance) return a.significance < b.significance;
        const std::size_t m = moved_points(a), n = moved_points(b);
        if (m != n) return m > n;
        if (a.type != b.type) return a.type < b.type;
        // Of the generators of one ring or row, the smallest turn or step.
        const double x = std::round(a.isometry.angle_deg * 1e3), y = std::round(b.isometry.angle_deg * 1e3);
        if (x != y) return x < y;
        return cycles_before(a, b);
    });
    std::vector<Symmetry> ranked;
    ranked.reserve(symmetries.size());
    for (const std::size_t k : order) {
        ranked.push_back(std::move(symmetries[k]));
        ranked.back().id = static_cast<int>(ranked.size());
    }
    symmetries.swap(ranked);
}

}  // namespace insym
