// Spheres, tubes, cones and sheets as triangles: what cycles and axes are drawn with.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>

#include "view/shaded_mesh.hpp"

namespace insym {

void add_sphere(const Eigen::Vector3f& centre, float radius, ShadedMesh& mesh);
void add_tube(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius, ShadedMesh& mesh);
/// A tube that is interrupted, in dashes of about `dash`.
void add_dashes(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius, float dash,
                ShadedMesh& mesh);
/// An arrow's head of `length` with its tip at `tip`.
void add_cone(const Eigen::Vector3f& tip, const Eigen::Vector3f& along, float length, ShadedMesh& mesh);
/// A ring about `centre` across `normal`.
void add_ring(const Eigen::Vector3f& centre, const Eigen::Vector3f& normal, float radius, float thickness,
              ShadedMesh& mesh);
/// A flat piece with these corners, in order.
void add_sheet(const std::array<Eigen::Vector3f, 4>& corners, ShadedMesh& mesh);

/// Two directions that are square to `normal` and to each other.
std::pair<Eigen::Vector3f, Eigen::Vector3f> square_to(const Eigen::Vector3f& normal);

}  // namespace insym
