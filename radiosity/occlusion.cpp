#include "radiosity/occlusion.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace tyndall::radiosity {
namespace {

constexpr double gap = 1e-5;  // of the scene's diagonal: well above single precision's rounding

}  // namespace

struct Occlusion::Scene {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = device ? rtcNewScene(device) : nullptr;

    Scene() {
        if (!device || !scene)
            throw std::runtime_error("Embree cannot be started on this machine.");
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    }
    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
};

Occlusion::Occlusion(const mesh::BaseMesh& mesh)
    : scene_(std::make_unique<Scene>()), gap_(gap * glm::distance(mesh.hull_min, mesh.hull_max)) {
    std::vector<std::array<mesh::VertexId, 3>> triangles;
    for (const auto& facet : mesh.facets)
        if (facet.opacity == mesh::Opacity::opaque) triangles.push_back(facet.corners);
    if (!triangles.empty()) {
        RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* points = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), mesh.points.size()));
        auto* corners = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(unsigned), triangles.size()));
        for (std::size_t k = 0; k < mesh.points.size(); ++k)
            for (int axis = 0; axis < 3; ++axis)
                points[3 * k + axis] = static_cast<float>(mesh.points[k][axis]);
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) corners[3 * t + k] = triangles[t][k].value;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_->scene);
}

Occlusion::~Occlusion() = default;
Occlusion::Occlusion(Occlusion&&) noexcept = default;
Occlusion& Occlusion::operator=(Occlusion&&) noexcept = default;

bool Occlusion::blocked(Point x, Direction path) const {
    const double length = glm::length(path);
    if (length <= 2.0 * gap_) return false;
    const glm::dvec3 d = path / length;
    RTCRay ray{};
    ray.org_x = static_cast<float>(x.x);
    ray.org_y = static_cast<float>(x.y);
    ray.org_z = static_cast<float>(x.z);
    ray.dir_x = static_cast<float>(d.x);
    ray.dir_y = static_cast<float>(d.y);
    ray.dir_z = static_cast<float>(d.z);
    ray.tnear = static_cast<float>(gap_);
    ray.tfar = static_cast<float>(std::min(length - gap_, 1e30));
    ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

}  // namespace tyndall::radiosity
