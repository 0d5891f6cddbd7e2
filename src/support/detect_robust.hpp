// Method `robust`: symmetries judged as a whole (definitions, section 8).
#pragma once

#include "points/cloud.hpp"
#include "ranking/significance.hpp"
#include "run_monitor.hpp"

namespace insym {

struct RobustResult {
    std::vector<Symmetry> symmetries;  ///< type, cycles, tolerance, missing and significance are set
    std::size_t hypotheses = 0;        ///< isometries that were tried
    double max_tolerance = 0;          ///< the largest tolerance looked at, in the input's unit
};

/// Hypotheses from pairs, chains and frames of points; the support of each; the best of those that rest on
/// the same links. Memory linear in the points plus the output.
RobustResult detect_robust(const Cloud& cloud, const Significance& significance, TypeSet types,
                           RunMonitor& monitor);

}  // namespace insym
