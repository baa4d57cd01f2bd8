#include "engine/render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "engine/assets/model.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/shading/ggx.hpp"

namespace bolt::render {

namespace {

constexpr std::uint32_t table_size = 48;

std::uint16_t half(float x) { return glm::packHalf1x16(std::clamp(x, 0.0F, 65000.0F)); }

// Uploads every level of every face from one staging buffer.
Status upload_levels(gpu::Device& device, gpu::Image& image, const std::vector<shading::CubeMap>& levels) {
    std::vector<std::uint32_t> texels;
    std::vector<VkBufferImageCopy> regions;
    for (std::uint32_t level = 0; level < levels.size(); ++level) {
        VkBufferImageCopy region{};
        region.bufferOffset = texels.size() * sizeof(std::uint32_t);
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 6};
        region.imageExtent = {levels[level].size, levels[level].size, 1};
        regions.push_back(region);
        for (const glm::vec3& texel : levels[level].texels)
            texels.push_back(glm::packF3x9_E1x5(glm::clamp(texel, 0.0F, 65000.0F)));
    }
    BOLT_TRY_ASSIGN(auto staging,
                    gpu::Buffer::create(device, texels.size() * sizeof(std::uint32_t),
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::upload));
    std::memcpy(staging.bytes().data(), texels.data(), texels.size() * sizeof(std::uint32_t));
    return gpu::submit_and_wait(device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::undefined, gpu::ResourceUse::transfer_to);
        vkCmdCopyBufferToImage(commands, staging.get(), image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               static_cast<std::uint32_t>(regions.size()), regions.data());
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::transfer_to, gpu::ResourceUse::sampled);
    });
}

}  // namespace

Result<EnvironmentLight> upload_environment(gpu::Device& device, const shading::RadianceImage& radiance,
                                            std::uint32_t size) {
    const std::vector<shading::CubeMap> levels = shading::prefilter(radiance, size);
    gpu::ImageInfo info;
    // A shared-exponent format: half the size of four half floats, and faster to read without hardware
    // support.
    info.format = VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
    info.extent = {size, size};
    info.mips = static_cast<std::uint32_t>(levels.size());
    info.layers = 6;
    info.cube = true;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    BOLT_TRY_ASSIGN(auto image, gpu::Image::create(device, info));
    BOLT_TRY(upload_levels(device, image, levels));
    return EnvironmentLight{std::move(image), shading::diffuse_harmonics(levels.front())};
}

Result<gpu::Image> upload_albedo_table(gpu::Device& device) {
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R16G16_SFLOAT;
    info.extent = {table_size, table_size};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    BOLT_TRY_ASSIGN(auto image, gpu::Image::create(device, info));
    std::vector<std::uint16_t> texels;
    for (std::uint32_t row = 0; row < table_size; ++row) {
        for (std::uint32_t column = 0; column < table_size; ++column) {
            const float roughness = static_cast<float>(row) / static_cast<float>(table_size - 1);
            const float root = static_cast<float>(column) / static_cast<float>(table_size - 1);
            const glm::vec2 albedo = shading::directional_albedo(roughness * roughness, root * root);
            texels.push_back(half(albedo.x));
            texels.push_back(half(albedo.y));
        }
    }
    BOLT_TRY(gpu::upload_image(device, image, std::as_bytes(std::span(texels))));
    return image;
}

namespace {

// Calls `visit(index)` for every node of the default scene, parents first.
template <class Visit>
void for_each_node(const assets::Model& model, const Visit& visit) {
    std::vector<int> pending(model.roots.rbegin(), model.roots.rend());
    while (!pending.empty()) {
        const auto node = static_cast<std::size_t>(pending.back());
        pending.pop_back();
        visit(node);
        pending.insert(pending.end(), model.nodes[node].children.rbegin(), model.nodes[node].children.rend());
    }
}

shared::Light make_light(const assets::Light& light, const glm::mat4& world) {
    shared::Light to{};
    const glm::vec3 forward = -glm::normalize(glm::vec3(world[2]));
    to.color = glm::vec4(light.color * light.intensity, 0.0F);
    to.direction = glm::vec4(forward, light.range);
    to.position = glm::vec4(glm::vec3(world[3]), light.type == assets::LightType::directional ? 0.0F
                                                 : light.type == assets::LightType::point     ? 1.0F
                                                                                              : 2.0F);
    const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
    to.cone.x = 1.0F / std::max(inner - outer, 1e-3F);
    to.cone.y = -outer * to.cone.x;
    return to;
}

}  // namespace

void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model,
               const assets::ModelPose& pose, const glm::mat4& world) {
    const std::vector<glm::mat4> transforms = assets::world_transforms(model, pose);
    for_each_node(model, [&](std::size_t index) {
        const assets::Node& node = model.nodes[index];
        if (node.mesh < 0) return;
        Object object;
        object.model = &gpu_model;
        object.mesh = static_cast<std::uint32_t>(node.mesh);
        object.node = static_cast<int>(index);
        // glTF 2.0, 3.7.3.3: the joints alone place a skinned mesh, not its node.
        object.world = node.skin >= 0 ? world : world * transforms[index];
        const std::vector<float>& weights = pose[index].weights;
        const bool morphs = std::any_of(weights.begin(), weights.end(), [](float w) { return w != 0.0F; });
        if (node.skin >= 0 || morphs) {
            Deformation deformation{{}, weights};
            if (node.skin >= 0)
                deformation.joints =
                    assets::joint_matrices(model.skins[static_cast<std::size_t>(node.skin)], transforms);
            object.deformation = std::make_shared<const Deformation>(std::move(deformation));
        }
        scene.objects.push_back(object);
    });
}

void add_model(Scene& scene, const assets::Model& model, const GpuModel& gpu_model, const glm::mat4& world) {
    add_model(scene, model, gpu_model, assets::rest_pose(model), world);
}

void add_lights(Scene& scene, const assets::Model& model, const glm::mat4& world) {
    add_lights(scene, model, assets::rest_pose(model), world);
}

void add_lights(Scene& scene, const assets::Model& model, const assets::ModelPose& pose,
                const glm::mat4& world) {
    const std::vector<glm::mat4> transforms = assets::world_transforms(model, pose);
    for_each_node(model, [&](std::size_t node) {
        if (model.nodes[node].light < 0) return;
        const assets::Light& light = model.lights[static_cast<std::size_t>(model.nodes[node].light)];
        scene.lights.push_back({make_light(light, world * transforms[node]), false});
    });
    const auto directional = std::find_if(scene.lights.begin(), scene.lights.end(),
                                          [](const SceneLight& l) { return l.light.position.w == 0.0F; });
    if (directional == scene.lights.end()) return;
    std::rotate(scene.lights.begin(), directional, directional + 1);
    scene.lights.front().casts_shadow = true;
}

bool casts_shadow(const Object& object) { return object.opacity >= 1.0F && !object.flat; }

bool casts_shadow(const Scene& scene) {
    return !scene.lights.empty() && scene.lights.front().casts_shadow &&
           scene.lights.front().light.position.w == 0.0F &&
           std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const Object& object) { return casts_shadow(object); });
}

BoundingBox bounds(const Object& object, const MeshPart& part) {
    return transformed(bounds(part.box, part.deformable, object.deformation.get()), object.world);
}

BoundingBox bounds(const Scene& scene) {
    BoundingBox box;
    for (const Object& object : scene.objects) {
        const MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = 0; i < range.count; ++i) {
            const BoundingBox moved = bounds(object, object.model->parts[range.first + i]);
            box.add(moved.low);
            box.add(moved.high);
        }
    }
    return box;
}

}  // namespace bolt::render
