// Placing a point set: orientation, mirror image, scale, position, order of the points.
#pragma once

#include "insym/point_set.hpp"

#include <array>
#include <cstdint>
#include <iosfwd>
#include <random>
#include <vector>

#include <rapidcheck.h>

namespace insym::property {

/// x -> scale * (turn x + shift); turn is a rotation, after a mirror image if `mirrored`.
struct Pose {
    std::array<std::array<double, 3>, 3> turn{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    bool mirrored = false;
    double scale = 1;
    Point shift{};

    Point apply(const Point& p) const;
};

std::ostream& operator<<(std::ostream& out, const Pose& pose);

/// Any orientation, mirrored or not, scale 1e-3 to 1e6, shift up to ten units before scaling.
rc::Gen<Pose> any_pose(int dimension);

/// Rotation matrix of a quaternion (w, x, y, z), of any length but 0.
std::array<std::array<double, 3>, 3> rotation_of(const std::array<double, 4>& quaternion);

/// A random order of n things, the same for the same seed on every machine.
std::vector<int> shuffled_order(int n, std::uint64_t seed);

/// Points, labels and entities placed by `pose`, then listed so that item k is old item order[k].
PointSet placed(const PointSet& points, const Pose& pose, const std::vector<int>& order);

/// Uniform number in [low, high), the same on every machine (std's distributions are not).
double uniform(std::mt19937_64& random, double low, double high);

/// Normally distributed number, by Box and Muller, the same on every machine.
double normal(std::mt19937_64& random);

}  // namespace insym::property
