#include "engine/render/gpu_layout.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "engine/assets/image.hpp"
#include "engine/assets/model.hpp"
#include "engine/gpu/resources.hpp"

namespace bolt::render {

namespace {

std::int16_t snorm(float x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0F, 1.0F) * 32767.0F));
}

void set(std::int16_t (&to)[4], const glm::vec3& v, float w) {
    to[0] = snorm(v.x);
    to[1] = snorm(v.y);
    to[2] = snorm(v.z);
    to[3] = snorm(w);
}

VertexAttributes attributes_of(const assets::Primitive& p, std::uint32_t i, const glm::vec3& normal,
                               const std::vector<glm::vec4>& tangents) {
    VertexAttributes a{};
    set(a.normal, normal, 0.0F);
    if (!tangents.empty()) set(a.tangent, glm::vec3(tangents[i]), tangents[i].w);
    if (!p.texcoords[0].empty()) {
        a.texcoord[0] = p.texcoords[0][i].x;
        a.texcoord[1] = p.texcoords[0][i].y;
    }
    const glm::vec4 color = p.colors.empty() ? glm::vec4(1.0F) : glm::clamp(p.colors[i], 0.0F, 1.0F);
    for (int c = 0; c < 4; ++c) a.color[c] = static_cast<std::uint8_t>(std::lround(color[c] * 255.0F));
    return a;
}

// Brushed metal needs a direction along the surface. For normal maps the shader derives one itself.
bool needs_tangents(const assets::Primitive& p, const assets::Material& material, std::size_t set) {
    return p.tangents.empty() && material.anisotropy > 0.0F && !p.texcoords[set].empty();
}

}  // namespace

void copy_with_normal(Vertices& v, std::uint32_t source, const glm::vec3& normal) {
    v.positions.push_back(glm::vec3(v.positions[source]));
    v.sources.push_back(std::uint32_t{v.sources[source]});
    v.attributes.push_back(VertexAttributes(v.attributes[source]));
    set(v.attributes.back().normal, normal, 0.0F);
}

std::vector<glm::vec4> make_tangents(const assets::Primitive& p, std::size_t set) {
    const std::vector<std::uint32_t> triangles = assets::triangle_indices(p);
    const std::vector<glm::vec2>& uv = p.texcoords[set];
    std::vector<glm::vec3> along(p.positions.size(), glm::vec3(0.0F)), up(along);
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const std::uint32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
        const glm::vec2 u = uv[b] - uv[a], v = uv[c] - uv[a];
        const glm::vec3 x = p.positions[b] - p.positions[a], y = p.positions[c] - p.positions[a];
        // Divides only by the sign of the triangle's texture area, so that large triangles have more weight.
        const float side = u.x * v.y - u.y * v.x < 0.0F ? -1.0F : 1.0F;
        for (const std::uint32_t corner : {a, b, c}) {
            along[corner] += side * (x * v.y - y * u.y);
            up[corner] -= side * (y * u.x - x * v.x);  // against v, which grows downwards
        }
    }
    std::vector<glm::vec4> tangents;
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        const glm::vec3 n = p.normals.empty() ? glm::vec3(0.0F) : p.normals[i];
        const glm::vec3 t = along[i] - glm::dot(along[i], n) * n;
        const float length = glm::length(t);
        const float side = glm::dot(glm::cross(n, t), up[i]) < 0.0F ? -1.0F : 1.0F;
        tangents.emplace_back(length > 0.0F ? t / length : glm::vec3(0.0F), side);
    }
    return tangents;
}

