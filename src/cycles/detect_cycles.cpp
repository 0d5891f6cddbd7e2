#include "cycles/detect_cycles.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>

#include <tbb/enumerable_thread_specific.h>

#include "cycles/chain.hpp"
#include "cycles/chain_memo.hpp"
#include "cycles/seeds.hpp"
#include "cycles/types.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

/// A sequence in the one form that all its reversals and rotations share.
struct CanonicalCycle {
    std::vector<int> points;
    bool closed = false;
    friend auto operator<=>(const CanonicalCycle&, const CanonicalCycle&) = default;
};

CanonicalCycle canonical(std::span<const int> sequence, bool closed) {
    std::vector<int> p(sequence.begin(), sequence.end());
    if (closed) {
        std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
        if (p.size() > 2 && p[1] > p.back()) std::reverse(p.begin() + 1, p.end());
    } else if (p.front() > p.back()) {
        std::reverse(p.begin(), p.end());
    }
    return {std::move(p), closed};
}

/// Which seeds have a fourth point from which no cycle was found. Thread-safe.
class FailedSeeds {
public:
    explicit FailedSeeds(const Fourths& fourths) : fourths_(fourths), failed_(fourths.seeds()) {}

    void add(int a, int b, int c) {
        if (const auto s = fourths_.seed(a, b, c); s >= 0)
            failed_[static_cast<std::size_t>(s)].store(true, std::memory_order_relaxed);
    }
    /// Also true if the seed has no fourth point, or if that is not known.
    bool contains(int a, int b, int c) const {
        const auto s = fourths_.seed(a, b, c);
        return s < 0 || failed_[static_cast<std::size_t>(s)].load(std::memory_order_relaxed);
    }

private:
    const Fourths& fourths_;
    std::vector<std::atomic<bool>> failed_;
};

/// The expansion of section 4. What it finds depends on the seed alone, never on what was asked
/// before: the memo only saves time. One for each thread.
class Expansion {
public:
    Expansion(const Scene& scene, const Seeds& seeds, const Fourths& fourths, FailedSeeds& failed,
              RunMonitor& monitor)
        : scene_(scene),
          seeds_(seeds),
          fourths_(fourths),
          failed_(failed),
          monitor_(monitor),
          oracle_(scene, fourths),
          type_oracle_(scene),
          chain_(scene),
          extended_(scene) {}

    /// Every chain of four whose second point is `apex`, met once: from its end with the smaller index.
    void expand_fours(int apex);
    /// The seeds about `apex` that close or from which the chains of four find nothing; after all of those.
    void resolve_seeds(int apex);

    std::size_t visited() const { return visited_; }
    std::vector<std::pair<CanonicalCycle, TypeSet>>& found() { return found_; }

private:
    bool is_start(int a, int b, int c, int d) const;
    bool may_be_on_line(const Seed& seed) const;
    bool expand_four(std::span<const int> four, double tolerance, std::array<SeedLink, 2> links);
    using Ends = std::pair<Candidate, Candidate>;  // the best candidates at the left and at the right end
    bool follow_path(double tolerance, std::optional<Ends> ends = {});
    bool follow_branch(const Candidate& next, End end);
    Ends best_ends(double least, double limit);
    End better_end(const Candidate& left, const Candidate& right) const;
    bool follow_both(const Candidate& left, const Candidate& right);
    bool resolve_open(std::span<const int> chain, double tolerance);
    bool resolve_open(std::span<const int> chain, double tolerance, ChainMemo::Id id);
    bool become_cycle(std::span<const int> chain, double tolerance);
    bool resolve_closed(std::span<const int> ring, const Fingerprint& fingerprint, double tolerance);
    bool keep(std::span<const int> sequence, bool closed, double tolerance);
    bool extend(double& tolerance);

    /// Ends tie at every step of an exact row; beyond this length it makes no difference which is first.
    static constexpr int kLongestBranching = Chain::kLongestSaved;
    /// And less where seeds are chosen, in exact rows.
    static constexpr int kLongestBranchingInRows = 5;
    int longest_branching() const { return seeds_.listed() ? kLongestBranchingInRows : kLongestBranching; }
    /// Shorter chains are met once only.
    static constexpr std::size_t kShortestRemembered = 5;

    using Answer = ChainMemo::Answer;
    static Answer answer(bool found) { return found ? Answer::yes : Answer::no; }

