// Reads materials, textures and the media types of images.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

namespace {

using tinygltf::ExtensionMap;
using tinygltf::Value;

glm::vec2 vec2(const Value& v) {
    return {static_cast<float>(v.Get(0).GetNumberAsDouble()),
            static_cast<float>(v.Get(1).GetNumberAsDouble())};
}
glm::vec3 vec3(const Value& v) { return {vec2(v), static_cast<float>(v.Get(2).GetNumberAsDouble())}; }
glm::vec3 vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }
glm::vec4 vec4(const std::vector<double>& v) { return {v[0], v[1], v[2], v[3]}; }

void set(float& target, const Value& owner, const char* key) {
    if (owner.Has(key)) target = static_cast<float>(owner.Get(key).GetNumberAsDouble());
}

void set_transform(TextureRef& ref, const Value& transform) {
    if (transform.Has("offset")) ref.offset = vec2(transform.Get("offset"));
    if (transform.Has("scale")) ref.scale = vec2(transform.Get("scale"));
    if (transform.Has("texCoord")) ref.texcoord = transform.Get("texCoord").GetNumberAsInt();
    set(ref.rotation, transform, "rotation");
}

// Converts a texture reference of the core material, which tinygltf stores in three similar structures.
template <class Info>
TextureRef reference(const Info& info) {
    TextureRef ref;
    ref.texture = info.index;
    ref.texcoord = info.texCoord;
    const auto transform = info.extensions.find("KHR_texture_transform");
    if (transform != info.extensions.end()) set_transform(ref, transform->second);
    return ref;
}

// Converts a texture reference in an extension, which tinygltf stores as a generic value.
void set(TextureRef& ref, const Value& owner, const char* key) {
    if (!owner.Has(key)) return;
    const Value& info = owner.Get(key);
    ref.texture = info.Get("index").GetNumberAsInt();
    if (info.Has("texCoord")) ref.texcoord = info.Get("texCoord").GetNumberAsInt();
    if (!info.Has("extensions")) return;
    const Value& extensions = info.Get("extensions");
    if (extensions.Has("KHR_texture_transform")) set_transform(ref, extensions.Get("KHR_texture_transform"));
}

void read_extensions(const ExtensionMap& extensions, Material& m) {
    const auto if_present = [&](const char* name, auto read) {
        const auto extension = extensions.find(name);
        if (extension != extensions.end()) read(extension->second);
    };
    if_present("KHR_materials_clearcoat", [&](const Value& v) {
        set(m.clearcoat, v, "clearcoatFactor");
        set(m.clearcoat_texture, v, "clearcoatTexture");
        set(m.clearcoat_roughness, v, "clearcoatRoughnessFactor");
        set(m.clearcoat_roughness_texture, v, "clearcoatRoughnessTexture");
        set(m.clearcoat_normal_texture, v, "clearcoatNormalTexture");
    });
    if_present("KHR_materials_anisotropy", [&](const Value& v) {
        set(m.anisotropy, v, "anisotropyStrength");
        set(m.anisotropy_rotation, v, "anisotropyRotation");
        set(m.anisotropy_texture, v, "anisotropyTexture");
    });
    if_present("KHR_materials_ior", [&](const Value& v) { set(m.ior, v, "ior"); });
    if_present("KHR_materials_specular", [&](const Value& v) {
        set(m.specular, v, "specularFactor");
        set(m.specular_texture, v, "specularTexture");
        if (v.Has("specularColorFactor")) m.specular_color = vec3(v.Get("specularColorFactor"));
        set(m.specular_color_texture, v, "specularColorTexture");
    });
    if_present("KHR_materials_emissive_strength",
               [&](const Value& v) { set(m.emissive_strength, v, "emissiveStrength"); });
}

}  // namespace

