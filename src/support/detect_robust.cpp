#include "support/detect_robust.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "hypotheses/generators.hpp"
#include "parallel_for.hpp"
#include "points/diameter.hpp"
#include "support/collection.hpp"
#include "support/pattern.hpp"
#include "support/representatives.hpp"
#include "support/spread.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

/// A symmetry is kept while searching, and listed, below these; above 0 chance does as well.
constexpr double kKept = 3;
constexpr double kListed = 1;

constexpr std::size_t kMostPairs = 300000;  // that vote together

/// The largest tolerance worth looking at: there a scattered set has a point in one place of eight.
double largest_reach(const PointScene& scene, const Significance& significance) {
    constexpr double kChance = 0.12;
    double reach = scene.resolution;
    while (reach < scene.max_tolerance && significance.background().chance(1.2 * reach) < kChance)
        reach *= 1.2;
    return std::min(reach, scene.max_tolerance);
}

class Search {
public:
    Search(const Cloud& cloud, const Significance& significance, RunMonitor& monitor)
        : cloud_(cloud),
          significance_(significance),
          monitor_(monitor),
          gatherer_(cloud, significance, largest_reach(cloud.scene(), significance)) {}

    RobustResult run(TypeSet types) {
        const double reach = gatherer_.reach();
        offer(frames(cloud_, Vector3d::Zero(), reach, static_cast<std::size_t>(budget(1000))));
        SearchGroup points(static_cast<std::size_t>(cloud_.size()));
        std::iota(points.begin(), points.end(), 0);
        // What is exact first, which is found among few candidates; what is not, then among few points: a
        // share of each exact orbit, in a small set a larger one, so that of any set a dozen points stay.
        constexpr std::size_t kShare = 8, kDozen = 12;
        const std::size_t share = std::clamp<std::size_t>(points.size() / kDozen, 1, kShare);
        const double exact = exact_reach();
        if (exact < reach) {
            look_at(points, exact, 3e5);
            points = representatives(cloud_, collection_.supports(), share, Stay::outer);
        }
        look_at(points, reach, 1e6);
        offer_roots();
        close_products();
        RobustResult result;
        result.hypotheses = tried_;
        result.max_tolerance = reach;
        result.symmetries = symmetries(types);
        return result;
    }

private:
    double exact_reach() const {
        constexpr double kExact = 4;  // resolutions
        return kExact * cloud_.scene().resolution;
    }

    /// So many hypotheses of each source, for 100 points; in a large set one costs little, as most are local,
    /// and what there is to find grows with the points.
    double budget(double at_100) const {
        const double hundreds = cloud_.size() / 100.0;
        return 40 + at_100 / (hundreds * hundreds);
    }

    /// Hypotheses from pairs and chains of `points` to a tolerance. `looks`: of all points, at pairs of
    /// pairs.
    void look_at(const SearchGroup& points, double reach, double looks) {
        // There votes are counted in cells of one size only.
        const bool exact = reach <= exact_reach();
        const auto n = static_cast<double>(points.size());
        // Fewer points, fewer hypotheses.
        const double share = n / cloud_.size();
        const auto of_share = [&](double most) { return static_cast<std::size_t>(share * share * most); };
        // In looks at a point: many are needed where noise hides which are meant.
        const auto looked = [&](double all) { return 100 + all / cloud_.size(); };
        const auto voted = of_share(budget(600) + std::min(n / 5, 500.0));
        const Groups groups(cloud_, points, !all_pairs_vote(points), reach,
                            {of_share(looked(3e5) + n / 4), of_share(looked(1e5) + n / 8),
                             of_share(budget(200) + n / 8), share * share * looks, share * share * share});
        monitor_.begin_stage("votes of pairs", 1);
        const std::vector<std::vector<Hypothesis>> votes = votes_of(points, reach, voted / 2);
        std::vector<Source> sources;
        sources.reserve(votes.size());
        for (const std::vector<Hypothesis>& v : votes)
            sources.push_back(source(v, exact ? voted / 2 : voted));
        offer(std::move(sources));
        monitor_.advance();
        offer_groups(groups, focus());
    }

    /// Points that are exactly alike suggest alike. Where there are few, all suggest, which costs little.
    Focus focus() const {
        constexpr std::size_t kFocus = 16;
        constexpr int kFew = 100;
        if (cloud_.size() <= kFew) return {};
        Focus focus(static_cast<std::size_t>(cloud_.size()), 0);
        for (const int i : representatives(cloud_, collection_.supports(), kFocus, Stay::inner))
            focus[static_cast<std::size_t>(i)] = 1;
        return focus;
    }

