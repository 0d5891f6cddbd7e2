// Mirrors, inversions and half-turns of larger sets, of which `auto` lists the exact ones with the most
// pairs.
//
// Oracle: the search that compares all pairs with all (a tolerance above ten resolutions asks for it), which
// pairs_test.cpp compares with brute force; and what was planted.
#include "insym/detect.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "property/support/pose.hpp"
#include "property/support/results.hpp"

namespace insym::property {
namespace {

using PairSet = std::set<std::pair<int, int>>;
using Lists = std::map<SymmetryType, std::vector<PairSet>>;

DetectOptions pairs_only(std::optional<double> max_tolerance) {
    DetectOptions options;
    options.method = Method::paper;
    options.types = {};
    for (const SymmetryType type : {SymmetryType::mirror, SymmetryType::inversion, SymmetryType::half_turn})
        options.types.insert(type);
    options.max_tolerance = max_tolerance;
    return options;
}

/// A box of nx * ny * nz points, unevenly high, of which a few are missing: exact, with hundreds of
/// symmetries.
PointSet broken_grid(int nx, int ny, int nz, int missing, std::uint64_t seed) {
    PointSet points;
    points.dimension = nz == 1 ? 2 : 3;
    for (int x = 0; x < nx; ++x)
        for (int y = 0; y < ny; ++y)
            for (int z = 0; z < nz; ++z)
                points.positions.push_back({1.0 * x, 1.3 * y, 1.7 * z + 0.11 * z * z});
    std::mt19937_64 random(seed);
    for (; missing > 0; --missing)
        points.positions.erase(points.positions.begin() +
                               static_cast<std::ptrdiff_t>(random() % points.positions.size()));
    return points;
}

Lists lists_of(const DetectResult& result) {
    Lists lists;
    for (const Symmetry& symmetry : result.symmetries) {
        PairSet pairs;
        for (const Orbit& orbit : symmetry.cycles) {
            const auto [a, b] = std::minmax(orbit.points.at(0), orbit.points.at(1));
            pairs.emplace(a, b);
        }
        lists[symmetry.type].push_back(pairs);
    }
    return lists;
}

bool tells_of_pairs(const DetectResult& result) {
    return std::any_of(result.diagnostics.begin(), result.diagnostics.end(),
                       [](const Diagnostic& d) { return d.code == "exact_pairs"; });
}

std::size_t least(const std::vector<PairSet>& sets) {
    return std::min_element(sets.begin(), sets.end(),
                            [](const PairSet& a, const PairSet& b) { return a.size() < b.size(); })
        ->size();
}

/// What is listed is what the complete search lists, without gaps at the top; of half-turns only about some
/// directions, but the largest of all is there.
std::string difference(const Lists& complete, const Lists& cut) {
    for (const auto& [type, kept] : cut) {
        const std::string name(option_letter(type));
        const std::vector<PairSet>& all = complete.at(type);
        const std::set<PairSet> known(all.begin(), all.end()), listed(kept.begin(), kept.end());
        if (listed.size() != kept.size()) return name + ": one is listed twice";
        for (const PairSet& set : kept)
            if (!known.contains(set))
                return name + ": the complete search lists no set of these " + std::to_string(set.size());
        const std::size_t most = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
                                     return a.size() < b.size();
                                 })->size();
        const std::size_t floor = type == SymmetryType::half_turn ? most - 1 : least(kept);
        for (const PairSet& set : all)
            if (set.size() > floor && set.size() >= 4 && !listed.contains(set))
                return name + ": a set of " + std::to_string(set.size()) + " is missing";
    }
    return {};
}

}  // namespace

RC_GTEST_PROP(ExactPairs, are_the_largest_that_the_complete_search_lists, ()) {
    const bool plane = *rc::gen::arbitrary<bool>();
    const int missing = *rc::gen::inRange(0, 7);
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const PointSet grid =
        plane ? broken_grid(*rc::gen::inRange(11, 13), 11, 1, missing, seed)
              : broken_grid(*rc::gen::inRange(6, 9), 5, *rc::gen::inRange(4, 6), missing, seed);
    const auto order = shuffled_order(static_cast<int>(grid.size()), *rc::gen::arbitrary<std::uint64_t>());
    const PointSet input = placed(grid, *any_pose(grid.dimension), order);
    const DetectResult cut = detect(input, pairs_only(*rc::gen::element<std::optional<double>>({}, 1e-5)));
    RC_ASSERT(tells_of_pairs(cut));
    const DetectResult complete = detect(input, pairs_only(2e-5));
    RC_ASSERT(!tells_of_pairs(complete));
    RC_ASSERT(difference(lists_of(complete), lists_of(cut)) == "");
}

RC_GTEST_PROP(ExactPairs, are_the_same_bits_for_one_thread_and_for_two, ()) {
    const PointSet grid = broken_grid(7, 5, 5, 9, *rc::gen::arbitrary<std::uint64_t>());
    RunContext one, two;
    one.threads = 1;
    two.threads = 2;
    RC_ASSERT(difference_in_bits(detect(grid, pairs_only({}), one), detect(grid, pairs_only({}), two)) == "");
}

// Where hardly anything is exact, auto compares all pairs with all, up to the tolerance that it chose: a
// large one, as each pair has a label of its own.
RC_GTEST_PROP(RoughPairs, of_a_larger_set_are_those_of_the_complete_search, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    PointSet points;
    for (int k = 0; k < 60; ++k) {
        const Point p{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0.1, 1)};
        const double off = 2e-5 * uniform(random, 0.5, 1);
        points.positions.push_back(p);
        points.positions.push_back({p[0] + off, p[1] - off, -p[2]});
        points.labels.insert(points.labels.end(), 2, k);
    }
    const DetectResult by_auto = detect(points, pairs_only({}));
    RC_ASSERT(!tells_of_pairs(by_auto));
    RC_ASSERT(!by_auto.symmetries.empty());
    const DetectResult complete = detect(points, pairs_only(by_auto.max_tolerance / by_auto.diameter));
    RC_ASSERT(lists_of(by_auto) == lists_of(complete));
}

}  // namespace insym::property
