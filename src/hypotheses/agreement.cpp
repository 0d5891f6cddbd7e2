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
        Candidate best;
        int votes;
    };
    std::vector<Voted> all;
    std::unordered_map<std::uint64_t, std::size_t> known;
    known.reserve(candidates.size());
    for (const Candidate& c : candidates) {
        if (disagreement(cloud, c) <= kExact * resolution) {
            const Hypothesis h = hypothesis_of(cloud, c);
            const auto [place, is_new] =
                known.try_emplace(key_of(h.map, h.type, cloud.radius(), kCell * resolution), all.size());
            if (!is_new) {
                Voted& same = all[place->second];
                ++same.votes;
                if (before(c, same.best)) same.best = c;
                continue;
            }
        }
        all.push_back({c, 1});
    }
    std::sort(all.begin(), all.end(), [](const Voted& a, const Voted& b) {
        return a.votes != b.votes ? a.votes > b.votes : before(a.best, b.best);
    });
    Agreed out;
    out.candidates.reserve(all.size());
    for (const Voted& v : all) {
        out.candidates.push_back(v.best);
        if (v.votes > 1) ++out.agreeing;
    }
    return out;
}

}  // namespace insym
