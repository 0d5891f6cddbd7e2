#include "isometry/describe.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The angle of a proper linear map, 0..180; exact near both ends.
double angle_deg_of(const Matrix3d& proper) {
    const Vector3d twice_sine(proper(2, 1) - proper(1, 2), proper(0, 2) - proper(2, 0),
                              proper(1, 0) - proper(0, 1));
    return std::atan2(twice_sine.norm(), proper.trace() - 1) * kDegrees;
}

/// The unit vector that the linear map takes to itself (sign +1) or to its opposite (-1).
Vector3d eigenvector(const Matrix3d& linear, double sign) {
    // For an orthogonal map (Q - sI)^T (Q - sI) = 2I - s (Q + Q^T), whose null space it is.
    const Matrix3d normal = 2 * Matrix3d::Identity() - sign * (linear + linear.transpose());
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(normal).eigenvectors().col(0);
}

/// The fixed point nearest to `near` of x -> linear x + shift, in the least-squares sense.
Vector3d fixed_point(const Matrix3d& linear, const Vector3d& shift, const Vector3d& near) {
    const Matrix3d a = Matrix3d::Identity() - linear;
    Eigen::CompleteOrthogonalDecomposition<Matrix3d> solver;
    solver.setThreshold(1e-9);
    solver.compute(a);
    return near + solver.solve(shift - a * near);
}

/// Elements of one sign look alike from run to run: the largest component counts as positive.
Vector3d with_fixed_sign(const Vector3d& v) {
    Eigen::Index largest = 0;
    for (Eigen::Index k = 1; k < 3; ++k)
        if (std::abs(v[k]) > std::abs(v[largest]) * (1 + 1e-9)) largest = k;
    return v[largest] < 0 ? Vector3d(-v) : v;
}

/// The rotation of a rotation-reflection about `axis`: the reflection in its plane undone.
Matrix3d reflection_free(const Matrix3d& linear, const Vector3d& axis) {
    return linear - 2 * (linear * axis) * axis.transpose();
}

void describe_plane(Isometry& out, const RigidMap& map, const Vector3d& near) {
    const Vector3d normal = with_fixed_sign(eigenvector(map.linear, -1));
    const double offset = normal.dot(map.shift) / 2;
    const Vector3d on_plane = near + (offset - normal.dot(near)) * normal;
    out.plane = Plane{to_point(on_plane), to_point(normal)};
    const Vector3d glide = map.shift - normal * normal.dot(map.shift);
    out.step = glide.norm();
}

}  // namespace

Isometry describe(SymmetryType type, const RigidMap& map, const Vector3d& near, int dimension) {
    Isometry out;
    out.dimension = dimension;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out.linear[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = map.linear(i, j);
    out.translation = to_point(map.shift);

    switch (type) {
        case SymmetryType::translation:
            out.step = map.shift.norm();
            if (out.step > 0) out.axis = Axis{to_point(near), to_point(map.shift / out.step)};
            break;
        case SymmetryType::mirror:
            describe_plane(out, map, near);
            out.step = 0;
            break;
        case SymmetryType::glide_reflection: {
            describe_plane(out, map, near);
            const Vector3d normal = to_vector(out.plane->normal);
            const Vector3d glide = map.shift - normal * normal.dot(map.shift);
            if (out.step > 0) out.axis = Axis{out.plane->point, to_point(glide / out.step)};
            break;
        }
        case SymmetryType::inversion:
            out.angle_deg = 180;
            out.center = to_point(map.shift / 2);
            break;
        case SymmetryType::half_turn:
        case SymmetryType::rotation:
        case SymmetryType::screw: {
            out.angle_deg = type == SymmetryType::half_turn ? 180 : angle_deg_of(map.linear);
            if (dimension == 2) {
                out.center = to_point(fixed_point(map.linear, map.shift, near));
                break;
            }
            const Vector3d axis = type == SymmetryType::half_turn
                                      ? with_fixed_sign(eigenvector(map.linear, 1))
                                      : rotation_axis(map.linear);
            const double step = axis.dot(map.shift);
            out.step = type == SymmetryType::screw ? std::abs(step) : 0;
            out.axis = Axis{to_point(fixed_point(map.linear, map.shift - step * axis, near)), to_point(axis)};
            break;
        }
        case SymmetryType::rotation_reflection: {
            Vector3d axis = eigenvector(map.linear, -1);
            const Matrix3d turn = reflection_free(map.linear, axis);
            out.angle_deg = angle_deg_of(turn);
            if (out.angle_deg > 0 && out.angle_deg < 180) axis = rotation_axis(turn);
            const Vector3d center = fixed_point(map.linear, map.shift, near);
            out.axis = Axis{to_point(center), to_point(axis)};
            out.plane = Plane{to_point(center), to_point(axis)};
            out.center = to_point(center);
            break;
        }
    }
    return out;
}

}  // namespace insym
