#include "support/spread.hpp"

#include <algorithm>

#include "points/diameter.hpp"

namespace insym {
namespace {

/// The spread of the distances that sigma carries into one another, over all orbits of pairs of points of two
/// cycles (or one): walks from every pair that has no predecessor, then what is left wraps round.
class PairOrbits {
public:
    PairOrbits(const PointScene& scene, const Orbit& a, const Orbit& b, bool same)
        : scene_(scene), a_(a), b_(b), same_(same), seen_(a.points.size() * b.points.size(), 0) {}

    double largest() {
        const auto m = static_cast<int>(a_.points.size()), n = static_cast<int>(b_.points.size());
        double worst = 0;
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < n; ++j) {
                const bool first = (!a_.closed && i == 0) || (!b_.closed && j == 0);
                if (first) worst = std::max(worst, walk(i, j));
            }
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < n; ++j) worst = std::max(worst, walk(i, j));
        return worst;
    }

private:
    char& seen(int i, int j) {
        return seen_[static_cast<std::size_t>(i) * b_.points.size() + static_cast<std::size_t>(j)];
    }

    double walk(int i, int j) {
        double low = 0, high = 0;
        bool any = false;
        while (i >= 0 && j >= 0 && seen(i, j) == 0) {
            seen(i, j) = 1;
            if (!same_ || i != j) {
                const double d = distance(scene_.position(a_.points[static_cast<std::size_t>(i)]),
                                          scene_.position(b_.points[static_cast<std::size_t>(j)]));
                low = any ? std::min(low, d) : d;
                high = any ? std::max(high, d) : d;
                any = true;
            }
            i = after(a_, i);
            j = after(b_, j);
        }
        return high - low;
    }

    static int after(const Orbit& o, int i) {
        if (i + 1 < static_cast<int>(o.points.size())) return i + 1;
        return o.closed ? 0 : -1;
    }

    const PointScene& scene_;
    const Orbit& a_;
    const Orbit& b_;
    bool same_;
    std::vector<char> seen_;
};

}  // namespace

double spread(const PointScene& scene, const std::vector<Orbit>& orbits, double deviation) {
    std::size_t longest = 0, points = 0;
    for (const Orbit& o : orbits) {
        longest = std::max(longest, o.points.size());
        points += o.points.size();
    }
    // A distance changes by at most two deviations a step.
    if (2 * deviation * static_cast<double>(longest) <= scene.resolution) return scene.resolution;
    double worst = scene.resolution;
    for (std::size_t i = 0; i < orbits.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j)
            worst = std::max(worst, PairOrbits(scene, orbits[i], orbits[j], i == j).largest());
    return worst;
}

}  // namespace insym
