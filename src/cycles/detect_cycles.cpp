#include "cycles/detect_cycles.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include "cycles/chain.hpp"
#include "cycles/chain_memo.hpp"
#include "cycles/five_table.hpp"
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

/// Which seeds have a fourth point from which no cycle was found; by their apex and where their fourth points
/// are stored. Thread-safe.
class FailedSeeds {
public:
    FailedSeeds(const Fourths& fourths, int apexes) {
        if (!fourths.stored()) return;
        for (int b = 0; b < apexes; ++b) failed_.emplace_back(fourths.stored_about(b));
    }

    void add(int apex, SeedLink list) {
        if (list != kUnknownLink) of(apex)[list].store(true, std::memory_order_relaxed);
    }
    /// Also true if the seed has no fourth point, or if that is not known.
    bool contains(int apex, SeedLink list) const {
        return list == kUnknownLink || list == Fourths::kEmpty ||
               of(apex)[list].load(std::memory_order_relaxed);
    }

private:
    using Flags = std::vector<std::atomic<bool>>;
    Flags& of(int apex) { return failed_[static_cast<std::size_t>(apex)]; }
    const Flags& of(int apex) const { return failed_[static_cast<std::size_t>(apex)]; }

    std::vector<Flags> failed_;
};

/// What is known of the chains of five that branch from a chain of four at one of its ends.
struct Branches {
    double best = std::numeric_limits<double>::infinity();  ///< least E_min
    bool failed = false;                                    ///< did one find no cycle?
    bool tied = false;                                      ///< did one depend on where ties go?

    bool none() const { return best == std::numeric_limits<double>::infinity(); }
};

/// Those of each chain of four (a, b, c, d) beyond a, by where d is among the fourth points of b. Those
/// beyond d are about c, where a is a fourth point of (d, c, b). Each thread writes what belongs to the
/// apexes that are its own.
class FourBranches {
public:
    FourBranches(const Fourths& fourths, int apexes) {
        if (!fourths.stored()) return;
        for (int b = 0; b < apexes; ++b) branches_.emplace_back(fourths.stored_about(b));
    }

    Branches& of(int apex, std::size_t fourth) { return branches_[static_cast<std::size_t>(apex)][fourth]; }

private:
    std::vector<std::vector<Branches>> branches_;
};

/// Are chains of five met in tables, and those of four after them?
bool in_tables(const Scene& scene, const Fourths& fourths) {
    return fourths.stored() && scene.dimension() == 3;
}

/// The expansion of section 4. What it finds depends on the seed alone, never on what was asked
/// before: the memo only saves time. One for each thread.
class Expansion {
public:
    Expansion(const Scene& scene, const Seeds& seeds, const Fourths& fourths, FourBranches& branches,
              FailedSeeds& failed, RunMonitor& monitor)
        : scene_(scene),
          seeds_(seeds),
          fourths_(fourths),
          branches_(branches),
          failed_(failed),
          monitor_(monitor),
          shortest_remembered_(in_tables(scene, fourths) ? kShortestRememberedInTables : kShortestRemembered),
          oracle_(scene, fourths),
          type_oracle_(scene),
          table_(scene),
          chain_(scene),
          extended_(scene) {}

    /// Every chain of five whose middle is `apex` and that a chain of four branches to. In 3D, and where the
    /// fourth points are stored.
    void follow_fives(int apex);
    /// After that, every chain of four whose second point is `apex`, met once: from its end with the smaller
    /// index.
    void resolve_fours(int apex);
    /// The same of both where the chains of five are not known.
    void expand_fours(int apex);
    /// The seeds about `apex` that close or from which the chains of four find nothing; after all of those.
    void resolve_seeds(int apex);

