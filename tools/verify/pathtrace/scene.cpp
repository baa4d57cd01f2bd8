#include "tools/verify/pathtrace/scene.hpp"

#include <embree3/rtcore.h>

#include <cfloat>
#include <cstring>
#include <glm/geometric.hpp>
#include <string>

#include "tools/verify/pathtrace/flatten.hpp"

namespace bolt::pathtrace {

namespace {

RTCRay make_ray(const glm::vec3& origin, const glm::vec3& direction, float distance) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = distance;
    ray.mask = 0xFFFFFFFFU;
    return ray;
}

void add_floor(Flat& flat, std::size_t material, const glm::vec3& low, const glm::vec3& high) {
    const float half = 20.0F * glm::distance(low, high);
    const glm::vec3 middle = 0.5F * (low + high);
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (const auto& [x, z] : {std::pair{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}) {
        Vertex vertex;
        vertex.position = {middle.x + static_cast<float>(x) * half, low.y,
                           middle.z + static_cast<float>(z) * half};
        vertex.normal = {0.0F, 1.0F, 0.0F};
        flat.vertices.push_back(vertex);
    }
    const auto index = static_cast<std::uint32_t>(material);
    flat.triangles.push_back({{first, first + 1, first + 2}, index, -1});
    flat.triangles.push_back({{first, first + 2, first + 3}, index, -1});
}

assets::Material floor_material() {
    assets::Material material;
    material.name = "floor";
    material.base_color = {0.4F, 0.4F, 0.4F, 1.0F};
    material.metallic = 0.0F;
    material.roughness = 0.8F;
    return material;
}

}  // namespace

void Scene::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void Scene::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Result<Scene> Scene::build(const assets::Model& model, const SceneOptions& options) {
    Flat flat = flatten(model, options.nodes);
    if (flat.triangles.empty()) return fail(ErrorCode::bad_content, "there are no triangles to be seen");
    Scene scene;
    scene.low_ = glm::vec3(FLT_MAX);
    scene.high_ = glm::vec3(-FLT_MAX);
    for (const Triangle& triangle : flat.triangles) {
        for (const std::uint32_t corner : triangle.corners) {
            scene.low_ = glm::min(scene.low_, flat.vertices[corner].position);
            scene.high_ = glm::max(scene.high_, flat.vertices[corner].position);
        }
    }
    scene.materials_ = model.materials;
    scene.materials_.emplace_back();  // the default material of glTF
    scene.materials_.push_back(floor_material());
    if (options.floor) add_floor(flat, scene.materials_.size() - 1, scene.low_, scene.high_);
    for (const assets::Material& material : scene.materials_)
        scene.transparent_ = scene.transparent_ || material.alpha_mode != assets::AlphaMode::opaque;
    BOLT_TRY_ASSIGN(auto textures, Textures::load(model));
    scene.textures_ = std::move(textures);
    scene.vertices_ = std::move(flat.vertices);
    scene.triangles_ = std::move(flat.triangles);
    scene.lights_ = std::move(flat.lights);
    BOLT_TRY(scene.build_tree());
    return scene;
}

Status Scene::build_tree() {
    // One thread builds, so that the tree, and with it the picture, is the same on every machine.
    device_.reset(rtcNewDevice("threads=1"));
    if (!device_) return fail(ErrorCode::failed, "Embree cannot be started");
    tree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices_.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles_.size()));
    if (positions == nullptr || corners == nullptr) {
        rtcReleaseGeometry(geometry);
        return fail(ErrorCode::failed, "Embree has no memory for the model");
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i)
        std::memcpy(positions + 3 * i, &vertices_[i].position, 3 * sizeof(float));
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        std::memcpy(corners + 3 * i, triangles_[i].corners.data(), 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree_.get());
    return {};
}

std::optional<Hit> Scene::cast(const glm::vec3& origin, const glm::vec3& direction) const {
    RTCRayHit query{};
    query.ray = make_ray(origin, direction, FLT_MAX);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(tree_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return Hit{query.ray.tfar, query.hit.primID, {query.hit.u, query.hit.v}};
}

bool Scene::blocked(const glm::vec3& origin, const glm::vec3& direction, float distance) const {
    RTCRay ray = make_ray(origin, direction, distance);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(tree_.get(), &context, &ray);
    return ray.tfar < 0.0F;  // Embree's sign of a hit
}

}  // namespace bolt::pathtrace
