#include "symmetries/axis_directions.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>

#include <tbb/parallel_sort.h>

#include "hypotheses/places.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostPoints = 256;

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

/// Segments with one vector, or its opposite.
struct Parallel {
    Vector3d vector;
    double count = 0;
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

/// The votes for each direction, by the cell it lies in.
class Directions {
public:
    void vote(const Vector3d& along, double votes) {
        const Vector3d direction = turned_up(along).normalized();
        // Off the borders of cells, where the coordinates of aligned models lie.
        const Vector3d cell = direction / kSameDirection + Vector3d(0.37, 0.41, 0.43);
        std::uint64_t key = 0;
        for (const double x : cell) key = mixed(key, static_cast<std::int64_t>(std::floor(x)));
        ballots_.push_back({key, votes, direction});
    }

    std::vector<Vector3d> fullest(std::size_t most) {
        tbb::parallel_sort(ballots_.begin(), ballots_.end(), [](const Ballot& a, const Ballot& b) {
            if (a.key != b.key) return a.key < b.key;
            return std::lexicographical_compare(a.direction.begin(), a.direction.end(), b.direction.begin(),
                                                b.direction.end());
        });
        std::vector<Ballot> cells;
        for (const Ballot& b : ballots_)
            if (!cells.empty() && cells.back().key == b.key)
                cells.back().votes += b.votes;
            else
                cells.push_back(b);
        const auto end = cells.begin() + static_cast<std::ptrdiff_t>(std::min(most, cells.size()));
        std::partial_sort(cells.begin(), end, cells.end(), [](const Ballot& a, const Ballot& b) {
            return a.votes != b.votes ? a.votes > b.votes : a.key < b.key;
        });
        std::vector<Vector3d> out;
        for (auto cell = cells.begin(); cell != end; ++cell) out.push_back(cell->direction);
        return out;
    }

private:
    struct Ballot {
        std::uint64_t key;
        double votes;
        Vector3d direction;
    };
    std::vector<Ballot> ballots_;
};

/// Of segments of one length, those with one vector together.
std::vector<Parallel> parallels(const Cloud& cloud, const Segment* begin, const Segment* end) {
    const double resolution = cloud.scene().resolution;
    std::vector<std::pair<double, Vector3d>>
        vectors;  // and how far they reach along a direction askew to all
    for (const Segment* s = begin; s != end; ++s) {
        const Vector3d v = turned_up(cloud[s->to] - cloud[s->from]);
        vectors.emplace_back(v.dot(kOutside), v);
    }
    std::sort(vectors.begin(), vectors.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Parallel> out;
    for (const auto& [reach, v] : vectors) {
        if (out.empty() || (out.back().vector - v).norm() > 2 * resolution) out.push_back({v, 0});
        ++out.back().count;
    }
    return out;
}

void suggest(const std::vector<Parallel>& equal, double shortest, Directions& out) {
    for (std::size_t i = 0; i < equal.size(); ++i) {
        const auto& [v, count] = equal[i];
        if (count > 1 && v.norm() > shortest) out.vote(v, count * (count - 1) / 2);
        const std::size_t others = equal.size() - 1 - i;
        const std::size_t stride = std::max<std::size_t>(1, others / kMostMates);
        for (std::size_t j = i + 1; j < equal.size(); j += stride)
            for (const Vector3d& sum : {Vector3d(v + equal[j].vector), Vector3d(v - equal[j].vector)})
                if (sum.norm() > shortest)
                    out.vote(sum, count * equal[j].count * static_cast<double>(stride));
    }
}

}  // namespace

std::vector<Vector3d> axis_directions(const Cloud& cloud, std::size_t most) {
    const std::vector<Segment> all = segments(cloud);
    Directions directions;
    for (std::size_t k = 0; k < all.size();) {
        std::size_t end = k + 1;
        while (end < all.size() && all[end].length - all[end - 1].length <= cloud.scene().resolution / 4)
            ++end;
        if (end - k > 1)
            suggest(parallels(cloud, &all[k], all.data() + end), kShortest * cloud.radius(), directions);
        k = end;
    }
    return directions.fullest(most);
}

}  // namespace insym
