#include "support/detect_robust.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hypotheses/generators.hpp"
#include "parallel_for.hpp"
#include "points/diameter.hpp"
#include "support/collection.hpp"
#include "support/pattern.hpp"
#include "support/spread.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

/// A symmetry is kept while searching, and listed, below these; above 0 chance does as well.
constexpr double kKept = 3;
constexpr double kListed = 1;

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
    Search(const PointScene& scene, const Significance& significance, RunMonitor& monitor)
        : scene_(scene),
          significance_(significance),
          monitor_(monitor),
          cloud_(scene),
          gatherer_(cloud_, significance, largest_reach(scene, significance)) {}

    RobustResult run(TypeSet types) {
        const double reach = gatherer_.reach();
        const std::size_t n = scene_.points.size();
        // So many looks at a point for each source of hypotheses.
        const auto budget = [&](double looks) {
            return static_cast<std::size_t>(100 + looks / static_cast<double>(n));
        };
        offer(frames(cloud_, Vector3d::Zero(), reach, budget(1e5)));
        offer_votes(reach, budget(2e4), budget(6e4));
        offer_groups(reach, budget(3e5), budget(1e5));
        offer_roots();
        close_products();
        RobustResult result;
        result.hypotheses = tried_;
        result.max_tolerance = reach;
        result.symmetries = symmetries(types);
        return result;
    }

