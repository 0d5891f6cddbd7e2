#include "property/support/pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <ostream>

namespace insym::property {

Point Pose::apply(const Point& p) const {
    const Point from = {mirrored ? -p[0] : p[0], p[1], p[2]};
    Point to{};
    for (std::size_t i = 0; i < 3; ++i) {
        to[i] = shift[i];
        for (std::size_t j = 0; j < 3; ++j) to[i] += turn[i][j] * from[j];
        to[i] *= scale;
    }
    return to;
}

std::ostream& operator<<(std::ostream& out, const Pose& pose) {
    out << "{scale " << pose.scale << ", mirrored " << pose.mirrored << ", shift " << pose.shift[0] << ' '
        << pose.shift[1] << ' ' << pose.shift[2] << ", turn";
    for (const auto& row : pose.turn) out << ' ' << row[0] << ' ' << row[1] << ' ' << row[2] << ';';
    return out << '}';
}

std::array<std::array<double, 3>, 3> rotation_of(const std::array<double, 4>& quaternion) {
    const auto& [w, x, y, z] = quaternion;
    const double s = 2 / (w * w + x * x + y * y + z * z);
    return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
             {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
             {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

rc::Gen<Pose> any_pose(int dimension) {
    return rc::gen::exec([dimension] {
        const auto part = rc::gen::inRange(-1000, 1001);
        const double tilt = dimension == 3 ? 1 : 0;  // in 2D only turns about z
        Pose pose;
        pose.turn = rotation_of({1000.5, tilt * *part, tilt * *part, 1.0 * *part});
        pose.mirrored = *rc::gen::arbitrary<bool>();
        pose.scale = std::pow(10, *rc::gen::inRange(-30, 61) / 10.0);
        pose.shift = {*part / 100.0, *part / 100.0, tilt * *part / 100.0};
        return pose;
    });
}

std::vector<int> shuffled_order(int n, std::uint64_t seed) {
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    std::mt19937_64 random(seed);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    return order;
}

PointSet placed(const PointSet& points, const Pose& pose, const std::vector<int>& order) {
    PointSet result;
    result.dimension = points.dimension;
    for (int old : order) {
        const auto k = static_cast<std::size_t>(old);
        result.positions.push_back(pose.apply(points.positions[k]));
        if (!points.labels.empty()) result.labels.push_back(points.labels[k]);
        if (!points.entities.empty()) result.entities.push_back(points.entities[k]);
    }
    return result;
}

double uniform(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

double normal(std::mt19937_64& random) {
    const double radius = std::sqrt(-2 * std::log(1 - uniform(random, 0, 1)));
    return radius * std::cos(2 * std::numbers::pi * uniform(random, 0, 1));
}

}  // namespace insym::property
