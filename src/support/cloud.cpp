#include "support/cloud.hpp"

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
}

double Cloud::nearest_gap() const {
    double best = 4 * radius_ * radius_;
    for (int i = 0; i < size(); ++i)
        grid_.visit_ball(to_point((*this)[i]), std::sqrt(best), [&](int j, double square) {
            if (j != i) best = std::min(best, square);
            return true;
        });
    return std::sqrt(best);
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
