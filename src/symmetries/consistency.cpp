#include "symmetries/consistency.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "cycles/tolerance_interval.hpp"
#include "isometry/fit.hpp"
#include "parallel_for.hpp"
#include "points/shells.hpp"
#include "symmetries/anchors.hpp"

namespace insym {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the search needs of a cycle, those of all cycles one after another.
struct Member {
    std::span<const int> points;
    ToleranceInterval tolerance;
    TypeSet types;
    bool closed = false;
};

/// A cycle read in one of its two directions.
struct Strand {
    const Member& cycle;
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

/// The largest distance by which a map misses the end of a link.
class Miss {
public:
    explicit Miss(const RigidMap& map) : map_(map) {}
    void include(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
        square_ = std::max(square_, (map_(from) - to).squaredNorm());
    }
    double largest() const { return std::sqrt(square_); }

private:
    const RigidMap& map_;
    double square_ = 0;
};

/// What all searches of a run look at; immutable.
class Strands {
public:
    Strands(const Scene& points, const std::vector<Cycle>& cycles)
        : scene(points),
          anchors(cycles, points.size()),
          shells(points.distances),
          rounding(1e-12 * points.diameter) {
        for (const Cycle& c : cycles) points_.insert(points_.end(), c.points.begin(), c.points.end());
        const int* next = points_.data();
        for (const Cycle& c : cycles) {
            members_.push_back({{next, c.points.size()}, c.tolerance, c.types, c.closed});
            next += c.points.size();
        }
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (const Point& p : scene.points.positions) centre += to_vector(p) / scene.size();
        centred_.reserve(scene.points.size());
        for (const Point& p : scene.points.positions) centred_.emplace_back(to_vector(p) - centre);
        sums_.resize(cycles.size());
        parallel_for(cycles.size(), [&](std::size_t c) {
            for_each_link({members_[c]}, [&](const auto& from, const auto& to) { sums_[c].add({from, to}); });
        });
    }

    const Member& cycle(int c) const { return members_[static_cast<std::size_t>(c)]; }
    const LinkSums& sums(int c) const { return sums_[static_cast<std::size_t>(c)]; }

    /// Calls visit(from, to) with the places of all links, relative to the centroid of the set.
    template <class Visit>
    void for_each_link(const Strand& s, Visit visit) const {
        for (int k = 0; k < s.links(); ++k)
            visit(centred_[static_cast<std::size_t>(s.point(k))],
                  centred_[static_cast<std::size_t>(s.point(s.next(k)))]);
    }

    double miss(const RigidMap& map, const Strand& s) const {
        Miss miss(map);
        for_each_link(s, [&](const auto& from, const auto& to) { miss.include(from, to); });
        return miss.largest();
    }

    const Scene& scene;
    const Anchors anchors;
    const Shells shells;
    const double rounding;  // more than all that is computed here can be off by

private:
    std::vector<int> points_;
    std::vector<Member> members_;
    std::vector<Eigen::Vector3d> centred_;
    std::vector<LinkSums> sums_;
};

/// Two strands as one: a cycle, and another in one of its directions.
struct Union {
    int other = 0;
    bool reversed = false;
    double tolerance = 0;
    // Of the cycle's own isometries, proper and improper, over the links of both.
    std::array<double, 2> miss{kInfinity, kInfinity};
};

/// Finds the partners of one cycle among those whose anchors come before its own.
class PartnerSearch {
public:
    PartnerSearch(const Strands& all, int cycle)
        : all_(all),
          scene_(all.scene),
          cycle_(cycle),
          p_{all.cycle(cycle)},
          limit_(std::min(scene_.max_tolerance, p_.cycle.tolerance.max)) {
        for (const int point : p_.cycle.points) rows_.push_back(scene_.distances.row(point).data());
    }

