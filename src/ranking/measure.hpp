// What every symmetry carries (definitions, section 7): isometry, deviation, coverage, fixed points.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "points/near_cells.hpp"
#include "points/near_field.hpp"
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

    /// The same for many. Those of one isometry, to a rounding, share what it covers. Parallel.
    void complete_all(std::span<Symmetry* const> symmetries) const;

    /// How surely it is no chance, by its links and its deviation alone. After complete().
    double significance_of(const Symmetry& symmetry) const;

private:
    /// What an isometry covers, and between which reaches it is just that.
    struct Cover {
        Isometry isometry;
        int covered = 0;
        std::vector<int> fixed_points;
        double least_reach = 0;
        double most_reach = 0;
    };

    void fit(Symmetry& symmetry) const;
    void cover(Symmetry& symmetry, const NearField* field = nullptr) const;
    void find_near(const Isometry& isometry, double reach, const NearField* field,
                   std::vector<NearField::Near>& out) const;
    double reach_of(const Symmetry& symmetry) const;
    Cover cover_of(const Isometry& isometry, double reach) const;
    bool same_cover(const Cover& cover, const Symmetry& symmetry) const;
    void cover_alike(std::span<Symmetry* const> symmetries, const NearField* field) const;
    std::uint64_t fingerprint(const Isometry& isometry) const;
    std::optional<int> order_of(const Symmetry& symmetry) const;

    const PointScene& scene_;
    PointGrid grid_;
    NearCells near_;
    std::vector<Point> corners_;  // of the box about the points
    double rounding_ = 0;         // more than a place computed here can be off by
    const Significance& significance_;
};

}  // namespace insym
