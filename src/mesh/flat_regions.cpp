#include "mesh/flat_regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace insym {
namespace {

using Eigen::Vector3d;

/// A region smaller than this share of the whole area is not large.
constexpr double kLeastShare = 1e-4;

/// A neighbour over a smooth edge that has at least this share of a region's area makes it the facet of a
/// curved face.
constexpr double kFacetShare = 0.25;

/// A group of regions that meet over smooth edges alone: a face of the part, as far as a mesh can tell.
struct Group {
    std::vector<int> regions;
    double area = 0;
    Vector3d area_vector = {0, 0, 0}, centroid = {0, 0, 0};
};

class RegionGrower {
public:
    RegionGrower(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, const Flatness& flatness)
        : mesh_(mesh),
          edges_(edges),
          flatness_(flatness),
          region_(mesh.triangles.size(), -1),
          neighbours_(mesh.triangles.size()) {
        for (const MeshEdge& edge : edges) {
            if (edge.triangles[1] < 0) continue;
            neighbours_[static_cast<std::size_t>(edge.triangles[0])].push_back(edge.triangles[1]);
            neighbours_[static_cast<std::size_t>(edge.triangles[1])].push_back(edge.triangles[0]);
        }
    }

    /// Large triangles first: their planes are the best known.
    std::vector<FlatRegion> grow_all() {
        std::vector<int> order(mesh_.triangles.size());
        std::iota(order.begin(), order.end(), 0);
        std::vector<double> areas;
        areas.reserve(order.size());
        for (const int t : order) areas.push_back(mesh_.area_vector(t).norm());
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
            return areas[static_cast<std::size_t>(a)] > areas[static_cast<std::size_t>(b)];
        });
        std::vector<FlatRegion> regions;
        for (const int seed : order)
            if (region_[static_cast<std::size_t>(seed)] < 0)
                regions.push_back(grow(seed, static_cast<int>(regions.size())));
        return regions;
    }

    /// Makes one region of those that between sharp edges are flat together, to the larger length: an
    /// approximate plane is triangles that are not quite of one plane, and no curved face. The others of such
    /// a group are left empty.
    void merge_nearly_flat(std::vector<FlatRegion>& regions) {
        for (const Group& group : smooth_groups(regions)) {
            if (group.regions.size() < 2 || !is_nearly_flat(group, regions)) continue;
            const int first = group.regions.front();
            FlatRegion whole{group.centroid, group.area, {}};
            for (const int i : group.regions) {
                std::vector<int>& triangles = regions[static_cast<std::size_t>(i)].triangles;
                whole.triangles.insert(whole.triangles.end(), triangles.begin(), triangles.end());
                regions[static_cast<std::size_t>(i)] = {{0, 0, 0}, 0, {}};
            }
            for (const int t : whole.triangles) region_[static_cast<std::size_t>(t)] = first;
            regions[static_cast<std::size_t>(first)] = std::move(whole);
        }
    }

    /// For each region, the area of its largest neighbour over a smooth edge.
    std::vector<double> smooth_neighbours(const std::vector<FlatRegion>& regions) const {
        std::vector<double> largest(regions.size(), 0);
        for (const MeshEdge& edge : edges_) {
            if (edge.sharp) continue;
            const auto a = static_cast<std::size_t>(region_[static_cast<std::size_t>(edge.triangles[0])]);
            const auto b = static_cast<std::size_t>(region_[static_cast<std::size_t>(edge.triangles[1])]);
            if (a == b) continue;
            largest[a] = std::max(largest[a], regions[b].area);
            largest[b] = std::max(largest[b], regions[a].area);
        }
        return largest;
    }

    /// The regions by their first triangles.
    std::vector<int> order() const {
        std::vector<int> order;
        std::vector<char> seen(region_.size(), 0);
        for (const int region : region_)
            if (!std::exchange(seen[static_cast<std::size_t>(region)], 1)) order.push_back(region);
        return order;
    }