Vertices make_vertices(const assets::Primitive& p, const assets::Material& material) {
    Vertices v;
    const std::vector<std::uint32_t> triangles = assets::triangle_indices(p);
    const auto uv_set = static_cast<std::size_t>(material.normal_texture.texcoord & 1);
    const std::vector<glm::vec4> generated_tangents =
        needs_tangents(p, material, uv_set) ? make_tangents(p, uv_set) : std::vector<glm::vec4>();
    const std::vector<glm::vec4>& tangents = p.tangents.empty() ? generated_tangents : p.tangents;
    v.tangents = !tangents.empty();
    if (!p.normals.empty()) {
        v.positions = p.positions;
        v.indices = triangles;
        v.sources.resize(p.positions.size());
        std::iota(v.sources.begin(), v.sources.end(), 0U);
        v.attributes.reserve(p.positions.size());
        for (const std::uint32_t i : v.sources)
            v.attributes.push_back(attributes_of(p, i, p.normals[i], tangents));
        return v;
    }
    v.positions.reserve(triangles.size());
    v.attributes.reserve(triangles.size());
    v.indices.reserve(triangles.size());
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const glm::vec3 a = p.positions[triangles[t]], b = p.positions[triangles[t + 1]],
                        c = p.positions[triangles[t + 2]];
        const glm::vec3 across = glm::cross(b - a, c - a);
        const float area = glm::length(across);
        const glm::vec3 normal = area > 0.0F ? across / area : glm::vec3(0.0F, 1.0F, 0.0F);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t source = triangles[t + k];
            v.indices.push_back(static_cast<std::uint32_t>(v.positions.size()));
            v.positions.push_back(p.positions[source]);
            v.sources.push_back(source);
            v.attributes.push_back(attributes_of(p, source, normal, tangents));
        }
    }
    return v;
}

namespace {

// Returns the references in the order of shared::Material::uv. The first five have one feature bit each, from
// SCENE_BASE_MAP on.
std::array<const assets::TextureRef*, 11> references(const assets::Material& m) {
    return {&m.base_color_texture,
            &m.metallic_roughness_texture,
            &m.normal_texture,
            &m.occlusion_texture,
            &m.emissive_texture,
            &m.clearcoat_texture,
            &m.clearcoat_roughness_texture,
            &m.clearcoat_normal_texture,
            &m.anisotropy_texture,
            &m.specular_texture,
            &m.specular_color_texture};
}

// KHR_texture_transform: scale, then rotate, then translate.
void set_uv(shared::Material& to, std::size_t map, const assets::TextureRef& t) {
    const float c = std::cos(t.rotation), s = std::sin(t.rotation);
    to.uv[2 * map] = {c * t.scale.x, s * t.scale.y, t.offset.x, static_cast<float>(t.texcoord & 1)};
    to.uv[2 * map + 1] = {-s * t.scale.x, c * t.scale.y, t.offset.y, 0.0F};
}

VkSamplerAddressMode address_mode(assets::Wrap wrap) {
    switch (wrap) {
        case assets::Wrap::clamp:
            return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        case assets::Wrap::mirror:
            return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case assets::Wrap::repeat:
            break;
    }
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

// Converts to eight bits and four channels.
std::vector<std::uint8_t> four_channels(const assets::Bitmap& image) {
    const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const auto channels = static_cast<std::size_t>(image.channels);
    std::vector<std::uint8_t> texels(4 * count, 255);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 4; ++c) {
            const std::size_t from = channels >= 3 ? c : c < 3 ? 0 : 1;  // grey, or grey with alpha
            if (from < channels) texels[4 * i + c] = image.pixels[channels * i + from];
        }
    return texels;
}

Result<gpu::Image> upload_texels(gpu::Device& device, std::uint32_t width, std::uint32_t height, bool srgb,
                                 bool mips, std::span<const std::uint8_t> texels) {
    gpu::ImageInfo info;
    info.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    info.extent = {width, height};
    info.mips = mips ? static_cast<std::uint32_t>(std::bit_width(std::max(width, height))) : 1;
    info.usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    BOLT_TRY_ASSIGN(auto image, gpu::Image::create(device, info));
    BOLT_TRY(gpu::upload_image(device, image, std::as_bytes(texels)));
    return image;
}

}  // namespace

shared::Material make_material(const assets::Material& m) {
    shared::Material to{};
    to.base_color = m.base_color;
    to.emissive = glm::vec4(m.emissive * m.emissive_strength, m.alpha_cutoff);
    to.specular_color = glm::vec4(m.specular_color, m.specular);
    to.metallic = m.metallic;
    to.roughness = m.roughness;
    to.coat = m.clearcoat;
    to.coat_roughness = m.clearcoat_roughness;
    const float r = (m.ior - 1.0F) / (m.ior + 1.0F);
    to.f0 = r * r;
    to.anisotropy = m.anisotropy;
    to.anisotropy_rotation = m.anisotropy_rotation;
    to.normal_scale = m.normal_scale;
    to.occlusion_strength = m.occlusion_strength;
    const auto maps = references(m);
    for (std::size_t i = 0; i < maps.size(); ++i) set_uv(to, i, *maps[i]);
    return to;
}

