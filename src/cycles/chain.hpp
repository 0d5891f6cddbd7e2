// A growing chain of points with its distance orbits (definitions, sections 2 and 4).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cycles/chain_memo.hpp"
#include "cycles/fourths.hpp"
#include "cycles/tolerance_interval.hpp"
#include "scene.hpp"

namespace insym {

enum class End { left, right };

/// An open chain P_1 ... P_c that grows at either end and goes back to what it was. Its orbits are kept up to
/// date: adding a point costs O(c).
class Chain {
public:
    /// With room for all points on either side of where it starts.
    explicit Chain(const Scene& scene)
        : scene_(&scene), buffer_(3 * static_cast<std::size_t>(scene.size())), orbits_(buffer_.size() / 3) {}

    /// `links`: where the fourth points at the left and at the right end are stored, if that is known.
    void assign(std::span<const int> points, std::array<SeedLink, 2> links = {kUnknownLink, kUnknownLink});
    /// `link`: where the fourth points of the last three at that end are stored then, if that is known.
    void add(int point, End end, SeedLink link = kUnknownLink) {
        const double* d = scene_->distances.row(point).data();
        const Inwards inwards = from(end);
        const std::ptrdiff_t c = size();
        fingerprint_.add_link(inwards[0], point);
        orbits_[static_cast<std::size_t>(c - 1)] = {};
        for (std::ptrdiff_t k = 0; k < c; ++k) orbits_[static_cast<std::size_t>(k)].include(d[inwards[k]]);
        if (end == End::right)
            buffer_[end_++] = point;
        else
            buffer_[--begin_] = point;
        links_[end == End::right] = link;
    }
    void add(const Candidate& next, End end) { add(next.point, end, next.next); }

    int size() const { return static_cast<int>(end_ - begin_); }
    std::span<const int> points() const { return {buffer_.data() + begin_, end_ - begin_}; }
    /// The points counted from one end, from 0.
    struct Inwards {
        const int* first;
        std::ptrdiff_t step;
        int operator[](std::ptrdiff_t k) const { return first[k * step]; }
    };
    Inwards from(End end) const {
        return end == End::right ? Inwards{buffer_.data() + end_ - 1, -1}
                                 : Inwards{buffer_.data() + begin_, 1};
    }
    int from(End end, int k) const { return from(end)[k]; }
    SeedLink link(End end) const { return links_[end == End::right]; }
    /// Orbit r - 1 holds the distances |P_l P_{l+r}|.
    std::span<const Span> orbits() const { return {orbits_.data(), end_ - begin_ - 1}; }
    const Fingerprint& fingerprint() const { return fingerprint_; }

private:
    const Scene* scene_;
    std::vector<int> buffer_;
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::vector<Span> orbits_;
    std::array<SeedLink, 2> links_ = {kUnknownLink, kUnknownLink};  // at the left and at the right end
    Fingerprint fingerprint_;
};

/// Answers the questions of sections 2 to 4 about chains and cycles. Holds scratch memory: one for
/// each thread.
class ChainOracle {
public:
    ChainOracle(const Scene& scene, const Fourths& fourths)
        : scene_(scene), fourths_(fourths), replaced_by_(static_cast<std::size_t>(scene.size()), -1) {}

    const Scene& scene() const { return scene_; }

    /// E_min and E_max of a sequence. O(c^2).
    ToleranceInterval interval(std::span<const int> points, bool closed);
    /// E_min of the chain closed to a cycle, infinite above max_tolerance. O(c log c).
    double closed_tolerance(const Chain& chain);
    /// C2: no outside point can replace a point of the sequence with its E_min, `eps`, still valid.
    bool unambiguous(std::span<const int> points, bool closed, double eps) {
        return !replaceable_as_before(points, closed, eps) && !replaceable_anywhere(points, closed, eps);
    }
    /// Can what could replace one of the points the last time do it again? Most sequences end here.
    bool replaceable_as_before(std::span<const int> points, bool closed, double eps);
    /// Can any point? Where the quick question above has been asked in vain.
    bool replaceable_anywhere(std::span<const int> points, bool closed, double eps);
    /// Of the last sequence that was not unambiguous: the point that another can replace.
    int replaced_point() const { return replaced_point_; }

    /// Every point that extends `end` of a chain of three and more with C1 true, least E_min first, ties by
    /// index.
    void candidates(const Chain& chain, End end, std::vector<Candidate>& out);
    /// They are asked for soon.
    void prefetch_candidates(const Chain& chain) const {
        for (const End end : {End::left, End::right}) fourths_.prefetch(chain.from(end, 1), chain.link(end));
    }
    /// The first of them, or kNobody if none is within `limit`. `least`: E_min of the chain.
    Candidate best_candidate(const Chain& chain, End end, double least, double limit);
    /// The first of them on each side of the plane of the three points at `end` of the chain, and in it; in
    /// 2D all are in the plane.
    using Sides = std::array<Candidate, 3>;
    Sides best_on_sides(const Chain& chain, End end, double least);

    static constexpr Candidate kNobody = Fourths::kNobody;

private:
    const Candidate* list_for(const Chain& chain, End end);
    double extended_tolerance(const Chain& chain, Chain::Inwards inwards, const Candidate& q, double limit);
    void collect_extremes(std::span<const int> points, bool closed);
    bool replaceable(std::span<const int> points, bool closed, std::size_t at, double eps);
    bool replaceable_from_shell(std::span<const int> points, bool closed, std::size_t at, double eps);
    bool fits_in_place(std::span<const int> points, bool closed, std::size_t at, int q, double eps);
    ToleranceInterval short_interval_with(std::span<const int> points, bool closed, std::size_t at, int q,
                                          double limit) const;
    void leave_out(std::size_t c, bool closed, std::size_t at);
    ToleranceInterval long_interval_with(std::span<const int> points, bool closed, std::size_t at, int q,
                                         double limit);

    /// The distances that lead an orbit from either side, with the places where they start: enough to
    /// know its span without the (at most two) distances of any one point.
    struct Extremes {
        double low[3];
        double high[3];
        int low_at[3];
        int high_at[3];

        Extremes();
        void include(double d, int at);
        Span without(int first, int second) const;
    };

    const Scene& scene_;
    const Fourths& fourths_;
    Fourths::List fourths_scratch_;
    std::vector<Span> spans_;
    std::vector<Extremes> extremes_;  // of the sequence at hand, once they are asked for
    bool collects_ = false;           // so many points are asked about it that they are worth it
    std::vector<int> replaced_sequence_;
    std::size_t left_out_ = 0;  // the place of a point
    std::vector<Span> rest_;    // the orbits without the distances of that point
    int replaced_point_ = -1;
    std::vector<int> replaced_by_;  // of each point: what could replace it the last time, or -1
};

}  // namespace insym
