#include "support/pattern.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace insym {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kMostSteps = 12;  // from one run to the next
constexpr int kMostOrder = 200;

class Tracer {
public:
    Tracer(const Cloud& cloud, const Significance& significance, const Support& support)
        : cloud_(cloud), significance_(significance) {
        pattern_.support = support;
        next_.assign(static_cast<std::size_t>(cloud.size()), -1);
        previous_ = next_;
        for (const auto& [from, to] : support.links) {
            next_[static_cast<std::size_t>(from)] = to;
            previous_[static_cast<std::size_t>(to)] = from;
        }
    }

    Pattern run() {
        find_period();
        lay_out();
        if (is_pair_type(pattern_.support.type)) {
            // nothing lies between the two
        } else if (pattern_.period > 0) {
            walk_rings();
        } else {
            bridge_rows();
        }
        judge();
        return std::move(pattern_);
    }

private:
    int& next(int i) { return next_[static_cast<std::size_t>(i)]; }
    int& previous(int i) { return previous_[static_cast<std::size_t>(i)]; }

    /// Rotations and rotation-reflections of whole order; the map is made exactly so.
    void find_period() {
        const SymmetryType type = pattern_.support.type;
        exact_ = pattern_.support.map;
        if (is_pair_type(type)) pattern_.period = 2;
        if (type != SymmetryType::rotation && type != SymmetryType::rotation_reflection) return;
        const bool improper = type == SymmetryType::rotation_reflection;
        const Motion motion = motion_of(exact_, improper);
        WholeOrder whole = whole_order(motion.angle, angle_slack(cloud_, pattern_.support, motion));
        if (whole.order < 2) whole = order_of_closed_orbits(motion.angle);
        if (whole.order < 2) return;
        pattern_.period = improper && whole.order % 2 != 0 ? 2 * whole.order : whole.order;
        const double turn = 2 * std::numbers::pi * whole.turns / whole.order;
        if (cloud_.dimension() == 2 && improper) return;
        // A point that the map leaves in place, on the axis and nearest to the middle.
        const Matrix3d a = Matrix3d::Identity() - exact_.linear;
        const Vector3d fixed = a.completeOrthogonalDecomposition().solve(exact_.shift);
        Matrix3d linear = Eigen::AngleAxisd(turn, motion.axis).toRotationMatrix();
        if (improper) linear = linear * (Matrix3d::Identity() - 2 * motion.axis * motion.axis.transpose());
        exact_.linear = linear;
        exact_.shift = fixed - linear * fixed;
    }

    /// An orbit of q points that closes says the order, where noise leaves the angle itself unsure.
    WholeOrder order_of_closed_orbits(double angle) {
        int longest = 0;
        std::vector<char> seen(next_.size(), 0);
        for (int start = 0; start < cloud_.size(); ++start) {
            int length = 0, i = start;
            while (i >= 0 && seen[static_cast<std::size_t>(i)] == 0) {
                seen[static_cast<std::size_t>(i)] = 1;
                i = next(i);
                ++length;
            }
            if (i == start && length > longest && length <= kMostOrder) longest = length;
        }
        const auto turns = static_cast<int>(std::lround(angle * longest / (2 * std::numbers::pi)));
        if (longest < 2 || turns < 1) return {};
        const int common = std::gcd(longest, turns);
        return {longest / common, turns / common};
    }

    /// Chains from their ends, then what is closed. A closed run of another length than the period is none.
    void lay_out() {
        const int n = cloud_.size();
        std::vector<char> seen(static_cast<std::size_t>(n), 0);
        const bool pairs = is_pair_type(pattern_.support.type);
        const auto add = [&](int start, bool closed) {
            Orbit run;
            run.closed = closed;
            for (int i = start; i >= 0 && seen[static_cast<std::size_t>(i)] == 0; i = next(i)) {
                seen[static_cast<std::size_t>(i)] = 1;
                run.points.push_back(i);
            }
            const auto length = static_cast<int>(run.points.size());
            const bool fits = closed ? length == pattern_.period
                                     : !pairs && (pattern_.period == 0 || length <= pattern_.period);
            if (fits) pattern_.runs.push_back(std::move(run));
        };
        for (int i = 0; i < n; ++i)
            if (previous(i) < 0 && next(i) >= 0) add(i, false);
        for (int i = 0; i < n; ++i)
            if (next(i) >= 0 && seen[static_cast<std::size_t>(i)] == 0) add(i, true);
        for (const Orbit& run : pattern_.runs)
            pattern_.evidence.hits += static_cast<int>(run.points.size()) - 1;
        run_of_.assign(static_cast<std::size_t>(n), -1);
        for (std::size_t r = 0; r < pattern_.runs.size(); ++r)
            for (const int i : pattern_.runs[r].points)
                run_of_[static_cast<std::size_t>(i)] = static_cast<int>(r);
    }

    int point_at(const Vector3d& place, int label) const {
        double ignored = 0;
        return cloud_.nearest(place, label, 1.5 * pattern_.support.tolerance, ignored);
    }

