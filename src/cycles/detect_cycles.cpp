#include "cycles/detect_cycles.hpp"

#include <algorithm>

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

/// The expansion of section 4. What it finds depends on the seed alone, never on what was asked
/// before: the memo only saves time. One for each thread.
class Expansion {
public:
    Expansion(const Scene& scene, RunMonitor& monitor)
        : scene_(scene),
          monitor_(monitor),
          oracle_(scene),
          type_oracle_(scene),
          chain_(scene),
          extended_(scene) {}

    void expand_apex(int apex);

    std::size_t seeds() const { return seeds_; }
    std::vector<std::pair<CanonicalCycle, TypeSet>>& found() { return found_; }

private:
    void expand_seed(std::span<const int> seed);
    /// For each end: a list that holds all candidates of a chain there, or none where it is not known.
    struct Ends {
        const std::vector<Candidate>* left = nullptr;
        const std::vector<Candidate>* right = nullptr;
    };
    static constexpr int kLeft = 0;
    static constexpr int kRight = 1;

    bool expand_chain(std::span<const int> four);
    bool expand_side(std::span<const int> four, const std::vector<Candidate>& fifths,
                     const std::vector<Candidate>& far);
    bool follow(std::span<const int> start, Ends ends);
    bool follow_path(Ends ends);
    std::pair<Candidate, Candidate> best_ends(double limit, Ends ends);
    void add_branch(int left);
    bool resolve_open(std::span<const int> chain);
    bool resolve_closed(std::span<const int> ring);
    bool keep(std::span<const int> sequence, bool closed);
    bool extend(std::vector<int>& sequence);
    int side(std::span<const int> chain, int point) const;

    /// Ends tie at every step of an exact row; beyond this length it makes no difference which is first.
    static constexpr int kLongestBranching = 8;

    using Answer = ChainMemo::Answer;
    static Answer answer(bool found) { return found ? Answer::yes : Answer::no; }

    struct Branch {
        std::vector<int> points;
        std::vector<End> path;
    };

    const Scene& scene_;
    RunMonitor& monitor_;
    ChainOracle oracle_;
    TypeOracle type_oracle_;
    ChainMemo memo_;
    ChainMemo rings_;
    Chain chain_;
    std::vector<End> path_;  // at which end of chain_ each point after the start was added
    std::vector<Branch> branches_;
    std::vector<Candidate> fourths_[2];  // at the left and the right end of the seed
    std::vector<Candidate> fifths_[2];
    Chain extended_;
    std::vector<Candidate> extensions_;
    std::size_t seeds_ = 0;
    std::vector<std::pair<CanonicalCycle, TypeSet>> found_;
};

/// Every seed (A, B, C) with B = apex: A and C are at nearly the same distance, so each A looks only
/// at the few that follow it in B's list by distance.
void Expansion::expand_apex(int apex) {
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
            if (!oracle_.holds(seed, false)) continue;
            ++seeds_;
            // An equilateral triangle closes at once; it is met from all three apexes.
            if (apex < a && oracle_.holds(seed, true)) resolve_closed(seed);
            expand_seed(seed);
        }
    }
}

/// Branches over every fourth point at either end. A path on which nothing is unambiguous and has a type
/// falls back to the chain of four and then to the seed.
void Expansion::expand_seed(std::span<const int> seed) {
    chain_.assign(seed);
    oracle_.candidates(chain_, End::right, fourths_[kRight]);
    oracle_.candidates(chain_, End::left, fourths_[kLeft]);
    bool found = !fourths_[kRight].empty() && !fourths_[kLeft].empty();
    for (const Candidate& fourth : fourths_[kRight]) {
        const int four[] = {seed[0], seed[1], seed[2], fourth.point};
        found = expand_chain(four) && found;
    }
    for (const Candidate& fourth : fourths_[kLeft]) {
        const int four[] = {fourth.point, seed[0], seed[1], seed[2]};
        found = expand_chain(four) && found;
    }
    if (!found) resolve_open(seed);
}

/// In 3D also branches over the best fifth point at either end on each side of the plane of the three
/// points there. True if every branch found a cycle, be it the chain of four itself.
bool Expansion::expand_chain(std::span<const int> four) {
    const ChainMemo::Id id = memo_.id(four);
    if (const auto known = memo_[id].all; known != Answer::unknown) return known == Answer::yes;
    Ends ends;
    if (scene_.dimension() == 3) {
        chain_.assign(four);
        oracle_.candidates(chain_, End::right, fifths_[kRight]);
        oracle_.candidates(chain_, End::left, fifths_[kLeft]);
        ends = {&fifths_[kLeft], &fifths_[kRight]};
    }
    bool found = follow(four, ends);
    if (scene_.dimension() == 3) {
        const int reversed[] = {four[3], four[2], four[1], four[0]};
        // What can come at the far end is known from the chain of four; at the near end it is not.
        found = expand_side(four, fifths_[kRight], fifths_[kLeft]) && found;
        found = expand_side(reversed, fifths_[kLeft], fifths_[kRight]) && found;
    }
    memo_[id].all = answer(found);
    return found;
}

