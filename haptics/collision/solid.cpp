#include "haptics/collision/solid.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace bolt::collision {
namespace {

struct DeviceRelease {
    void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
};
struct GeometryRelease {
    void operator()(RTCGeometryTy* geometry) const { rtcReleaseGeometry(geometry); }
};

void edge_box(const RTCBoundsFunctionArguments* arguments) {
    const auto& solid = *static_cast<const Solid*>(arguments->geometryUserPtr);
    const auto& [a, b] = solid.ridges[arguments->primID].ends;
    const glm::vec3 low = glm::min(a, b);
    const glm::vec3 high = glm::max(a, b);
    *arguments->bounds_o = {low.x, low.y, low.z, 0.0F, high.x, high.y, high.z, 0.0F};
}

Result<SceneHandle> commit(RTCDevice device, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    SceneHandle scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);

    rtcAttachGeometry(scene.get(), geometry);
    rtcCommitScene(scene.get());
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        return fail(ErrorCode::failed, fmt::format("Embree could not build a contact scene (error {})",
                                                   static_cast<int>(error)));
    return scene;
}

Status build_scenes(Solid& solid) {
    const std::unique_ptr<RTCDeviceTy, DeviceRelease> device(rtcNewDevice("threads=1"));
    if (!device) return fail(ErrorCode::failed, "Embree opens no device");
    const auto new_geometry = [&](RTCGeometryType type) {
        return std::unique_ptr<RTCGeometryTy, GeometryRelease>(rtcNewGeometry(device.get(), type));
    };
    const auto triangles = new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
    const ContactMesh& mesh = solid.mesh;
    void* vertices = rtcSetNewGeometryBuffer(triangles.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(glm::vec3), mesh.vertices.size());
    void* indices = rtcSetNewGeometryBuffer(triangles.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(mesh.triangles[0]), mesh.triangles.size());
    if (vertices == nullptr || indices == nullptr)
        return fail(ErrorCode::failed, "Embree has no memory for a contact mesh");
    std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(glm::vec3));
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
    BOLT_TRY_ASSIGN(auto scene, commit(device.get(), triangles.get()));
    solid.scene = std::move(scene);
    if (solid.ridges.empty()) return {};

    const auto edges = new_geometry(RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(edges.get(), static_cast<unsigned>(solid.ridges.size()));
    rtcSetGeometryUserData(edges.get(), &solid);  // read by `edge_box` during this commit only
    rtcSetGeometryBoundsFunction(edges.get(), edge_box, nullptr);
    BOLT_TRY_ASSIGN(auto edge_scene, commit(device.get(), edges.get()));
    solid.edge_scene = std::move(edge_scene);
    return {};
}

}  // namespace

void SceneRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Result<Solid> make_solid(std::span<const ContactMesh> parts) {
    Solid solid;
    if (parts.size() > 0xffff) return fail(ErrorCode::bad_content, "more than 65,535 parts in one solid");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        append(solid.mesh, parts[i]);
        solid.part.resize(solid.mesh.triangles.size(), static_cast<std::uint32_t>(i));
    }
    if (solid.mesh.triangles.empty()) return fail(ErrorCode::bad_content, "a solid without a triangle");
    for (std::uint32_t i = 0; i < solid.mesh.sharp_edges.size(); ++i) {
        const SharpEdge& edge = solid.mesh.sharp_edges[i];
        const auto end = [&](std::size_t k) { return solid.mesh.vertices[edge.vertices[k]]; };
        if (edge.convex)
            solid.ridges.push_back(
                {{end(0), end(1)}, edge.normals, edge.inward, glm::normalize(end(1) - end(0)), i});
    }
    for (const auto& t : solid.mesh.triangles)
        solid.corners.push_back(
            {solid.mesh.vertices[t[0]], solid.mesh.vertices[t[1]], solid.mesh.vertices[t[2]]});
    solid.box = {Vec3(solid.mesh.vertices[0]), Vec3(solid.mesh.vertices[0])};
    for (const glm::vec3& v : solid.mesh.vertices) {
        solid.box.low = glm::min(solid.box.low, Vec3(v));
        solid.box.high = glm::max(solid.box.high, Vec3(v));
    }
    solid.middle = 0.5 * (solid.box.low + solid.box.high);
    for (const glm::vec3& v : solid.mesh.vertices) {
        solid.radius = std::max(solid.radius, glm::length(Vec3(v) - solid.middle));
        solid.reach = std::max(solid.reach, glm::length(Vec3(v)));
    }
    BOLT_TRY(build_scenes(solid));
    return solid;
}

bool blocked(const Solid& solid, const Vec3& from, const Vec3& to) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x);
    ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(to.x - from.x);
    ray.dir_y = static_cast<float>(to.y - from.y);
    ray.dir_z = static_cast<float>(to.z - from.z);
    ray.tfar = 1.0F;
    ray.mask = 0xffffffffU;
    rtcOccluded1(solid.scene.get(), &context, &ray);
    return ray.tfar < 0.0F;
}

}  // namespace bolt::collision
