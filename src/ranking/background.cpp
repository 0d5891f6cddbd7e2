#include "ranking/background.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "isometry/fit.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

constexpr int kNeighbours = 12;
constexpr int kMostSamples = 400;

/// The layout around one point: so many neighbours in a box of these half edges.
struct Surroundings {
    int neighbours = 0;
    Eigen::Vector3d extent = Eigen::Vector3d::Zero();
};

/// Points spread over the set by their distance from its middle, so that neither their order nor the pose
/// matters.
std::vector<int> samples(const PointScene& scene) {
    const int n = scene.size();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int i = 0; i < n; ++i) middle += to_vector(scene.position(i)) / n;
    std::vector<double> radius;
    radius.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) radius.push_back((to_vector(scene.position(i)) - middle).squaredNorm());
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    if (n <= kMostSamples) return order;
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return radius[static_cast<std::size_t>(a)] < radius[static_cast<std::size_t>(b)];
    });
    std::vector<int> chosen;
    chosen.reserve(kMostSamples);
    for (int k = 0; k < kMostSamples; ++k)
        chosen.push_back(order[static_cast<std::size_t>((std::int64_t{k} * n + n / 2) / kMostSamples)]);
    return chosen;
}

Surroundings around(const PointScene& scene, int i) {
    const Eigen::Vector3d here = to_vector(scene.position(i));
    std::vector<std::pair<double, int>> nearest;  // a heap, the farthest first
    for (int j = 0; j < scene.size(); ++j) {
        if (j == i || scene.label(j) != scene.label(i)) continue;
        const double square = (to_vector(scene.position(j)) - here).squaredNorm();
        if (nearest.size() == kNeighbours) {
            if (square >= nearest.front().first) continue;
            std::pop_heap(nearest.begin(), nearest.end());
            nearest.pop_back();
        }
        nearest.emplace_back(square, j);
        std::push_heap(nearest.begin(), nearest.end());
    }
    if (nearest.empty()) return {};
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const auto& [square, j] : nearest) {
        const Eigen::Vector3d d = to_vector(scene.position(j)) - here;
        spread += d * d.transpose();
    }
    spread /= static_cast<double>(nearest.size());
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
    // A disc of radius 1 has a mean square of 1/4 along each axis.
    return {static_cast<int>(nearest.size()), 2 * values.cwiseMax(0).cwiseSqrt()};
}

}  // namespace

Background::Background(const PointScene& scene) : low_(scene.resolution / 4) {
    log_ratio_ = std::log(scene.diameter / low_) / kSteps;
    const std::vector<int> chosen = samples(scene);
    std::vector<Surroundings> all(chosen.size());
    parallel_for(chosen.size(), [&](std::size_t k) { all[k] = around(scene, chosen[k]); });
    for (int step = 0; step <= kSteps; ++step) {
        const double reach = low_ * std::exp(log_ratio_ * step);
        double sum = 0;
        for (const Surroundings& s : all) {
            double p = s.neighbours;
            for (int axis = 0; axis < 3; ++axis)
                if (s.extent[axis] > reach) p *= reach / s.extent[axis];
            sum += std::min(1.0, p);
        }
        chance_.push_back(sum / static_cast<double>(all.size()));
    }
}

double Background::chance(double reach) const {
    const double at = std::clamp(std::log(std::max(reach, low_) / low_) / log_ratio_, 0.0, kSteps - 1e-9);
    const auto k = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(k);
    if (!(chance_[k] > 0)) return chance_[k + 1];
    return chance_[k] * std::pow(chance_[k + 1] / chance_[k], share);
}

}  // namespace insym
