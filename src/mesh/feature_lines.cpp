#include "mesh/feature_lines.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

namespace insym {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// Tracing -------------------------------------------------------------------------------------

/// The graph of the sharp edges.
class SharpGraph {
public:
    SharpGraph(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, double sharp_angle_deg)
        : mesh_(mesh), cos_sharp_(std::cos(sharp_angle_deg * std::numbers::pi / 180)) {
        for (const MeshEdge& edge : edges) {
            if (!edge.sharp) continue;
            neighbours_[edge.vertices[0]].push_back(edge.vertices[1]);
            neighbours_[edge.vertices[1]].push_back(edge.vertices[0]);
        }
        for (const auto& [vertex, around] : neighbours_)
            if (is_corner(vertex, around)) corners_.push_back(vertex);
    }

    FeatureLines trace() {
        FeatureLines found{corners_, {}};
        for (const int corner : corners_)
            for (const int next : neighbours_.at(corner))
                if (!used_.contains(std::minmax(corner, next))) found.lines.push_back(follow(corner, next));
        for (const auto& [vertex, around] : neighbours_)
            if (!used_.contains(std::minmax(vertex, around.front())) && !at_corner(vertex)) {
                FeatureLine loop = follow(vertex, around.front());
                loop.vertices.pop_back();
                loop.closed = true;
                found.lines.push_back(std::move(loop));
            }
        return found;
    }

private:
    const Vector3d& at(int vertex) const { return mesh_.vertices[static_cast<std::size_t>(vertex)]; }
    bool at_corner(int vertex) const { return std::binary_search(corners_.begin(), corners_.end(), vertex); }

    bool is_corner(int vertex, const std::vector<int>& around) const {
        if (around.size() != 2) return true;
        const Vector3d in = at(vertex) - at(around[0]), out = at(around[1]) - at(vertex);
        return in.dot(out) < cos_sharp_ * in.norm() * out.norm();
    }

    /// On from `start` over `next` to the next corner, or back to the start.
    FeatureLine follow(int start, int next) {
        FeatureLine line{{start, next}, false};
        used_[std::minmax(start, next)] = true;
        while (!at_corner(next) && next != start) {
            const std::vector<int>& around = neighbours_.at(next);
            const int before = line.vertices[line.vertices.size() - 2];
            const int after = around[0] == before ? around[1] : around[0];
            used_[std::minmax(next, after)] = true;
            line.vertices.push_back(next = after);
        }
        return line;
    }

    const TriangleMesh& mesh_;
    double cos_sharp_;
    std::map<int, std::vector<int>> neighbours_;
    std::vector<int> corners_;
    std::map<std::pair<int, int>, bool> used_;
};

// Parting -------------------------------------------------------------------------------------

/// An edge so many times longer than the median of its line is a straight piece of it: the edges of a curve
/// that a mesh approximates are all about as long.
constexpr double kLongEdge = 4;

/// Parts lines where they run smoothly from straight into curved: a slot's outline, a rounded corner.
class LineParter {
public:
    LineParter(const TriangleMesh& mesh, FeatureLines& out) : mesh_(mesh), out_(out) {}

    void part(FeatureLine line) {
        if (line.closed) line.vertices.push_back(line.vertices.front());
        const std::vector<char> is_long = long_edges(line.vertices);
        if (std::find(is_long.begin(), is_long.end(), 1) == is_long.end()) {
            if (line.closed) line.vertices.pop_back();
            out_.lines.push_back(std::move(line));
            return;
        }
        if (line.closed) begin_at_long_edge(line.vertices, is_long);
        const std::vector<char> straight = line.closed ? long_edges(line.vertices) : is_long;
        std::size_t start = 0;
        for (std::size_t i = 1; i < line.vertices.size(); ++i) {
            const bool last = i + 1 == line.vertices.size();
            if (!last && straight[i] == 0 && straight[i - 1] == 0) continue;
            out_.lines.push_back({{line.vertices.begin() + static_cast<std::ptrdiff_t>(start),
                                   line.vertices.begin() + static_cast<std::ptrdiff_t>(i) + 1},
                                  false});
            if (!last || line.closed) out_.corners.push_back(line.vertices[i]);
            start = i;
        }
    }

private:
    std::vector<char> long_edges(const std::vector<int>& vertices) const {
        std::vector<double> lengths;
        for (std::size_t i = 1; i < vertices.size(); ++i)
            lengths.push_back((mesh_.vertices[static_cast<std::size_t>(vertices[i])] -
                               mesh_.vertices[static_cast<std::size_t>(vertices[i - 1])])
                                  .norm());
        std::vector<double> sorted = lengths;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::nth_element(sorted.begin(), middle, sorted.end());
        std::vector<char> is_long;
        for (const double length : lengths) is_long.push_back(length > kLongEdge * *middle ? 1 : 0);
        return is_long;
    }

    /// `vertices` ends with its first, also afterwards.
    static void begin_at_long_edge(std::vector<int>& vertices, const std::vector<char>& is_long) {
        const auto first = std::find(is_long.begin(), is_long.end(), 1) - is_long.begin();
        vertices.pop_back();
        std::rotate(vertices.begin(), vertices.begin() + first, vertices.end());
        vertices.push_back(vertices.front());
    }

