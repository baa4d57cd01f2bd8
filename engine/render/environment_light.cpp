#include "engine/render/environment_light.hpp"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "engine/gpu/transfer.hpp"
#include "engine/shading/albedo.hpp"

namespace bolt::render {

namespace {

constexpr std::uint32_t table_size = 48;

std::uint16_t half(float x) { return glm::packHalf1x16(std::clamp(x, 0.0F, 65000.0F)); }

// Copies every level of every face from one staging buffer.
Status upload_levels(gpu::Device& device, gpu::Image& image, const std::vector<shading::Cube>& levels) {
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
    const std::vector<shading::Cube> levels = shading::prefilter(radiance, size);
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

}  // namespace bolt::render