std::uint32_t features_of(const assets::Material& m) {
    std::uint32_t features = 0;
    const auto maps = references(m);
    for (std::size_t i = 0; i < 5; ++i)
        if (maps[i]->texture >= 0) features |= 1U << i;
    const auto has = [](const assets::TextureRef& map) { return map.texture >= 0; };
    if (m.clearcoat > 0.0F) {
        features |= SCENE_COAT;
        if (has(m.clearcoat_texture) || has(m.clearcoat_roughness_texture)) features |= SCENE_COAT_MAPS;
        if (has(m.clearcoat_normal_texture)) features |= SCENE_COAT_NORMAL_MAP;
    }
    if (m.anisotropy > 0.0F) {
        features |= SCENE_ANISOTROPY;
        if (has(m.anisotropy_texture)) features |= SCENE_ANISOTROPY_MAP;
    }
    if (has(m.specular_texture) || has(m.specular_color_texture)) features |= SCENE_SPECULAR_MAPS;
    if (std::any_of(maps.begin(), maps.end(),
                    [&](const assets::TextureRef* map) { return has(*map) && (map->texcoord & 1) != 0; }))
        features |= SCENE_SECOND_UV;
    if (m.alpha_mode == assets::AlphaMode::mask) features |= SCENE_MASK;
    if (m.alpha_mode == assets::AlphaMode::blend) features |= SCENE_BLEND;
    return features;
}

MaterialMaps maps_of(const assets::Material& m) {
    MaterialMaps maps;
    const auto from = references(m);
    for (std::size_t i = 0; i < from.size(); ++i) maps.textures[i] = from[i]->texture;
    maps.blends = m.alpha_mode == assets::AlphaMode::blend;
    maps.double_sided = m.double_sided;
    return maps;
}

Result<std::vector<GpuTexture>> upload_textures(gpu::Device& device, const assets::Model& model) {
    // A texture is converted from sRGB if at least one material uses it as a colour map.
    std::vector<bool> color(model.textures.size(), false);
    for (const assets::Material& material : model.materials)
        for (const assets::TextureRef* ref :
             {&material.base_color_texture, &material.emissive_texture, &material.specular_color_texture})
            if (ref->texture >= 0) color[static_cast<std::size_t>(ref->texture)] = true;
    std::vector<GpuTexture> textures;
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
        const assets::Texture& texture = model.textures[i];
        if (texture.image < 0) {  // the image's format is known only to an extension
            BOLT_TRY_ASSIGN(auto white, plain_texture(device, {255, 255, 255, 255}));
            textures.push_back(std::move(white));
            continue;
        }
        assets::Bitmap image = model.images[static_cast<std::size_t>(texture.image)];
        BOLT_TRY(assets::decode(image));
        BOLT_TRY_ASSIGN(auto uploaded, upload_texels(device, static_cast<std::uint32_t>(image.width),
                                                     static_cast<std::uint32_t>(image.height), color[i],
                                                     texture.mipmapped, four_channels(image)));
        gpu::SamplerInfo info;
        info.filter = texture.mag == assets::Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
        info.min_filter = texture.min == assets::Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
        info.mips = texture.mip == assets::Filter::nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                           : VK_SAMPLER_MIPMAP_MODE_LINEAR;
        info.address = address_mode(texture.wrap_s);
        info.address_v = address_mode(texture.wrap_t);
        info.anisotropy = 8.0F;
        BOLT_TRY_ASSIGN(auto sampler, gpu::make_sampler(device, info));
        textures.push_back({std::move(uploaded), std::move(sampler)});
    }
    return textures;
}

Result<GpuTexture> plain_texture(gpu::Device& device, const std::array<std::uint8_t, 4>& texel) {
    BOLT_TRY_ASSIGN(auto image, upload_texels(device, 1, 1, false, false, texel));
    BOLT_TRY_ASSIGN(auto sampler, gpu::make_sampler(device, {}));
    return GpuTexture{std::move(image), std::move(sampler)};
}

}  // namespace bolt::render
