#include "cycles/chain.hpp"

#include <algorithm>
#include <cmath>

#include "cycles/side.hpp"

namespace insym {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

// --- Chain ---------------------------------------------------------------------------------------

void Chain::assign(std::span<const int> points, std::array<SeedLink, 2> links) {
    const std::size_t c = points.size();
    begin_ = buffer_.size() / 3;
    end_ = begin_ + c;
    std::copy(points.begin(), points.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
    links_ = links;
    fingerprint_ = Fingerprint(points);
    std::fill_n(orbits_.begin(), c - 1, Span{});
    for (std::size_t i = 0; i < c; ++i) {
        const double* d = scene_->distances.row(points[i]).data();
        for (std::size_t j = i + 1; j < c; ++j) orbits_[j - i - 1].include(d[points[j]]);
    }
}

// --- short sequences -----------------------------------------------------------------------------

namespace {

/// Most sequences are this short; their orbits are simply counted again for each question, in loops of known
/// length.
constexpr std::size_t kShortSequence = 8;

/// The points of a sequence, but for q in the place `at`, if that is one.
struct Replaced {
    std::size_t at;
    int q;
};

template <std::size_t kPoints, bool kClosed>
ToleranceInterval interval_of(const Distances& distances, const int* sequence, Replaced replaced,
                              double floor, double limit) {
    constexpr std::size_t kOrbits = kClosed ? kPoints / 2 : kPoints - 1;
    int points[kPoints];
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kPoints; ++i) points[i] = i == replaced.at ? replaced.q : sequence[i];
    Span spans[kOrbits];
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kPoints; ++i) {
        const double* row = distances.row(points[i]).data();
#pragma GCC unroll 8
        for (std::size_t j = i + 1; j < kPoints; ++j) {
            const std::size_t step = kClosed ? std::min(j - i, kPoints - (j - i)) : j - i;
            spans[step - 1].include(row[points[j]]);
        }
    }
    return detail::interval_of_few<kOrbits>(spans, floor, limit);
}

template <bool kClosed>
ToleranceInterval short_interval(const Distances& distances, std::span<const int> points, Replaced replaced,
                                 double floor, double limit) {
    switch (points.size()) {
        case 2:
            return interval_of<2, kClosed>(distances, points.data(), replaced, floor, limit);
        case 3:
            return interval_of<3, kClosed>(distances, points.data(), replaced, floor, limit);
        case 4:
            return interval_of<4, kClosed>(distances, points.data(), replaced, floor, limit);
        case 5:
            return interval_of<5, kClosed>(distances, points.data(), replaced, floor, limit);
        case 6:
            return interval_of<6, kClosed>(distances, points.data(), replaced, floor, limit);
        case 7:
            return interval_of<7, kClosed>(distances, points.data(), replaced, floor, limit);
        default:
            return interval_of<kShortSequence, kClosed>(distances, points.data(), replaced, floor, limit);
    }
}

/// E_min of a chain of kPoints points with one more at the distances `d`; `points` from that end inwards.
template <std::size_t kPoints>
double tolerance_with(const Span* orbits, const double* d, Chain::Inwards points, double floor,
                      double limit) {
    Span spans[kPoints];
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kPoints; ++k) {
        const double own = d[points[static_cast<std::ptrdiff_t>(k)]];
        spans[k] = {own, own};
        // The farthest point starts an orbit of its own.
        if (k + 1 < kPoints) spans[k].include(orbits[k]);
    }
    return detail::interval_of_few<kPoints>(spans, floor, limit).min;
}

}  // namespace

/// Of `points`, with q in the place `at` unless that is beyond the last.
ToleranceInterval ChainOracle::short_interval_with(std::span<const int> points, bool closed, std::size_t at,
                                                   int q, double limit) const {
    return closed ? short_interval<true>(scene_.distances, points, {at, q}, scene_.resolution, limit)
                  : short_interval<false>(scene_.distances, points, {at, q}, scene_.resolution, limit);
}

// --- tolerance -----------------------------------------------------------------------------------

