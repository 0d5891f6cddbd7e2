#include "ranking/rank.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_sort.h>

#include "parallel_for.hpp"

namespace insym {
namespace {

std::size_t moved_points(const Symmetry& s) {
    std::size_t sum = 0;
    for (const Orbit& orbit : s.cycles) sum += orbit.points.size();
    return sum;
}

bool cycles_before(const Symmetry& a, const Symmetry& b) {
    return std::lexicographical_compare(a.cycles.begin(), a.cycles.end(), b.cycles.begin(), b.cycles.end(),
                                        [](const Orbit& x, const Orbit& y) {
                                            if (x.points != y.points) return x.points < y.points;
                                            return x.closed && !y.closed;
                                        });
}

}  // namespace

void rank(std::vector<Symmetry>& symmetries) {
    // What mostly decides, side by side, and places in the place of symmetries, which are slower to move.
    struct Key {
        double significance;
        std::size_t moved;
        SymmetryType type;
        double angle;  // of the generators of one ring or row, the smallest turn or step first
        std::size_t place;
    };
    std::vector<Key> order(symmetries.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Symmetry& s = symmetries[k];
        order[k] = {s.significance, moved_points(s), s.type, std::round(s.isometry.angle_deg * 1e3), k};
    }
    tbb::parallel_sort(order.begin(), order.end(), [&](const Key& a, const Key& b) {
        if (a.significance != b.significance) return a.significance < b.significance;
        if (a.moved != b.moved) return a.moved > b.moved;
        if (a.type != b.type) return a.type < b.type;
        if (a.angle != b.angle) return a.angle < b.angle;
        return cycles_before(symmetries[a.place], symmetries[b.place]);
    });
    std::vector<Symmetry> ranked(symmetries.size());
    parallel_for(ranked.size(), [&](std::size_t k) {
        ranked[k] = std::move(symmetries[order[k].place]);
        ranked[k].id = static_cast<int>(k) + 1;
    });
    symmetries.swap(ranked);
}

}  // namespace insym