    /// Half-turns in the plane are inversions there.
    std::vector<SymmetryType> types_voted() const {
        return {SymmetryType::translation, SymmetryType::mirror,
                cloud_.dimension() == 2 ? SymmetryType::half_turn : SymmetryType::inversion};
    }

    static bool all_pairs_vote(const SearchGroup& points) {
        return points.size() * (points.size() - 1) / 2 <= kMostPairs;
    }

    std::vector<std::vector<Hypothesis>> votes_of(const SearchGroup& points, double reach,
                                                  std::size_t most) const {
        const std::vector<SymmetryType> types = types_voted();
        // Where groups vote by themselves, a sample finds what covers much of the set.
        const PointPairs pairs =
            spread_pairs(cloud_, points, all_pairs_vote(points) ? kMostPairs : kMostPairs / 5);
        std::vector<std::vector<Hypothesis>> votes(types.size());
        parallel_for(types.size(),
                     [&](std::size_t k) { votes[k] = vote(cloud_, types[k], pairs, reach, most); });
        return votes;
    }

    /// What a group of points suggests.
    struct Suggestions {
        std::vector<std::vector<Hypothesis>> voted;
        Agreed chains, half_turns;
    };

    /// How much is made of the groups together: each has its share.
    struct GroupBudget {
        std::size_t chains, half_turns, votes;
        double looks;   // at pairs of pairs
        double effort;  // of one group, for chains

        /// What the groups from one share of the whole to another may spend.
        GroupBudget between(double from, double to) const {
            const auto part = [&](std::size_t whole) {
                const auto upto = [&](double share) {
                    return std::floor(share * static_cast<double>(whole));
                };
                return static_cast<std::size_t>(upto(to) - upto(from));
            };
            return {part(chains), part(half_turns), part(votes), (to - from) * looks, effort};
        }
    };

    /// Groups of points to a tolerance, with what each may spend.
    struct Groups {
        Groups(const Cloud& cloud, const SearchGroup& points, bool vote, double within, GroupBudget all)
            : groups(search_groups(cloud, points, kGroup)), with_votes(vote), reach(within), budget(all) {
            for (const SearchGroup& g : groups)
                before.push_back(before.back() + static_cast<double>(g.size()));
        }

        GroupBudget budget_of(std::size_t k) const {
            return budget.between(before[k] / before.back(), before[k + 1] / before.back());
        }

        static constexpr std::size_t kGroup = 512;
        std::vector<SearchGroup> groups;
        bool with_votes;
        double reach;
        GroupBudget budget;
        std::vector<double> before{0};  // points in the groups before each
    };

    /// So many groups at a time.
    static constexpr std::size_t kAtATime = 16;

    std::vector<Suggestions> suggestions_from(const Groups& groups, const Focus& focus,
                                              std::size_t first) const {
        std::vector<Suggestions> found(std::min(kAtATime, groups.groups.size() - first));
        parallel_for(found.size(), [&](std::size_t k) { found[k] = suggestions(groups, focus, first + k); });
        return found;
    }

    Suggestions suggestions(const Groups& groups, const Focus& focus, std::size_t k) const {
        // So many candidates are kept for each that is tried: most of them say the same, or what was found.
        constexpr std::size_t kSpare = 20, kLeast = 20000;  // to keep some costs little
        const auto kept = [&](std::size_t tried) { return std::max(kLeast, kSpare * tried); };
        Suggestions out;
        if (monitor_.should_stop()) return out;
        const GroupBudget budget = groups.budget_of(k);
        const GroupDistances known(cloud_, groups.groups[k], focus);
        parallel_for(2, [&](int half) {
            if (half == 0)
                out.chains =
                    agreeing_first(cloud_, chains(known, groups.reach, budget.effort, kept(budget.chains)));
            else
                out.half_turns = agreeing_first(
                    cloud_, half_turns(known, groups.reach, budget.looks, kept(budget.half_turns)));
        });
        if (!groups.with_votes) return out;
        const PointPairs pairs = pairs_within(groups.groups[k], focus);
        for (const SymmetryType type : types_voted())
            out.voted.push_back(vote(cloud_, type, pairs, groups.reach, budget.votes));
        return out;
    }

    /// Where candidates agree exactly, those that do come first, and fewer are needed.
    static std::size_t tries(const Agreed& found, std::size_t most) {
        constexpr std::size_t kSome = 4;
        return found.agreeing < kSome ? most : std::min(most / 4, found.agreeing + most / 32);
    }

