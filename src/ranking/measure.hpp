// What every symmetry carries (definitions, section 7): isometry, deviation, coverage, fixed points.
#pragma once

#include "points/point_grid.hpp"
#include "ranking/significance.hpp"
#include "scene.hpp"

namespace insym {

/// Measures symmetries of one scene; immutable, thread-safe.
class Measure {
public:
    explicit Measure(const Scene& scene);

    /// Fills isometry, order, deviation, coverage, fixed points and significance of a symmetry whose
    /// type, cycles and tolerance are set. O(links + n).
    void complete(Symmetry& symmetry) const;

private:
    void fit(Symmetry& symmetry) const;
    void cover(Symmetry& symmetry) const;
    std::optional<int> order_of(const Symmetry& symmetry) const;

    const Scene& scene_;
    PointGrid grid_;
    Significance significance_;
};

}  // namespace insym