private:
    void offer_votes(double reach, std::size_t most_cells, std::size_t most) {
        constexpr std::size_t kPairs = 300000;
        std::vector<SymmetryType> types{
            SymmetryType::translation, SymmetryType::mirror,
            cloud_.dimension() == 2 ? SymmetryType::half_turn : SymmetryType::inversion};
        std::vector<std::vector<Hypothesis>> votes(types.size());
        monitor_.begin_stage("votes of pairs", types.size());
        parallel_for(types.size(),
                     [&](std::size_t k) { votes[k] = vote(cloud_, types[k], reach, kPairs, most_cells); });
        for (const std::vector<Hypothesis>& v : votes) {
            offer(v, most);
            monitor_.advance();
        }
    }

    /// A few groups at a time: the search for candidates needs no knowledge of what was found.
    void offer_groups(double reach, std::size_t most_chains, std::size_t most_half_turns) {
        constexpr std::size_t kGroup = 400, kAtATime = 16;
        // So many candidates are kept for each that is tried: most of them say what was found already.
        constexpr std::size_t kSpare = 20;
        const std::vector<SearchGroup> groups = search_groups(cloud_, kGroup);
        monitor_.begin_stage("chains of points", groups.size());
        std::vector<std::vector<Candidate>> found(2 * kAtATime);
        for (std::size_t first = 0; first < groups.size() && !monitor_.should_stop(); first += kAtATime) {
            const std::size_t count = std::min(kAtATime, groups.size() - first);
            parallel_for(2 * count, [&](std::size_t k) {
                const SearchGroup& group = groups[first + k / 2];
                if (monitor_.should_stop())
                    found[k].clear();
                else if (k % 2 == 0)
                    found[k] = chains(cloud_, group, reach, kSpare * most_chains);
                else
                    found[k] = half_turns(cloud_, group, reach, kSpare * most_half_turns);
            });
            for (std::size_t k = 0; k < 2 * count; ++k) {
                // What is tried in all grows with the points looked at.
                const std::size_t most = k % 2 == 0 ? most_chains : most_half_turns;
                offer(found[k],
                      20 + most * groups[first + k / 2].size() / static_cast<std::size_t>(cloud_.size()));
                if (k % 2 == 1) monitor_.advance();
            }
        }
    }

    const Hypothesis& hypothesis(const Hypothesis& h) const { return h; }
    Hypothesis hypothesis(const Candidate& c) const { return hypothesis_of(cloud_, c); }

    /// Tries hypotheses in their order, in blocks, so that what one finds spares the next ones the work; the
    /// blocks do not depend on the threads.
    template <class Suggestion>
    void offer(const std::vector<Suggestion>& suggestions, std::size_t most = 1000000) {
        constexpr std::size_t kBlock = 64;
        const std::size_t stop = tried_ + most;
        std::vector<std::optional<Support>> found(kBlock);
        std::vector<Hypothesis> block;
        for (std::size_t k = 0; k < suggestions.size() && tried_ < stop && !monitor_.should_stop();) {
            block.clear();
            for (; k < suggestions.size() && block.size() < kBlock; ++k) {
                Hypothesis h = hypothesis(suggestions[k]);
                if (!collection_.explains(h)) block.push_back(std::move(h));
            }
            tried_ += block.size();
            parallel_for(block.size(), [&](std::size_t i) {
                found[i] = monitor_.should_stop() ? std::nullopt : gatherer_.gather(block[i], kKept);
            });
            for (std::size_t i = 0; i < block.size(); ++i)
                if (found[i]) collection_.add(std::move(*found[i]));
        }
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
        std::vector<Hypothesis> roots;
        for (const Support& s : collection_.supports())
            if (s.significance < -1) add_roots(s, roots);
        if (roots.size() > 20000) roots.resize(20000);
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

    /// How many points a support carries, from or to or in place.
    int covered(const Support& s) const {
        std::vector<char> in(static_cast<std::size_t>(cloud_.size()), 0);
        for (const auto& [from, to] : s.links)
            in[static_cast<std::size_t>(from)] = in[static_cast<std::size_t>(to)] = 1;
        for (int i = 0; i < cloud_.size(); ++i)
            if ((s.map(cloud_[i]) - cloud_[i]).norm() <= 1.5 * s.tolerance)
                in[static_cast<std::size_t>(i)] = 1;
        return static_cast<int>(std::count(in.begin(), in.end(), 1));
    }

    /// Products of the symmetries of nearly the whole set, until there are no more: they form a group.
    void close_products() {
        constexpr std::size_t kMostElements = 130;
        std::size_t done = 0;
        std::vector<std::size_t> whole;
        for (int round = 0; round < 4 && !monitor_.should_stop(); ++round) {
            const std::size_t before = collection_.supports().size();
            for (; done < collection_.supports().size(); ++done)
                if (5 * covered(collection_.supports()[done]) >= 4 * cloud_.size() &&
                    collection_.supports()[done].significance < kListed)
                    whole.push_back(done);
            if (whole.size() > kMostElements) break;
            std::vector<Hypothesis> products;
            for (const std::size_t a : whole)
                for (const std::size_t b : whole) {
                    const Support &first = collection_.supports()[a], &second = collection_.supports()[b];
                    const RigidMap &f = first.map, &g = second.map;
                    RigidMap product;
                    product.linear = f.linear * g.linear;
                    product.shift = f(g.shift);
                    if ((product.linear - Eigen::Matrix3d::Identity()).norm() < 1e-3) continue;
                    products.push_back(of_map(product.linear.determinant() < 0
                                                  ? SymmetryType::rotation_reflection
                                                  : SymmetryType::screw,
                                              product, std::max(first.tolerance, second.tolerance)));
                    if (cloud_.dimension() == 2)
                        products.back().type = product.linear.determinant() < 0
                                                   ? SymmetryType::glide_reflection
                                                   : SymmetryType::rotation;
                }
            if (products.size() > 20000) break;
            offer(products);
            if (collection_.supports().size() == before) break;
        }
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
            s.tolerance.min = spread(scene_, s.cycles, p.support.tolerance);
            s.tolerance.max = std::max(turns_ambiguous(p), s.tolerance.min);
            for (const Vector3d& place : p.missing) s.missing.push_back(to_point(place + cloud_.middle()));
        });
        std::vector<Symmetry> kept;
        for (std::size_t k = 0; k < out.size(); ++k)
            if (keep[k] != 0) kept.push_back(std::move(out[k]));
        return kept;
    }

    /// How near the image of a point comes to a point that it does not belong to.
    double turns_ambiguous(const Pattern& p) const {
        double best = std::numeric_limits<double>::infinity();
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

    const PointScene& scene_;
    const Significance& significance_;
    RunMonitor& monitor_;
    Cloud cloud_;
    Gatherer gatherer_;
    Collection collection_;
    std::size_t tried_ = 0;
};

}  // namespace

RobustResult detect_robust(const PointScene& scene, const Significance& significance, TypeSet types,
                           RunMonitor& monitor) {
    return Search(scene, significance, monitor).run(types);
}

}  // namespace insym
