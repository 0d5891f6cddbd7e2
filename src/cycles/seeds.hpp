// The seeds of method `paper`: near-isosceles triangles (definitions, section 4).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cycles/rows.hpp"
#include "cycles/tolerance_interval.hpp"
#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// (a, apex, c) with a < c that satisfies C1.
struct Seed {
    int a;
    int c;
    Span links;
    double ends;       ///< |a c|
    double tolerance;  ///< E_min
};

/// All seeds but those that rows make superfluous. Where there are rows the others are few, and listed; else
/// they are found anew whenever they are asked for. Immutable after construction.
///
/// Cost: a and c are at nearly the same distance from their apex, so each looks only at the few that follow
/// it in the list by distance. Memory: what is listed.
class Seeds {
public:
    Seeds(const Scene& scene, const Rows& rows, RunMonitor& monitor);

    bool listed() const { return !rows_.empty(); }
    const std::vector<Seed>& of(int apex) const { return lists_[static_cast<std::size_t>(apex)]; }
    std::size_t left_out() const { return left_out_; }
    /// Those of Rows, the same for (c, b, a).
    bool superfluous(int a, int b, int c) const { return listed() && rows_.superfluous(a, b, c); }
    bool repeats(int a, int b, int c) const { return listed() && rows_.repeats(a, b, c); }

    /// Calls visit(seed) for every seed about `apex`; stops, unless they are listed, when the run should.
    template <class Visit>
    void visit(int apex, Visit visit) const {
        if (listed()) {
            for (const Seed& seed : of(apex)) visit(seed);
        } else {
            find(
                apex, [](int, int) { return true; }, visit);
        }
    }

private:
    template <class Ask, class Visit>
    void find(int apex, Ask ask, Visit visit) const;

    static constexpr std::size_t kAskedOnce = 64;  // of the others; a look at the clock takes as long as some

    const Scene& scene_;
    const Rows& rows_;
    RunMonitor& monitor_;
    std::vector<std::vector<Seed>> lists_;
    std::size_t left_out_ = 0;
};

/// Of those for which ask(a, c) is true.
template <class Ask, class Visit>
void Seeds::find(int apex, Ask ask, Visit visit) const {
    const auto d = scene_.distances.row(apex);
    const auto others = scene_.distances.nearest_first(apex);
    const auto distance = [&](std::size_t i) { return d[static_cast<std::size_t>(others[i])]; };
    for (std::size_t i = 0; i + 1 < others.size(); ++i) {
        if (i % kAskedOnce == 0 && monitor_.should_stop()) return;
        const double near = distance(i);
        if (distance(i + 1) - near > scene_.max_tolerance) continue;
        if (scene_.label(others[i]) != scene_.label(apex)) continue;
        const auto to_first = scene_.distances.row(others[i]);
        for (std::size_t j = i + 1; j < others.size(); ++j) {
            const double far = distance(j);
            if (far - near > scene_.max_tolerance) break;
            if (scene_.label(others[j]) != scene_.label(apex)) continue;
            if (!ask(others[i], others[j])) continue;
            const auto [a, c] = std::minmax(others[i], others[j]);
            Seed seed{a, c, {near, far}, to_first[static_cast<std::size_t>(others[j])], 0};
            const Span orbits[] = {seed.links, {seed.ends, seed.ends}};
            seed.tolerance = tolerance_interval(orbits, scene_.resolution, scene_.max_tolerance).min;
            if (seed.tolerance <= scene_.max_tolerance) visit(seed);
        }
    }
}

}  // namespace insym
