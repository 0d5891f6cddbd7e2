// What every symmetry carries (definitions, section 7): isometry, deviation, coverage, fixed points.
#pragma once

#include "points/near_cells.hpp"
#include "points/point_grid.hpp"
#include "ranking/significance.hpp"
#include "scene.hpp"

namespace insym {

/// Measures symmetries of one scene; immutable, thread-safe.
class Measure {
public:
    Measure(const PointScene& scene, const Significance& significance);

    /// Fills isometry, order, deviation, coverage and fixed points of a symmetry whose type, cycles and
    /// tolerance are set. O(links + n).
    void complete(Symmetry& symmetry) const;

    /// How surely it is no chance, by its links and its deviation alone. After complete().
    double significance_of(const Symmetry& symmetry) const;

private:
    void fit(Symmetry& symmetry) const;
    void cover(Symmetry& symmetry) const;
    std::optional<int> order_of(const Symmetry& symmetry) const;

    const PointScene& scene_;
    PointGrid grid_;
    NearCells near_;
    const Significance& significance_;
};

}  // namespace insym