private:
    FlatRegion grow(int seed, int number) {
        const Vector3d origin = mesh_.corner(seed, 0), normal = mesh_.area_vector(seed).normalized();
        FlatRegion region{Vector3d(0, 0, 0), 0, {}};
        std::vector<int> stack = {seed};
        region_[static_cast<std::size_t>(seed)] = number;
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            const double area = mesh_.area_vector(t).norm() / 2;
            region.area += area;
            region.triangles.push_back(t);
            region.centroid += (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3 * area;
            for (const int next : neighbours_[static_cast<std::size_t>(t)]) {
                if (region_[static_cast<std::size_t>(next)] >= 0 || !in_plane(next, origin, normal)) continue;
                region_[static_cast<std::size_t>(next)] = number;
                stack.push_back(next);
            }
        }
        if (region.area > 0) region.centroid /= region.area;
        return region;
    }

    /// Turned over it would be the other side of a thin sheet.
    bool in_plane(int triangle, const Vector3d& origin, const Vector3d& normal) const {
        for (int i = 0; i < 3; ++i)
            if (std::abs(normal.dot(mesh_.corner(triangle, i) - origin)) > flatness_.exact) return false;
        return normal.dot(mesh_.area_vector(triangle)) >= 0;
    }

    std::vector<Group> smooth_groups(const std::vector<FlatRegion>& regions) const {
        std::vector<std::vector<int>> adjoining(regions.size());
        for (const MeshEdge& edge : edges_) {
            if (edge.sharp) continue;
            const int a = region_[static_cast<std::size_t>(edge.triangles[0])];
            const int b = region_[static_cast<std::size_t>(edge.triangles[1])];
            if (a == b) continue;
            adjoining[static_cast<std::size_t>(a)].push_back(b);
            adjoining[static_cast<std::size_t>(b)].push_back(a);
        }
        std::vector<Group> groups;
        std::vector<char> seen(regions.size(), 0);
        for (std::size_t start = 0; start < regions.size(); ++start) {
            if (std::exchange(seen[start], 1) != 0) continue;
            Group group{{static_cast<int>(start)}};
            for (std::size_t k = 0; k < group.regions.size(); ++k)
                for (const int next : adjoining[static_cast<std::size_t>(group.regions[k])])
                    if (std::exchange(seen[static_cast<std::size_t>(next)], 1) == 0)
                        group.regions.push_back(next);
            groups.push_back(std::move(group));
        }
        for (Group& group : groups) measure(regions, group);
        return groups;
    }

    void measure(const std::vector<FlatRegion>& regions, Group& group) const {
        for (const int i : group.regions) {
            const FlatRegion& region = regions[static_cast<std::size_t>(i)];
            group.area += region.area;
            group.centroid += region.area * region.centroid;
            for (const int t : region.triangles) group.area_vector += mesh_.area_vector(t);
        }
        if (group.area > 0) group.centroid /= group.area;
    }

    /// All of it near the plane through its middle, and nowhere turned from that by the sharp angle: the
    /// narrow round of an edge is near a plane too.
    bool is_nearly_flat(const Group& group, const std::vector<FlatRegion>& regions) const {
        const Vector3d normal = group.area_vector.normalized();
        for (const int i : group.regions)
            for (const int t : regions[static_cast<std::size_t>(i)].triangles) {
                const Vector3d across = mesh_.area_vector(t);
                if (normal.dot(across) < flatness_.least_cosine * across.norm()) return false;
                for (int k = 0; k < 3; ++k)
                    if (std::abs(normal.dot(mesh_.corner(t, k) - group.centroid)) > flatness_.approximate)
                        return false;
            }
        return true;
    }

    const TriangleMesh& mesh_;
    const std::vector<MeshEdge>& edges_;
    Flatness flatness_;
    std::vector<int> region_;  ///< of each triangle
    std::vector<std::vector<int>> neighbours_;
};

}  // namespace

std::vector<FlatRegion> find_flat_regions(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges,
                                          const Flatness& flatness) {
    RegionGrower grower(mesh, edges, flatness);
    std::vector<FlatRegion> all = grower.grow_all();
    grower.merge_nearly_flat(all);
    const std::vector<double> neighbours = grower.smooth_neighbours(all);
    double whole = 0;
    for (const FlatRegion& region : all) whole += region.area;
    std::vector<FlatRegion> kept;
    for (const int i : grower.order()) {
        const FlatRegion& region = all[static_cast<std::size_t>(i)];
        if (region.area >= kLeastShare * whole &&
            neighbours[static_cast<std::size_t>(i)] < kFacetShare * region.area)
            kept.push_back(region);
    }
    return kept;
}

}  // namespace insym
