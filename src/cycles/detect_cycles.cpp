#include "cycles/detect_cycles.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>

#include <tbb/enumerable_thread_specific.h>

#include "cycles/chain.hpp"
#include "cycles/chain_memo.hpp"
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
    Expansion(const Scene& scene, const Fourths& fourths, FailedSeeds& failed, RunMonitor& monitor)
        : scene_(scene),
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

    std::size_t seeds() const { return seeds_; }
    std::vector<std::pair<CanonicalCycle, TypeSet>>& found() { return found_; }

private:
    template <class Visit>
    void visit_seeds(int apex, Visit visit);
    bool expand_four(std::span<const int> four);
    bool expand_side(std::span<const int> four, const std::vector<Candidate>& fifths);
    using Ends = std::pair<Candidate, Candidate>;  // the best candidates at the left and at the right end
    bool follow(std::span<const int> start, const std::optional<Ends>& ends = {});
    bool follow_path(std::optional<Ends> ends);
    Ends best_ends(double limit);
    End better_end(const Candidate& left, const Candidate& right) const;
    bool follow_both(int left, int right);
    bool resolve_open(std::span<const int> chain);
    bool resolve_open(std::span<const int> chain, ChainMemo::Id id);
    bool become_cycle(std::span<const int> chain);
    bool resolve_closed(std::span<const int> ring);
    bool keep(std::span<const int> sequence, bool closed);
    bool extend(std::vector<int>& sequence);
    int side(std::span<const int> chain, int point) const;

    /// Ends tie at every step of an exact row; beyond this length it makes no difference which is first.
    static constexpr int kLongestBranching = 8;
    /// Shorter chains are met once only.
    static constexpr std::size_t kShortestRemembered = 5;

    using Answer = ChainMemo::Answer;
    static Answer answer(bool found) { return found ? Answer::yes : Answer::no; }

    /// The number of a chain in the memo, or none if it is too short for that.
    static constexpr ChainMemo::Id kNone = ~ChainMemo::Id{0};
    ChainMemo::Id remembered(std::span<const int> chain) {
        return chain.size() < kShortestRemembered ? kNone : memo_.id(chain);
    }

    /// A chain on the way from a start, and the end at which the next point was added.
    struct Step {
        ChainMemo::Id id;
        End added_at;
    };

    const Scene& scene_;
    const Fourths& fourths_;
    FailedSeeds& failed_;
    RunMonitor& monitor_;
    ChainOracle oracle_;
    TypeOracle type_oracle_;
    ChainMemo memo_;
    ChainMemo rings_;
    Chain chain_;
    std::vector<Step> path_;          // from the start to chain_
    std::optional<bool> four_alone_;  // does the chain of four at hand become a cycle?
    Fourths::List list_;
    std::vector<int> fours_;  // the fourth points of a seed
    std::vector<Candidate> left_fifths_, right_fifths_;
    Chain extended_;
    std::vector<Candidate> extensions_;
    std::vector<ChainMemo::Id> passed_;
    std::size_t seeds_ = 0;
    std::vector<std::pair<CanonicalCycle, TypeSet>> found_;
};

/// Calls visit(a, c) for every seed (a, apex, c) with a < c: a and c are at nearly the same distance, so each
/// a looks only at the few that follow it in the list by distance.
template <class Visit>
void Expansion::visit_seeds(int apex, Visit visit) {
    const auto d = scene_.distances.row(apex);
    const auto others = scene_.distances.nearest_first(apex);
    for (std::size_t i = 0; i < others.size(); ++i) {
        if (scene_.label(others[i]) != scene_.label(apex)) continue;
        if (monitor_.should_stop()) return;
        const double near = d[static_cast<std::size_t>(others[i])];
        for (std::size_t j = i + 1; j < others.size(); ++j) {
            const double far = d[static_cast<std::size_t>(others[j])];
            if (far - near > scene_.max_tolerance) break;
            const auto [a, c] = std::minmax(others[i], others[j]);
            const int seed[] = {a, apex, c};
            if (oracle_.holds(seed, false)) visit(a, c);
        }
    }
}

void Expansion::expand_fours(int apex) {
    const auto expand = [&](int a, int c) {
        const auto fourths = fourths_.of(a, apex, c, list_);
        fours_.clear();
        for (const Candidate& d : fourths)
            if (a < d.point) fours_.push_back(d.point);
        for (const int d : fours_) {
            const int four[] = {a, apex, c, d};
            if (expand_four(four)) continue;
            failed_.add(a, apex, c);
            failed_.add(d, c, apex);
        }
    };
    visit_seeds(apex, [&](int a, int c) {
        ++seeds_;
        expand(a, c);
        expand(c, a);
    });
}

