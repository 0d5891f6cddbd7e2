#include "support/representatives.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace insym {
namespace {

constexpr double kExact = 3;       // resolutions
constexpr double kSure = -10;      // significance
constexpr std::size_t kLeast = 2;  // of an orbit stay

/// Points that the exact supports carry into one another.
std::vector<SearchGroup> exact_orbits(const Cloud& cloud, const std::vector<Support>& supports) {
    const int n = cloud.size();
    std::vector<int> above(static_cast<std::size_t>(n));
    std::iota(above.begin(), above.end(), 0);
    const auto top = [&](int i) {
        int& up = above[static_cast<std::size_t>(i)];
        while (up != above[static_cast<std::size_t>(up)]) up = above[static_cast<std::size_t>(up)];
        return up;
    };
    for (const Support& s : supports) {
        if (s.significance > kSure || s.tolerance > kExact * cloud.scene().resolution) continue;
        for (const auto& [from, to] : s.links)
            above[static_cast<std::size_t>(std::max(top(from), top(to)))] = std::min(top(from), top(to));
    }
    std::map<int, SearchGroup> by_top;
    for (int i = 0; i < n; ++i) by_top[top(i)].push_back(i);
    std::vector<SearchGroup> out;
    out.reserve(by_top.size());
    for (auto& [_, members] : by_top) out.push_back(std::move(members));
    return out;
}

/// By their distance from its middle; of equally far ones, to rounding, the first in the input first.
void sort_orbit(const Cloud& cloud, Stay first, SearchGroup& orbit) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int i : orbit) middle += cloud[i] / static_cast<double>(orbit.size());
    const double step = 2 * kExact * cloud.scene().resolution;
    const auto steps = [&](int i) { return std::round((cloud[i] - middle).norm() / step); };
    const double sign = first == Stay::outer ? -1 : 1;
    std::stable_sort(orbit.begin(), orbit.end(),
                     [&](int a, int b) { return sign * steps(a) < sign * steps(b); });
}

}  // namespace

SearchGroup representatives(const Cloud& cloud, const std::vector<Support>& supports, std::size_t share,
                            Stay stay) {
    SearchGroup out;
    for (SearchGroup& orbit : exact_orbits(cloud, supports)) {
        const std::size_t count = std::max(kLeast, orbit.size() / share);
        if (count < orbit.size()) {
            sort_orbit(cloud, stay, orbit);
            orbit.resize(count);
        }
        out.insert(out.end(), orbit.begin(), orbit.end());
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace insym
