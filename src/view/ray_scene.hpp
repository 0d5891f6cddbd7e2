// Embree: what rays meet first among the triangles of some parts.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "view/drawing.hpp"

struct RTCSceneTy;
struct RTCDeviceTy;

namespace insym {

struct Hit {
    float distance = 0;
    Eigen::Vector3f normal;  ///< of unit length, either way
    const Part* part = nullptr;
};

/// Immutable once it is made; first_hit() may be called from several threads.
class RayScene {
public:
    /// The parts of `kinds`; they have to outlive the scene.
    RayScene(const std::vector<Part>& parts, const std::vector<PartKind>& kinds);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// `direction` of unit length.
    std::optional<Hit> first_hit(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const;

private:
    RTCDeviceTy* device_;
    RTCSceneTy* scene_;
    std::vector<const Part*> parts_;  ///< by Embree's number of the geometry
};

}  // namespace insym
