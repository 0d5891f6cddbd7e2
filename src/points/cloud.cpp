#include "points/cloud.hpp"

#include <algorithm>
#include <cmath>

namespace insym {
namespace {

Eigen::Vector3d mean_of(const PointScene& scene) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < scene.size(); ++i) sum += to_vector(scene.position(i)) / scene.size();
    return sum;
}

std::vector<Point> about(const PointScene& scene, const Eigen::Vector3d& middle) {
    std::vector<Point> out;
    out.reserve(scene.points.size());
    for (int i = 0; i < scene.size(); ++i) out.push_back(to_point(to_vector(scene.position(i)) - middle));
    return out;
}

}  // namespace

Cloud::Cloud(const PointScene& scene) : scene_(scene), middle_(mean_of(scene)), grid_(about(scene, middle_)) {
    points_.reserve(scene.points.size());
    for (int i = 0; i < scene.size(); ++i) {
        points_.emplace_back(to_vector(scene.position(i)) - middle_);
        radius_ = std::max(radius_, points_.back().norm());
    }
    double least = 4 * radius_ * radius_;
    for (int i = 0; i < size(); ++i)
        grid_.visit_ball(to_point((*this)[i]), std::sqrt(least), [&](int j, double square) {
            if (j != i) least = std::min(least, square);
            return true;
        });
    gap_ = std::sqrt(least);
}

void Cloud::nearest_distances(int i, std::span<double> out) const {
    std::vector<double> squares;
    // A ball that holds the number asked for in a set that is spread evenly, and then twice as far at a time.
    double reach = radius_ * std::cbrt(static_cast<double>(out.size()) / size());
    for (; squares.size() < out.size() && reach < 4 * radius_; reach *= 2) {
        squares.clear();
        grid_.visit_ball(to_point((*this)[i]), reach, [&](int j, double square) {
            if (j != i && label(j) == label(i)) squares.push_back(square);
            return true;
        });
    }
    const std::size_t count = std::min(squares.size(), out.size());
    std::partial_sort(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(count), squares.end());
    for (std::size_t k = 0; k < count; ++k) out[k] = std::sqrt(squares[k]);
}

int Cloud::nearest(const Eigen::Vector3d& place, int label, double reach, double& square) const {
    int best = -1;
    square = reach * reach;
    grid_.visit_ball(to_point(place), reach, [&](int j, double s) {
        if (scene_.label(j) == label && (s < square || (s == square && (best < 0 || j < best)))) {
            best = j;
            square = s;
        }
        return true;
    });
    return best;
}

}  // namespace insym
