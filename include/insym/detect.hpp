// The detector: options in, every approximate incomplete symmetry out.
#pragma once

#include "insym/error.hpp"
#include "insym/export.hpp"
#include "insym/isometry.hpp"
#include "insym/point_set.hpp"
#include "insym/run_context.hpp"
#include "insym/symmetry_type.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace insym {

/// Which definition of a symmetry is used (definitions, sections 4 to 6).
enum class Method {
    robust,  ///< an isometry is judged by all the points it carries, against chance (section 8)
    paper,   ///< cycles and clusters of consistent cycles, as in Li, Langbein and Martin 2007
};

/// The remedy of Li, Langbein and Martin for large sets, of method paper: cycles are searched inside slabs of
/// equal height, symmetries over all of them. What crosses a border of slabs is not found.
struct Regions {
    int count = 1;            ///< of slabs, 1 to 10,000; 1: all points at once
    std::optional<int> axis;  ///< 0, 1, 2: x, y, z (z not in the plane); none: that of the longest extent
};

/// What to look for. The defaults suit exact and slightly noisy models.
struct DetectOptions {
    Method method = Method::robust;
    TypeSet types = TypeSet::all();  ///< kinds to look for; not empty
    double resolution = 1e-6;        ///< share of the diameter, in (0, 1): equal lengths
    /// Share of the diameter, in [resolution, 1]; none: auto. Under auto or up to ten resolutions method
    /// paper lists of exact sets of more than 100 points only the 100 mirrors, inversions and half-turns of
    /// most pairs, which a diagnostic `exact_pairs` tells, and no cycles that follow from others and a
    /// translation that makes rows, which a diagnostic `rows` tells.
    std::optional<double> max_tolerance;
    /// Method paper, searched as one region: with more chains of four points within the tolerance, it is
    /// lowered until there are no more (not below ten resolutions), `status` says result_limit and a
    /// diagnostic `chains` up to where was searched; 0: no limit. A million takes some seconds.
    std::size_t max_chains = 2'000'000;
    Regions regions;                 ///< method robust takes the default only
    std::size_t max_symmetries = 0;  ///< so many of the best are kept; 0: all
};

/// The tolerances over which something holds, in the input's unit; max may be infinite.
struct ToleranceInterval {
    double min = 0;
    double max = 0;
};

/// A sequence of distinct points, sigma: each to the next (definitions, section 2).
struct Orbit {
    std::vector<int> points;  ///< 0-based indices into DetectResult::points
    bool closed = false;      ///< sigma also maps the last point to the first
};

/// A cycle that satisfies C1, C2 and C3 (definitions, sections 3 to 5).
struct Cycle {
    std::vector<int> points;
    bool closed = false;
    TypeSet types;
    ToleranceInterval tolerance;
};

/// Distance of the images to the points they belong to, over all links, in the input's unit.
struct Deviation {
    double rms = 0;
    double max = 0;
};

/// One symmetry with what section 7 of the definitions asks of it.
struct Symmetry {
    int id = 0;  ///< 1-based rank in the list
    SymmetryType type = SymmetryType::mirror;
    std::optional<int> order;   ///< 360 degrees over the angle, where that is whole
    Isometry isometry;          ///< least squares over all links
    std::vector<Orbit> cycles;  ///< in the direction of the isometry
    ToleranceInterval tolerance;
    Deviation deviation;
    double coverage = 0;            ///< share of all points that the isometry takes to a point
    std::vector<int> fixed_points;  ///< points that the isometry leaves in place
    std::vector<Point> missing;     ///< empty slots of the pattern
    double significance = 0;        ///< log10 of the expected number of false alarms
    bool maximal = true;            ///< inside no larger symmetry of the list
    std::vector<int> implied_by;    ///< ids of better-ranked symmetries that give this one
};

/// The symmetries of the whole set: they leave one point in place and form a group.
struct PointGroup {
    std::string schoenflies;      ///< "C1", "D3h", "Oh", "Cinfv"; in 2D "C4" or, with mirrors, "D4"
    std::string hermann_mauguin;  ///< "1", "-6m2", "m-3m", "inf m"; a leading minus is the bar
    Point center{};       ///< what all elements leave in place; the centroid with the empty slots filled
    int empty_slots = 0;  ///< points that the set lacks for the group to be complete
};

enum class RunStatus { complete, time_limit, cancelled, result_limit };

/// The columns of the paper's Table 1.
struct Stats {
    std::size_t seeds = 0;  ///< of method robust: hypotheses tried
    std::size_t cycles = 0;
    std::size_t symmetries = 0;
};

/// Seconds of wall-clock time.
struct Timing {
    double cycles_s = 0;
    double symmetries_s = 0;
    double detect_s = 0;
};

struct DetectResult {
    RunStatus status = RunStatus::complete;
    DetectOptions options;             ///< as given
    PointSet points;                   ///< after merging; all indices refer to it
    double diameter = 0;               ///< longest distance between two points
    double resolution = 0;             ///< the length used, in the input's unit
    double max_tolerance = 0;          ///< the length used, in the input's unit
    int merged_points = 0;             ///< how many points fell together with another
    std::vector<Cycle> cycles;         ///< method paper; every symmetry has its own besides
    std::vector<Symmetry> symmetries;  ///< best rank first
    std::optional<PointGroup> group;   ///< method robust
    Stats stats;
    Timing timing;
    std::vector<Diagnostic> diagnostics;
};

/// Finds the symmetries of `points`.
///
/// Cost: grows with the number of near-isosceles triangles within the tolerance and with the
/// number of symmetries; see docs/algorithm.md. Thread-safe: calls share no state. The result is
/// the same for any number of threads. A run that is cancelled or reaches its deadline returns
/// what it has, with `status` saying so; everything in it is valid.
/// Throws Error: invalid_option for options out of range; invalid_input for fewer than two
/// distinct points, more than 15,000, coordinates that are not finite, or distances that overflow.
INSYM_EXPORT DetectResult detect(const PointSet& points, const DetectOptions& options = {},
                                 const RunContext& context = {});

}  // namespace insym
