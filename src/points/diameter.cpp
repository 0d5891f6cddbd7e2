#include "points/diameter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace insym {

double distance(const Point& p, const Point& q) {
    const double dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
    return std::sqrt(dx * dx + dy * dy + dz * dz);
}

double diameter(const std::vector<Point>& positions) {
    if (positions.empty()) return 0;
    Point centroid{};
    for (const Point& p : positions)
        for (std::size_t k = 0; k < 3; ++k) centroid[k] += p[k] / static_cast<double>(positions.size());

    // Farthest from the centroid first: a pair whose two radii sum to less than the best distance
    // so far cannot beat it (triangle inequality), nor can any pair after it.
    std::vector<std::pair<double, const Point*>> by_radius;
    by_radius.reserve(positions.size());
    for (const Point& p : positions) by_radius.emplace_back(distance(p, centroid), &p);
    std::sort(by_radius.begin(), by_radius.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });

    double best = 0;
    for (std::size_t i = 0; i < by_radius.size() && 2 * by_radius[i].first >= best; ++i)
        for (std::size_t j = i + 1; j < by_radius.size(); ++j) {
            // A relative slack of 1e-12 keeps rounding of the radii from hiding the longest pair.
            if ((by_radius[i].first + by_radius[j].first) * (1 + 1e-12) < best) break;
            best = std::max(best, distance(*by_radius[i].second, *by_radius[j].second));
        }
    return best;
}

}  // namespace insym