    const TriangleMesh& mesh_;
    FeatureLines& out_;
};

// Describing ----------------------------------------------------------------------------------

struct Circle {
    Vector3d center;
    double radius;
    double misfit;  ///< the largest distance of a point to it
};

/// The circle through points on it, and near it by algebraic least squares (Kasa) in the plane that fits them
/// best.
std::optional<Circle> fit_circle(const Points& points) {
    const auto n = static_cast<Eigen::Index>(points.size());
    if (n < 3) return std::nullopt;
    const Vector3d mean =
        std::accumulate(points.begin(), points.end(), Vector3d(0, 0, 0)) / static_cast<double>(n);
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
    const Vector3d u = axes.eigenvectors().col(2), v = axes.eigenvectors().col(1);
    Eigen::MatrixX3d left(n, 3);
    Eigen::VectorXd right(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Vector3d off = points[static_cast<std::size_t>(i)] - mean;
        left.row(i) << 2 * off.dot(u), 2 * off.dot(v), 1;
        right[i] = off.dot(u) * off.dot(u) + off.dot(v) * off.dot(v);
    }
    const Vector3d solution = left.colPivHouseholderQr().solve(right);
    const double square = solution[2] + solution[0] * solution[0] + solution[1] * solution[1];
    if (!(square > 0)) return std::nullopt;
    Circle circle{mean + u * solution[0] + v * solution[1], std::sqrt(square), 0};
    const Vector3d normal = axes.eigenvectors().col(0);
    for (const Vector3d& p : points) {
        const Vector3d off = p - circle.center;
        const double height = off.dot(normal);
        const double flat = std::sqrt(std::max(0.0, off.squaredNorm() - height * height));
        circle.misfit = std::max(circle.misfit, std::hypot(flat - circle.radius, height));
    }
    return circle;
}

double distance_to_line(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
    const Vector3d along = (b - a).normalized(), off = p - a;
    return (off - along * along.dot(off)).norm();
}

/// Centroid by length and length of a polyline.
std::pair<Vector3d, double> centroid_of(const Points& points) {
    Vector3d moment(0, 0, 0);
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step = (points[i] - points[i - 1]).norm();
        moment += (points[i] + points[i - 1]) / 2 * step;
        length += step;
    }
    return {length > 0 ? Vector3d(moment / length) : points.front(), length};
}

Vector3d halfway(const Points& points, double length) {
    double left = length / 2;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step = (points[i] - points[i - 1]).norm();
        if (step >= left && step > 0) return points[i - 1] + (points[i] - points[i - 1]) * (left / step);
        left -= step;
    }
    return points.back();
}

/// How far the line leaves the chord of its ends.
double sagitta_of(const Points& points) {
    double sagitta = 0;
    for (const Vector3d& p : points)
        sagitta = std::max(sagitta, distance_to_line(p, points.front(), points.back()));
    return sagitta;
}

/// A misfit above this share of its size is too much for a circle, or a straight line.
constexpr double kCircleMisfit = 0.01, kLineMisfit = 1e-3;

std::pair<Vector3d, Entity> describe_closed(const Points& points, Entity entity) {
    Points around = points;
    around.push_back(points.front());
    const auto [centroid, length] = centroid_of(around);
    entity.geometry = "loop";
    entity.length = length;
    const auto circle = fit_circle(points);
    if (!circle || circle->misfit > kCircleMisfit * circle->radius) return {centroid, entity};
    entity.geometry = "circle";
    entity.radius = circle->radius;
    entity.length = 2 * std::numbers::pi * circle->radius;
    return {circle->center, entity};
}

std::pair<Vector3d, Entity> describe_open(const Points& points, Entity entity) {
    const auto [centroid, length] = centroid_of(points);
    entity.length = length;
    entity.geometry = "line";
    const double sagitta = sagitta_of(points);
    if (sagitta <= kLineMisfit * length) return {(points.front() + points.back()) / 2, entity};
    const auto circle = fit_circle(points);
    if (points.size() >= 4 && circle && circle->misfit <= kCircleMisfit * sagitta) {
        entity.geometry = "circle";
        entity.radius = circle->radius;
        return {circle->center, entity};
    }
    entity.geometry = "curve";
    return {halfway(points, length), entity};
}

}  // namespace

FeatureLines find_feature_lines(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges,
                                double sharp_angle_deg) {
    FeatureLines traced = SharpGraph(mesh, edges, sharp_angle_deg).trace();
    FeatureLines parted{std::move(traced.corners), {}};
    LineParter parter(mesh, parted);
    for (FeatureLine& line : traced.lines) parter.part(std::move(line));
    std::sort(parted.corners.begin(), parted.corners.end());
    return parted;
}

std::pair<Vector3d, Entity> describe_line(const TriangleMesh& mesh, const FeatureLine& line) {
    Points points;
    for (const int v : line.vertices) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    Entity entity;
    entity.kind = EntityKind::edge;
    return line.closed ? describe_closed(points, entity) : describe_open(points, entity);
}

}  // namespace insym
