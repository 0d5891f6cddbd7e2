#include "ranking/rank.hpp"

#include <algorithm>
#include <cmath>

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
    std::sort(symmetries.begin(), symmetries.end(), [](const Symmetry& a, const Symmetry& b) {
        if (a.significance != b.significance) return a.significance < b.significance;
        const std::size_t m = moved_points(a), n = moved_points(b);
        if (m != n) return m > n;
        if (a.type != b.type) return a.type < b.type;
        // Of the generators of one ring or row, the smallest turn or step.
        const double x = std::round(a.isometry.angle_deg * 1e3), y = std::round(b.isometry.angle_deg * 1e3);
        if (x != y) return x < y;
        return cycles_before(a, b);
    });
    int id = 0;
    for (Symmetry& s : symmetries) s.id = ++id;
}

}  // namespace insym
