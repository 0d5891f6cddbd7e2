// A growing chain of points with its distance orbits (definitions, sections 2 and 4).
#pragma once

#include <span>
#include <vector>

#include "cycles/tolerance_interval.hpp"
#include "scene.hpp"

namespace insym {

enum class End { left, right };

/// An open chain P_1 ... P_c that grows at either end and shrinks again. Its orbits are kept up to
/// date: adding a point costs O(c).
class Chain {
public:
    explicit Chain(const Scene& scene) : scene_(&scene) {}

    void assign(std::span<const int> points);
    void add(int point, End end);

    int size() const { return static_cast<int>(end_ - begin_); }
    std::span<const int> points() const { return {buffer_.data() + begin_, end_ - begin_}; }
    /// The k-th point counted from `end`, from 0.
    int from(End end, int k) const {
        return end == End::right ? buffer_[end_ - 1 - static_cast<std::size_t>(k)]
                                 : buffer_[begin_ + static_cast<std::size_t>(k)];
    }
    /// Orbit r - 1 holds the distances |P_l P_{l+r}|.
    std::span<const Span> orbits() const { return orbits_; }
    bool contains(int point) const;

private:
    const Scene* scene_;
    std::vector<int> buffer_;
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::vector<Span> orbits_;
};

/// A point that a chain can take at an end, and E_min of the longer chain.
struct Candidate {
    double tolerance = 0;
    int point = 0;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
};

/// Answers the questions of sections 2 to 4 about chains and cycles. Holds scratch memory: one for
/// each thread.
class ChainOracle {
public:
    explicit ChainOracle(const Scene& scene)
        : scene_(scene), twin_(static_cast<std::size_t>(scene.size()), -1) {}

    const Scene& scene() const { return scene_; }

    /// E_min and E_max of a sequence. O(c^2).
    ToleranceInterval interval(std::span<const int> points, bool closed);
    /// E_min of the chain closed to a cycle, infinite above max_tolerance. O(c log c).
    double closed_tolerance(const Chain& chain);
    /// C1 of a sequence: one label, and E_min <= max_tolerance.
    bool holds(std::span<const int> points, bool closed);
    /// C2: no outside point can replace a point of the sequence with E_min still valid.
    bool unambiguous(std::span<const int> points, bool closed);

    /// Every point that extends `end` with C1 true, least E_min first, ties by index.
    void candidates(const Chain& chain, End end, std::vector<Candidate>& out);
    /// The first of them, or tolerance = infinity and point = -1 if none is within `limit`. `among`: a list
    /// known to hold all of them, such as the candidates of a part of the chain at the same end.
    Candidate best_candidate(const Chain& chain, End end, double limit,
                             const std::vector<Candidate>* among = nullptr);

private:
    /// Visits the points at a distance of [low, high], and a few more: the bounds are computed from
    /// other distances, so rounding must not lose a point that the exact test after it would take.
    template <class Visit>
    void visit_shell(int point, double low, double high, Visit visit) const {
        const double slack = 1e-12 * scene_.diameter;
        scene_.distances.visit_shell(point, low - slack, high + slack, visit);
    }
    template <class Visit>
    void visit_extensions(const Chain& chain, End end, const std::vector<Candidate>* among, double& limit,
                          Visit visit);
    void collect_extremes(std::span<const int> points, bool closed);
    void collect_distances(std::span<const int> points);
    void leave_out(std::span<const int> points, bool closed, std::size_t at);
    bool replaceable(std::span<const int> points, bool closed, std::size_t at, double eps);
    bool replaceable_by_twin(std::span<const int> points, bool closed, std::size_t at, double eps);
    bool fits_in_place(std::span<const int> points, bool closed, std::size_t at, int point, double eps);

    /// How far a new point may be from one of the chain.
    struct Shell {
        const double* distances = nullptr;  // of that point
        double low = 0;
        double high = 0;
    };

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
        Span all() const { return {low[0], high[0]}; }
    };

    const Scene& scene_;
    std::vector<Shell> shells_;
    std::vector<std::size_t> by_length_;
    std::vector<Span> spans_;
    std::vector<Span> rest_;  // the orbits without the distances of one point
    std::vector<Extremes> extremes_;
    std::vector<int> twin_;      // for each point: what could replace it the last time, or -1
    int replaced_ = -1;          // the point that could be replaced the last time
    std::vector<double> table_;  // the distances within a short sequence, row by row
};

}  // namespace insym