    /// The number of a chain in the memo, or none if it is too short for that.
    static constexpr ChainMemo::Id kNone = ~ChainMemo::Id{0};
    ChainMemo::Id remembered(std::span<const int> chain) {
        return chain.size() < kShortestRemembered ? kNone : memo_.id(Fingerprint(chain));
    }
    ChainMemo::Id remembered(const Chain& chain) {
        return chain.points().size() < kShortestRemembered ? kNone : memo_.id(chain.fingerprint());
    }

    /// A chain on the way from a start, and the end at which the next point was added.
    struct Step {
        ChainMemo::Id id;
        End added_at;
        double tolerance;  // E_min of the chain
    };

    const Scene& scene_;
    const Seeds& seeds_;
    const Fourths& fourths_;
    FailedSeeds& failed_;
    RunMonitor& monitor_;
    ChainOracle oracle_;
    TypeOracle type_oracle_;
    ChainMemo memo_;
    ChainMemo rings_;
    Chain chain_;
    int replaced_at_resolution_ = -1;  // C2: of the chain that was asked last a point, if there is one
    std::vector<Step> path_;           // from the start to chain_
    std::optional<bool> four_alone_;   // does the chain of four at hand become a cycle?
    Fourths::List list_;
    Fourths::List fours_;  // the fourth points of a seed
    // Of C3: the chain, what it can take at either end, and with one of these:
    struct Extension {
        Candidate candidate;
        End end;
    };
    Chain extended_;
    std::vector<Candidate> candidates_;
    std::vector<Extension> extensions_;
    std::vector<int> longer_;
    std::vector<ChainMemo::Id> passed_;
    std::size_t visited_ = 0;  // seeds
    std::vector<std::pair<CanonicalCycle, TypeSet>> found_;
};

void Expansion::expand_fours(int apex) {
    const auto expand = [&](int a, int c) {
        fours_.clear();
        for (const Candidate* d = fourths_.of(a, apex, c, list_); d->point >= 0; ++d)
            if (a < d->point && is_start(a, apex, c, d->point)) fours_.push_back(*d);
        if (fours_.empty()) return;
        const SeedLink backwards = fourths_.link(c, apex, a);
        for (const Candidate& d : fours_) {
            const int four[] = {a, apex, c, d.point};
            if (expand_four(four, d.tolerance, {backwards, d.next})) continue;
            failed_.add(a, apex, c);
            failed_.add(d.point, c, apex);
        }
    };
    seeds_.visit(apex, [&](const Seed& seed) {
        ++visited_;
        expand(seed.a, seed.c);
        expand(seed.c, seed.a);
    });
}

/// With both seeds of a chain of four needed, and not both far from the middle of their row.
bool Expansion::is_start(int a, int b, int c, int d) const {
    return !seeds_.superfluous(b, c, d) && !(seeds_.repeats(a, b, c) && seeds_.repeats(b, c, d));
}

/// A path on which nothing is unambiguous and has a type falls back to the chain of four and then to the
/// seed.
void Expansion::resolve_seeds(int apex) {
    seeds_.visit(apex, [&](const Seed& seed) {
        const auto [a, c, links, ends, tolerance] = seed;
        const int points[] = {a, apex, c};
        // An equilateral triangle closes at once; it is met from all three apexes, or of the chosen ones from
        // some.
        Span ring = links;
        ring.include(ends);
        if ((apex < a || seeds_.listed()) && ring.spread() <= scene_.max_tolerance)
            resolve_closed(points, Fingerprint(points, true), std::max(ring.spread(), scene_.resolution));
        const bool alone = fourths_.none(a, apex, c) && fourths_.none(c, apex, a);
        // Where nothing can be added it must be on a line: quicker to ask than C2.
        if (alone && !may_be_on_line(seed)) return;
        if (alone || failed_.contains(a, apex, c) || failed_.contains(c, apex, a))
            resolve_open(points, tolerance);
    });
}

/// With room for rounding: the types decide.
bool Expansion::may_be_on_line(const Seed& seed) const {
    const double slack = seed.tolerance * (1 + 1e-6) + 1e-9 * scene_.diameter;
    return seed.ends / 2 >= seed.links.high - slack && seed.ends / 2 <= seed.links.low + slack;
}

