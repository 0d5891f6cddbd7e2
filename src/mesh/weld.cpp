#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "mesh/triangle_mesh.hpp"

namespace insym {
namespace {

using Eigen::Vector3d;
using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        std::uint64_t hash = 0;
        for (const std::int64_t i : cell) hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15U;
        return static_cast<std::size_t>(hash ^ (hash >> 29U));
    }
};

/// Vertices kept so far, by cells of a size of which the distance is the half: what is near lies in at most
/// eight.
class Welder {
public:
    explicit Welder(double distance) : distance_(distance) {}

    /// The number of the kept vertex that `point` is one with.
    int find_or_add(const Vector3d& point) {
        const Cell low = cell_of(point - Vector3d::Constant(distance_));
        const Cell high = cell_of(point + Vector3d::Constant(distance_));
        for (std::int64_t x = low[0]; x <= high[0]; ++x)
            for (std::int64_t y = low[1]; y <= high[1]; ++y)
                for (std::int64_t z = low[2]; z <= high[2]; ++z)
                    if (const int found = find_in({x, y, z}, point); found >= 0) return found;
        cells_[cell_of(point)].push_back(static_cast<int>(kept_.size()));
        kept_.push_back(point);
        return static_cast<int>(kept_.size()) - 1;
    }

    std::vector<Vector3d> take() { return std::move(kept_); }

private:
    Cell cell_of(const Vector3d& point) const {
        Cell cell{};
        for (int i = 0; i < 3; ++i)
            cell[static_cast<std::size_t>(i)] =
                static_cast<std::int64_t>(std::floor(point[i] / (2 * distance_)));
        return cell;
    }

    int find_in(const Cell& cell, const Vector3d& point) const {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) return -1;
        for (const int i : found->second)
            if ((kept_[static_cast<std::size_t>(i)] - point).norm() <= distance_) return i;
        return -1;
    }

    double distance_;
    std::vector<Vector3d> kept_;
    std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

double box_diagonal(const std::vector<Vector3d>& vertices) {
    if (vertices.empty()) return 0;
    Vector3d low = vertices.front(), high = low;
    for (const Vector3d& p : vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return (high - low).norm();
}

TriangleMesh weld(const TriangleMesh& mesh, double distance) {
    Welder welder(distance);
    std::vector<int> number;
    number.reserve(mesh.vertices.size());
    for (const Vector3d& point : mesh.vertices) number.push_back(welder.find_or_add(point));
    TriangleMesh welded;
    welded.vertices = welder.take();
    for (std::array<int, 3> triangle : mesh.triangles) {
        for (int& i : triangle) i = number[static_cast<std::size_t>(i)];
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
            welded.triangles.push_back(triangle);
    }
    return welded;
}

}  // namespace insym
