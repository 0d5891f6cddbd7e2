#include "insym/detect.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <map>
#include <span>
#include <sstream>

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "cycles/regions.hpp"
#include "parallel_for.hpp"
#include "points/cloud.hpp"
#include "points/diameter.hpp"
#include "points/merge.hpp"
#include "ranking/implied.hpp"
#include "ranking/measure.hpp"
#include "ranking/point_group.hpp"
#include "ranking/rank.hpp"
#include "run_monitor.hpp"
#include "scene.hpp"
#include "support/detect_robust.hpp"
#include "symmetries/detect_symmetries.hpp"

namespace insym {
namespace {

/// 13 n^2 bytes of distances are 2.9 GB then.
constexpr std::size_t kMostPoints = 15000;

constexpr int kMostRegions = 10000;

/// Up to so many points method paper starts from all seeds and compares all pairs with all, which takes n^3 /
/// 3 steps.
constexpr int kSearchesAll = 100;
/// Of larger sets it takes, under `auto` and up to so many resolutions, the seeds that do not follow from
/// others and a translation, and of pairs, where the set is drawn and not measured, so many exact symmetries
/// of each kind.
constexpr double kExactUpTo = 10;
constexpr std::size_t kMostExactPairs = 100;

/// Method `robust` chooses the tolerance of each symmetry itself, up to this share of the diameter.
constexpr double kLargestTolerance = 0.1;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void check_options(const DetectOptions& options, const RunContext& context) {
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorCode::invalid_option, sentence); };
    if (options.types.empty()) refuse("types: choose at least one kind of symmetry");
    if (!(options.resolution > 0 && options.resolution < 1))
        refuse("resolution: must be a share of the diameter above 0 and below 1");
    if (options.max_tolerance) {
        if (!(*options.max_tolerance > 0 && *options.max_tolerance <= 1))
            refuse("max_tolerance: must be a share of the diameter above 0 and at most 1");
        if (*options.max_tolerance < options.resolution)
            refuse("max_tolerance: must not be below the resolution");
    }
    const Regions& regions = options.regions;
    if (regions.count < 1 || regions.count > kMostRegions)
        refuse("regions: the number of slabs must be from 1 to " + std::to_string(kMostRegions));
    if (regions.axis && (*regions.axis < 0 || *regions.axis > 2))
        refuse("regions: the axis must be 0, 1 or 2");
    if (regions.count > 1 && options.method != Method::paper)
        refuse("regions: only method paper searches region by region");
    if (context.threads < 0) refuse("threads: must not be negative");
}

void check_points(const PointSet& points) {
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorCode::invalid_input, sentence); };
    if (points.dimension != 2 && points.dimension != 3) refuse("the dimension of the points must be 2 or 3");
    if (points.positions.empty()) refuse("no points");
    if (!points.labels.empty() && points.labels.size() != points.size())
        refuse("there must be one label for each point, or none");
    if (!points.entities.empty() && points.entities.size() != points.size())
        refuse("there must be one entity for each point, or none");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points.positions[i];
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
            refuse("point " + std::to_string(i + 1) + " has a coordinate that is not a finite number");
        if (points.dimension == 2 && p[2] != 0)
            refuse("point " + std::to_string(i + 1) + " of a set in the plane has a third coordinate");
    }
    if (points.size() == 1) refuse("only one point: a symmetry needs at least two");
}

/// The share of the diameter up to which chance does not drown what is meant: m scattered points of one label
/// have of the order of m^4 tau^2 chains of four points by chance; this keeps them all of the order of n.
double automatic_tolerance(const PointSet& points, double resolution) {
    constexpr double kPaperTolerance = 0.05;
    const auto n = static_cast<double>(points.size());
    std::map<int, double> sizes;
    for (const int label : points.labels) sizes[label] += 1;
    if (points.labels.empty()) sizes[0] = n;
    double chains = 0;
    for (const auto& [label, m] : sizes) chains += std::pow(m, 4);
    return std::clamp(std::sqrt(n / chains), std::min(10 * resolution, kPaperTolerance), kPaperTolerance);
}

TypeSet cycle_types() {
    TypeSet types;
    for (const SymmetryType type : kAllSymmetryTypes)
        if (!is_pair_type(type)) types.insert(type);
    return types;
}

/// A symmetry of pairs is listed only if it covers the set or rests on four pairs and fixed points, as any
/// trapezoid's corners make a mirror of two pairs (definitions, section 6).
bool listed(const Symmetry& s) {
    return !is_pair_type(s.type) || s.coverage >= 1 || s.cycles.size() + s.fixed_points.size() >= 4;
}

