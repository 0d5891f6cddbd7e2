#include "symmetries/axis_directions.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include <tbb/parallel_sort.h>

#include "hypotheses/cells.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostPoints = 128;

/// So many others of equal length a segment is compared with.
constexpr std::size_t kMostMates = 8;

/// Sums of segments shorter than this share of the radius fix no direction.
constexpr double kShortest = 0.02;

/// Directions that differ by less are one.
constexpr double kSameDirection = 1e-5;

struct Segment {
    double length;
    int from;
    int to;
    bool operator<(const Segment& o) const {
        return length != o.length ? length < o.length : from != o.from ? from < o.from : to < o.to;
    }
};

Vector3d turned_up(const Vector3d& v) {
    return v.dot(kAskew) < 0 ? Vector3d(-v) : v;
}

std::vector<Segment> segments(const Cloud& cloud) {
    std::vector<int> points(static_cast<std::size_t>(cloud.size()));
    std::iota(points.begin(), points.end(), 0);
    if (points.size() > kMostPoints) {
        std::stable_sort(points.begin(), points.end(),
                         [&](int a, int b) { return cloud[a].squaredNorm() > cloud[b].squaredNorm(); });
        points.resize(kMostPoints);
    }
    std::vector<Segment> out;
    out.reserve(points.size() * (points.size() - 1) / 2);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            out.push_back({(cloud[points[i]] - cloud[points[j]]).norm(), points[i], points[j]});
    tbb::parallel_sort(out.begin(), out.end());
    return out;
}

/// The vectors of segments of one length, each once, whichever way round.
std::vector<Vector3d> vectors_of(const Cloud& cloud, std::span<const Segment> equally_long) {
    const double resolution = cloud.scene().resolution;
    std::vector<std::pair<double, Vector3d>>
        vectors;  // and how far they reach along a direction askew to all
    for (const Segment& s : equally_long) {
        const Vector3d v = turned_up(cloud[s.to] - cloud[s.from]);
        vectors.emplace_back(v.dot(kOutside), v);
    }
    std::sort(vectors.begin(), vectors.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Vector3d> out;
    for (const auto& [reach, v] : vectors)
        if (out.empty() || (out.back() - v).norm() > 2 * resolution) out.push_back(v);
    return out;
}

/// What these vectors of one length suggest.
void suggest(const std::vector<Vector3d>& vectors, double shortest, std::vector<Vector3d>& out) {
    const auto add = [&](const Vector3d& along) {
        if (along.norm() > shortest) out.push_back(turned_up(along).normalized());
    };
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        const std::size_t stride = std::max<std::size_t>(1, (vectors.size() - 1 - i) / kMostMates);
        for (std::size_t j = i + 1; j < vectors.size(); j += stride) {
            add(vectors[i] + vectors[j]);
            add(vectors[i] - vectors[j]);
        }
    }
}

}  // namespace

std::vector<Vector3d> axis_directions(const Cloud& cloud, std::size_t most) {
    const std::vector<Segment> all = segments(cloud);
    std::vector<Vector3d> suggested;
    for (std::size_t k = 0; k < all.size();) {
        std::size_t end = k + 1;
        while (end < all.size() && all[end].length - all[end - 1].length <= cloud.scene().resolution / 4)
            ++end;
        if (end - k > 1)
            suggest(vectors_of(cloud, {&all[k], end - k}), kShortest * cloud.radius(), suggested);
        k = end;
    }
    const Vector3d off = off_borders(kSameDirection);
    std::vector<Ranked> cells = full_cells(suggested.size(), kSameDirection,
                                           [&](std::size_t k) -> Vector3d { return suggested[k] + off; });
    keep_fullest(cells, most);
    std::vector<Vector3d> out;
    out.reserve(cells.size());
    for (const Ranked& r : cells) out.push_back(suggested[static_cast<std::size_t>(r.first)]);
    return out;
}

}  // namespace insym
