#include "cycles/fourths.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>

#include "cycles/tolerance_interval.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

/// E_min of the chain of four with these distances, infinite above `limit`.
double tolerance_of_four(const Span& links, const Span& steps, double ends, double floor, double limit) {
    if (links.spread() > limit || steps.spread() > limit) return std::numeric_limits<double>::infinity();
    const Span spans[] = {links, steps, {ends, ends}};
    return detail::interval_of_few<3>(spans, floor, limit).min;
}

/// How much two distances of one orbit may differ. The exact test decides; rounding here must lose nothing.
double reach_of(const Scene& scene) {
    return scene.max_tolerance + 1e-12 * scene.diameter;
}

/// One end of a chain of four: the point, its distance to its neighbour and to the point after that.
struct Wing {
    double far = 0;
    double near = 0;
    int point = 0;
};

/// The points that can follow (from, apex) with |apex point| = |from apex|, sorted by their distance to
/// `from`.
void wings(const Scene& scene, int from, int apex, std::vector<Wing>& out) {
    out.clear();
    const double link = scene.distances(from, apex);
    const auto to_from = scene.distances.row(from);
    const double reach = reach_of(scene);
    scene.distances.visit_shell(apex, link - reach, link + reach, [&](int q, double near) {
        if (q != from && scene.label(q) == scene.label(apex))
            out.push_back({to_from[static_cast<std::size_t>(q)], near, q});
        return true;
    });
    std::sort(out.begin(), out.end(), [](const Wing& x, const Wing& y) { return x.far < y.far; });
}

}  // namespace

/// Bits, for the loops over all pairs to ask them in the cache, where the rows of distances do not fit.
class Fourths::Mates {
public:
    explicit Mates(const Scene& scene)
        : width_((static_cast<std::size_t>(scene.size()) + 63) / 64),
          bits_(width_ * static_cast<std::size_t>(scene.size())) {
        parallel_for(scene.size(), [&](int apex) { find(scene, apex); });
    }

    /// Has `apex` another point of its label as far off as `p`?
    bool has(int apex, int p) const { return (word(apex, p) >> (p & 63) & 1) != 0; }

private:
    void find(const Scene& scene, int apex) {
        const auto d = scene.distances.row(apex);
        int last = -1;
        for (const int p : scene.distances.nearest_first(apex)) {
            if (scene.label(p) != scene.label(apex)) continue;
            if (last >= 0 &&
                d[static_cast<std::size_t>(p)] - d[static_cast<std::size_t>(last)] <= reach_of(scene))
                for (const int mate : {last, p}) bits_[place(apex, mate)] |= std::uint64_t{1} << (mate & 63);
            last = p;
        }
    }
    std::size_t place(int apex, int p) const {
        return static_cast<std::size_t>(apex) * width_ + static_cast<std::size_t>(p) / 64;
    }
    std::uint64_t word(int apex, int p) const { return bits_[place(apex, p)]; }

    std::size_t width_;
    std::vector<std::uint64_t> bits_;
};

Fourths::Fourths(const Scene& scene, const Seeds& seeds, std::size_t most_chains, RunMonitor& monitor,
                 std::size_t most_stored)
    : scene_(scene),
      listed_(seeds.listed() ? &seeds : nullptr),
      most_stored_(most_stored),
      stored_(true),
      apexes_(static_cast<std::size_t>(scene.size())) {
    build_all(most_chains, monitor);
    if (stored_) parallel_for(scene.size(), [&](int b) { link_seeds(b); });
}

void Fourths::build_all(std::size_t most_chains, RunMonitor& monitor) {
    std::optional<Mates> mates;
    if (listed_ == nullptr) mates.emplace(scene_);
    std::atomic<std::size_t> stored{0}, chains{0};  // chains from either end
    const auto exceeds = [&] {
        return most_chains > 0 && chains.load(std::memory_order_relaxed) > 2 * most_chains;
    };
    const auto full = [&] { return stored.load(std::memory_order_relaxed) > most_stored_; };
    parallel_for(scene_.size(), [&](int b) {
        if (exceeds() || (most_chains == 0 && full())) return;
        if (mates)
            build(b, *mates, monitor);
        else
            build_listed(b, monitor);
        Apex& apex = apexes_[static_cast<std::size_t>(b)];
        stored += apex.fourths.size();
        chains += static_cast<std::size_t>(std::count_if(apex.fourths.begin(), apex.fourths.end(),
                                                         [](const Candidate& d) { return d.point >= 0; }));
        if (full()) apex = {};  // only counted from here on
    });
    too_many_ = exceeds();
    if (full() || too_many_ || monitor.should_stop()) {
        stored_ = false;
        apexes_ = {};
    }
}

/// Few seeds: each looks for its own.
void Fourths::build_listed(int b, RunMonitor& monitor) {
    Apex& apex = apexes_[static_cast<std::size_t>(b)];
    std::vector<Slot>& seeds = apex.seeds;
    List fourths;
    apex.fourths.push_back(kNobody);
    const auto add = [&](int a, int c) {
        make(a, b, c, fourths);
        if (fourths.size() == 1) return;
        seeds.push_back({a, c, static_cast<SeedLink>(apex.fourths.size())});
        apex.fourths.insert(apex.fourths.end(), fourths.begin(), fourths.end());
    };
    if (monitor.should_stop()) return;
    for (const Seed& seed : listed_->of(b)) {
        if (apex.fourths.size() > most_stored_) return;
        add(seed.a, seed.c);
        add(seed.c, seed.a);
    }
    fill_table(apex);
}