/// Past the deadline the largest are measured, and it is said how many more there were.
void measure_largest_first(const Measure& measure, RunMonitor& monitor, DetectResult& result) {
    constexpr std::size_t kAlways = 2000, kLeastBlock = 512, kImages = 40'000'000;
    // So that a block takes some tenths of a second at most.
    const std::size_t block = std::max(kLeastBlock, kImages / result.points.size());
    std::vector<Symmetry>& all = result.symmetries;
    std::vector<std::pair<std::size_t, Symmetry*>> largest_first;  // by the points moved, then by place
    for (Symmetry& s : all) {
        std::size_t moved = 0;
        for (const Orbit& o : s.cycles) moved += o.points.size();
        largest_first.emplace_back(moved, &s);
    }
    std::sort(largest_first.begin(), largest_first.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::vector<Symmetry*> next;
    std::size_t done = 0;
    while (done < all.size() && (done < kAlways || !monitor.should_stop())) {
        const std::size_t end = std::min(all.size(), done + block);
        next.clear();
        for (; done < end; ++done) next.push_back(largest_first[done].second);
        measure.complete_all(next);
        parallel_for(next.size(),
                     [&](std::size_t k) { next[k]->significance = measure.significance_of(*next[k]); });
    }
    if (done == all.size()) return;
    result.diagnostics.push_back(
        {"not_measured",
         std::to_string(all.size() - done) + " smaller symmetries were left out when the time was up"});
    std::vector<Symmetry> measured;
    for (std::size_t k = 0; k < done; ++k) measured.push_back(std::move(*largest_first[k].second));
    all.swap(measured);
}

/// The cycles of the kinds asked for.
CycleSearchResult search_cycles(const Scene& scene, const DetectOptions& options, const CycleSearch& how,
                                RunMonitor& monitor, std::vector<Diagnostic>& diagnostics) {
    // Pairs need no cycles; a run that asks for pairs alone does not pay for them.
    CycleSearchResult none;
    none.max_tolerance = scene.max_tolerance;
    if ((options.types & cycle_types()).empty()) return none;
    monitor.begin_stage("cycles", 2 * static_cast<std::size_t>(scene.size()));
    auto [search, axis, ambiguous] = detect_cycles_in_regions(scene, options.regions, how, monitor);
    if (options.regions.count > 1)
        diagnostics.push_back(
            {"regions", "cycles were searched only inside " + std::to_string(options.regions.count) +
                            " slabs of equal height along " + "xyz"[axis] + "; " + std::to_string(ambiguous) +
                            " that a point of another slab makes ambiguous were left out"});
    std::erase_if(search.cycles, [&](const Cycle& c) { return (c.types & options.types).empty(); });
    return std::move(search);
}

bool is_searched_as_exact(const PointScene& scene, const DetectOptions& options) {
    if (scene.size() <= kSearchesAll) return false;
    return !options.max_tolerance || *options.max_tolerance <= kExactUpTo * options.resolution * (1 + 1e-9);
}

/// Up to where was searched, if not up to the tolerance asked for.
void tell_of_chains(const CycleSearchResult& search, const Scene& scene, const DetectOptions& options,
                    DetectResult& result) {
    if (search.max_tolerance == scene.max_tolerance) return;
    const auto share = [&](double tolerance) {
        std::ostringstream text;
        text << std::setprecision(3) << tolerance / scene.diameter;
        return text.str();
    };
    result.status = RunStatus::result_limit;
    result.diagnostics.push_back({"chains", "within the tolerance of " + share(scene.max_tolerance) +
                                                " of the diameter there are more than " +
                                                std::to_string(options.max_chains) +
                                                " chains of four points; what holds up to " +
                                                share(search.max_tolerance) + " of it was searched"});
}

/// What was not searched as it follows from translations.
void tell_of_rows(const CycleSearchResult& search, DetectResult& result) {
    if (search.superfluous_seeds == 0) return;
    result.diagnostics.push_back(
        {"rows",
         std::to_string(search.superfluous_seeds) + " of " +
             std::to_string(search.superfluous_seeds + search.seeds) +
             " near-isosceles triangles in exact rows follow from others and a translation (" +
             std::to_string(search.translations) +
             " found), and no cycles were searched from them; a tolerance above ten resolutions has all "
             "searched"});
}

/// What was cut off the mirrors, inversions and half-turns.
void tell_of_pairs(const std::vector<ExactKind>& kinds, DetectResult& result) {
    if (kinds.empty()) return;
    std::string counts;
    for (const ExactKind& kind : kinds)
        counts += (counts.empty() ? "" : ", ") + std::string(option_letter(kind.type)) + ": " +
                  std::to_string(kind.kept) + " of " + std::to_string(kind.suggested);
    result.diagnostics.push_back(
        {"exact_pairs",
         "of the exact mirrors, inversions and half-turns those with the most pairs are listed (" + counts +
             " that three pairs suggest); a tolerance above ten resolutions has all pairs compared with "
             "all"});
}

void run_paper(Scene scene, const DetectOptions& options, RunMonitor& monitor, DetectResult& result) {
    const auto start = std::chrono::steady_clock::now();
    const bool exact = is_searched_as_exact(scene, options);
    CycleSearch how;
    how.seeds = exact ? SeedChoice::needed : SeedChoice::all;
    how.most_chains = options.max_chains;
    CycleSearchResult search = search_cycles(scene, options, how, monitor, result.diagnostics);
    tell_of_chains(search, scene, options, result);
    result.max_tolerance = scene.max_tolerance = search.max_tolerance;
    result.cycles = std::move(search.cycles);
    result.timing.cycles_s = seconds_since(start);

    const auto after_cycles = std::chrono::steady_clock::now();
    const std::size_t most_exact = exact ? kMostExactPairs : 0;
    SymmetrySearchResult found = detect_symmetries(scene, result.cycles, options.types, most_exact, monitor);
    result.symmetries = std::move(found.symmetries);
    const Significance significance(scene);
    const Measure measure(scene, significance);
    measure_largest_first(measure, monitor, result);
    std::erase_if(result.symmetries, [](const Symmetry& s) { return !listed(s); });
    rank(result.symmetries);
    result.timing.symmetries_s = seconds_since(after_cycles);

    tell_of_rows(search, result);
    tell_of_pairs(found.exact_kinds, result);
    if (found.frustrated > 0)
        result.diagnostics.push_back(
            {"no_common_direction",
             std::to_string(found.frustrated) +
                 " sets of consistent cycles have no common direction and were left out"});
    result.stats = {search.seeds, result.cycles.size(), result.symmetries.size()};
}

void run_robust(const PointScene& scene, const DetectOptions& options, RunMonitor& monitor,
                DetectResult& result) {
    const auto start = std::chrono::steady_clock::now();
    const Cloud cloud(scene);
    const Significance significance(scene);
    RobustResult found = detect_robust(cloud, significance, options.types, monitor);
    result.symmetries = std::move(found.symmetries);
    if (!options.max_tolerance) result.max_tolerance = found.max_tolerance;
    const Measure measure(scene, significance);
    parallel_for(result.symmetries.size(), [&](std::size_t i) { measure.complete(result.symmetries[i]); });
    promote_generators(cloud, result.symmetries, monitor);
    rank(result.symmetries);
    mark_implied(cloud, result.symmetries, monitor);
    result.group = point_group(cloud, result.symmetries);
    result.timing.symmetries_s = seconds_since(start);
    result.stats = {found.hypotheses, 0, result.symmetries.size()};
}

/// The best of them; what they follow from ranks better and stays.
void keep_best(std::size_t most, DetectResult& result) {
    const std::size_t found = result.symmetries.size();
    if (most == 0 || found <= most) return;
    result.symmetries.resize(most);
    result.stats.symmetries = most;
    if (result.status == RunStatus::complete) result.status = RunStatus::result_limit;
    result.diagnostics.push_back({"result_limit", "the best " + std::to_string(most) + " of " +
                                                      std::to_string(found) + " symmetries are kept"});
}

}  // namespace

