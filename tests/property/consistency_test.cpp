// Consistent cycles: none is lost, whatever the search for partners leaves out.
//
// Oracle: brute force over all pairs of cycles and both directions, with reference.pair_tolerance and
// reference.carries word for word (definitions, section 6).
#include "symmetries/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "isometry/fit.hpp"
#include "property/support/pose.hpp"

namespace insym::property {
namespace {

using Sequence = std::vector<int>;

class BruteForce {
public:
    explicit BruteForce(const Scene& scene) : scene_(scene) {}

    std::optional<Consistency> consistent(const Cycle& a, const Cycle& b, SymmetryType type) const {
        for (const int p : a.points)
            if (std::count(b.points.begin(), b.points.end(), p) > 0) return std::nullopt;
        if (a.closed && b.closed && a.points.size() != b.points.size()) return std::nullopt;
        std::optional<Consistency> best;
        for (const bool reversed : {false, true}) {
            Sequence q = b.points;
            if (reversed) std::reverse(q.begin(), q.end());
            const double tolerance =
                std::max({pair_tolerance(a.points, a.closed, q, b.closed), a.tolerance.min, b.tolerance.min});
            if (tolerance < std::min(a.tolerance.max, b.tolerance.max) && tolerance <= scene_.max_tolerance &&
                (!best || tolerance < best->tolerance) &&
                (scene_.dimension() == 2 || carries({{a.points, a.closed}, {q, b.closed}}, type)))
                best = Consistency{tolerance, 0, 0, reversed};
        }
        return best;
    }

private:
    double pair_tolerance(const Sequence& a, bool a_closed, const Sequence& b, bool b_closed) const {
        const auto ca = static_cast<int>(a.size()), cb = static_cast<int>(b.size());
        const auto step = [](int i, int by, int count, bool closed) {
            const int next = i + by;
            if (next >= 0 && next < count) return next;
            return closed ? (next + count) % count : -1;
        };
        std::set<std::pair<int, int>> todo;
        for (int i = 0; i < ca; ++i)
            for (int j = 0; j < cb; ++j) todo.emplace(i, j);
        double worst = 0;
        while (!todo.empty()) {
            auto [i, j] = *todo.begin();
            const auto first = std::pair(i, j);
            for (;;) {
                const int k = step(i, -1, ca, a_closed), l = step(j, -1, cb, b_closed);
                if (k < 0 || l < 0 || std::pair(k, l) == first) break;
                i = k;
                j = l;
            }
            double low = scene_.diameter, high = 0;
            while (i >= 0 && j >= 0 && todo.erase({i, j}) > 0) {
                const double d =
                    scene_.distances(a[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(j)]);
                low = std::min(low, d);
                high = std::max(high, d);
                i = step(i, 1, ca, a_closed);
                j = step(j, 1, cb, b_closed);
            }
            worst = std::max(worst, high - low);
        }
        return worst;
    }

    bool carries(const std::vector<std::pair<Sequence, bool>>& chains, SymmetryType type) const {
        std::vector<Link> links;
        LinkSums sums;
        for (const auto& [points, closed] : chains)
            for (std::size_t k = 0; k + (closed ? 0 : 1) < points.size(); ++k) {
                links.push_back({to_vector(scene_.position(points[k])),
                                 to_vector(scene_.position(points[(k + 1) % points.size()]))});
                sums.add(links.back());
            }
        const RigidFits fits = fit_rigid(sums, 3);
        const auto worst = [&](const RigidMap& map) {
            double most = 0;
            for (const Link& l : links) most = std::max(most, (map(l.from) - l.to).norm());
            return most;
        };
        const double own = worst(is_improper(type, 3) ? fits.improper : fits.proper);
        return own <= 2 * std::min(worst(fits.proper), worst(fits.improper)) + scene_.resolution;
    }

    const Scene& scene_;
};

/// Rows of zigzags, or turns of a screw, with noise and scattered points: exact and less so, flat and not.
PointSet layout(int dimension, bool screw, double noise, std::mt19937_64& random) {
    PointSet points;
    points.dimension = dimension;
    const int rows = 3 + static_cast<int>(random() % 4), length = 5 + static_cast<int>(random() % 4);
    const double turn = uniform(random, 0.4, 2.5), pitch = uniform(random, 0.3, 1);
    for (int row = 0; row < rows; ++row) {
        const double radius = uniform(random, 0.5, 2), phase = uniform(random, 0, 6);
        for (int k = 0; k < length; ++k) {
            if (screw && dimension == 3)
                points.positions.push_back(
                    {radius * std::cos(turn * k + phase), radius * std::sin(turn * k + phase), pitch * k});
            else
                points.positions.push_back(
                    {pitch * k, (k % 2 == 0 ? radius : -radius) + 0.1, dimension == 3 ? 0.7 * row : 0});
        }
    }
    for (int k = 0; k < 3; ++k)
        points.positions.push_back({uniform(random, -1, 3), uniform(random, -2, 2), uniform(random, -1, 3)});
    for (Point& p : points.positions)
        for (std::size_t axis = 0; axis < 3; ++axis)
            p[axis] = axis < static_cast<std::size_t>(dimension) ? p[axis] + noise * normal(random) : 0;
    return points;
}

/// One sentence where the search and the oracle differ.
std::string difference(const DetectResult& result) {
    const Distances distances(result.points.positions);
    const Scene scene{{result.points, result.diameter, result.resolution, result.max_tolerance}, distances};
    const RunContext context;
    RunMonitor monitor(context);
    const ConsistentPairs found = consistent_cycles(scene, result.cycles, TypeSet::all(), monitor);
    const BruteForce oracle(scene);
    for (const SymmetryType type : kAllSymmetryTypes) {
        const std::vector<Consistency>& pairs = found[static_cast<std::size_t>(type)];
        auto next = pairs.begin();
        const auto count = static_cast<int>(result.cycles.size());
        for (int i = 0; i < count; ++i)
            for (int j = i + 1; j < count; ++j) {
                const Cycle& a = result.cycles[static_cast<std::size_t>(i)];
                const Cycle& b = result.cycles[static_cast<std::size_t>(j)];
                const bool listed = next != pairs.end() && next->first == i && next->second == j;
                const auto expected = a.types.contains(type) && b.types.contains(type)
                                          ? oracle.consistent(a, b, type)
                                          : std::nullopt;
                const std::string which =
                    std::string(option_letter(type)) + " " + std::to_string(i) + " " + std::to_string(j);
                if (listed != expected.has_value()) return which + (listed ? " is too much" : " is lost");
                if (!listed) continue;
                if (next->tolerance != expected->tolerance) return which + ": the tolerance differs";
                if (next->reversed != expected->reversed) return which + ": the direction differs";
                ++next;
            }
        if (next != pairs.end()) return "pairs out of order";
    }
    return {};
}

}  // namespace

RC_GTEST_PROP(ConsistentCycles, are_those_of_brute_force, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    const int dimension = *rc::gen::element(2, 3);
    const double noise = *rc::gen::element(0.0, 0.0, 1e-7, 1e-4);
    const PointSet points = layout(dimension, *rc::gen::arbitrary<bool>(), noise, random);
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = *rc::gen::element(1e-5, 1e-3, 1e-2);
    const DetectResult result = detect(points, options);
    RC_TAG(result.cycles.size() < 20 ? "few cycles" : "many cycles");
    const std::string found = difference(result);
    if (!found.empty()) RC_FAIL(found);
}

}  // namespace insym::property