ToleranceInterval ChainOracle::interval(std::span<const int> points, bool closed) {
    const std::size_t c = points.size();
    if (c <= kShortSequence) return short_interval_with(points, closed, c, -1, kInfinity);
    const std::size_t orbits = closed ? c / 2 : c - 1;
    spans_.assign(orbits, Span{});
    for (std::size_t i = 0; i < c; ++i) {
        const auto d = scene_.distances.row(points[i]);
        for (std::size_t j = i + 1; j < c; ++j) {
            // In a ring the distances of steps r and c - r are the same orbit.
            const std::size_t r = closed ? std::min(j - i, c - (j - i)) : j - i;
            spans_[r - 1].include(d[static_cast<std::size_t>(points[j])]);
        }
    }
    return tolerance_interval(spans_, scene_.resolution);
}

double ChainOracle::closed_tolerance(const Chain& chain) {
    const auto orbits = chain.orbits();
    const std::size_t c = orbits.size() + 1;
    spans_.clear();
    for (std::size_t r = 1; r <= c / 2; ++r) {
        Span span = orbits[r - 1];
        span.include(orbits[c - r - 1]);
        if (span.spread() > scene_.max_tolerance) return kInfinity;
        spans_.push_back(span);
    }
    return tolerance_interval(spans_, scene_.resolution, scene_.max_tolerance).min;
}

// --- candidates ----------------------------------------------------------------------------------

/// The points that the last three at `end` leave to ask.
const Candidate* ChainOracle::list_for(const Chain& chain, End end) {
    const Chain::Inwards last = chain.from(end);
    const SeedLink link = chain.link(end);
    return link != kUnknownLink ? fourths_.of(last[1], link)
                                : fourths_.of(last[2], last[1], last[0], fourths_scratch_);
}

/// E_min of the chain with q of the list at an end; infinite above `limit` and if q is in the chain.
double ChainOracle::extended_tolerance(const Chain& chain, Chain::Inwards inwards, const Candidate& q,
                                       double limit) {
    const std::ptrdiff_t c = chain.size();
    // The list knows of the last three.
    if (c == 3) return q.tolerance;
    bool inside = false;
    for (std::ptrdiff_t k = 3; k < c; ++k) inside |= inwards[k] == q.point;
    if (inside) return kInfinity;
    const auto orbits = chain.orbits();
    const double* d = scene_.distances.row(q.point).data();
    const double floor = scene_.resolution;
    switch (c) {
        case 4:
            return tolerance_with<4>(orbits.data(), d, inwards, floor, limit);
        case 5:
            return tolerance_with<5>(orbits.data(), d, inwards, floor, limit);
        case 6:
            return tolerance_with<6>(orbits.data(), d, inwards, floor, limit);
        case 7:
            return tolerance_with<7>(orbits.data(), d, inwards, floor, limit);
        default:
            break;
    }
    spans_.assign(orbits.begin(), orbits.end());
    spans_.emplace_back();
    for (std::ptrdiff_t k = 0; k < c; ++k) {
        Span& span = spans_[static_cast<std::size_t>(k)];
        span.include(d[inwards[k]]);
        if (span.spread() > limit) return kInfinity;
    }
    return tolerance_interval(spans_, floor, limit).min;
}

void ChainOracle::candidates(const Chain& chain, End end, std::vector<Candidate>& out) {
    out.clear();
    for (const Candidate* q = list_for(chain, end); q->point >= 0; ++q) {
        const double tolerance = extended_tolerance(chain, chain.from(end), *q, scene_.max_tolerance);
        if (tolerance <= scene_.max_tolerance) out.push_back({tolerance, q->point, q->next});
    }
    std::sort(out.begin(), out.end());
}

namespace {

/// Can q come before `best`, given E_min of the chain that both extend and that of its last three with q? A
/// part of a chain is never worse than the whole.
bool may_be_better(const Candidate& q, const Candidate& best, double least) {
    return Candidate{std::max(q.tolerance, least), q.point} < best;
}

}  // namespace

Candidate ChainOracle::best_candidate(const Chain& chain, End end, double least, double limit) {
    Candidate best{limit, std::numeric_limits<int>::max()};
    const Chain::Inwards inwards = chain.from(end);
    for (const Candidate* q = list_for(chain, end); *q < best; ++q) {
        if (!may_be_better(*q, best, least)) continue;
        best = std::min(best, {extended_tolerance(chain, inwards, *q, best.tolerance), q->point, q->next});
    }
    return best.point == std::numeric_limits<int>::max() ? kNobody : best;
}