DetectResult detect(const PointSet& points, const DetectOptions& options, const RunContext& context) {
    const auto start = std::chrono::steady_clock::now();
    check_options(options, context);
    check_points(points);

    DetectResult result;
    result.options = options;
    if (options.regions.axis == 2 && points.dimension == 2)
        throw Error(ErrorCode::invalid_option, "regions: points in the plane have no z");
    result.diameter = diameter(points.positions);
    if (!std::isfinite(result.diameter))
        throw Error(ErrorCode::invalid_input, "the points are so far apart that their distances overflow");
    result.resolution = options.resolution * result.diameter;
    if (!(result.resolution > 0)) throw Error(ErrorCode::invalid_input, "all points are equal");

    result.points = merge_equal_points(points, result.resolution);
    result.merged_points = static_cast<int>(points.size() - result.points.size());
    if (result.merged_points > 0)
        result.diagnostics.push_back(
            {"merged_points",
             std::to_string(result.merged_points) +
                 " points lay closer than the resolution to another and were merged with it"});
    const bool paper = options.method == Method::paper;
    if (paper && result.points.size() > kMostPoints)
        throw Error(ErrorCode::invalid_input,
                    std::to_string(result.points.size()) +
                        " points are too many: method paper keeps all distances, for at most " +
                        std::to_string(kMostPoints) + " points");
    const double automatic = paper ? automatic_tolerance(result.points, options.resolution)
                                   : std::max(kLargestTolerance, options.resolution);
    result.max_tolerance = options.max_tolerance.value_or(automatic) * result.diameter;

    RunMonitor monitor(context);
    // More threads than cores would only make TBB complain on standard error.
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(context.threads > 0 ? std::min(context.threads, cores) : cores);
    arena.execute([&] {
        const PointScene scene{result.points, result.diameter, result.resolution, result.max_tolerance};
        if (paper) {
            const Distances distances(result.points.positions);
            run_paper({scene, distances}, options, monitor, result);
        } else {
            run_robust(scene, options, monitor, result);
        }
    });
    if (monitor.status() != RunStatus::complete) result.status = monitor.status();
    keep_best(options.max_symmetries, result);
    result.timing.detect_s = seconds_since(start);
    return result;
}

}  // namespace insym