    std::size_t visited() const { return visited_; }
    std::vector<std::pair<CanonicalCycle, TypeSet>>& found() { return found_; }
    ToleranceInterval interval(std::span<const int> points, bool closed) {
        return oracle_.interval(points, closed);
    }

private:
    /// A look at the clock takes as long as some steps.
    bool should_stop() {
        constexpr unsigned kAskedOnce = 32;
        stopped_ = stopped_ || (++steps_ % kAskedOnce == 0 && monitor_.should_stop());
        return stopped_;
    }
    bool is_start(int a, int b, int c, int d) const;
    void begin_start(std::span<const int> chain) {
        start_size_ = chain.size();
        start_alone_.reset();
    }
    bool may_be_on_line(const Seed& seed) const;
    bool expand_four(std::span<const int> four, double tolerance, std::array<SeedLink, 2> links);
    using Ends = std::pair<Candidate, Candidate>;  // the best candidates at the left and at the right end
    void follow_five(const FiveTable::Start& start, const std::array<int, 3>& seed, Branches& row,
                     Branches& column);
    bool replaces(const Candidate& other, std::span<const int, 4> four, std::size_t at, double eps);
    bool resolve_four(std::span<const int> four, double tolerance, std::array<SeedLink, 2> links,
                      const Branches& left, const Branches& right);
    bool follow_path(double tolerance, std::optional<Ends> ends = {}, bool met_once = false);
    bool fall_back(bool found, std::size_t tied);
    bool prefers_lower(int left, int right) const;
    void remember(std::span<const int> chain, ChainMemo::Id id, bool found, bool depends);
    Ends best_ends(double least, double limit);
    End better_end(const Candidate& left, const Candidate& right) const;
    bool resolve_open(std::span<const int> chain, double tolerance);
    bool resolve_open(std::span<const int> chain, double tolerance, ChainMemo::Id id);
    bool become_cycle(std::span<const int> chain, double tolerance);
    bool resolve_closed(std::span<const int> ring, double tolerance);
    bool keep(std::span<const int> sequence, bool closed, double tolerance);
    bool extend(double& tolerance);

    /// Up to this length a tie goes to the end at which the path began to grow. In exact rows ends tie at
    /// every step, and beyond it makes no difference which is first.
    static constexpr int kLongestPreferring = 8;
    /// And less where seeds are chosen, in exact rows.
    static constexpr int kLongestPreferringInRows = 5;
    int longest_preferring() const { return seeds_.listed() ? kLongestPreferringInRows : kLongestPreferring; }
    /// Shorter chains are met once, in tables mostly: to follow them again takes less than to remember them.
    static constexpr std::size_t kShortestRemembered = 5;
    static constexpr std::size_t kShortestRememberedInTables = 7;
    /// So many chains of five ahead is asked for what they can take.
    static constexpr std::size_t kPrefetched = 2;

    using Answer = ChainMemo::Answer;
    static Answer answer(bool found) { return found ? Answer::yes : Answer::no; }