/// A path on which nothing is unambiguous and has a type falls back to the chain of four and then to the
/// seed.
void Expansion::resolve_seeds(int apex) {
    visit_seeds(apex, [&](int a, int c) {
        const int seed[] = {a, apex, c};
        // An equilateral triangle closes at once; it is met from all three apexes.
        if (apex < a && oracle_.holds(seed, true)) resolve_closed(seed);
        if (failed_.contains(a, apex, c) || failed_.contains(c, apex, a)) resolve_open(seed);
    });
}

/// In 3D also branches over the best fifth point at either end on each side of the plane of the three
/// points there. True if every branch found a cycle, be it the chain of four itself.
bool Expansion::expand_four(std::span<const int> four) {
    chain_.assign(four);
    oracle_.candidates(chain_, End::right, right_fifths_);
    oracle_.candidates(chain_, End::left, left_fifths_);
    constexpr Candidate kNobody{std::numeric_limits<double>::infinity(), -1};
    const auto best = [&](const auto& list) { return list.empty() ? kNobody : list.front(); };
    four_alone_.reset();
    bool found = follow(four, Ends{best(left_fifths_), best(right_fifths_)});
    if (scene_.dimension() == 3) {
        const int reversed[] = {four[3], four[2], four[1], four[0]};
        found = expand_side(four, right_fifths_) && found;
        found = expand_side(reversed, left_fifths_) && found;
    }
    return found;
}

bool Expansion::expand_side(std::span<const int> four, const std::vector<Candidate>& fifths) {
    bool found = true;
    bool taken[3] = {false, false, false};
    for (const Candidate& fifth : fifths) {
        bool& done = taken[side(four, fifth.point) + 1];
        if (done) continue;
        done = true;
        const int five[] = {four[0], four[1], four[2], four[3], fifth.point};
        if (!follow(five) && !resolve_open(four)) found = false;
    }
    return found;
}