ChainOracle::Sides ChainOracle::best_on_sides(const Chain& chain, End end, double least) {
    const std::array<int, 3> plane = {chain.from(end, 2), chain.from(end, 1), chain.from(end, 0)};
    Sides best = {kNobody, kNobody, kNobody};
    const Chain::Inwards inwards = chain.from(end);
    for (const Candidate* q = list_for(chain, end); q->point >= 0; ++q) {
        Candidate& here = best[static_cast<std::size_t>(side_of(scene_, plane, q->point))];
        if (!may_be_better(*q, here, least)) continue;
        const double limit = std::min(here.tolerance, scene_.max_tolerance);
        here = std::min(here, {extended_tolerance(chain, inwards, *q, limit), q->point, q->next});
    }
    return best;
}

// --- C2 ------------------------------------------------------------------------------------------

ChainOracle::Extremes::Extremes()
    : low{kInfinity, kInfinity, kInfinity},
      high{-kInfinity, -kInfinity, -kInfinity},
      low_at{-1, -1, -1},
      high_at{-1, -1, -1} {}

void ChainOracle::Extremes::include(double d, int at) {
    if (d < low[2]) {
        int k = 2;
        for (; k > 0 && d < low[k - 1]; --k) {
            low[k] = low[k - 1];
            low_at[k] = low_at[k - 1];
        }
        low[k] = d;
        low_at[k] = at;
    }
    if (d > high[2]) {
        int k = 2;
        for (; k > 0 && d > high[k - 1]; --k) {
            high[k] = high[k - 1];
            high_at[k] = high_at[k - 1];
        }
        high[k] = d;
        high_at[k] = at;
    }
}

Span ChainOracle::Extremes::without(int first, int second) const {
    Span span;
    for (int k = 0; k < 3; ++k)
        if (low_at[k] != first && low_at[k] != second) {
            span.low = low[k];
            break;
        }
    for (int k = 0; k < 3; ++k)
        if (high_at[k] != first && high_at[k] != second) {
            span.high = high[k];
            break;
        }
    return span;
}

void ChainOracle::collect_extremes(std::span<const int> points, bool closed) {
    const std::size_t c = points.size();
    extremes_.assign(closed ? c / 2 : c - 1, Extremes{});
    for (std::size_t i = 0; i < c; ++i) {
        const auto d = scene_.distances.row(points[i]);
        for (std::size_t r = 1; r <= extremes_.size(); ++r) {
            const std::size_t j = closed ? (i + r) % c : i + r;
            if (j >= c) break;
            extremes_[r - 1].include(d[static_cast<std::size_t>(points[j])], static_cast<int>(i));
        }
    }
}

bool ChainOracle::replaceable_as_before(std::span<const int> points, bool closed, double eps) {
    collects_ = false;
    for (std::size_t k = 0; k < points.size(); ++k)
        if (const int q = replaced_by_[static_cast<std::size_t>(points[k])];
            q >= 0 && fits_in_place(points, closed, k, q, eps))
            return true;
    return false;
}

bool ChainOracle::replaceable_anywhere(std::span<const int> points, bool closed, double eps) {
    extremes_.clear();
    collects_ = true;
    // From the ends inwards: there the distances say least. The last first: what can replace the fourth point
    // of a chain that was made of three is where it came from.
    const std::size_t c = points.size();
    for (std::size_t k = 0; k < c; ++k)
        if (replaceable(points, closed, k % 2 == 0 ? c - 1 - k / 2 : k / 2, eps)) return true;
    return false;
}

/// What can stand in the place of a point is a fourth point of the three beside it, on whichever side there
/// are three.
bool ChainOracle::replaceable(std::span<const int> points, bool closed, std::size_t at, double eps) {
    const std::size_t c = points.size();
    if (c < 4 || (!closed && at < 3 && at + 3 >= c)) return replaceable_from_shell(points, closed, at, eps);
    const bool before = closed || at >= 3;
    const auto beside = [&](std::size_t k) {
        return points[!before ? at + k : at >= k ? at - k : at + c - k];
    };
    const Candidate* q = fourths_.of(beside(3), beside(2), beside(1), fourths_scratch_);
    for (; q->tolerance <= eps; ++q)
        if (q->point != points[at] && fits_in_place(points, closed, at, q->point, eps)) return true;
    return false;
}

