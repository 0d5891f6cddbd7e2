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

double log_binomial_tail(double trials, double hits, double chance) {
    if (hits <= 0 || trials <= 0 || chance >= 1 || hits <= trials * chance) return 0;
    if (!(chance > 0)) return -1e9;
    const double share = std::min(1.0, hits / trials);
    const double rest = share < 1 ? (1 - share) * std::log((1 - share) / (1 - chance)) : 0;
    return -trials * (share * std::log(share / chance) + rest);
}

Significance::Significance(const PointScene& scene)
    : n_(scene.size()),
      dimension_(scene.dimension()),
      resolution_(scene.resolution),
      diameter_(scene.diameter),
      background_(scene) {}

double Significance::log10_false_alarms(SymmetryType type, const Evidence& evidence, double tolerance) const {
    constexpr double kKinds = 8;
    constexpr double kTolerances = 36;  // powers of the root of two between the resolution and the diameter
    const double reach = std::max(tolerance, resolution_);
    const double p = background_.chance(reach);

    // So many links are spent on fixing the isometry; each could be any ordered pair of points. Where they
    // fix more than there is to fix, they must agree on the rest.
    const int freedom = degrees_of_freedom(type, dimension_);
    const int spent = (freedom + dimension_ - 1) / dimension_;
    const double agree = std::min(1.0, 6 * reach / diameter_);
    const double n = n_;
    double log_tests = std::log(kKinds * kTolerances) + spent * std::log(std::max(1.0, n * (n - 1)));
    if (evidence.hits < spent) return log_tests / std::numbers::ln10;
    log_tests += (spent * dimension_ - freedom) * std::log(agree);

    const double trials = (is_pair_type(type) ? n / 2 : n) - spent;
    double log_tail = log_binomial_tail(trials, evidence.hits - spent, p);
    if (evidence.bridged > 0) log_tail += log_binomial_tail(evidence.looks, evidence.bridged, p);
    return (log_tests + log_tail) / std::numbers::ln10;
}

}  // namespace insym