    /// A few groups at a time, and meanwhile what the next ones suggest, which does not depend on them.
    void offer_groups(const Groups& groups, const Focus& focus) {
        monitor_.begin_stage("chains of points", groups.groups.size());
        std::vector<Suggestions> found = suggestions_from(groups, focus, 0), next;
        for (std::size_t first = 0; !found.empty() && !monitor_.should_stop(); found.swap(next)) {
            std::vector<Source> sources;
            for (std::size_t k = 0; k < found.size(); ++k) {
                const GroupBudget most = groups.budget_of(first + k);
                for (const std::vector<Hypothesis>& v : found[k].voted)
                    sources.push_back(source(v, most.votes));
                sources.push_back(source(found[k].chains, most.chains));
                sources.push_back(source(found[k].half_turns, most.half_turns));
                monitor_.advance();
            }
            first += found.size();
            parallel_for(2, [&](int k) {
                if (k == 0)
                    offer(std::move(sources));
                else
                    next = suggestions_from(groups, focus, first);
            });
        }
    }

    /// Hypotheses in their order, of which so many are tried.
    struct Source {
        std::function<Hypothesis(std::size_t)> at;
        std::size_t size = 0, most = 0;
        std::size_t next = 0, tried = 0;

        bool ended() const { return next == size || tried >= most; }
    };

    static Source source(const std::vector<Hypothesis>& hypotheses, std::size_t most) {
        return {[&hypotheses](std::size_t k) { return hypotheses[k]; }, hypotheses.size(), most};
    }
    Source source(const Agreed& found, std::size_t most) const {
        return {[this, &found](std::size_t k) { return hypothesis_of(cloud_, found.candidates[k]); },
                found.candidates.size(), tries(found, most)};
    }
    void offer(const std::vector<Hypothesis>& hypotheses) { offer({source(hypotheses, hypotheses.size())}); }

    /// Tries hypotheses, of all sources by turns, in blocks, so that what one finds spares the later ones the
    /// work. While a block is gathered the last one's finds are collected and the next block is drawn; the
    /// blocks do not depend on the threads.
    void offer(std::vector<Source> sources) {
        std::vector<Hypothesis> block = next_block(sources), next;
        std::vector<std::optional<Support>> found, last;
        while (!block.empty() && !monitor_.should_stop()) {
            tried_ += block.size();
            found.assign(block.size(), std::nullopt);
            parallel_for(2, [&](int k) {
                if (k == 0) {
                    parallel_for(block.size(), [&](std::size_t i) {
                        if (!monitor_.should_stop()) found[i] = gatherer_.gather(block[i], kKept);
                    });
                } else {
                    collect(last);
                    next = next_block(sources);
                }
            });
            last.swap(found);
            block.swap(next);
        }
        collect(last);
    }

    std::vector<Hypothesis> next_block(std::vector<Source>& sources) const {
        constexpr std::size_t kBlock = 32;
        std::vector<Hypothesis> block;
        std::erase_if(sources, [](const Source& s) { return s.ended(); });
        const std::size_t share = std::max<std::size_t>(1, kBlock / std::max<std::size_t>(1, sources.size()));
        for (Source& s : sources)
            for (const std::size_t stop = s.tried + share; s.tried < stop && !s.ended(); ++s.next) {
                Hypothesis h = s.at(s.next);
                if (collection_.explains(h)) continue;
                block.push_back(std::move(h));
                ++s.tried;
            }
        return block;
    }

    void collect(std::vector<std::optional<Support>>& found) {
        for (std::optional<Support>& f : found)
            if (f) collection_.add(std::move(*f));
        found.clear();
    }

    /// `off`: how well the map is known.
    static Hypothesis of_map(SymmetryType type, const RigidMap& map, double off) {
        Hypothesis h;
        h.type = type;
        h.map = map;
        h.off = off;
        return h;
    }

    /// What a found symmetry may be a power of: half and third steps, and turns of whole order.
    void offer_roots() {
        constexpr std::size_t kMost = 100;
        std::vector<const Support*> best;
        for (const Support& s : collection_.supports())
            if (s.significance < -1) best.push_back(&s);
        std::stable_sort(best.begin(), best.end(), [](const Support* a, const Support* b) {
            return a->significance < b->significance;
        });
        if (best.size() > kMost) best.resize(kMost);
        std::vector<Hypothesis> roots;
        for (const Support* s : best) add_roots(*s, roots);
        offer(roots);
    }