Status read_materials(const Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.materials.size(); ++i) {
        const tinygltf::Material& from = document.gltf.materials[i];
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        Material m;
        m.name = from.name;
        m.base_color = vec4(pbr.baseColorFactor);
        m.metallic = static_cast<float>(pbr.metallicFactor);
        m.roughness = static_cast<float>(pbr.roughnessFactor);
        m.base_color_texture = reference(pbr.baseColorTexture);
        m.metallic_roughness_texture = reference(pbr.metallicRoughnessTexture);
        m.normal_texture = reference(from.normalTexture);
        m.normal_scale = static_cast<float>(from.normalTexture.scale);
        m.occlusion_texture = reference(from.occlusionTexture);
        m.occlusion_strength = static_cast<float>(from.occlusionTexture.strength);
        m.emissive_texture = reference(from.emissiveTexture);
        m.emissive = vec3(from.emissiveFactor);
        m.alpha_cutoff = static_cast<float>(from.alphaCutoff);
        m.double_sided = from.doubleSided;
        if (from.alphaMode == "MASK") {
            m.alpha_mode = AlphaMode::mask;
        } else if (from.alphaMode == "BLEND") {
            m.alpha_mode = AlphaMode::blend;
        } else if (from.alphaMode != "OPAQUE") {
            return error_at(document, fmt::format("/materials/{}/alphaMode", i),
                            "is '" + from.alphaMode + "'", "OPAQUE, MASK or BLEND");
        }
        read_extensions(from.extensions, m);
        if (m.ior != 0.0F && m.ior < 1.0F)
            return error_at(document, fmt::format("/materials/{}/extensions/KHR_materials_ior/ior", i),
                            "is less than the index of a vacuum", "0 or at least 1");
        model.materials.push_back(std::move(m));
    }
    return {};
}

namespace {

Status set_wrap(const Document& document, std::size_t sampler, const char* key, int value, Wrap& wrap) {
    switch (value) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            wrap = Wrap::repeat;
            return {};
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            wrap = Wrap::clamp;
            return {};
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            wrap = Wrap::mirror;
            return {};
        default:
            break;
    }
    return error_at(document, fmt::format("/samplers/{}/{}", sampler, key),
                    fmt::format("{} is not a wrapping mode", value), "10497, 33071 or 33648");
}

Status set_filters(const Document& document, std::size_t sampler, int mag, int min, Texture& texture) {
    const std::string pointer = fmt::format("/samplers/{}", sampler);
    if (mag != -1 && mag != TINYGLTF_TEXTURE_FILTER_NEAREST && mag != TINYGLTF_TEXTURE_FILTER_LINEAR)
        return error_at(document, pointer + "/magFilter", fmt::format("{} is not a filter", mag),
                        "9728 or 9729");
    texture.mag = mag == TINYGLTF_TEXTURE_FILTER_NEAREST ? Filter::nearest : Filter::linear;
    switch (min) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_LINEAR:
            texture.mipmapped = false;
            break;
        case -1:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
            break;
        default:
            return error_at(document, pointer + "/minFilter", fmt::format("{} is not a filter", min),
                            "9728, 9729 or 9984 to 9987");
    }
    if (min == TINYGLTF_TEXTURE_FILTER_NEAREST || min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
        min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR)
        texture.min = Filter::nearest;
    if (min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
        min == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST)
        texture.mip = Filter::nearest;
    return {};
}

// Detects the type from the first bytes, because a file's declared type may be wrong.
const char* media_type(const std::vector<std::uint8_t>& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG\r\n\x1A\n")) return "image/png";
    if (text.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
    return nullptr;
}

}  // namespace

Status read_textures(Document& document, Model& model) {
    for (std::size_t i = 0; i < document.images.size(); ++i) {
        Bitmap image;
        image.name = document.json["images"][i].value("name", "");
        const char* type = media_type(document.images[i]);
        // Optional extensions may add images of other types, to which no core texture refers.
        const bool used = std::any_of(document.gltf.textures.begin(), document.gltf.textures.end(),
                                      [i](const auto& t) { return t.source == static_cast<int>(i); });
        if (type == nullptr && used)
            return error_at(document, fmt::format("/images/{}", i), "is neither a PNG nor a JPEG file");
        image.mime_type = type != nullptr ? type : "application/octet-stream";
        image.encoded = std::move(document.images[i]);
        model.images.push_back(std::move(image));
    }
    for (const tinygltf::Texture& from : document.gltf.textures) {
        Texture texture;
        texture.image = from.source;
        if (from.sampler >= 0) {
            const auto index = static_cast<std::size_t>(from.sampler);
            const tinygltf::Sampler& sampler = document.gltf.samplers[index];
            Status status = set_filters(document, index, sampler.magFilter, sampler.minFilter, texture);
            if (status) status = set_wrap(document, index, "wrapS", sampler.wrapS, texture.wrap_s);
            if (status) status = set_wrap(document, index, "wrapT", sampler.wrapT, texture.wrap_t);
            if (!status) return status;
        }
        model.textures.push_back(texture);
    }
    return {};
}

}  // namespace bolt::assets
