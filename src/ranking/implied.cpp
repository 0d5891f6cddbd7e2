#include "ranking/implied.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "isometry/fit.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

constexpr int kMostPowers = 24;

/// A set of points, a bit for each.
class PointBits {
public:
    explicit PointBits(int n = 0) : words_((static_cast<std::size_t>(n) + 63) / 64) {}

    void add(int p) { words_[static_cast<std::size_t>(p) / 64] |= bit(p); }
    bool has(int p) const { return (words_[static_cast<std::size_t>(p) / 64] & bit(p)) != 0; }

    /// Holds all of `others` but so many.
    bool holds_but(const PointBits& others, std::size_t most) const {
        for (std::size_t w = 0; w < words_.size(); ++w)
            for (std::uint64_t left = others.words_[w] & ~words_[w]; left != 0; left &= left - 1)
                if (most-- == 0) return false;
        return true;
    }

private:
    static std::uint64_t bit(int p) { return std::uint64_t{1} << (static_cast<unsigned>(p) & 63U); }

    std::vector<std::uint64_t> words_;
};

/// A symmetry with what is asked of it again and again, about the middle of the set.
struct Item {
    RigidMap map;
    PointBits carried;        // points on its orbits, or left in place
    PointBits own;            // on its orbits, unless they are few of many
    std::vector<int> points;  // on its orbits
    double slack = 0;         // how well a link says the map
    double reach = 0;         // of its points from the middle
};

class Implications {
public:
    Implications(const Cloud& cloud, const std::vector<Symmetry>& symmetries)
        : cloud_(cloud), symmetries_(symmetries), items_(symmetries.size()) {
        parallel_for(symmetries.size(), [&](std::size_t k) { items_[k] = item(symmetries[k]); });
    }

    /// The same motion on the points of `a`, to what both are known.
    bool equal(const Item& a, const RigidMap& other, double slack) const {
        const double limit = slack * slack;
        // A few points settle most cases.
        const std::size_t step = std::max<std::size_t>(1, a.points.size() / 4);
        for (std::size_t k = 0; k < a.points.size(); k += step)
            if (off(a, other, a.points[k]) > limit) return false;
        return std::all_of(a.points.begin(), a.points.end(),
                           [&](int p) { return off(a, other, p) <= limit; });
    }

    /// The share of a's points that b carries or leaves in place is (nearly) all.
    bool carries(const Item& b, const Item& a) const {
        std::size_t left = a.points.size() / 10;  // that it may leave out
        if (!few(a)) return b.carried.holds_but(a.own, left);
        return std::all_of(a.points.begin(), a.points.end(),
                           [&](int p) { return b.carried.has(p) || left-- > 0; });
    }

    const Item& operator[](std::size_t k) const { return items_[k]; }
    const Vector3d& place(int point) const { return cloud_[point]; }

    /// Powers of symmetry k, both ways, the first the map itself.
    std::vector<RigidMap> powers(std::size_t k, int most) const {
        std::vector<RigidMap> out;
        const RigidMap& f = items_[k].map;
        const RigidMap back = inverse(f);
        RigidMap forward = f, backward = back;
        const int count = is_pair_type(symmetries_[k].type) ? 1 : most;
        for (int i = 0; i < count; ++i) {
            out.push_back(forward);
            if (count > 1) out.push_back(backward);
            forward = compose(f, forward);
            backward = compose(back, backward);
        }
        return out;
    }

private:
    bool few(const Item& a) const { return a.points.size() < static_cast<std::size_t>(cloud_.size()) / 64; }

    double off(const Item& a, const RigidMap& other, int p) const {
        return (a.map(cloud_[p]) - other(cloud_[p])).squaredNorm();
    }

    Item item(const Symmetry& s) const {
        Item out;
        out.map = map_about(s.isometry, cloud_.middle());
        for (const Orbit& o : s.cycles) out.points.insert(out.points.end(), o.points.begin(), o.points.end());
        out.carried = PointBits(cloud_.size());
        for (const int p : out.points) out.carried.add(p);
        if (!few(out)) out.own = out.carried;
        for (const int p : s.fixed_points) out.carried.add(p);
        out.slack = std::max(s.deviation.max, cloud_.scene().resolution);
        if (!is_pair_type(s.type) && s.significance < 0) carry_beyond_gaps(s, out);
        return out;
    }

