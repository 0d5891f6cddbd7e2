#include "symmetries/consistency.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cycles/tolerance_interval.hpp"
#include "isometry/fit.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A cycle read in one of its two directions.
struct Strand {
    const Cycle& cycle;
    bool reversed = false;

    int size() const { return static_cast<int>(cycle.points.size()); }
    int point(int k) const { return cycle.points[static_cast<std::size_t>(reversed ? size() - 1 - k : k)]; }
    int links() const { return cycle.closed ? size() : size() - 1; }
    int next(int k) const { return k + 1 < size() ? k + 1 : 0; }
};

/// The largest spread of a cross orbit { |P_i Q_j|, |sigma P_i sigma Q_j|, ... }, or infinity as soon
/// as one exceeds `limit`. O(product of the lengths).
class CrossOrbits {
public:
    CrossOrbits(const Scene& scene, const Strand& p, const Strand& q, double limit)
        : scene_(scene), p_(p), q_(q), limit_(limit) {}

    double largest_spread() {
        // An orbit starts where neither index can go back; a ring has no such place of its own.
        if (p_.cycle.closed && q_.cycle.closed) {
            for (int j = 0; j < q_.size(); ++j)
                if (!walk(0, j, p_.size())) return kInfinity;
        } else if (p_.cycle.closed) {
            for (int i = 0; i < p_.size(); ++i)
                if (!walk(i, 0, q_.size())) return kInfinity;
        } else if (q_.cycle.closed) {
            for (int j = 0; j < q_.size(); ++j)
                if (!walk(0, j, p_.size())) return kInfinity;
        } else {
            for (int i = 0; i < p_.size(); ++i)
                if (!walk(i, 0, std::min(p_.size() - i, q_.size()))) return kInfinity;
            for (int j = 1; j < q_.size(); ++j)
                if (!walk(0, j, std::min(p_.size(), q_.size() - j))) return kInfinity;
        }
        return worst_;
    }

private:
    bool walk(int i, int j, int count) {
        Span span;
        for (; count > 0; --count) {
            span.include(scene_.distances(p_.point(i), q_.point(j)));
            i = p_.next(i);
            j = q_.next(j);
        }
        worst_ = std::max(worst_, span.spread());
        return span.spread() <= limit_;
    }

    const Scene& scene_;
    const Strand& p_;
    const Strand& q_;
    double limit_;
    double worst_ = 0;
};

/// The links at which the strands of all members start, by their first point: a strand can belong to
/// a cycle's symmetry only if that cycle carries its first link, whichever strands share it.
class StartLinks {
public:
    struct Start {
        int from;
        int to;
        int member;
        bool reversed;
    };

    explicit StartLinks(const std::vector<const Cycle*>& members) {
        for (int m = 0; m < static_cast<int>(members.size()); ++m)
            for (const bool reversed : {false, true}) {
                const Strand s{*members[static_cast<std::size_t>(m)], reversed};
                starts_.push_back({s.point(0), s.point(1), m, reversed});
            }
        std::sort(starts_.begin(), starts_.end(), [](const Start& a, const Start& b) {
            return std::tie(a.from, a.to, a.member, a.reversed) <
                   std::tie(b.from, b.to, b.member, b.reversed);
        });
        for (const Start& start : starts_) {
            if (links_.empty() || links_.back().from != start.from || links_.back().to != start.to)
                links_.push_back({start.from, start.to, 0, start.member});
            ++links_.back().count;
            links_.back().last_member = std::max(links_.back().last_member, start.member);
        }
    }

    /// Calls visit(start) for all strands of members after `first` whose first link passes `carried`.
    template <class Carried, class Visit>
    void visit_carried(int first, Carried carried, Visit visit) const {
        std::size_t k = 0;
        for (const DistinctLink& link : links_) {
            const std::size_t end = k + static_cast<std::size_t>(link.count);
            if (link.last_member > first && carried(link.from, link.to))
                for (std::size_t i = k; i < end; ++i)
                    if (starts_[i].member > first) visit(starts_[i]);
            k = end;
        }
    }

private:
    struct DistinctLink {
        int from;
        int to;
        int count;  // how many of starts_, one after another
        int last_member;
    };

    std::vector<Start> starts_;
    std::vector<DistinctLink> links_;
};

/// What the type check of a union needs of each member.
struct MemberLinks {
    std::vector<Link> links;
    LinkSums sums;
};

/// Finds the partners of one cycle after another; shared, immutable.
class PartnerSearch {
public:
    PartnerSearch(const Scene& scene, const std::vector<const Cycle*>& members, SymmetryType type)
        : scene_(scene), members_(members), type_(type), starts_(members), member_links_(members.size()) {
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (const Point& p : scene.points.positions) centre += to_vector(p) / scene.size();
        for (std::size_t m = 0; m < members.size(); ++m) {
            const Strand s{*members[m]};
            for (int k = 0; k < s.links(); ++k) {
                const Link link{to_vector(scene.position(s.point(k))) - centre,
                                to_vector(scene.position(s.point(s.next(k)))) - centre};
                member_links_[m].links.push_back(link);
                member_links_[m].sums.add(link);
            }
        }
    }