/// The same for the middle of a short chain: any point at the right distance from its neighbour.
bool ChainOracle::replaceable_from_shell(std::span<const int> points, bool closed, std::size_t at,
                                         double eps) {
    const std::size_t c = points.size();
    // In the middle of a chain the one farther from its end, which many chains have in common.
    const bool in_last_half = at + 1 == c || (c > 3 && 2 * at >= c);
    const int neighbour = in_last_half ? points[at - 1] : points[at + 1];
    const double usual = scene_.distances(points[at], neighbour);
    // The other links of the sequence bound it, too.
    Span links;
    for (std::size_t k = 0; k + (closed ? 0 : 1) < c; ++k)
        if (k != at && (k + 1 < c ? k + 1 : 0) != at)
            links.include(scene_.distances(points[k], points[k + 1 < c ? k + 1 : 0]));
    // The bounds come from other distances: rounding must not lose a point that the exact test would take.
    const double slack = 1e-12 * scene_.diameter;
    const double low = std::max(usual - 2 * eps, links.high - eps) - slack;
    const double high = std::min(usual + 2 * eps, links.low + eps) + slack;
    bool found = false;
    scene_.distances.visit_shell(neighbour, low, high, [&](int q, double) {
        found = scene_.label(q) == scene_.label(neighbour) && q != points[at] &&
                fits_in_place(points, closed, at, q, eps);
        return !found;
    });
    return found;
}

/// Can the outside point q stand in the place `at`, with the tolerance eps valid?
bool ChainOracle::fits_in_place(std::span<const int> points, bool closed, std::size_t at, int q, double eps) {
    const int neighbour = points[at + 1 < points.size() ? at + 1 : at - 1];
    const double usual = scene_.distances(points[at], neighbour);
    if (std::abs(scene_.distances(neighbour, q) - usual) > 2 * eps) return false;
    bool inside = false;
    for (const int p : points) inside |= p == q;
    if (inside) return false;
    const ToleranceInterval other = points.size() <= kShortSequence
                                        ? short_interval_with(points, closed, at, q, eps)
                                        : long_interval_with(points, closed, at, q, eps);
    if (!(other.min <= eps && eps < other.max)) return false;
    replaced_point_ = points[at];
    replaced_by_[static_cast<std::size_t>(points[at])] = q;
    return true;
}

/// Sets rest_.
void ChainOracle::leave_out(std::size_t c, bool closed, std::size_t at) {
    left_out_ = at;
    rest_.resize(closed ? c / 2 : c - 1);
    for (std::size_t r = 1; r <= rest_.size(); ++r) {
        // The two distances of the orbit start at `at` and r places before it.
        const std::size_t before = at >= r ? at - r : closed ? at + c - r : c;
        rest_[r - 1] =
            extremes_[r - 1].without(static_cast<int>(at), before < c ? static_cast<int>(before) : -1);
    }
}

/// The orbits without one point follow from the extremes, so that C2 costs O(c^2) and not O(c^3).
ToleranceInterval ChainOracle::long_interval_with(std::span<const int> points, bool closed, std::size_t at,
                                                  int q, double limit) {
    const auto d = scene_.distances.row(q);
    const std::size_t c = points.size();
    const auto to = [&](std::size_t k) { return d[static_cast<std::size_t>(points[k])]; };
    if (!collects_) {
        replaced_sequence_.assign(points.begin(), points.end());
        replaced_sequence_[at] = q;
        return interval(replaced_sequence_, closed);
    }
    if (extremes_.empty()) {
        collect_extremes(points, closed);
        left_out_ = c;
    }
    if (at != left_out_) leave_out(c, closed, at);
    spans_ = rest_;
    for (std::size_t r = 1; r <= rest_.size(); ++r) {
        Span& span = spans_[r - 1];
        if (at + r < c || closed) span.include(to(at + r < c ? at + r : at + r - c));
        if (at >= r || closed) span.include(to(at >= r ? at - r : at + c - r));
        if (span.spread() > limit) return {kInfinity, kInfinity};
    }
    return tolerance_interval(spans_, scene_.resolution, limit);
}

}  // namespace insym