    /// Points that lie on an orbit with gaps between them and its runs are carried as well.
    void carry_beyond_gaps(const Symmetry& s, Item& out) const {
        constexpr int kSteps = 12;
        const RigidMap back = inverse(out.map);
        for (const Orbit& o : s.cycles) {
            if (o.closed) continue;
            for (const bool forward : {true, false}) {
                Vector3d place = cloud_[forward ? o.points.back() : o.points.front()];
                for (int k = 0; k < kSteps; ++k) {
                    place = forward ? out.map(place) : back(place);
                    // A row that has left the set never comes back.
                    if (s.type == SymmetryType::translation && place.norm() > cloud_.radius() + 2 * out.slack)
                        break;
                    cloud_.grid().visit_ball(to_point(place), 2 * out.slack, [&](int p, double) {
                        out.carried.add(p);
                        return true;
                    });
                }
            }
        }
    }

    const Cloud& cloud_;
    const std::vector<Symmetry>& symmetries_;
    std::vector<Item> items_;
};

/// How much may lie between a map and a word of others: each is known to about its deviation.
double slack_of(const Item& a, const Item& b, const Item& c) {
    return 2 * (a.slack + b.slack + c.slack);
}

/// The same for a power of a generator: the errors of its steps add up. `index` counts forward and back in
/// turn.
double slack_of_power(const Item& a, const Item& generator, std::size_t index) {
    const std::size_t steps = index / 2;
    return 2 * a.slack + (2 + 0.5 * static_cast<double>(steps)) * generator.slack;
}

}  // namespace

void promote_generators(const Cloud& cloud, std::vector<Symmetry>& symmetries, RunMonitor& monitor) {
    if (monitor.should_stop()) return;
    const Implications all(cloud, symmetries);
    constexpr double kShare = 0.4;  // of a power's significance that its generator must have by itself
    // The largest turns and steps first, so that the smallest has the last word.
    std::vector<std::size_t> order, pairs;
    for (std::size_t k = 0; k < symmetries.size(); ++k)
        if (symmetries[k].significance < 0) (is_pair_type(symmetries[k].type) ? pairs : order).push_back(k);
    std::vector<std::pair<double, double>> motion;
    std::vector<double> significance;
    for (const Symmetry& s : symmetries) {
        motion.emplace_back(std::round(s.isometry.angle_deg * 1e3), s.isometry.step);
        significance.push_back(s.significance);
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return motion[a] > motion[b]; });
    // What could be a power of each: what turns or steps as far; a half-turn, a mirror or an inversion, which
    // will not become more significant.
    std::vector<std::vector<std::size_t>> carried(order.size());
    const auto kept_by_a_power = [&](std::size_t g, std::size_t k) {
        // A power may become more significant yet, which makes it harder.
        return significance[g] <= kShare * significance[k];
    };
    parallel_for(order.size(), [&](std::size_t i) {
        const std::size_t g = order[i];
        const auto carry = [&](std::size_t k) {
            if (kept_by_a_power(g, k) && all.carries(all[g], all[k])) carried[i].push_back(k);
        };
        for (std::size_t j = 0; j < order.size() && motion[order[j]] >= motion[g]; ++j)
            if (j != i && !monitor.should_stop()) carry(order[j]);
        for (const std::size_t k : pairs)
            if (significance[k] <= significance[g] && !monitor.should_stop()) carry(k);
    });
    for (std::size_t i = 0; i < order.size() && !monitor.should_stop(); ++i) {
        const std::size_t g = order[i];
        const double own = significance[g];
        // A power of a chance is no intent.
        std::vector<std::size_t>& better = carried[i];
        std::erase_if(better, [&](std::size_t k) { return significance[k] > own || !kept_by_a_power(g, k); });
        if (better.empty()) continue;
        std::sort(better.begin(), better.end(),
                  [&](std::size_t a, std::size_t b) { return significance[a] < significance[b]; });
        std::vector<RigidMap> powers = all.powers(g, kMostPowers);
        powers.erase(powers.begin(), powers.begin() + 2);
        const auto is_power = [&](std::size_t k) {
            for (std::size_t j = 0; j < powers.size(); ++j)
                if (all.equal(all[k], powers[j], slack_of_power(all[k], all[g], j))) return true;
            return false;
        };
        const auto best = std::find_if(better.begin(), better.end(), is_power);
        if (best != better.end()) significance[g] = significance[*best] * (1 + 1e-9);
    }
    for (std::size_t k = 0; k < symmetries.size(); ++k) symmetries[k].significance = significance[k];
}

namespace {

/// The better-ranked symmetries that others are words of.
class Generators {
public:
    explicit Generators(const Implications& all) : all_(all) {}

