// Comparing results: as sets that forget the order of points, and to the last bit.
#pragma once

#include "insym/detect.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include "property/support/oracle.hpp"

namespace insym::property {

/// Points without labels as the detector takes them.
PointSet point_set(const std::vector<Point>& points, int dimension);

/// Options for exact sets: nothing above 1e-4 of the diameter.
DetectOptions exact_options();

/// For each point of the result, the index of the same point in `positions`.
std::vector<int> indices_in(const DetectResult& result, const std::vector<Point>& positions);

/// "closed 0 1 2".
std::string text_of(const CanonicalCycle& cycle);

/// What must not depend on pose and order: lengths are shares of the diameter.
struct Summary {
    struct CycleFacts {
        std::set<std::string> types;
        double min = 0;
        double max = 0;
    };
    std::map<CanonicalCycle, CycleFacts> cycles;
    /// Type, order and cycles of every symmetry -> its tolerance, deviation and flags. Coverage and
    /// fixed points only for M, I and half-turns: the others may run in either direction, and under
    /// noise an isometry may take more points to a point than its inverse does.
    std::map<std::string, std::vector<double>> symmetries;
    std::map<std::string, int> count_by_type;
};

/// The summary with the half-turns left out.
Summary without_half_turns(Summary summary);

/// `original[k]` is what point k of the result is called in the summary.
Summary summary_of(const DetectResult& result, const std::vector<int>& original);

/// A sentence about the first difference, or nothing; lengths may differ by 1e-6 relative.
std::string difference(const Summary& a, const Summary& b);

/// A sentence about the first difference, to the last bit, or nothing. Timing is left out.
std::string difference_in_bits(const DetectResult& a, const DetectResult& b);

/// Planted orbits of several kinds with noise (standard deviation, share of the diameter), and
/// scattered points: generic sets without ties. Labels: 1, 2, ... by orbit, 0 for scattered points.
PointSet noisy_set(int dimension, int orbits, int scattered, double noise, std::uint64_t seed);

}  // namespace insym::property
