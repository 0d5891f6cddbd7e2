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
        for (std::size_t i = 0; i < j; ++i)
            orbits_[j - i - 1].include(scene_->distances(points[i], points[j]));
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

/// Calls visit(q, E_min of the chain with q at `end`) for the points q that keep all orbits within `limit`,
/// which visit may lower. `among`: as in best_candidate().
template <class Visit>
void ChainOracle::visit_extensions(const Chain& chain, End end, const std::vector<Candidate>* among,
                                   double& limit, Visit visit) {
    const auto orbits = chain.orbits();
    const auto points = chain.points();
    const std::size_t c = points.size();
    // Each orbit says how far q may be from one point of the chain, from the end inwards.
    shells_.resize(c);
    const double slack = 1e-12 * scene_.diameter;
    for (std::size_t k = 0; k < c; ++k) {
        shells_[k].distances = scene_.distances.row(points[end == End::right ? c - 1 - k : k]).data();
        if (k + 1 == c) break;
        shells_[k].low = orbits[k].high - limit - slack;
        shells_[k].high = orbits[k].low + limit + slack;
    }
    // Orbits in order of length, so that they are nearly so with q, too, and quickly sorted.
    by_length_.resize(c - 1);
    for (std::size_t k = 0; k + 1 < c; ++k) {
        std::size_t at = k;
        for (; at > 0 && orbits[k].low < orbits[by_length_[at - 1]].low; --at)
            by_length_[at] = by_length_[at - 1];
        by_length_[at] = k;
    }
    spans_.resize(c);
    const auto consider = [&](int q) {
        for (std::size_t k = 0; k + 1 < c; ++k) {
            const double d = shells_[k].distances[q];
            if (d < shells_[k].low || d > shells_[k].high) return;
        }
        for (std::size_t k = 0; k + 1 < c; ++k) {
            spans_[k] = orbits[by_length_[k]];
            spans_[k].include(shells_[by_length_[k]].distances[q]);
            if (spans_[k].spread() > limit) return;
        }
        // The farthest point starts an orbit of its own.
        const double longest = shells_[c - 1].distances[q];
        spans_[c - 1] = {longest, longest};
        const double tolerance = tolerance_interval(spans_, scene_.resolution, limit).min;
        if (tolerance <= limit && !chain.contains(q)) visit(q, tolerance);
    };
    if (among != nullptr) {
        // A part of a chain is never worse than the whole: no later one of the list can be better.
        for (const Candidate& candidate : *among) {
            if (candidate.tolerance > limit) break;
            consider(candidate.point);
        }
        return;
    }
    const int label = scene_.label(chain.from(end, 0));
    scene_.distances.visit_shell(chain.from(end, 0), shells_[0].low, shells_[0].high, [&](int q, double) {
        if (scene_.label(q) == label) consider(q);
        return true;
    });
}

void ChainOracle::candidates(const Chain& chain, End end, std::vector<Candidate>& out) {
    out.clear();
    double limit = scene_.max_tolerance;
    visit_extensions(chain, end, nullptr, limit, [&](int q, double tolerance) {
        out.push_back({tolerance, q});
    });
    std::sort(out.begin(), out.end());
}

Candidate ChainOracle::best_candidate(const Chain& chain, End end, double limit,
                                      const std::vector<Candidate>* among) {
    Candidate best{kInfinity, -1};
    visit_extensions(chain, end, among, limit, [&](int q, double tolerance) {
        best = std::min(best, Candidate{tolerance, q});
        limit = best.tolerance;
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

/// The spans of the orbits without the distances of the point `at` (c or more: of no point).
void ChainOracle::leave_out(std::span<const int> points, bool closed, std::size_t at) {
    const std::size_t c = points.size();
    rest_.resize(closed ? c / 2 : c - 1);
    if (c > kShortSequence) {
        for (std::size_t r = 1; r <= rest_.size(); ++r) {
            const int before = static_cast<int>(at) - static_cast<int>(r);
            rest_[r - 1] = extremes_[r - 1].without(
                static_cast<int>(at), closed && before < 0 ? before + static_cast<int>(c) : before);
        }
        return;
    }
    for (std::size_t r = 1; r <= rest_.size(); ++r) {
        Span span;
        for (std::size_t i = 0; i < (closed ? c : c - r); ++i) {
            const std::size_t j = i + r < c ? i + r : i + r - c;
            if (i != at && j != at) span.include(table_[i * c + j]);
        }
        rest_[r - 1] = span;
    }
}

bool ChainOracle::unambiguous(std::span<const int> points, bool closed) {
    if (points.size() <= kShortSequence) {
        collect_distances(points);
        leave_out(points, closed, points.size());
        spans_ = rest_;
    } else {
        collect_extremes(points, closed);
        spans_.clear();
        for (const Extremes& e : extremes_) spans_.push_back(e.all());
    }
    const double eps = tolerance_interval(spans_, scene_.resolution).min;
    // What could replace a point the last time often can again: most chains end here.
    const auto again = std::find(points.begin(), points.end(), replaced_);
    if (again != points.end() &&
        replaceable_by_twin(points, closed, static_cast<std::size_t>(again - points.begin()), eps))
        return false;
    for (std::size_t at = 0; at < points.size(); ++at)
        if (points[at] != replaced_ && replaceable_by_twin(points, closed, at, eps)) return false;
    for (std::size_t at = 0; at < points.size(); ++at)
        if (replaceable(points, closed, at, eps)) return false;
    return true;
}

bool ChainOracle::replaceable_by_twin(std::span<const int> points, bool closed, std::size_t at, double eps) {
    const int twin = twin_[static_cast<std::size_t>(points[at])];
    if (twin < 0) return false;
    const std::size_t c = points.size();
    const auto d = scene_.distances.row(twin);
    const auto to = [&](std::size_t k) { return d[static_cast<std::size_t>(points[k])]; };
    const std::size_t neighbour = at + 1 < c ? at + 1 : at - 1;
    if (std::abs(to(neighbour) - scene_.distances(points[at], points[neighbour])) > 2 * eps) return false;
    // Its own two distances of a step must agree; this settles most before the other orbits are looked at.
    for (std::size_t r = 1; r < c; ++r) {
        Span span;
        if (at + r < c) span.include(to(at + r));
        if (at >= r) span.include(to(at - r));
        if (span.empty()) break;
        if (span.spread() > eps) return false;
    }
    if (std::find(points.begin(), points.end(), twin) != points.end()) return false;
    leave_out(points, closed, at);
    if (!fits_in_place(points, closed, at, twin, eps)) return false;
    replaced_ = points[at];
    return true;
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
        if (found) {
            replaced_ = points[at];
            twin_[static_cast<std::size_t>(replaced_)] = q;
        }
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