int Expansion::side(std::span<const int> chain, int point) const {
    const Point& a = scene_.position(chain[1]);
    const auto from_a = [&](int i) {
        const Point& p = scene_.position(i);
        return Point{p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    };
    const Point u = from_a(chain[2]), v = from_a(chain[3]), w = from_a(point);
    const double volume = (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
                          (u[0] * v[1] - u[1] * v[0]) * w[2];
    return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

/// Adds the point of least E_min at either end until the chain closes at no greater tolerance or
/// nothing fits; keeps the longest chain met that is unambiguous and has a type. True if there is one.
/// `ends`: those of `start`, if known.
bool Expansion::follow(std::span<const int> start, const std::optional<Ends>& ends) {
    chain_.assign(start);
    return follow_path(ends);
}

/// The same from chain_ on. What follows depends on the chain alone, so chains met before end it.
bool Expansion::follow_path(std::optional<Ends> ends) {
    const std::size_t first_step = path_.size();
    bool found = false;
    while (true) {
        const ChainMemo::Id id = remembered(chain_.points());
        if (const auto known = id != kNone ? memo_[id].path : Answer::unknown; known != Answer::unknown) {
            found = known == Answer::yes;
            break;
        }
        if (monitor_.should_stop()) {
            path_.resize(first_step);
            return true;
        }
        const double closed = oracle_.closed_tolerance(chain_);
        const auto [left, right] = ends ? *ends : best_ends(std::min(closed, scene_.max_tolerance));
        ends.reset();
        const double best = std::min(right.tolerance, left.tolerance);
        const bool closes = closed <= std::min(best, scene_.max_tolerance);
        const bool ends_here = closes || best > scene_.max_tolerance;
        const bool parts = right.tolerance == left.tolerance && chain_.size() <= kLongestBranching;
        if (ends_here || parts) {
            found =
                ends_here ? closes && resolve_closed(chain_.points()) : follow_both(left.point, right.point);
            found = found || resolve_open(chain_.points(), id);
            if (id != kNone) memo_[id].path = answer(found);
            break;
        }
        const End to = better_end(left, right);
        path_.push_back({id, to});
        chain_.add(to == End::right ? right.point : left.point, to);
    }
    // Back along the path, each chain a window of the last.
    std::span<const int> window = chain_.points();
    for (; path_.size() > first_step; path_.pop_back()) {
        const auto [id, added_at] = path_.back();
        window = added_at == End::right ? window.first(window.size() - 1) : window.subspan(1);
        found = found || resolve_open(window, id);
        if (id != kNone) memo_[id].path = answer(found);
    }
    return found;
}

/// The end with the better candidate, in a way that does not depend on which end is called left: what is
/// remembered of a chain holds for its reverse.
End Expansion::better_end(const Candidate& left, const Candidate& right) const {
    if (left != right) return right < left ? End::right : End::left;
    return chain_.points().front() < chain_.points().back() ? End::right : End::left;
}

/// Where both ends are equally good, a chain and its reverse part ways, and both are followed: true if there
/// is a cycle on both.
bool Expansion::follow_both(int left, int right) {
    const std::vector<int> here(chain_.points().begin(), chain_.points().end());
    chain_.add(right, End::right);
    const bool found = follow_path({});
    chain_.assign(here);
    chain_.add(left, End::left);
    const bool found_left = follow_path({});
    chain_.assign(here);
    return found && found_left;
}

/// What the second end offers counts only if it is as good as the first.
Expansion::Ends Expansion::best_ends(double limit) {
    const Candidate right = oracle_.best_candidate(chain_, End::right, limit);
    return {oracle_.best_candidate(chain_, End::left, std::min(limit, right.tolerance)), right};
}

bool Expansion::resolve_open(std::span<const int> chain) {
    return resolve_open(chain, remembered(chain));
}

/// Does this chain by itself become a cycle? `id`: its number in the memo.
bool Expansion::resolve_open(std::span<const int> chain, ChainMemo::Id id) {
    passed_.clear();
    if (id != kNone) {
        if (const auto known = memo_[id].alone; known != Answer::unknown) return known == Answer::yes;
        passed_.push_back(id);
    } else if (chain.size() == 4 && four_alone_) {
        return *four_alone_;
    }
    const bool found = oracle_.unambiguous(chain, false) && become_cycle(chain);
    for (const ChainMemo::Id p : passed_) memo_[p].alone = answer(found);
    if (chain.size() == 4) four_alone_ = found;
    return found;
}

/// C3 by extension, then the types. True if a cycle came out. Each longer chain met on the way
/// would come to the same end, so one answer serves them all: passed_.
bool Expansion::become_cycle(std::span<const int> chain) {
    std::vector<int> s(chain.begin(), chain.end());
    if (s.front() > s.back()) std::reverse(s.begin(), s.end());
    while (extend(s)) {
        if (oracle_.holds(s, true) && oracle_.unambiguous(s, true)) return keep(s, true);
        const ChainMemo::Id id = remembered(s);
        if (id == kNone) continue;
        if (const auto known = memo_[id].alone; known != Answer::unknown) return known == Answer::yes;
        passed_.push_back(id);
    }
    return keep(s, false);
}

/// A ring is met from each of its points and in both directions; asked once.
bool Expansion::resolve_closed(std::span<const int> ring) {
    const CanonicalCycle cycle = canonical(ring, true);
    const ChainMemo::Id id = rings_.id(cycle.points);
    if (rings_[id].alone == Answer::unknown)
        rings_[id].alone = answer(oracle_.unambiguous(cycle.points, true) && keep(cycle.points, true));
    return rings_[id].alone == Answer::yes;
}

/// Adds the cycle if it has a type.
bool Expansion::keep(std::span<const int> sequence, bool closed) {
    CanonicalCycle cycle = canonical(sequence, closed);
    const TypeSet types =
        type_oracle_.types(cycle.points, closed, oracle_.interval(cycle.points, closed).min);
    if (types.empty()) return false;
    found_.emplace_back(std::move(cycle), types);
    return true;
}

/// C3: takes the point of least E_min at either end that keeps C1 and C2; ties by the sequence.
bool Expansion::extend(std::vector<int>& sequence) {
    extended_.assign(sequence);
    std::vector<std::pair<double, std::vector<int>>> longer;
    for (const End end : {End::left, End::right}) {
        oracle_.candidates(extended_, end, extensions_);
        for (const Candidate& candidate : extensions_) {
            std::vector<int> s = sequence;
            s.insert(end == End::left ? s.begin() : s.end(), candidate.point);
            longer.emplace_back(candidate.tolerance, std::move(s));
        }
    }
    std::sort(longer.begin(), longer.end());
    for (auto& [tolerance, s] : longer)
        if (oracle_.unambiguous(s, false)) {
            sequence = std::move(s);
            return true;
        }
    return false;
}

}  // namespace

CycleSearchResult detect_cycles(const Scene& scene, RunMonitor& monitor) {
    monitor.begin_stage("cycles", 2 * static_cast<std::size_t>(scene.size()));
    const Fourths fourths(scene, monitor);
    FailedSeeds failed(fourths);
    tbb::enumerable_thread_specific<Expansion> expansions(
        [&] { return Expansion(scene, fourths, failed, monitor); });
    parallel_for(scene.size(), [&](int apex) {
        expansions.local().expand_fours(apex);
        monitor.advance();
    });
    parallel_for(scene.size(), [&](int apex) {
        expansions.local().resolve_seeds(apex);
        monitor.advance();
    });

    CycleSearchResult result;
    std::vector<std::pair<CanonicalCycle, TypeSet>> found;
    for (Expansion& expansion : expansions) {
        result.seeds += expansion.seeds();
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

}  // namespace insym
