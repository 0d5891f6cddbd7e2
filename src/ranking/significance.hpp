// How many symmetries at least this good are expected by chance (a-contrario; Desolneux, Moisan,
// Morel 2000). The model and its assumptions stand in docs/significance.md.
#pragma once

#include "ranking/background.hpp"

namespace insym {

/// What speaks for a symmetry.
struct Evidence {
    int hits = 0;     ///< links whose ends no other link of the orbit brings together: points - 1 of each run
    int bridged = 0;  ///< gaps with points at either end
    int looks = 0;    ///< the places looked at, over all gaps, for the point beyond
};

/// Scores symmetries of one point set. Immutable after construction, thread-safe.
class Significance {
public:
    explicit Significance(const PointScene& scene);

    /// log10 of the expected number of false alarms: of symmetries of this type with at least this evidence,
    /// each point met within `tolerance`.
    double log10_false_alarms(SymmetryType type, const Evidence& evidence, double tolerance) const;

    const Background& background() const { return background_; }

private:
    int n_ = 0;
    int dimension_ = 3;
    double resolution_ = 0;
    double diameter_ = 0;
    Background background_;
};

/// The number of lengths and angles that an isometry of the type is free to take.
int degrees_of_freedom(SymmetryType type, int dimension);

/// Natural logarithm of a bound on P[Binomial(trials, chance) >= hits] (Chernoff, Hoeffding).
double log_binomial_tail(double trials, double hits, double chance);

}  // namespace insym