    /// Every ring slot by slot, from the run that is longest.
    void walk_rings() {
        std::vector<char> done(pattern_.runs.size(), 0);
        std::vector<std::size_t> order(pattern_.runs.size());
        for (std::size_t r = 0; r < order.size(); ++r) order[r] = r;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return pattern_.runs[a].points.size() > pattern_.runs[b].points.size();
        });
        for (const std::size_t r : order) {
            const Orbit& run = pattern_.runs[r];
            if (done[r] != 0 || run.closed) continue;
            const int label = cloud_.label(run.points.front());
            const auto length = static_cast<int>(run.points.size());
            std::vector<Vector3d> empty;
            int others = 0;
            Vector3d place = mean_start(run);
            for (int k = 1; k < length; ++k) place = exact_(place);
            for (int k = length; k < pattern_.period; ++k) {
                place = exact_(place);
                const int there = point_at(place, label);
                if (there < 0) {
                    empty.push_back(place);
                    continue;
                }
                ++others;
                const int other = run_of_[static_cast<std::size_t>(there)];
                if (other < 0) continue;
                // Its own links are counted already.
                if (done[static_cast<std::size_t>(other)] != 0 || other == static_cast<int>(r)) {
                    --others;
                } else {
                    others -=
                        static_cast<int>(pattern_.runs[static_cast<std::size_t>(other)].points.size()) - 1;
                    done[static_cast<std::size_t>(other)] = 1;
                }
            }
            done[r] = 1;
            pattern_.evidence.looks += pattern_.period - length;
            pattern_.evidence.bridged += std::max(0, others);
            if (3 * (pattern_.period - static_cast<int>(empty.size())) >= pattern_.period)
                pattern_.missing.insert(pattern_.missing.end(), empty.begin(), empty.end());
        }
    }

    /// The first place of a run as all its points say it.
    Vector3d mean_start(const Orbit& run) const {
        Vector3d sum = Vector3d::Zero();
        RigidMap power;
        for (const int i : run.points) {
            sum += power.linear.transpose() * (cloud_[i] - power.shift);
            power = compose(exact_, power);
        }
        return sum / static_cast<double>(run.points.size());
    }

    /// From each end of a row to the next point on its orbit, if one is near enough to be no chance.
    void bridge_rows() {
        const double p = significance_.background().chance(1.5 * pattern_.support.tolerance);
        const int steps = std::min(kMostSteps, static_cast<int>(0.2 / std::max(p, 1e-9)));
        std::vector<char> reached(static_cast<std::size_t>(cloud_.size()), 0);
        const RigidMap back = inverse(exact_);
        const std::size_t runs = pattern_.runs.size();
        for (std::size_t r = 0; r < runs; ++r) {
            const Orbit& run = pattern_.runs[r];
            if (run.closed) continue;
            extend(run.points.back(), exact_, steps, true, reached);
            extend(run.points.front(), back, steps, false, reached);
        }
    }

    /// From the end of a run on, over empty places and single points, to the next run.
    void extend(int end, const RigidMap& map, int steps, bool forward, std::vector<char>& reached) {
        std::vector<Vector3d> empty;
        Vector3d place = map(cloud_[end]);
        for (int k = 1; k <= steps; ++k, place = map(place)) {
            const int there = point_at(place, cloud_.label(end));
            if (k > 1) ++pattern_.evidence.looks;
            if (there < 0) {
                empty.push_back(place);
                continue;
            }
            if (k == 1 || there == end) return;
            const int run = run_of_[static_cast<std::size_t>(there)];
            // Backwards only to single points: the run before looks forward to this one.
            const bool start =
                run < 0 || (forward && pattern_.runs[static_cast<std::size_t>(run)].points.front() == there);
            if (!start || reached[static_cast<std::size_t>(there)] != 0) return;
            reached[static_cast<std::size_t>(there)] = 1;
            ++pattern_.evidence.bridged;
            pattern_.missing.insert(pattern_.missing.end(), empty.begin(), empty.end());
            if (run >= 0) return;
            empty.clear();
            place = cloud_[there];
            k = 0;
        }
    }

    void judge() {
        const Support& s = pattern_.support;
        const Evidence direct{pattern_.evidence.hits, 0, 0};
        pattern_.significance = significance_.log10_false_alarms(s.type, direct, s.tolerance);
        const double joined = significance_.log10_false_alarms(s.type, pattern_.evidence, 1.5 * s.tolerance);
        pattern_.significance = std::min(pattern_.significance, joined);
    }

    const Cloud& cloud_;
    const Significance& significance_;
    Pattern pattern_;
    RigidMap exact_;
    std::vector<int> next_, previous_, run_of_;
};

}  // namespace

double angle_slack(const Cloud& cloud, const Support& s, const Motion& motion) {
    double sum = 0;
    Vector3d middle = Vector3d::Zero();
    for (const auto& [from, to] : s.links) middle += cloud[from] / static_cast<double>(s.links.size());
    // Distance from the axis: for a turn by an angle, the chord says it.
    const double sine = 2 * std::sin(motion.angle / 2);
    for (const auto& [from, to] : s.links) {
        Vector3d chord = s.map(cloud[from]) - cloud[from];
        chord -= motion.axis * motion.axis.dot(chord);
        sum += chord.squaredNorm() / (sine * sine);
    }
    return sum > 0 ? 1.5 * s.tolerance / std::sqrt(sum) : 1.0;
}

WholeOrder whole_order(double angle, double slack) {
    const double turns = angle / (2 * std::numbers::pi);
    for (int q = 2; q <= kMostOrder; ++q) {
        const double whole = std::round(q * turns);
        if (whole >= 1 && std::abs(turns - whole / q) * 2 * std::numbers::pi <= slack &&
            // A slack that lets any order through says nothing.
            slack < 0.3 * 2 * std::numbers::pi / (static_cast<double>(q) * q))
            return {q, static_cast<int>(whole)};
    }
    return {};
}

Pattern trace(const Cloud& cloud, const Significance& significance, const Support& support) {
    return Tracer(cloud, significance, support).run();
}

}  // namespace insym