    void add_roots(const Support& s, std::vector<Hypothesis>& out) const {
        const bool improper = s.type == SymmetryType::rotation_reflection;
        if (s.type == SymmetryType::translation) {
            for (const double k : {2.0, 3.0})
                out.push_back(of_map(s.type, {s.map.linear, s.map.shift / k}, s.tolerance));
            return;
        }
        if (s.type != SymmetryType::rotation && !improper) return;
        const Motion motion = motion_of(s.map, improper);
        const double slack = 2 * angle_slack(cloud_, s, motion);
        const Eigen::Matrix3d a = Eigen::Matrix3d::Identity() - s.map.linear;
        const Vector3d fixed = a.completeOrthogonalDecomposition().solve(s.map.shift);
        const auto offer_order = [&](int order) {
            RigidMap map;
            map.linear = Eigen::AngleAxisd(2 * std::numbers::pi / order, motion.axis).toRotationMatrix();
            if (improper) map.linear -= 2 * (map.linear * motion.axis) * motion.axis.transpose();
            map.shift = fixed - map.linear * fixed;
            out.push_back(of_map(s.type, map, s.tolerance));
        };
        constexpr int kMostOrder = 200, kMostTries = 8;
        int tries = 0;
        const double turns = motion.angle / (2 * std::numbers::pi);
        for (int order = 3; order <= kMostOrder && tries < kMostTries; ++order) {
            const double whole = std::round(order * turns);
            if (whole < 1 || std::abs(turns - whole / order) * 2 * std::numbers::pi > slack) continue;
            ++tries;
            offer_order(order);
        }
    }

    static constexpr std::size_t kMostElements = 130;  // of a finite group that is looked for

    /// A look at a sample: of the points that a symmetry of nearly all carries.
    static constexpr double kMany = 0.6;

    /// Of nearly the whole set, and such as some point can stay in place under: part of a finite group.
    bool of_group(const Support& s) const {
        return s.type != SymmetryType::translation && s.type != SymmetryType::screw &&
               s.type != SymmetryType::glide_reflection && s.significance < kListed &&
               gatherer_.share_carried(s.map, 1.5 * s.tolerance) >= kMany &&
               5 * gatherer_.carried(s, 1.5 * s.tolerance) >= 4 * cloud_.size();
    }

    /// Of any kind; what it is comes out when it is gathered.
    Hypothesis product(const Support& a, const Support& b) const {
        const RigidMap map = compose(a.map, b.map);
        const bool improper = map.linear.determinant() < 0;
        const bool plane = cloud_.dimension() == 2;
        const SymmetryType type =
            improper ? plane ? SymmetryType::glide_reflection : SymmetryType::rotation_reflection
            : plane  ? SymmetryType::rotation
                     : SymmetryType::screw;
        return of_map(type, map, std::max(a.tolerance, b.tolerance));
    }

    /// Products of the symmetries of the whole set, until there are no more: they form a group.
    void close_products() {
        std::size_t done = 0, multiplied = 0;
        std::vector<std::size_t> whole;
        for (int round = 0; round < 4 && !monitor_.should_stop(); ++round) {
            const std::vector<Support>& all = collection_.supports();
            const std::size_t before = all.size();
            std::vector<char> in_group(before - done);
            parallel_for(in_group.size(),
                         [&](std::size_t k) { in_group[k] = of_group(all[done + k]) ? 1 : 0; });
            for (std::size_t k = 0; k < in_group.size(); ++k)
                if (in_group[k] != 0) whole.push_back(done + k);
            done = before;
            if (whole.size() > kMostElements) break;
            offer(unknown_products(whole, multiplied));
            multiplied = whole.size();
            if (all.size() == before) break;
        }
    }

    /// Products of two of `whole`, one of them not among the first `multiplied`: each once, and none that
    /// could be no part of a finite group, nor of one of the set.
    std::vector<Hypothesis> unknown_products(const std::vector<std::size_t>& whole,
                                             std::size_t multiplied) const {
        const std::vector<Support>& all = collection_.supports();
        std::vector<Hypothesis> products;
        const auto is_new = [&](const Hypothesis& h) {
            return !collection_.knows(h.map, cloud_.radius()) &&
                   std::none_of(products.begin(), products.end(), [&](const Hypothesis& other) {
                       return (h.map.linear - other.map.linear).norm() * cloud_.radius() +
                                  (h.map.shift - other.map.shift).norm() <=
                              2 * std::max(h.off, cloud_.scene().resolution);
                   });
        };
        for (std::size_t a = 0; a < whole.size(); ++a)
            for (std::size_t b = 0; b < whole.size(); ++b) {
                if (std::max(a, b) < multiplied) continue;
                Hypothesis h = product(all[whole[a]], all[whole[b]]);
                if (leaves_a_point(h) && is_new(h)) products.push_back(std::move(h));
                // Of no one group: the centres differ, as of a grid and its parts.
                if (products.size() > kMostElements) return {};
            }
        std::vector<char> many(products.size());
        parallel_for(products.size(), [&](std::size_t k) {
            const double reach = 4 * std::max(products[k].off, cloud_.scene().resolution);
            many[k] = gatherer_.share_carried(products[k].map, reach) >= kMany ? 1 : 0;
        });
        std::size_t kept = 0;
        for (std::size_t k = 0; k < products.size(); ++k)
            if (many[k] != 0) products[kept++] = products[k];
        products.resize(kept);
        return products;
    }