bool Expansion::expand_side(std::span<const int> four, const std::vector<Candidate>& fifths,
                            const std::vector<Candidate>& far) {
    bool found = true;
    bool taken[3] = {false, false, false};
    for (const Candidate& fifth : fifths) {
        bool& done = taken[side(four, fifth.point) + 1];
        if (done) continue;
        done = true;
        const int five[] = {four[0], four[1], four[2], four[3], fifth.point};
        if (!follow(five, {&far, nullptr}) && !resolve_open(four)) found = false;
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
/// nothing fits; keeps the longest chain met that is unambiguous and has a type. True if there is
/// one on every branch: where both ends are equally good, a chain and its reverse part ways, and both
/// are followed.
bool Expansion::follow(std::span<const int> start, Ends ends) {
    chain_.assign(start);
    path_.clear();
    branches_.clear();
    bool found = follow_path(ends);
    while (!branches_.empty()) {
        const Branch branch = std::move(branches_.back());
        branches_.pop_back();
        chain_.assign(branch.points);
        path_ = branch.path;
        found = follow_path({}) && found;
    }
    return found;
}

/// One branch, from chain_ on; path_ says how chain_ came from the start. What follows depends on the
/// chain alone, so chains met before end it.
bool Expansion::follow_path(Ends ends) {
    bool found = false;
    const int known_size = chain_.size();
    while (true) {
        const ChainMemo::Id id = memo_.id(chain_.points());
        if (const auto known = memo_[id].path; known != Answer::unknown) {
            found = known == Answer::yes;
            break;
        }
        if (monitor_.should_stop()) return true;
        const double closed = oracle_.closed_tolerance(chain_);
        const auto [right, left] = best_ends(std::min(closed, scene_.max_tolerance), ends);
        const double best = std::min(right.tolerance, left.tolerance);
        const bool closes = closed <= std::min(best, scene_.max_tolerance);
        if (closes || best > scene_.max_tolerance) {
            found = (closes && resolve_closed(chain_.points())) || resolve_open(chain_.points());
            memo_[id].path = answer(found);
            break;
        }
        if (right.tolerance == left.tolerance && chain_.size() <= kLongestBranching) add_branch(left.point);
        const bool to_right = right.tolerance == best;
        chain_.add(to_right ? right.point : left.point, to_right ? End::right : End::left);
        path_.push_back(to_right ? End::right : End::left);
        // The end that moved on has new neighbours.
        (to_right ? ends.right : ends.left) = nullptr;
    }
    // Back along the path, each chain a window of the last.
    std::span<const int> window = chain_.points();
    for (; !path_.empty(); path_.pop_back()) {
        window = path_.back() == End::right ? window.first(window.size() - 1) : window.subspan(1);
        if (found && static_cast<int>(window.size()) < known_size) break;
        found = found || resolve_open(window);
        if (auto& known = memo_[memo_.id(window)].path; known == Answer::unknown) known = answer(found);
    }
    return found;
}

/// The best candidates at the right and at the left end within `limit`. The end that is quickly asked goes
/// first: what it offers limits the other.
std::pair<Candidate, Candidate> Expansion::best_ends(double limit, Ends ends) {
    const bool left_first = ends.left != nullptr;
    const End first = left_first ? End::left : End::right;
    const Candidate one = oracle_.best_candidate(chain_, first, limit, left_first ? ends.left : ends.right);
    const Candidate other =
        oracle_.best_candidate(chain_, left_first ? End::right : End::left, std::min(limit, one.tolerance),
                               left_first ? ends.right : ends.left);
    return left_first ? std::pair(other, one) : std::pair(one, other);
}

void Expansion::add_branch(int left) {
    Branch branch;
    branch.points = {left};
    const auto points = chain_.points();
    branch.points.insert(branch.points.end(), points.begin(), points.end());
    branch.path = path_;
    branch.path.push_back(End::left);
    branches_.push_back(std::move(branch));
}

/// C2, then C3 by extension, then the types. True if a cycle came out. Each longer chain met on the way
/// would come to the same end, so one answer serves them all.
bool Expansion::resolve_open(std::span<const int> chain) {
    const ChainMemo::Id id = memo_.id(chain);
    if (const auto known = memo_[id].alone; known != Answer::unknown) return known == Answer::yes;
    if (!oracle_.unambiguous(chain, false)) {
        memo_[id].alone = Answer::no;
        return false;
    }
    std::vector<int> s(chain.begin(), chain.end());
    if (s.front() > s.back()) std::reverse(s.begin(), s.end());
    std::vector<ChainMemo::Id> passed = {id};
    bool found = false;
    for (bool open = true; open;) {
        if (!extend(s)) {
            found = keep(s, false);
            open = false;
        } else if (oracle_.holds(s, true) && oracle_.unambiguous(s, true)) {
            found = keep(s, true);
            open = false;
        } else {
            passed.push_back(memo_.id(s));
            const auto known = memo_[passed.back()].alone;
            found = known == Answer::yes;
            open = known == Answer::unknown;
        }
    }
    for (const ChainMemo::Id p : passed) memo_[p].alone = answer(found);
    return found;
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
    monitor.begin_stage("cycles", static_cast<std::size_t>(scene.size()));
    tbb::enumerable_thread_specific<Expansion> expansions([&] { return Expansion(scene, monitor); });
    parallel_for(scene.size(), [&](int apex) {
        expansions.local().expand_apex(apex);
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

    ChainOracle oracle(scene);
    result.cycles.reserve(found.size());
    for (auto& [cycle, types] : found) {
        const ToleranceInterval tolerance = oracle.interval(cycle.points, cycle.closed);
        result.cycles.push_back({std::move(cycle.points), cycle.closed, types, tolerance});
    }
    return result;
}

}  // namespace insym
