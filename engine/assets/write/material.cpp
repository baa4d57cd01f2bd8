// Writes materials with their texture references and extensions.
#include "engine/assets/write/writer.hpp"

namespace bolt::assets {

namespace {

bool has_transform(const TextureRef& ref) {
    return ref.offset != glm::vec2(0.0F) || ref.rotation != 0.0F || ref.scale != glm::vec2(1.0F);
}

void set_texture(GlbWriter& writer, Json& owner, const char* key, const TextureRef& ref) {
    if (ref.texture < 0) return;
    Json info = {{"index", ref.texture}};
    if (ref.texcoord != 0) info["texCoord"] = ref.texcoord;
    if (has_transform(ref)) {
        Json transform = Json::object();
        if (ref.offset != glm::vec2(0.0F)) transform["offset"] = array(ref.offset);
        if (ref.rotation != 0.0F) transform["rotation"] = json_number(ref.rotation);
        if (ref.scale != glm::vec2(1.0F)) transform["scale"] = array(ref.scale);
        info["extensions"]["KHR_texture_transform"] = std::move(transform);
        writer.used_extensions.insert("KHR_texture_transform");
    }
    owner[key] = std::move(info);
}

// Sets a factor if it differs from glTF's default.
void set(Json& owner, const char* key, float value, float default_value) {
    if (value != default_value) owner[key] = json_number(value);
}

Json clearcoat(GlbWriter& writer, const Material& m) {
    Json json = Json::object();
    set(json, "clearcoatFactor", m.clearcoat, 0.0F);
    set_texture(writer, json, "clearcoatTexture", m.clearcoat_texture);
    set(json, "clearcoatRoughnessFactor", m.clearcoat_roughness, 0.0F);
    set_texture(writer, json, "clearcoatRoughnessTexture", m.clearcoat_roughness_texture);
    set_texture(writer, json, "clearcoatNormalTexture", m.clearcoat_normal_texture);
    return json;
}

Json anisotropy(GlbWriter& writer, const Material& m) {
    Json json = Json::object();
    set(json, "anisotropyStrength", m.anisotropy, 0.0F);
    set(json, "anisotropyRotation", m.anisotropy_rotation, 0.0F);
    set_texture(writer, json, "anisotropyTexture", m.anisotropy_texture);
    return json;
}

Json specular(GlbWriter& writer, const Material& m) {
    Json json = Json::object();
    set(json, "specularFactor", m.specular, 1.0F);
    set_texture(writer, json, "specularTexture", m.specular_texture);
    if (m.specular_color != glm::vec3(1.0F)) json["specularColorFactor"] = array(m.specular_color);
    set_texture(writer, json, "specularColorTexture", m.specular_color_texture);
    return json;
}

void set_extension(GlbWriter& writer, Json& material, const char* name, Json extension) {
    if (extension.empty()) return;
    material["extensions"][name] = std::move(extension);
    writer.used_extensions.insert(name);
}

Json metallic_roughness(GlbWriter& writer, const Material& m) {
    Json pbr = Json::object();
    if (m.base_color != glm::vec4(1.0F)) pbr["baseColorFactor"] = array(m.base_color);
    set_texture(writer, pbr, "baseColorTexture", m.base_color_texture);
    set(pbr, "metallicFactor", m.metallic, 1.0F);
    set(pbr, "roughnessFactor", m.roughness, 1.0F);
    set_texture(writer, pbr, "metallicRoughnessTexture", m.metallic_roughness_texture);
    return pbr;
}

}  // namespace

Json write_material(GlbWriter& writer, const Material& m) {
    Json json = Json::object();
    if (!m.name.empty()) json["name"] = m.name;
    if (Json pbr = metallic_roughness(writer, m); !pbr.empty()) json["pbrMetallicRoughness"] = std::move(pbr);
    set_texture(writer, json, "normalTexture", m.normal_texture);
    if (json.contains("normalTexture")) set(json["normalTexture"], "scale", m.normal_scale, 1.0F);
    set_texture(writer, json, "occlusionTexture", m.occlusion_texture);
    if (json.contains("occlusionTexture"))
        set(json["occlusionTexture"], "strength", m.occlusion_strength, 1.0F);
    set_texture(writer, json, "emissiveTexture", m.emissive_texture);
    if (m.emissive != glm::vec3(0.0F)) json["emissiveFactor"] = array(m.emissive);
    if (m.alpha_mode != AlphaMode::opaque)
        json["alphaMode"] = m.alpha_mode == AlphaMode::mask ? "MASK" : "BLEND";
    if (m.alpha_mode == AlphaMode::mask) set(json, "alphaCutoff", m.alpha_cutoff, 0.5F);
    if (m.double_sided) json["doubleSided"] = true;

    set_extension(writer, json, "KHR_materials_clearcoat", clearcoat(writer, m));
    set_extension(writer, json, "KHR_materials_anisotropy", anisotropy(writer, m));
    set_extension(writer, json, "KHR_materials_specular", specular(writer, m));
    Json ior = Json::object();
    set(ior, "ior", m.ior, 1.5F);
    set_extension(writer, json, "KHR_materials_ior", std::move(ior));
    Json strength = Json::object();
    set(strength, "emissiveStrength", m.emissive_strength, 1.0F);
    set_extension(writer, json, "KHR_materials_emissive_strength", std::move(strength));
    return json;
}

}  // namespace bolt::assets