    /// Some point stays where it is: neither a translation nor a screw nor a glide.
    bool leaves_a_point(const Hypothesis& h) const {
        constexpr double kTurns = 1e-3;
        const bool improper = h.map.linear.determinant() < 0;
        const Motion motion = motion_of(h.map, improper);
        const bool steps = motion.step > 4 * std::max(h.off, cloud_.scene().resolution);
        if (improper) return motion.angle > kTurns || !steps;
        return motion.angle > kTurns && !steps;
    }

    /// Once the time is up only the best are laid out.
    double worst_after_deadline() const {
        constexpr std::size_t kBest = 500;
        std::vector<double> all;
        all.reserve(collection_.supports().size());
        for (const Support& s : collection_.supports()) all.push_back(s.significance);
        if (all.size() <= kBest) return std::numeric_limits<double>::infinity();
        const auto last = all.begin() + kBest;
        std::nth_element(all.begin(), last, all.end());
        return *last;
    }

    std::vector<Symmetry> symmetries(TypeSet types) {
        const std::vector<Support>& supports = collection_.supports();
        std::vector<Symmetry> out(supports.size());
        std::vector<char> keep(supports.size(), 0);
        const double worst = worst_after_deadline();
        monitor_.begin_stage("patterns", supports.size());
        parallel_for(supports.size(), [&](std::size_t k) {
            monitor_.advance();
            if (!types.contains(supports[k].type)) return;
            if (supports[k].significance > worst && monitor_.should_stop()) return;
            Pattern p = trace(cloud_, significance_, supports[k]);
            if (p.runs.empty()) return;
            if (p.significance > kListed && !gatherer_.whole(supports[k])) return;
            keep[k] = 1;
            Symmetry& s = out[k];
            s.type = p.support.type;
            s.cycles = std::move(p.runs);
            s.significance = p.significance;
            s.tolerance.min = spread(cloud_.scene(), s.cycles, deviation(p.support));
            s.tolerance.max = std::max(turns_ambiguous(p), s.tolerance.min);
            for (const Vector3d& place : p.missing) s.missing.push_back(to_point(place + cloud_.middle()));
        });
        std::vector<Symmetry> kept;
        for (std::size_t k = 0; k < out.size(); ++k)
            if (keep[k] != 0) kept.push_back(std::move(out[k]));
        return kept;
    }

    /// Of the link that is met worst.
    double deviation(const Support& s) const {
        double worst = 0;
        for (const auto& [from, to] : s.links)
            worst = std::max(worst, (s.map(cloud_[from]) - cloud_[to]).squaredNorm());
        return std::sqrt(worst);
    }

    /// How near the image of a point comes to a point that it does not belong to.
    double turns_ambiguous(const Pattern& p) const {
        double best = std::numeric_limits<double>::infinity();
        // No more than from one image to the neighbour of its point, so that no link looks at all points.
        if (!p.support.links.empty()) {
            const auto [from, to] = p.support.links.front();
            std::array<double, 1> neighbour{best};
            cloud_.nearest_distances(to, neighbour);
            best = (p.support.map(cloud_[from]) - cloud_[to]).norm() + neighbour[0] * (1 + 1e-9);
        }
        for (const auto& link : p.support.links) {
            const int to = link.second;
            const Vector3d image = p.support.map(cloud_[link.first]);
            const double reach = std::min(best, 2 * cloud_.radius());
            cloud_.grid().visit_ball(to_point(image), reach, [&](int j, double square) {
                if (j != to && cloud_.label(j) == cloud_.label(to)) best = std::min(best, std::sqrt(square));
                return true;
            });
        }
        return best;
    }

    const Cloud& cloud_;
    const Significance& significance_;
    RunMonitor& monitor_;
    Gatherer gatherer_;
    Collection collection_;
    std::size_t tried_ = 0;
};

}  // namespace

RobustResult detect_robust(const Cloud& cloud, const Significance& significance, TypeSet types,
                           RunMonitor& monitor) {
    return Search(cloud, significance, monitor).run(types);
}

}  // namespace insym