void Fourths::build(int b, const Mates& mates, RunMonitor& monitor) {
    // Where they grow is used again, apex after apex: they are as many as they are only in the end.
    thread_local List fourths;
    thread_local std::vector<Slot> seeds;
    thread_local std::vector<Wing> left, right;
    fourths.assign(1, kNobody);
    seeds.clear();
    const double reach = reach_of(scene_);
    for (int c = 0; c < scene_.size(); ++c) {
        constexpr int kAskedOnce = 16;  // a look at the clock takes as long as a few sides
        if (fourths.size() > most_stored_ || (c % kAskedOnce == 0 && monitor.should_stop())) break;
        if (!mates.has(b, c) || !mates.has(c, b)) continue;
        wings(scene_, c, b, left);
        wings(scene_, b, c, right);
        const double link = scene_.distances(b, c);
        std::size_t first = 0;
        for (const Wing& a : left) {
            while (first < right.size() && right[first].far < a.far - reach) ++first;
            const std::size_t before = fourths.size();
            for (std::size_t k = first; k < right.size() && right[k].far <= a.far + reach; ++k) {
                const Wing& d = right[k];
                if (d.point == a.point) continue;
                Span links{link, link}, steps{a.far, a.far};
                links.include(a.near);
                links.include(d.near);
                steps.include(d.far);
                const double tolerance = tolerance_of_four(links, steps, scene_.distances(a.point, d.point),
                                                           scene_.resolution, scene_.max_tolerance);
                if (tolerance <= scene_.max_tolerance) fourths.push_back({tolerance, d.point});
            }
            if (fourths.size() == before) continue;
            std::sort(fourths.begin() + static_cast<std::ptrdiff_t>(before), fourths.end());
            fourths.push_back(kNobody);
            seeds.push_back({a.point, c, static_cast<SeedLink>(before)});
        }
    }
    Apex& apex = apexes_[static_cast<std::size_t>(b)];
    apex.fourths = fourths;
    apex.seeds = seeds;
    fill_table(apex);
}

void Fourths::fill_table(Apex& apex) const {
    if (apex.seeds.empty()) return;
    if (scene_.size() <= kMostInSquare) {
        apex.square.assign(in_square(scene_.size(), 0), kEmpty);
        for (const Slot& seed : apex.seeds) apex.square[in_square(seed.a, seed.c)] = seed.first;
        return;
    }
    apex.slots.resize(std::bit_ceil(2 * apex.seeds.size()));
    const std::size_t mask = apex.slots.size() - 1;
    for (const Slot& seed : apex.seeds) {
        std::size_t s = place(seed.a, seed.c, mask);
        while (apex.slots[s].a >= 0) s = (s + 1) & mask;
        apex.slots[s] = seed;
    }
}

/// After all apexes are built: each fourth point d of (a, b, c) learns where those of (b, c, d) are.
void Fourths::link_seeds(int b) {
    Apex& apex = apexes_[static_cast<std::size_t>(b)];
    visit_seeds(b, [&](int, int c, SeedLink first) {
        for (Candidate* d = &apex.fourths[first]; d->point >= 0; ++d) d->next = link(b, c, d->point);
    });
}

const Candidate* Fourths::of(int a, int b, int c, List& scratch) const {
    if (const SeedLink known = link(a, b, c); known != kUnknownLink) return of(b, known);
    make(a, b, c, scratch);
    return scratch.data();
}

SeedLink Fourths::find(int a, int b, int c) const {
    const Apex& apex = apexes_[static_cast<std::size_t>(b)];
    if (apex.slots.empty()) return kEmpty;
    const std::size_t mask = apex.slots.size() - 1;
    for (std::size_t s = place(a, c, mask); apex.slots[s].a >= 0; s = (s + 1) & mask)
        if (apex.slots[s].a == a && apex.slots[s].c == c) return apex.slots[s].first;
    return kEmpty;
}

void Fourths::make(int a, int b, int c, List& list) const {
    list.assign(1, kNobody);
    const auto& d = scene_.distances;
    if (scene_.label(a) != scene_.label(b) || scene_.label(c) != scene_.label(b)) return;
    const double slack = reach_of(scene_);
    Span links{d(a, b), d(a, b)};
    links.include(d(b, c));
    d.visit_shell(c, links.high - slack, links.low + slack, [&](int q, double near) {
        if (q == a || q == b || scene_.label(q) != scene_.label(c)) return true;
        Span all = links, steps{d(a, c), d(a, c)};
        all.include(near);
        steps.include(d(b, q));
        const double tolerance =
            tolerance_of_four(all, steps, d(a, q), scene_.resolution, scene_.max_tolerance);
        if (tolerance <= scene_.max_tolerance) list.push_back({tolerance, q});
        return true;
    });
    std::sort(list.begin(), list.end());
}

}  // namespace insym
