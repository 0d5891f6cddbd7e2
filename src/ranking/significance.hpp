// How many symmetries at least this good are expected by chance (a-contrario; Desolneux, Moisan,
// Morel 2000). The model and its assumptions stand in docs/significance.md.
#pragma once

#include "insym/detect.hpp"

#include <vector>

namespace insym {

/// Scores symmetries of one point set. Immutable after construction, thread-safe.
class Significance {
public:
    explicit Significance(const PointSet& points, double resolution);

    /// log10 of the expected number of false alarms: of symmetries of this type with at least
    /// `links` links, each met within `reach`, among points scattered uniformly in the bounding box.
    double log10_false_alarms(SymmetryType type, int links, double reach) const;

private:
    double log_choose(int n, int k) const;

    int n_ = 0;
    int dimension_ = 3;
    double resolution_ = 0;
    double log_volume_ = 0;  ///< of the bounding box, natural logarithm
    std::vector<double> log_factorial_;
};

/// The number of lengths and angles that an isometry of the type is free to take.
int degrees_of_freedom(SymmetryType type, int dimension);

}  // namespace insym