/// In 3D also branches over the best fifth point at either end on each side of the plane of the three
/// points there. True if every branch found a cycle, be it the chain of four itself.
bool Expansion::expand_four(std::span<const int> four, double tolerance, std::array<SeedLink, 2> links) {
    chain_.assign(four, links);
    const Chain::Saved here = chain_.saved();
    const ChainOracle::Sides lefts = oracle_.best_on_sides(chain_, End::left, tolerance);
    const ChainOracle::Sides rights = oracle_.best_on_sides(chain_, End::right, tolerance);
    for (const End end : {End::right, End::left})
        for (const Candidate& fifth : end == End::left ? lefts : rights)
            if (fifth.point >= 0) memo_.prefetch(chain_.fingerprint_with(fifth.point, end));
    const Ends best{*std::min_element(lefts.begin(), lefts.end()),
                    *std::min_element(rights.begin(), rights.end())};
    four_alone_.reset();
    // As with seeds; `four` is in canonical form.
    if (best.first.point < 0 && best.second.point < 0 && type_oracle_.types(four, false, tolerance).empty())
        four_alone_ = false;
    bool found = follow_path(tolerance, best);
    if (scene_.dimension() != 3) return found;
    for (const End end : {End::right, End::left})
        for (const Candidate& fifth : end == End::left ? lefts : rights) {
            if (fifth.point < 0) continue;
            chain_.restore(here);
            if (!follow_branch(fifth, end) && !resolve_open(four, tolerance)) found = false;
        }
    return found;
}

/// The path of chain_ with `next` at `end`; chain_ does not grow where that is known.
bool Expansion::follow_branch(const Candidate& next, End end) {
    const Answer known = memo_.path(chain_.fingerprint_with(next.point, end));
    if (known != Answer::unknown) return known == Answer::yes;
    chain_.add(next, end);
    return follow_path(next.tolerance);
}

/// From chain_ on, with E_min `tolerance` and the best candidates `ends`, if known: adds the point of least
/// E_min at either end until the chain closes at no greater tolerance or nothing fits; keeps the longest
/// chain met that is unambiguous and has a type. True if there is one. What follows depends on the chain
/// alone, so chains met before end it.
bool Expansion::follow_path(double tolerance, std::optional<Ends> ends) {
    const std::size_t first_step = path_.size();
    bool found = false;
    while (true) {
        const ChainMemo::Id id = remembered(chain_);
        if (const auto known = id != kNone ? memo_[id].path : Answer::unknown; known != Answer::unknown) {
            found = known == Answer::yes;
            break;
        }
        if (monitor_.should_stop()) {
            path_.resize(first_step);
            return true;
        }
        const Fingerprint ring = chain_.fingerprint_with(chain_.from(End::left, 0), End::right);
        rings_.prefetch(ring);
        const double closed = oracle_.closed_tolerance(chain_);
        // No longer chain is better than this one.
        if (closed <= tolerance) ends = Ends{ChainOracle::kNobody, ChainOracle::kNobody};
        const auto [left, right] =
            ends ? *ends : best_ends(tolerance, std::min(closed, scene_.max_tolerance));
        ends.reset();
        const double best = std::min(right.tolerance, left.tolerance);
        const bool closes = closed <= std::min(best, scene_.max_tolerance);
        const bool ends_here = closes || best > scene_.max_tolerance;
        const bool parts = right.tolerance == left.tolerance && chain_.size() <= longest_branching();
        if (ends_here || parts) {
            found = ends_here ? closes && resolve_closed(chain_.points(), ring, closed)
                              : follow_both(left, right);
            found = found || resolve_open(chain_.points(), tolerance, id);
            if (id != kNone) memo_[id].path = answer(found);
            break;
        }
        const End to = better_end(left, right);
        path_.push_back({id, to, tolerance});
        const Candidate& next = to == End::right ? right : left;
        chain_.add(next, to);
        tolerance = next.tolerance;
    }
    // Back along the path, each chain a window of the last.
    std::span<const int> window = chain_.points();
    int replaced = -1;  // a point of the window that another can replace at the resolution
    for (; path_.size() > first_step; path_.pop_back()) {
        const auto [id, added_at, window_tolerance] = path_.back();
        const int left_out = added_at == End::right ? window.back() : window.front();
        window = added_at == End::right ? window.first(window.size() - 1) : window.subspan(1);
        if (replaced == left_out) replaced = -1;
        if (!found && replaced >= 0 && window_tolerance <= scene_.resolution) {
            // The resolution, if it is valid for a chain, is for its parts: the same point can be replaced
            // here.
            if (id != kNone) memo_[id].alone = Answer::no;
        } else if (!found) {
            found = resolve_open(window, window_tolerance, id);
            replaced = replaced_at_resolution_;
        }
        if (id != kNone) memo_[id].path = answer(found);
    }
    return found;
}

