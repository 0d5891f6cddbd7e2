// All the points that an isometry carries to points, both ways and uniquely, and the isometry and the
// tolerance that they suggest (definitions, section 8).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "hypotheses/hypothesis.hpp"
#include "points/cloud.hpp"
#include "ranking/significance.hpp"

namespace insym {

/// An isometry with the links it rests on.
struct Support {
    SymmetryType type = SymmetryType::mirror;
    RigidMap map;
    double tolerance = 0;                    ///< every link is met within
    std::vector<std::pair<int, int>> links;  ///< ascending
    int hits = 0;                            ///< see Evidence
    double significance = 0;
};

/// Of two kinds that say the same links the simpler one is meant, unless it is clearly less significant: the
/// freedom of the other always fits a little better. Lower is better.
double worth(const Support& support, int dimension);

/// Gathers and judges. Immutable, thread-safe.
class Gatherer {
public:
    /// `reach`: the largest tolerance that is looked at.
    Gatherer(const Cloud& cloud, const Significance& significance, double reach);

    /// Grows the support of a hypothesis outward from its points, refits it, takes the tolerance at which it
    /// is most significant and the simplest kind that explains as much. Nothing where that stays above
    /// `worst`, but for symmetries of the whole set where the hypothesis rests on its centre: of a few points
    /// these are no surer than chance, and wanted all the same.
    std::optional<Support> gather(const Hypothesis& hypothesis, double worst) const;

    /// All points are carried or stay in place, and no point is off by as much as could be another place.
    bool whole(const Support& support) const;

    /// How many points a support carries, from or to, or leaves in place to within `reach`. O(n).
    int carried(const Support& support, double reach) const;

    /// The share of the points, or of a sample of many, that `map` carries to points or leaves in place.
    double share_carried(const RigidMap& map, double reach) const;

    const std::vector<double>& levels() const { return levels_; }
    double reach() const { return levels_.back(); }

private:
    struct Linked;
    struct Judged;
    struct Region;
    void link(SymmetryType type, const RigidMap& map, double reach, const Region& region, Linked& out) const;
    Judged judge(SymmetryType type, const Linked& linked, double reach) const;
    static std::vector<std::pair<int, int>> links_within(const Linked& linked, double tolerance);
    RigidMap refit(SymmetryType type, const std::vector<std::pair<int, int>>& pairs,
                   const RigidMap& old) const;
    std::optional<Support> settle(SymmetryType type, RigidMap map, double reach, double worst,
                                  const Region& region, Linked& linked) const;
    Region grow(const Hypothesis& hypothesis, double reach, RigidMap& map, Linked& linked) const;
    bool carries(const Hypothesis& hypothesis, const RigidMap& map, int point, double reach,
                 double& square) const;
    double sampled(const Hypothesis& hypothesis, const RigidMap& map, double reach) const;
    bool widens(const Hypothesis& hypothesis, const RigidMap& map, double near) const;
    bool promising(const Hypothesis& hypothesis, double reach) const;

    const Cloud& cloud_;
    const Significance& significance_;
    std::vector<double> levels_;
};

/// The kinds that `map` is within `slack` of, over a ball of `radius` about `center`; the map as that kind.
std::vector<std::pair<SymmetryType, RigidMap>> simpler_kinds(SymmetryType type, const RigidMap& map,
                                                             const Eigen::Vector3d& center, double radius,
                                                             double slack, int dimension);

/// Angle of the turn of a map about its axis, 0..pi, its reflection undone; and the steps.
struct Motion {
    double angle = 0;  ///< C, W, S: radians
    double step = 0;   ///< along the axis (proper) or, where the linear part is a reflection, in its plane
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
};
Motion motion_of(const RigidMap& map, bool improper);

}  // namespace insym