    /// The number of a chain in the memo, or none if it is too short for that.
    static constexpr ChainMemo::Id kNone = ~ChainMemo::Id{0};
    ChainMemo::Id remembered(std::span<const int> chain) {
        return chain.size() < shortest_remembered_ ? kNone : memo_.id(Fingerprint(chain));
    }
    ChainMemo::Id remembered(const Chain& chain) {
        return chain.points().size() < shortest_remembered_ ? kNone : memo_.id(chain.fingerprint());
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
    FourBranches& branches_;
    FailedSeeds& failed_;
    RunMonitor& monitor_;
    const std::size_t shortest_remembered_;
    ChainOracle oracle_;
    TypeOracle type_oracle_;
    FiveTable table_;
    ChainMemo memo_;
    ChainMemo rings_;
    Chain chain_;
    int replaced_at_resolution_ = -1;  // C2: of the chain that was asked last a point, if there is one
    std::vector<Step> path_;           // from the start to chain_
    End preferred_ = End::right;       // where ends tie
    bool tied_ = false;                // did the last path depend on that?
    Ends first_ends_;                  // what the start of the last path can take
    // Does the chain at hand, of so many points, by itself become a cycle? It is not in the memo.
    std::size_t start_size_ = 0;
    std::optional<bool> start_alone_;
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
    unsigned steps_ = 0;
    bool stopped_ = false;
    std::size_t visited_ = 0;  // seeds
    std::vector<std::pair<CanonicalCycle, TypeSet>> found_;
};

void Expansion::follow_fives(int apex) {
    fourths_.visit_seeds(apex, [&](int a, int c, SeedLink right) {
        if (a > c || should_stop()) return;
        const SeedLink left = fourths_.link(c, apex, a);
        if (left == Fourths::kEmpty) return;
        table_.fill(
            {a, apex, c}, fourths_.of(apex, left), fourths_.of(apex, right),
            [&](int before) { return is_start(c, apex, a, before); },
            [&](int after) { return is_start(a, apex, c, after); });
        for (std::size_t i = 0; i < table_.rows(); ++i)
            branches_.of(apex, left + i).best = table_.row(i).best;
        for (std::size_t j = 0; j < table_.columns(); ++j)
            branches_.of(apex, right + j).best = table_.column(j).best;
        const std::vector<FiveTable::Start>& starts = table_.starts();
        for (std::size_t k = 0; k < starts.size(); ++k) {
            if (k + kPrefetched < starts.size()) {
                const FiveTable::Start& later = starts[k + kPrefetched];
                fourths_.prefetch(a, table_.row(later.row).fourth.next);
                fourths_.prefetch(c, table_.column(later.column).fourth.next);
            }
            follow_five(starts[k], {a, apex, c}, branches_.of(apex, left + starts[k].row),
                        branches_.of(apex, right + starts[k].column));
        }
    });
}

/// As a branch of its row it grows to the right first, of its column to the left; that makes a difference
/// only where ends tie.
void Expansion::follow_five(const FiveTable::Start& start, const std::array<int, 3>& seed, Branches& row,
                            Branches& column) {
    const Candidate &first = table_.row(start.row).fourth, &last = table_.column(start.column).fourth;
    const int five[] = {first.point, seed[0], seed[1], seed[2], last.point};
    begin_start(five);
    if (table_.ambiguous(start)) start_alone_ = false;
    std::optional<bool> found;  // whichever end is preferred
    std::optional<Ends> ends;
    const auto follow = [&](End end, Branches& branches) {
        if (!found || tied_) {
            chain_.assign(five, {first.next, last.next});
            preferred_ = end;
            found = follow_path(start.tolerance, ends, true);
            ends = first_ends_;
        }
        if (!*found) branches.failed = true;
        if (tied_) branches.tied = true;
    };
    if (start.of_row) follow(End::right, row);
    if (start.of_column) follow(End::left, column);
}

void Expansion::resolve_fours(int apex) {
    fourths_.visit_seeds(apex, [&](int a, int c, SeedLink list) {
        if (should_stop()) return;
        const Candidate* const first = fourths_.of(apex, list);
        const SeedLink beyond_a = fourths_.link(c, apex, a);
        std::size_t k = list;
        for (const Candidate* d = first; d->point >= 0; ++d, ++k) {
            if (d->point < a || !is_start(a, apex, c, d->point)) continue;
            const int four[] = {a, apex, c, d->point};
            const SeedLink backwards = fourths_.link(d->point, c, apex);
            const Candidate* const back_first = fourths_.of(c, backwards);
            std::size_t back = backwards;
            for (const Candidate* p = back_first; p->point >= 0 && p->point != a; ++p) ++back;
            begin_start(four);
            if (replaces(*first, four, 3, d->tolerance) || replaces(*back_first, four, 0, d->tolerance))
                start_alone_ = false;
            if (resolve_four(four, d->tolerance, {beyond_a, d->next}, branches_.of(apex, k),
                             branches_.of(c, back)))
                continue;
            failed_.add(apex, list);
            failed_.add(c, backwards);
        }
    });
}

/// C2: can `other` stand in the place `at` of a chain of four with E_min `eps`?
bool Expansion::replaces(const Candidate& other, std::span<const int, 4> four, std::size_t at, double eps) {
    if (other.point == four[at] || other.tolerance > eps) return false;
    std::array<int, 4> replaced;
    std::copy(four.begin(), four.end(), replaced.begin());
    replaced[at] = other.point;
    return eps < oracle_.interval(replaced, false).max;
}

/// After its branches. The path of a chain of four is that of the best of them unless it closes; where one
/// finds nothing, the chain itself is asked.
bool Expansion::resolve_four(std::span<const int> four, double tolerance, std::array<SeedLink, 2> links,
                             const Branches& left, const Branches& right) {
    chain_.assign(four, links);
    const bool ends_here = left.none() && right.none();
    // As with seeds; `four` is in canonical form.
    if (ends_here && !start_alone_ && type_oracle_.types(four, false, tolerance).empty())
        start_alone_ = false;
    bool found = !ends_here;
    const double closed = oracle_.closed_tolerance(chain_);
    const bool closes = closed <= std::min({left.best, right.best, scene_.max_tolerance});
    if (closes || ends_here)
        found = (closes && resolve_closed(four, closed)) || resolve_open(four, tolerance);
    bool failed = left.failed || right.failed;
    // Read the way in which it has nothing to its right, its own path grows to the left, but prefers the
    // right.
    if (!closes && left.none() != right.none() && (left.tied || right.tied)) {
        preferred_ = left.none() ? End::left : End::right;
        if (!follow_path(tolerance)) failed = true;
    }
    if (failed) found = resolve_open(four, tolerance) && found;
    return found;
}

void Expansion::expand_fours(int apex) {
    const auto expand = [&](int a, int c) {
        fours_.clear();
        for (const Candidate* d = fourths_.of(a, apex, c, list_); d->point >= 0; ++d)
            if (a < d->point && is_start(a, apex, c, d->point)) fours_.push_back(*d);
        if (fours_.empty()) return;
        const SeedLink list = fourths_.link(a, apex, c), backwards = fourths_.link(c, apex, a);
        for (const Candidate& d : fours_) {
            const int four[] = {a, apex, c, d.point};
            if (expand_four(four, d.tolerance, {backwards, d.next})) continue;
            failed_.add(apex, list);
            failed_.add(c, fourths_.link(d.point, c, apex));
        }
    };
    seeds_.visit(apex, [&](const Seed& seed) {
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
        ++visited_;
        const auto [a, c, links, ends, tolerance] = seed;
        const int points[] = {a, apex, c};
        begin_start(points);
        // An equilateral triangle closes at once; it is met from all three apexes, or of the chosen ones from
        // some.
        Span ring = links;
        ring.include(ends);
        if ((apex < a || seeds_.listed()) && ring.spread() <= scene_.max_tolerance)
            resolve_closed(points, std::max(ring.spread(), scene_.resolution));
        const SeedLink right = fourths_.link(a, apex, c), left = fourths_.link(c, apex, a);
        const bool alone = right == Fourths::kEmpty && left == Fourths::kEmpty;
        // Where nothing can be added it must be on a line: quicker to ask than C2.
        if (alone && !may_be_on_line(seed)) return;
        if (alone || failed_.contains(apex, right) || failed_.contains(apex, left))
            resolve_open(points, tolerance);
    });
}

/// With room for rounding: the types decide.
bool Expansion::may_be_on_line(const Seed& seed) const {
    const double slack = seed.tolerance * (1 + 1e-6) + 1e-9 * scene_.diameter;
    return seed.ends / 2 >= seed.links.high - slack && seed.ends / 2 <= seed.links.low + slack;
}

/// True if every branch found a cycle, be it the chain of four itself. In 3D it branches over the best fifth
/// point at either end on each side of the plane of the three points there.
bool Expansion::expand_four(std::span<const int> four, double tolerance, std::array<SeedLink, 2> links) {
    begin_start(four);
    chain_.assign(four, links);
    if (scene_.dimension() != 3) {
        preferred_ = End::right;
        const bool found = follow_path(tolerance);
        if (!tied_) return found;
        chain_.assign(four, links);
        preferred_ = End::left;
        return follow_path(tolerance) && found;
    }
    const ChainOracle::Sides lefts = oracle_.best_on_sides(chain_, End::left, tolerance);
    const ChainOracle::Sides rights = oracle_.best_on_sides(chain_, End::right, tolerance);
    const auto branches = [&](const ChainOracle::Sides& fifths, End end) {
        Branches result;
        for (const Candidate& fifth : fifths) {
            if (fifth.point < 0) continue;
            result.best = std::min(result.best, fifth.tolerance);
            chain_.assign(four, links);
            chain_.add(fifth, end);
            preferred_ = end;
            if (!follow_path(fifth.tolerance)) result.failed = true;
            if (tied_) result.tied = true;
        }
        return result;
    };
    const Branches right = branches(rights, End::right), left = branches(lefts, End::left);
    return resolve_four(four, tolerance, links, left, right);
}

/// Is the end that a tie goes to that of the lower index? The same for a chain and its reverse.
bool Expansion::prefers_lower(int left, int right) const {
    return preferred_ == End::left ? left < right : right < left;
}

/// Does the path from `chain` on find a cycle? `depends`: on the preferred end.
void Expansion::remember(std::span<const int> chain, ChainMemo::Id id, bool found, bool depends) {
    if (id == kNone) return;
    const bool lower = prefers_lower(chain.front(), chain.back());
    memo_[id].path[lower ? 1 : 0] = answer(found);
    if (!depends) memo_[id].path[lower ? 0 : 1] = answer(found);
}

/// From chain_ on, with E_min `tolerance` and the best candidates `ends`, if known: adds the point of least
/// E_min at either end until the chain closes at no greater tolerance or nothing fits; keeps the longest
/// chain met that is unambiguous and has a type. True if there is one. What follows depends on the chain and
/// the preferred end alone, so chains met before end it. `met_once`: this chain will not be met again.
bool Expansion::follow_path(double tolerance, std::optional<Ends> ends, bool met_once) {
    path_.clear();
    std::size_t tied = 0;  // so many of the first steps depend on the preferred end
    bool found = false, depends = false;
    while (true) {
        // What is far off in memory is asked for before it is needed.
        if (!met_once && chain_.points().size() >= shortest_remembered_) memo_.prefetch(chain_.fingerprint());
        if (!ends) oracle_.prefetch_candidates(chain_);
        const double closed = oracle_.closed_tolerance(chain_);
        const ChainMemo::Id id = met_once ? kNone : remembered(chain_);
        met_once = false;
        if (id != kNone) {
            const bool lower = prefers_lower(chain_.points().front(), chain_.points().back());
            const auto known = memo_[id].path[lower ? 1 : 0];
            if (known != Answer::unknown) {
                found = known == Answer::yes;
                depends = memo_[id].path[lower ? 0 : 1] != known;
                if (depends) tied = path_.size();
                break;
            }
        }
        if (should_stop()) {
            tied_ = false;
            return true;
        }
        // No longer chain is better than this one.
        if (closed <= tolerance) ends = Ends{ChainOracle::kNobody, ChainOracle::kNobody};
        const auto [left, right] =
            ends ? *ends : best_ends(tolerance, std::min(closed, scene_.max_tolerance));
        ends.reset();
        if (path_.empty()) first_ends_ = {left, right};
        const double best = std::min(right.tolerance, left.tolerance);
        const bool closes = closed <= std::min(best, scene_.max_tolerance);
        if (closes || best > scene_.max_tolerance) {
            found = (closes && resolve_closed(chain_.points(), closed)) ||
                    resolve_open(chain_.points(), tolerance, id);
            remember(chain_.points(), id, found, false);
            break;
        }
        if (left.tolerance == right.tolerance && chain_.size() <= longest_preferring())
            tied = path_.size() + 1;
        const End to = better_end(left, right);
        path_.push_back({id, to, tolerance});
        const Candidate& next = to == End::right ? right : left;
        chain_.add(next, to);
        tolerance = next.tolerance;
    }
    tied_ = depends || tied > 0;
    return fall_back(found, tied);
}

/// Back along path_ from chain_, each chain a window of the last: while nothing is `found`, is it in the
/// window? `tied`: so many of the first steps depend on the preferred end.
bool Expansion::fall_back(bool found, std::size_t tied) {
    std::span<const int> window = chain_.points();
    int replaced = -1;  // a point of the window that another can replace at the resolution
    for (; !path_.empty(); path_.pop_back()) {
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
        remember(window, id, found, path_.size() <= tied);
    }
    return found;
}

/// The end with the better candidate. Of equally good ones a short chain takes that at the preferred end, as
/// the reference does; a long one, in a way that does not depend on which end is called left, that next to
/// the lower of two scattered numbers where seeds are chosen, in exact rows: so parts meet soon, of n points
/// n log n parts and not n^2.
End Expansion::better_end(const Candidate& left, const Candidate& right) const {
    const int first = chain_.points().front(), last = chain_.points().back();
    if (left.tolerance != right.tolerance) return right < left ? End::right : End::left;
    if (chain_.size() <= longest_preferring()) return preferred_;
    if (!seeds_.listed()) {
        if (left != right) return right < left ? End::right : End::left;
        return first < last ? End::right : End::left;
    }
    const auto scattered = [](int point) { return static_cast<std::uint32_t>(point + 1) * 2654435769U; };
    return scattered(first) < scattered(last) ? End::left : End::right;
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
    } else if (chain.size() == start_size_ && start_alone_) {
        return *start_alone_;
    }
    const bool unambiguous = oracle_.unambiguous(chain, false, tolerance);
    if (!unambiguous && tolerance <= scene_.resolution) replaced_at_resolution_ = oracle_.replaced_point();
    const bool found = unambiguous && become_cycle(chain, tolerance);
    for (const ChainMemo::Id p : passed_) memo_[p].alone = answer(found);
    if (id == kNone && chain.size() == start_size_) start_alone_ = found;
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

/// A ring is met from each of its points and in both directions; what is not ambiguous at first sight is
/// asked once.
bool Expansion::resolve_closed(std::span<const int> ring, double tolerance) {
    if (oracle_.replaceable_as_before(ring, true, tolerance)) return false;
    const ChainMemo::Id id = rings_.id(Fingerprint(ring, true));
    if (rings_[id].alone == Answer::unknown)
        rings_[id].alone =
            answer(!oracle_.replaceable_anywhere(ring, true, tolerance) && keep(ring, true, tolerance));
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
    FailedSeeds failed(fourths, scene.size());
    FourBranches branches(fourths, scene.size());
    tbb::enumerable_thread_specific<Expansion> expansions(
        [&] { return Expansion(scene, seeds, fourths, branches, failed, monitor); });
    if (in_tables(scene, fourths)) {
        parallel_for(scene.size(), [&](int apex) {
            expansions.local().follow_fives(apex);
            monitor.advance();
        });
        parallel_for(scene.size(), [&](int apex) { expansions.local().resolve_fours(apex); });
    } else {
        parallel_for(scene.size(), [&](int apex) {
            expansions.local().expand_fours(apex);
            monitor.advance();
        });
    }
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
    tbb::parallel_sort(found.begin(), found.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
    found.erase(std::unique(found.begin(), found.end(),
                            [](const auto& a, const auto& b) { return a.first == b.first; }),
                found.end());
    result.cycles.resize(found.size());
    parallel_for(found.size(), [&](std::size_t k) {
        auto& [cycle, types] = found[k];
        const ToleranceInterval tolerance = expansions.local().interval(cycle.points, cycle.closed);
        result.cycles[k] = {std::move(cycle.points), cycle.closed, types, tolerance};
    });
    return result;
}

}  // namespace

CycleSearchResult detect_cycles(const Scene& scene, const CycleSearch& how, RunMonitor& monitor) {
    constexpr double kLower = 0.8, kLeastResolutions = 10;
    const Rows rows = how.seeds == SeedChoice::all ? Rows() : Rows(scene);
    for (Scene lowered = scene;; lowered.max_tolerance *= kLower) {
        const Seeds seeds(lowered, rows, monitor);
        const bool can_lower = kLower * lowered.max_tolerance >= kLeastResolutions * scene.resolution;
        const Fourths fourths(lowered, seeds, can_lower ? how.most_chains : 0, monitor, how.most_stored);
        if (fourths.too_many()) continue;
        CycleSearchResult result = search(lowered, seeds, fourths, monitor);
        result.translations = rows.translations();
        return result;
    }
}

}  // namespace insym