/// The end with the better candidate, in a way that does not depend on which end is called left: what is
/// remembered of a chain holds for its reverse. In exact rows all are equally good. That they grow next to
/// the lower of two scattered numbers makes parts meet soon: of n points they are n log n parts and not n^2.
End Expansion::better_end(const Candidate& left, const Candidate& right) const {
    const int first = chain_.points().front(), last = chain_.points().back();
    if (left.tolerance != right.tolerance || !seeds_.listed()) {
        if (left != right) return right < left ? End::right : End::left;
        return first < last ? End::right : End::left;
    }
    const auto scattered = [](int point) { return static_cast<std::uint32_t>(point + 1) * 2654435769U; };
    return scattered(first) < scattered(last) ? End::left : End::right;
}

/// Where both ends are equally good, a chain and its reverse part ways, and both are followed: true if there
/// is a cycle on both.
bool Expansion::follow_both(const Candidate& left, const Candidate& right) {
    memo_.prefetch(chain_.fingerprint_with(right.point, End::right));
    memo_.prefetch(chain_.fingerprint_with(left.point, End::left));
    const Chain::Saved here = chain_.saved();
    const bool found = follow_branch(right, End::right);
    chain_.restore(here);
    const bool found_left = follow_branch(left, End::left);
    chain_.restore(here);
    return found && found_left;
}

/// What the second end offers counts only if it is as good as the first.
Expansion::Ends Expansion::best_ends(double least, double limit) {
    const Candidate right = oracle_.best_candidate(chain_, End::right, least, limit);
    return {oracle_.best_candidate(chain_, End::left, least, std::min(limit, right.tolerance)), right};
}

bool Expansion::resolve_open(std::span<const int> chain, double tolerance) {
    return resolve_open(chain, tolerance, remembered(chain));
}

/// Does this chain, with E_min `tolerance`, by itself become a cycle? `id`: its number in the memo.
bool Expansion::resolve_open(std::span<const int> chain, double tolerance, ChainMemo::Id id) {
    passed_.clear();
    replaced_at_resolution_ = -1;
    if (id != kNone) {
        if (const auto known = memo_[id].alone; known != Answer::unknown) return known == Answer::yes;
        passed_.push_back(id);
    } else if (chain.size() == 4 && four_alone_) {
        return *four_alone_;
    }
    const bool unambiguous = oracle_.unambiguous(chain, false, tolerance);
    if (!unambiguous && tolerance <= scene_.resolution) replaced_at_resolution_ = oracle_.replaced_point();
    const bool found = unambiguous && become_cycle(chain, tolerance);
    for (const ChainMemo::Id p : passed_) memo_[p].alone = answer(found);
    if (chain.size() == 4) four_alone_ = found;
    return found;
}

/// C3 by extension, then the types. True if a cycle came out. Each longer chain met on the way
/// would come to the same end, so one answer serves them all: passed_.
bool Expansion::become_cycle(std::span<const int> chain, double tolerance) {
    extended_.assign(chain);
    while (extend(tolerance)) {
        const double closed = oracle_.closed_tolerance(extended_);
        if (closed <= scene_.max_tolerance && oracle_.unambiguous(extended_.points(), true, closed))
            return keep(extended_.points(), true, closed);
        const ChainMemo::Id id = remembered(extended_);
        if (id == kNone) continue;
        if (const auto known = memo_[id].alone; known != Answer::unknown) return known == Answer::yes;
        passed_.push_back(id);
    }
    return keep(extended_.points(), false, tolerance);
}

/// A ring is met from each of its points and in both directions; asked once.
bool Expansion::resolve_closed(std::span<const int> ring, const Fingerprint& fingerprint, double tolerance) {
    const ChainMemo::Id id = rings_.id(fingerprint);
    if (rings_[id].alone == Answer::unknown)
        rings_[id].alone = answer(oracle_.unambiguous(ring, true, tolerance) && keep(ring, true, tolerance));
    return rings_[id].alone == Answer::yes;
}