    /// Calls found(type, consistency).
    template <class Found>
    void visit_partners(TypeSet types, Found found) {
        types = types & p_.cycle.types;
        if (types.empty()) return;
        collect_candidates(types);
        std::sort(unions_.begin(), unions_.end(), [](const Union& a, const Union& b) {
            return std::tie(a.other, a.reversed) < std::tie(b.other, b.reversed);
        });
        std::erase_if(unions_, [&](Union& u) { return !measure(u); });
        // The better of the two directions first, the given one where they are equal.
        std::sort(unions_.begin(), unions_.end(), [](const Union& a, const Union& b) {
            return std::tie(a.other, a.tolerance, a.reversed) < std::tie(b.other, b.tolerance, b.reversed);
        });
        for (std::size_t k = 0; k < unions_.size();) {
            std::size_t end = k + 1;
            while (end < unions_.size() && unions_[end].other == unions_[k].other) ++end;
            const TypeSet common = types & all_.cycle(unions_[k].other).types;
            for (const SymmetryType type : kAllSymmetryTypes) {
                if (!common.contains(type)) continue;
                const auto best = std::find_if(unions_.begin() + static_cast<std::ptrdiff_t>(k),
                                               unions_.begin() + static_cast<std::ptrdiff_t>(end),
                                               [&](const Union& u) { return has_type(u, type); });
                if (best == unions_.begin() + static_cast<std::ptrdiff_t>(end)) continue;
                found(type, Consistency{best->tolerance, std::min(cycle_, best->other),
                                        std::max(cycle_, best->other), best->reversed});
            }
            k = end;
        }
    }

private:
    /// A partner carries every link of this cycle, and is carried by it, so also the one at its anchor.
    void collect_candidates(TypeSet types) {
        for (int place = 0; place < all_.anchors.place_of(cycle_); ++place) {
            const int from = all_.anchors.point(place);
            const auto ask = [&](int to, std::span<const AnchoredLink> links) {
                if (!carries_link(from, to)) return;
                for (const AnchoredLink& link : links)
                    if (!(types & link.types).empty()) unions_.push_back({link.cycle, link.reversed});
            };
            if (all_.shells.stored()) {
                Shells::visit(possible_ends(place, from),
                              [&](int to) { ask(to, all_.anchors.links(place, to)); });
                continue;
            }
            // Whichever are fewer: the ends of links, or the points as far from the second as the anchor is
            // from the first.
            if (all_.anchors.ends(place) < kShell + scene_.size() * limit_ / scene_.diameter) {
                all_.anchors.visit_ends(place, ask);
                continue;
            }
            const double d = distance(0, from);
            const double reach = limit_ + all_.rounding;
            scene_.distances.visit_shell(p_.point(1), d - reach, d + reach, [&](int to, double) {
                const auto links = all_.anchors.links(place, to);
                if (!links.empty()) ask(to, links);
                return true;
            });
        }
    }

    /// Of the links from the anchor `from`: what lies as far from the end of each link of this cycle as the
    /// anchor from its start.
    Shells::Set possible_ends(int place, int from) const {
        Shells::Set ends{};
        for (int w = 0; w < all_.anchors.words(); ++w)
            ends[static_cast<std::size_t>(w)] = all_.anchors.end_bits(place, w);
        const double reach = limit_ + all_.rounding;
        for (int k = 0; k < p_.links(); ++k) {
            const double d = distance(k, from);
            if (p_.point(k) == from || !all_.shells.keep(p_.point(p_.next(k)), d - reach, d + reach, ends))
                return {};
        }
        return ends;
    }

    bool carries_link(int from, int to) const {
        for (int k = 0; k < p_.links(); ++k) {
            const int here = p_.point(k), next = p_.next(k), there = p_.point(next);
            if (here == from || there == to) return false;  // not disjoint
            if (std::abs(distance(k, from) - distance(next, to)) > limit_) return false;
        }
        return true;
    }

    /// Of the k-th point of the cycle, whose row of distances stays in the cache.
    double distance(int k, int point) const {
        return rows_[static_cast<std::size_t>(k)][static_cast<std::size_t>(point)];
    }

    bool disjoint(const Strand& q) const {
        return std::none_of(q.cycle.points.begin(), q.cycle.points.end(), [&](int i) {
            return std::find(p_.cycle.points.begin(), p_.cycle.points.end(), i) != p_.cycle.points.end();
        });
    }

    /// Sets E_min of the union; false where it is not below its E_max, or above max_tolerance.
    bool measure(Union& u) {
        const Strand q{all_.cycle(u.other), u.reversed};
        if (p_.cycle.closed && q.cycle.closed && p_.size() != q.size()) return false;
        const double top = std::min(p_.cycle.tolerance.max, q.cycle.tolerance.max);
        const double own = std::max(p_.cycle.tolerance.min, q.cycle.tolerance.min);
        if (own >= top || !disjoint(q)) return false;
        if (exact()) {
            if (!own_) own_ = fit_own();
            for (std::size_t k = 0; k < 2; ++k)
                u.miss[k] = std::max((*own_)[k].miss, all_.miss((*own_)[k].map, q));
        }
        // An isometry that misses no link by more than m changes a distance by at most 2m in each step, so
        // that a cross orbit spreads by less than this.
        const double bound =
            2 * std::min(u.miss[0], u.miss[1]) * std::max(p_.size(), q.size()) + all_.rounding;
        const double limit = std::min(top, scene_.max_tolerance);
        u.tolerance = bound <= own ? own : std::max(own, CrossOrbits(scene_, p_, q, limit).largest_spread());
        return u.tolerance < top && u.tolerance <= scene_.max_tolerance;
    }

    /// What is not exact has no isometry that misses so little that it says anything.
    bool exact() const { return p_.cycle.tolerance.min <= scene_.resolution; }

    struct Own {
        RigidMap map;
        double miss = 0;
    };
    using OwnMaps = std::array<Own, 2>;

