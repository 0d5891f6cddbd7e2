#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "hypotheses/generators.hpp"
#include "hypotheses/places.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

/// An isometry or its inverse, as the cells that the images of two points outside the set fall in.
std::uint64_t key_of(const RigidMap& map, SymmetryType type, double radius, double cell) {
    const Vector3d first = radius * kOutside, second = radius * Vector3d(-0.69, 0.21, -0.69);
    const auto back = [&](const Vector3d& p) -> Vector3d { return map.linear.transpose() * (p - map.shift); };
    std::array<Vector3d, 2> images{map(first), map(second)};
    const std::array<Vector3d, 2> inverse{back(first), back(second)};
    if ((images[0] - inverse[0]).dot(kAskew) < 0) images = inverse;
    auto key = static_cast<std::uint64_t>(type);
    for (const Vector3d& image : images)
        for (const double x : image) key = mixed(key, static_cast<std::int64_t>(std::floor(x / cell)));
    return key;
}

}  // namespace

Agreed agreeing_first(const Cloud& cloud, const std::vector<Candidate>& candidates) {
    constexpr double kCell = 64, kExact = 16;  // resolutions
    const double resolution = cloud.scene().resolution;
    struct Voted {
        std::size_t first;
        int votes;
    };
    std::vector<Voted> all;
    std::unordered_map<std::uint64_t, std::size_t> known;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (disagreement(cloud, candidates[k]) <= kExact * resolution) {
            const Hypothesis h = hypothesis_of(cloud, candidates[k]);
            const auto [place, is_new] =
                known.try_emplace(key_of(h.map, h.type, cloud.radius(), kCell * resolution), all.size());
            if (!is_new) {
                ++all[place->second].votes;
                continue;
            }
        }
        all.push_back({k, 1});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Voted& a, const Voted& b) { return a.votes > b.votes; });
    Agreed out;
    out.candidates.reserve(all.size());
    for (const Voted& v : all) {
        out.candidates.push_back(candidates[v.first]);
        if (v.votes > 1) ++out.agreeing;
    }
    return out;
}

}  // namespace insym