/// Adds the cycle, with E_min `tolerance`, if it has a type.
bool Expansion::keep(std::span<const int> sequence, bool closed, double tolerance) {
    CanonicalCycle cycle = canonical(sequence, closed);
    const TypeSet types = type_oracle_.types(cycle.points, closed, tolerance);
    if (types.empty()) return false;
    found_.emplace_back(std::move(cycle), types);
    return true;
}

/// C3: extended_ takes the point of least E_min at either end that keeps C1 and C2; ties by the longer
/// sequence, in the direction in which the chain itself comes before its reverse: what is added depends on
/// the chain alone, never on how it was come by.
bool Expansion::extend(double& tolerance) {
    const auto points = extended_.points();
    const End head = points.front() < points.back() ? End::left : End::right;
    const int first = std::min(points.front(), points.back());
    extensions_.clear();
    for (const End end : {End::left, End::right}) {
        oracle_.candidates(extended_, end, candidates_);
        for (const Candidate& candidate : candidates_) extensions_.push_back({candidate, end});
    }
    std::sort(extensions_.begin(), extensions_.end(), [&](const Extension& x, const Extension& y) {
        if (x.candidate.tolerance != y.candidate.tolerance)
            return x.candidate.tolerance < y.candidate.tolerance;
        if (x.end == y.end) return x.candidate.point < y.candidate.point;
        return x.end == head ? x.candidate.point < first : first < y.candidate.point;
    });
    for (const auto& [candidate, end] : extensions_) {
        longer_.assign(points.begin(), points.end());
        longer_.insert(end == End::left ? longer_.begin() : longer_.end(), candidate.point);
        if (!oracle_.unambiguous(longer_, false, candidate.tolerance)) continue;
        extended_.add(candidate, end);
        tolerance = candidate.tolerance;
        return true;
    }
    return false;
}

CycleSearchResult search(const Scene& scene, const Seeds& seeds, const Fourths& fourths,
                         RunMonitor& monitor) {
    FailedSeeds failed(fourths);
    tbb::enumerable_thread_specific<Expansion> expansions(
        [&] { return Expansion(scene, seeds, fourths, failed, monitor); });
    parallel_for(scene.size(), [&](int apex) {
        expansions.local().expand_fours(apex);
        monitor.advance();
    });
    parallel_for(scene.size(), [&](int apex) {
        expansions.local().resolve_seeds(apex);
        monitor.advance();
    });

    CycleSearchResult result;
    result.max_tolerance = scene.max_tolerance;
    result.superfluous_seeds = seeds.left_out();
    std::vector<std::pair<CanonicalCycle, TypeSet>> found;
    for (Expansion& expansion : expansions) {
        result.seeds += expansion.visited();
        std::move(expansion.found().begin(), expansion.found().end(), std::back_inserter(found));
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    found.erase(std::unique(found.begin(), found.end(),
                            [](const auto& a, const auto& b) { return a.first == b.first; }),
                found.end());

    ChainOracle oracle(scene, fourths);
    result.cycles.reserve(found.size());
    for (auto& [cycle, types] : found) {
        const ToleranceInterval tolerance = oracle.interval(cycle.points, cycle.closed);
        result.cycles.push_back({std::move(cycle.points), cycle.closed, types, tolerance});
    }
    return result;
}

}  // namespace

CycleSearchResult detect_cycles(const Scene& scene, const CycleSearch& how, RunMonitor& monitor) {
    constexpr double kLower = 0.8, kLeastResolutions = 10;
    const Rows rows = how.seeds == SeedChoice::all ? Rows() : Rows(scene);
    for (Scene lowered = scene;; lowered.max_tolerance *= kLower) {
        const Seeds seeds(lowered, rows, monitor);
        const bool can_lower = kLower * lowered.max_tolerance >= kLeastResolutions * scene.resolution;
        const Fourths fourths(lowered, seeds, can_lower ? how.most_chains : 0, monitor);
        if (fourths.too_many()) continue;
        CycleSearchResult result = search(lowered, seeds, fourths, monitor);
        result.translations = rows.translations();
        return result;
    }
}

}  // namespace insym
