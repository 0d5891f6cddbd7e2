#include "ranking/significance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insym {

int degrees_of_freedom(SymmetryType type, int dimension) {
    const bool plane = dimension == 2;
    switch (type) {
        case SymmetryType::inversion:
            return 3;
        case SymmetryType::half_turn:
            return plane ? 2 : 4;
        case SymmetryType::mirror:
        case SymmetryType::translation:
            return plane ? 2 : 3;
        case SymmetryType::rotation:
        case SymmetryType::glide_reflection:
            return plane ? 3 : 5;
        case SymmetryType::rotation_reflection:
        case SymmetryType::screw:
            return 6;
    }
    return 6;
}

Significance::Significance(const PointSet& points, double resolution)
    : n_(static_cast<int>(points.size())),
      dimension_(points.dimension),
      resolution_(resolution),
      log_factorial_(points.size() + 1, 0.0) {
    for (std::size_t k = 1; k < log_factorial_.size(); ++k)
        log_factorial_[k] = log_factorial_[k - 1] + std::log(static_cast<double>(k));
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension_); ++axis) {
        double low = points.positions.front()[axis], high = low;
        for (const Point& p : points.positions) {
            low = std::min(low, p[axis]);
            high = std::max(high, p[axis]);
        }
        // A flat set still fills a slab as thick as the resolution.
        log_volume_ += std::log(std::max(high - low, 2 * resolution_));
    }
}

double Significance::log_choose(int n, int k) const {
    const auto f = [&](int i) { return log_factorial_[static_cast<std::size_t>(i)]; };
    return f(n) - f(k) - f(n - k);
}

double Significance::log10_false_alarms(SymmetryType type, int links, double reach) const {
    constexpr double kKinds = 8;
    constexpr double kTolerances = 16;  // decades and more between the resolution and the diameter
    const double r = std::max(reach, resolution_);
    const double log_ball = dimension_ == 3 ? std::log(4 * std::numbers::pi / 3) + 3 * std::log(r)
                                            : std::log(std::numbers::pi) + 2 * std::log(r);
    // The chance that a scattered set has a point within r of a given place.
    const double log_p = std::min(0.0, std::log(static_cast<double>(n_)) + log_ball - log_volume_);

    // So many links are spent on fixing the isometry; each could be any ordered pair of points.
    const int spent = (degrees_of_freedom(type, dimension_) + dimension_ - 1) / dimension_;
    const double n = n_;
    const double log_tests = std::log(kKinds * kTolerances) + spent * std::log(std::max(1.0, n * (n - 1)));

    const int trials = std::max(0, n_ - spent);
    const int hits = std::min(std::max(0, links - spent), trials);
    double log_tail = 0;
    if (hits > 0 && log_p < 0) {
        // The tail of the binomial distribution, largest term first where hits exceed the mean.
        const double log_q = std::log1p(-std::exp(log_p));
        double sum = 0, first = 0;
        for (int k = hits; k <= trials; ++k) {
            const double term = log_choose(trials, k) + k * log_p + (trials - k) * log_q;
            if (k == hits) first = term;
            sum += std::exp(term - first);
            if (term - first < -40 && k > n * std::exp(log_p)) break;
        }
        log_tail = std::min(0.0, first + std::log(sum));
    }
    return (log_tests + log_tail) / std::numbers::ln10;
}

}  // namespace insym