    bool full() const { return ids_.size() >= kMost; }
    void add(std::size_t k) {
        ids_.push_back(k);
        powers_.push_back(all_.powers(k, kMostPowers));
        inverses_.emplace_back();
        for (const RigidMap& power : powers_.back()) inverses_.back().push_back(inverse(power));
    }

    /// Those that symmetry k is a power of, or a product of powers of; nothing where there are none.
    std::vector<std::size_t> of(std::size_t k) const {
        const Item& a = all_[k];
        std::vector<std::size_t> able;  // those that carry these points
        for (std::size_t g = 0; g < ids_.size(); ++g)
            if (all_.carries(all_[ids_[g]], a)) able.push_back(g);
        for (const std::size_t g : able)
            for (std::size_t j = 0; j < powers_[g].size(); ++j)
                if (all_.equal(a, powers_[g][j], slack_of_power(a, all_[ids_[g]], j))) return {ids_[g]};
        return product_of_two(a, able);
    }

private:
    static constexpr std::size_t kMost = 24;
    static constexpr std::size_t kMostWords = 24;  // powers, forward and back

    /// A word of one generator, by where it takes a point.
    struct Word {
        double along;  // an axis, in whose order they are kept
        Vector3d place;
        std::size_t generator, word;
    };

    /// One point settles nearly all products: the second power takes it to where the first must fetch it
    /// from.
    std::vector<std::size_t> product_of_two(const Item& a, const std::vector<std::size_t>& able) const {
        const Vector3d &witness = all_.place(a.points.front()), image = a.map(witness);
        std::vector<Word> taken;
        double widest = 0;
        for (std::size_t g = 0; g < able.size(); ++g) {
            for (std::size_t j = 0; j < words(able[g]); ++j) {
                const Vector3d place = powers_[able[g]][j](witness);
                taken.push_back({kAskew.dot(place), place, g, j});
            }
            widest = std::max(widest, all_[ids_[able[g]]].slack);
        }
        widest = 2 * (a.slack + 2 * widest);
        std::sort(taken.begin(), taken.end(), [](const Word& x, const Word& y) { return x.along < y.along; });
        std::vector<std::array<std::size_t, 4>> products;  // two generators, and their words
        for (std::size_t g = 0; g < able.size(); ++g)
            for (std::size_t i = 0; i < words(able[g]); ++i) {
                const Vector3d fetched = inverses_[able[g]][i](image);
                const double from = kAskew.dot(fetched) - 1.01 * widest;
                auto second = std::lower_bound(taken.begin(), taken.end(), from,
                                               [](const Word& w, double along) { return w.along < along; });
                for (; second != taken.end() && second->along <= from + 2.02 * widest; ++second) {
                    const double slack =
                        slack_of(a, all_[ids_[able[g]]], all_[ids_[able[second->generator]]]);
                    if (second->generator != g && (fetched - second->place).squaredNorm() <= slack * slack)
                        products.push_back({g, second->generator, i, second->word});
                }
            }
        std::sort(products.begin(), products.end());
        for (const auto& [g, h, i, j] : products) {
            const std::size_t first = ids_[able[g]], second = ids_[able[h]];
            if (all_.equal(a, compose(powers_[able[g]][i], powers_[able[h]][j]),
                           slack_of(a, all_[first], all_[second])))
                return {first, second};
        }
        return {};
    }

    std::size_t words(std::size_t generator) const { return std::min(powers_[generator].size(), kMostWords); }

    const Implications& all_;
    std::vector<std::size_t> ids_;
    std::vector<std::vector<RigidMap>> powers_, inverses_;
};

}  // namespace

void mark_implied(const Cloud& cloud, std::vector<Symmetry>& symmetries, RunMonitor& monitor) {
    if (monitor.should_stop()) return;
    const Implications all(cloud, symmetries);
    Generators generators(all);
    const auto mark = [&](std::size_t k) {
        std::vector<int>& ids = symmetries[k].implied_by;
        for (const std::size_t g : generators.of(k)) ids.push_back(symmetries[g].id);
        std::sort(ids.begin(), ids.end());
    };
    std::size_t k = 0;
    for (; k < symmetries.size() && !generators.full() && !monitor.should_stop(); ++k) {
        mark(k);
        if (symmetries[k].implied_by.empty()) generators.add(k);
    }
    // What comes after the last generator does not depend on one another.
    parallel_for(symmetries.size() - k, [&](std::size_t i) {
        if (!monitor.should_stop()) mark(k + i);
    });
}

}  // namespace insym
