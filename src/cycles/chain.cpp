#include "cycles/chain.hpp"

#include <algorithm>
#include <cmath>

namespace insym {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

// --- Chain ---------------------------------------------------------------------------------------

void Chain::assign(std::span<const int> points) {
    constexpr std::size_t kRoom = 64;  // free places at each end before the buffer has to move
    buffer_.resize(points.size() + 2 * kRoom);
    begin_ = kRoom;
    end_ = kRoom + points.size();
    std::copy(points.begin(), points.end(), buffer_.begin() + kRoom);
    orbits_.assign(points.size() - 1, Span{});
    for (std::size_t j = 1; j < points.size(); ++j)
        for (std::size_t i = 0; i < j; ++i) orbits_[j - i - 1].include(scene_->distances(points[i], points[j]));
}

void Chain::add(int point, End end) {
    if (begin_ == 0 || end_ == buffer_.size()) {
        const std::size_t room = buffer_.size();
        std::vector<int> wider(3 * room);
        std::copy(buffer_.begin(), buffer_.end(), wider.begin() + static_cast<std::ptrdiff_t>(room));
        buffer_.swap(wider);
        begin_ += room;
        end_ += room;
    }
    const auto d = scene_->distances.row(point);
    const int c = size();
    orbits_.emplace_back();
    for (int k = 0; k < c; ++k)
        orbits_[static_cast<std::size_t>(k)].include(d[static_cast<std::size_t>(from(end, k))]);
    if (end == End::right)
        buffer_[end_++] = point;
    else
        buffer_[--begin_] = point;
}

bool Chain::contains(int point) const {
    const auto all = points();
    return std::find(all.begin(), all.end(), point) != all.end();
}

// --- tolerance -----------------------------------------------------------------------------------

ToleranceInterval ChainOracle::interval(std::span<const int> points, bool closed) {
    const std::size_t c = points.size();
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

bool ChainOracle::holds(std::span<const int> points, bool closed) {
    for (const int p : points)
        if (scene_.label(p) != scene_.label(points.front())) return false;
    return interval(points, closed).min <= scene_.max_tolerance;
}

// --- candidates ----------------------------------------------------------------------------------

double ChainOracle::extended_tolerance(const Chain& chain, End end, int point, double limit) {
    const auto d = scene_.distances.row(point);
    const auto orbits = chain.orbits();
    const auto points = chain.points();
    // From the end inwards; the farthest point starts an orbit of its own.
    const int* next = end == End::right ? &points.back() : &points.front();
    const std::ptrdiff_t stride = end == End::right ? -1 : 1;
    spans_.resize(orbits.size() + 1);
    for (std::size_t k = 0; k < orbits.size(); ++k, next += stride) {
        Span span = orbits[k];
        span.include(d[static_cast<std::size_t>(*next)]);
        if (span.spread() > limit) return kInfinity;
        spans_[k] = span;
    }
    const double longest = d[static_cast<std::size_t>(*next)];
    spans_.back() = {longest, longest};
    return tolerance_interval(spans_, scene_.resolution, limit).min;
}

void ChainOracle::candidates(const Chain& chain, End end, std::vector<Candidate>& out) {
    out.clear();
    const double cap = scene_.max_tolerance;
    const int tip = chain.from(end, 0);
    const Span links = chain.orbits().front();
    visit_shell(tip, links.high - cap, links.low + cap, [&](int q, double) {
        if (scene_.label(q) != scene_.label(tip)) return true;
        const double tolerance = extended_tolerance(chain, end, q, cap);
        if (tolerance <= cap && !chain.contains(q)) out.push_back({tolerance, q});
        return true;
    });
    std::sort(out.begin(), out.end());
}

Candidate ChainOracle::best_candidate(const Chain& chain, End end) {
    Candidate best{kInfinity, -1};
    double limit = scene_.max_tolerance;
    const int tip = chain.from(end, 0);
    const Span links = chain.orbits().front();
    visit_shell(tip, links.high - limit, links.low + limit, [&](int q, double) {
        if (scene_.label(q) != scene_.label(tip)) return true;
        const double tolerance = extended_tolerance(chain, end, q, limit);
        if (tolerance > limit || chain.contains(q)) return true;
        best = std::min(best, Candidate{tolerance, q});
        limit = best.tolerance;
        return true;
    });
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

/// For short sequences the orbits without one point are simply counted again; for long ones they follow
/// from the extremes, so that C2 costs O(c^2) and not O(c^3).
constexpr std::size_t kShortSequence = 8;

void ChainOracle::collect_distances(std::span<const int> points) {
    const std::size_t c = points.size();
    table_.resize(c * c);
    for (std::size_t i = 0; i < c; ++i) {
        const auto d = scene_.distances.row(points[i]);
        for (std::size_t j = 0; j < c; ++j) table_[i * c + j] = d[static_cast<std::size_t>(points[j])];
    }
}

/// The spans of the orbits without the distances of the point `at`.
void ChainOracle::leave_out(std::span<const int> points, bool closed, std::size_t at) {
    const std::size_t c = points.size();
    if (c <= kShortSequence) {
        rest_.assign(closed ? c / 2 : c - 1, Span{});
        for (std::size_t i = 0; i < c; ++i)
            for (std::size_t j = i + 1; j < c && i != at; ++j)
                if (j != at) {
                    const std::size_t r = closed ? std::min(j - i, c - (j - i)) : j - i;
                    rest_[r - 1].include(table_[i * c + j]);
                }
        return;
    }
    rest_.clear();
    for (std::size_t r = 1; r <= extremes_.size(); ++r) {
        const int before = static_cast<int>(at) - static_cast<int>(r);
        rest_.push_back(extremes_[r - 1].without(static_cast<int>(at),
                                                 closed && before < 0 ? before + static_cast<int>(c) : before));
    }
}

bool ChainOracle::unambiguous(std::span<const int> points, bool closed) {
    const double eps = interval(points, closed).min;
    if (points.size() <= kShortSequence)
        collect_distances(points);
    else
        collect_extremes(points, closed);
    // What could replace a point the last time often can again: most chains end here.
    for (std::size_t at = 0; at < points.size(); ++at)
        if (replaceable_by(points, closed, at, twin_[static_cast<std::size_t>(points[at])], eps)) return false;
    for (std::size_t at = 0; at < points.size(); ++at)
        if (replaceable(points, closed, at, eps)) return false;
    return true;
}

bool ChainOracle::replaceable_by(std::span<const int> points, bool closed, std::size_t at, int twin, double eps) {
    if (twin < 0 || scene_.label(twin) != scene_.label(points[at])) return false;
    if (std::find(points.begin(), points.end(), twin) != points.end()) return false;
    const int neighbour = at + 1 < points.size() ? points[at + 1] : points[at - 1];
    if (std::abs(scene_.distances(twin, neighbour) - scene_.distances(points[at], neighbour)) > 2 * eps) return false;
    leave_out(points, closed, at);
    return fits_in_place(points, closed, at, twin, eps);
}

bool ChainOracle::replaceable(std::span<const int> points, bool closed, std::size_t at, double eps) {
    leave_out(points, closed, at);
    const int neighbour = at + 1 < points.size() ? points[at + 1] : points[at - 1];
    const double usual = scene_.distances(points[at], neighbour);
    double low = usual - 2 * eps;
    double high = usual + 2 * eps;
    if (!rest_.front().empty()) {
        low = std::max(low, rest_.front().high - eps);
        high = std::min(high, rest_.front().low + eps);
    }
    bool found = false;
    visit_shell(neighbour, low, high, [&](int q, double d) {
        found = scene_.label(q) == scene_.label(points[at]) && std::abs(d - usual) <= 2 * eps &&
                fits_in_place(points, closed, at, q, eps) &&
                std::find(points.begin(), points.end(), q) == points.end();
        if (found) twin_[static_cast<std::size_t>(points[at])] = q;
        return !found;
    });
    return found;
}

bool ChainOracle::fits_in_place(std::span<const int> points, bool closed, std::size_t at, int point,
                                double eps) {
    const auto d = scene_.distances.row(point);
    const std::size_t c = points.size();
    spans_.resize(rest_.size());
    for (std::size_t r = 1; r <= rest_.size(); ++r) {
        Span span = rest_[r - 1];
        if (at + r < c)
            span.include(d[static_cast<std::size_t>(points[at + r])]);
        else if (closed)
            span.include(d[static_cast<std::size_t>(points[at + r - c])]);
        if (at >= r)
            span.include(d[static_cast<std::size_t>(points[at - r])]);
        else if (closed)
            span.include(d[static_cast<std::size_t>(points[at + c - r])]);
        if (span.spread() > eps) return false;
        spans_[r - 1] = span;
    }
    const ToleranceInterval other = tolerance_interval(spans_, scene_.resolution, eps);
    return other.min <= eps && eps < other.max;
}

}  // namespace insym
