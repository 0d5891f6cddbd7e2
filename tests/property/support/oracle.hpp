// Oracles that know nothing of the detector: the definitions word for word (shared/spec/reference.py
// in C++) and brute force over all isometries of an exact point set.
#pragma once

#include "insym/detect.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace insym::property {

/// Lowest and highest distance of an orbit.
using Span = std::pair<double, double>;

/// reference.interval: (E_min, E_max) of distance orbits (definitions, section 3).
ToleranceInterval reference_interval(std::vector<Span> spans, double floor);

/// Points, labels and the lengths that rule everything: reference.PointSet.
struct Problem {
    std::vector<Point> points;
    std::vector<int> labels;   ///< one for each point
    double resolution = 0;     ///< length
    double max_tolerance = 0;  ///< length

    double length(int a, int b) const;
    int size() const { return static_cast<int>(points.size()); }
};

/// The problem that a result says it solved.
Problem problem_of(const DetectResult& result);

using Sequence = std::vector<int>;

/// A sequence with its closed flag, in the form of reference.canonical: each cycle has one.
using CanonicalCycle = std::pair<Sequence, bool>;
CanonicalCycle canonical(const Sequence& points, bool closed);

/// reference.orbit_spans, reference.cycle_interval, reference.unambiguous (C2) and
/// reference.extensions (C3, here: is there any).
std::vector<Span> orbit_spans(const Problem& problem, const Sequence& points, bool closed);
ToleranceInterval cycle_interval(const Problem& problem, const Sequence& points, bool closed);
bool unambiguous(const Problem& problem, const Sequence& points, bool closed);
bool can_be_extended(const Problem& problem, const Sequence& points);

/// An isometry of an exact point set, found by brute force.
struct Element {
    std::array<std::array<double, 3>, 3> linear{};
    Point translation{};
    std::vector<int> image;  ///< index of the point that each point is taken to
    SymmetryType type = SymmetryType::rotation;
    int order = 1;  ///< least number of times that gives the identity
    /// Turn about the axis in units of the full turn, 0 to 1/2.
    double turn = 0;

    Point apply(const Point& p) const;
};

/// All isometries but the identity that map `points` onto themselves. Needs points that span the
/// space of `dimension`.
std::vector<Element> symmetry_group(const std::vector<Point>& points, int dimension);

/// Every closed cycle of three points or more that one isometry generates in an exact point set
/// and that is a regular polygon or a closed rotation-reflection; the value is its type. C2 is
/// not asked for.
std::map<CanonicalCycle, SymmetryType> exact_closed_cycles(const std::vector<Point>& points);

/// One sentence for each way in which a result of method `paper` breaks the definitions (types and
/// clusters are left to check_report.py); empty where it does not. C3 is checked only on request.
std::vector<std::string> violations(const DetectResult& result, bool check_maximal);

}  // namespace insym::property