    /// An isometry of either determinant for this cycle. A row fixes no turn about itself; a row's symmetry
    /// is most often a translation.
    OwnMaps fit_own() const {
        const LinkSums& sums = all_.sums(cycle_);
        RigidFits fits = fit_rigid(sums, 3);
        if (p_.cycle.types.contains(SymmetryType::translation))
            fits.proper = {Eigen::Matrix3d::Identity(), (sums.to - sums.from) / sums.count};
        return {Own{fits.proper, all_.miss(fits.proper, p_)},
                Own{fits.improper, all_.miss(fits.improper, p_)}};
    }

    /// The isometry of the type's determinant carries the links of both at most twice as far off as
    /// the other determinant's (`carries` of the reference).
    bool has_type(const Union& u, SymmetryType type) const {
        if (scene_.dimension() == 2) return true;
        const bool improper = is_improper(type, 3);
        const Strand other{all_.cycle(u.other), u.reversed};
        // The largest miss of a least-squares fit is at most the root of the sum of all squares.
        const auto most = [&](bool of_improper) {
            return std::sqrt(p_.links() + other.links()) * u.miss[of_improper ? 1 : 0] + all_.rounding;
        };
        if (most(improper) <= scene_.resolution) return true;
        const int first = std::min(cycle_, u.other), second = std::max(cycle_, u.other);
        LinkSums sums = all_.sums(first);
        sums += u.reversed ? all_.sums(second).reversed() : all_.sums(second);
        if (2 * most(!improper) + scene_.resolution + all_.rounding < least_miss(sums, improper))
            return false;
        const RigidFits fits = fit_rigid(sums, 3);
        const Strand p{all_.cycle(first)}, q{all_.cycle(second), u.reversed};
        const auto worst = [&](const RigidMap& map) {
            return std::max(all_.miss(map, p), all_.miss(map, q));
        };
        const double proper_miss = worst(fits.proper), improper_miss = worst(fits.improper);
        return (improper ? improper_miss : proper_miss) <=
               2 * std::min(proper_miss, improper_miss) + scene_.resolution;
    }

    /// No isometry of this determinant misses all links by less. With the singular values s1 >= s2 >= s3 of
    /// the covariance, whose determinant has the other sign, the squares sum up to 4 s3 more than for the
    /// other determinant, and s3 = |det| / (s1 s2) >= 2 |det| / (s1^2 + s2^2 + s3^2).
    double least_miss(const LinkSums& sums, bool improper) const {
        const Eigen::Matrix3d h = sums.covariance();
        const double det = h.determinant(), square = h.squaredNorm();
        if ((det < 0) == improper || !(square > 0)) return 0;
        const double rounding = scene_.diameter * all_.rounding / 10;
        return std::sqrt(std::max(0.0, 8 * std::abs(det) / (square * sums.count) - rounding));
    }

    static constexpr double kShell = 8;  // points in a narrow shell, about

    const Strands& all_;
    const Scene& scene_;
    int cycle_;
    Strand p_;
    double limit_;
    std::vector<const double*> rows_;  // of distances, for each point of the cycle
    std::vector<Union> unions_;
    std::optional<OwnMaps> own_;
};

struct TypedConsistency {
    SymmetryType type;
    Consistency pair;
};

/// Each type's in order of (first, second).
ConsistentPairs in_order(const std::vector<std::vector<TypedConsistency>>& found) {
    std::vector<std::size_t> start(found.size() + 1, 0);
    for (const auto& part : found)
        for (const TypedConsistency& c : part) ++start[static_cast<std::size_t>(c.pair.first) + 1];
    for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
    std::vector<TypedConsistency> all(start.back());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (const auto& part : found)
        for (const TypedConsistency& c : part) all[next[static_cast<std::size_t>(c.pair.first)]++] = c;
    parallel_for(found.size(), [&](std::size_t k) {
        std::sort(all.begin() + static_cast<std::ptrdiff_t>(start[k]),
                  all.begin() + static_cast<std::ptrdiff_t>(start[k + 1]),
                  [](const TypedConsistency& a, const TypedConsistency& b) {
                      return std::tie(a.pair.second, a.type) < std::tie(b.pair.second, b.type);
                  });
    });
    ConsistentPairs pairs;
    for (const TypedConsistency& c : all) pairs[static_cast<std::size_t>(c.type)].push_back(c.pair);
    return pairs;
}

}  // namespace

ConsistentPairs consistent_cycles(const Scene& scene, const std::vector<Cycle>& cycles, TypeSet types,
                                  RunMonitor& monitor) {
    const Strands all(scene, cycles);
    std::vector<std::vector<TypedConsistency>> found(cycles.size());
    monitor.begin_stage("consistency", cycles.size());
    parallel_for(cycles.size(), [&](std::size_t c) {
        if (!monitor.should_stop())
            PartnerSearch(all, static_cast<int>(c))
                .visit_partners(types, [&](SymmetryType type, const Consistency& pair) {
                    found[c].push_back({type, pair});
                });
        monitor.advance();
    });
    return in_order(found);
}

}  // namespace insym