    void partners_of(int first, std::vector<Consistency>& out) const {
        const Strand p{*members_[static_cast<std::size_t>(first)]};
        const double limit = std::min(scene_.max_tolerance, p.cycle.tolerance.max);
        std::vector<Consistency> passed;
        // Most fail at its first link; that one is asked of all in a tight loop.
        const auto d_here = scene_.distances.row(p.point(0));
        const auto d_there = scene_.distances.row(p.point(1));
        const auto carried = [&](int from, int to) {
            return std::abs(d_here[static_cast<std::size_t>(from)] - d_there[static_cast<std::size_t>(to)]) <=
                       limit &&
                   carries_link(p, from, to, limit);
        };
        starts_.visit_carried(first, carried, [&](const StartLinks::Start& start) {
            const double tolerance =
                union_tolerance(p, {*members_[static_cast<std::size_t>(start.member)], start.reversed});
            if (tolerance < kInfinity) passed.push_back({tolerance, first, start.member, start.reversed});
        });
        // The better of the two directions of each second cycle, the given one where they are equal.
        std::sort(passed.begin(), passed.end(), [](const Consistency& a, const Consistency& b) {
            return std::tie(a.second, a.tolerance, a.reversed) < std::tie(b.second, b.tolerance, b.reversed);
        });
        int last = -1;
        for (const Consistency& c : passed) {
            if (c.second == last) continue;
            if (scene_.dimension() == 3 && !union_has_type(c)) continue;
            last = c.second;
            out.push_back(c);
        }
    }

private:
    bool carries_link(const Strand& p, int from, int to, double limit) const {
        const auto d_from = scene_.distances.row(from);
        const auto d_to = scene_.distances.row(to);
        for (int k = 0; k < p.links(); ++k) {
            const int here = p.point(k), there = p.point(p.next(k));
            if (here == from || there == to) return false;  // not disjoint
            if (std::abs(d_from[static_cast<std::size_t>(here)] - d_to[static_cast<std::size_t>(there)]) >
                limit)
                return false;
        }
        return true;
    }

    static bool disjoint(const Strand& p, const Strand& q) {
        return std::none_of(q.cycle.points.begin(), q.cycle.points.end(), [&](int i) {
            return std::find(p.cycle.points.begin(), p.cycle.points.end(), i) != p.cycle.points.end();
        });
    }

    /// E_min of the union where it is below its E_max and max_tolerance, else infinity.
    double union_tolerance(const Strand& p, const Strand& q) const {
        if (p.cycle.closed && q.cycle.closed && p.size() != q.size()) return kInfinity;
        const double top = std::min(p.cycle.tolerance.max, q.cycle.tolerance.max);
        const double own = std::max(p.cycle.tolerance.min, q.cycle.tolerance.min);
        if (own >= top || !disjoint(p, q)) return kInfinity;
        const double limit = std::min(top, scene_.max_tolerance);
        const double tolerance = std::max(own, CrossOrbits(scene_, p, q, limit).largest_spread());
        return tolerance < top && tolerance <= scene_.max_tolerance ? tolerance : kInfinity;
    }

    /// The isometry of the type's determinant carries the links of both at most twice as far off as
    /// the other determinant's (`carries` of the reference).
    bool union_has_type(const Consistency& c) const {
        const MemberLinks& p = member_links_[static_cast<std::size_t>(c.first)];
        const MemberLinks& q = member_links_[static_cast<std::size_t>(c.second)];
        LinkSums sums = p.sums;
        sums += c.reversed ? q.sums.reversed() : q.sums;
        const RigidFits fits = fit_rigid(sums, 3);
        const auto worst = [&](const RigidMap& map) {
            double square = 0;
            for (const Link& l : p.links) square = std::max(square, (map(l.from) - l.to).squaredNorm());
            for (const Link& l : q.links)
                square =
                    std::max(square, (c.reversed ? map(l.to) - l.from : map(l.from) - l.to).squaredNorm());
            return std::sqrt(square);
        };
        const double proper = worst(fits.proper), improper = worst(fits.improper);
        const double own = is_improper(type_, 3) ? improper : proper;
        return own <= 2 * std::min(proper, improper) + scene_.resolution;
    }

    const Scene& scene_;
    const std::vector<const Cycle*>& members_;
    SymmetryType type_;
    StartLinks starts_;
    std::vector<MemberLinks> member_links_;
};

}  // namespace

std::vector<Consistency> consistent_cycles(const Scene& scene, const std::vector<const Cycle*>& members,
                                           SymmetryType type, RunMonitor& monitor) {
    const PartnerSearch search(scene, members, type);
    std::vector<std::vector<Consistency>> found(members.size());
    monitor.begin_stage("consistency", members.size());
    parallel_for(members.size(), [&](std::size_t first) {
        if (!monitor.should_stop()) search.partners_of(static_cast<int>(first), found[first]);
        monitor.advance();
    });
    std::vector<Consistency> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace insym
