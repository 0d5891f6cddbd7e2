#include "view/ray_scene.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

namespace insym {
namespace {

template <class Item>
void fill(RTCGeometry geometry, RTCBufferType type, unsigned slot, RTCFormat format,
          const std::vector<Item>& items) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(Item), items.size());
    if (buffer == nullptr) throw std::bad_alloc();
    std::memcpy(buffer, items.data(), items.size() * sizeof(Item));
}

RTCGeometry make_geometry(RTCDevice device, const ShadedMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions);
    fill(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles);
    rtcSetGeometryVertexAttributeCount(geometry, 1);
    fill(geometry, RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, RTC_FORMAT_FLOAT3, mesh.normals);
    rtcCommitGeometry(geometry);
    return geometry;
}

}  // namespace

RayScene::RayScene(const std::vector<Part>& parts, const std::vector<PartKind>& kinds)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    for (const Part& part : parts) {
        if (std::find(kinds.begin(), kinds.end(), part.kind) == kinds.end()) continue;
        RTCGeometry geometry = make_geometry(device_, part.mesh);
        rtcAttachGeometryByID(scene_, geometry, static_cast<unsigned>(parts_.size()));
        rtcReleaseGeometry(geometry);
        parts_.push_back(&part);
    }
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);  // no gaps between neighbours
    // By this thread alone: quick enough, and no thread of Embree's touches what another one made.
    tbb::task_arena alone(1);
    alone.execute([this] { rtcCommitScene(scene_); });
}

RayScene::~RayScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

std::optional<Hit> RayScene::first_hit(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const {
    RTCRayHit ray{};
    ray.ray.org_x = from.x();
    ray.ray.org_y = from.y();
    ray.ray.org_z = from.z();
    ray.ray.dir_x = direction.x();
    ray.ray.dir_y = direction.y();
    ray.ray.dir_z = direction.z();
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    Hit hit;
    hit.distance = ray.ray.tfar;
    hit.part = parts_[ray.hit.geomID];
    rtcInterpolate0(rtcGetGeometry(scene_, ray.hit.geomID), ray.hit.primID, ray.hit.u, ray.hit.v,
                    RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, hit.normal.data(), 3);
    hit.normal.normalize();
    return hit;
}

}  // namespace insym
