// The schema of the glTF 2.0 specification, section 5 (properties reference), and of the supported
// extensions.
#include "engine/assets/read/schema.hpp"

namespace bolt::assets {

namespace {

constexpr double half_pi = 1.5707964;  // the next float above π/2

Field text(const char* name, bool required = false) {
    return {.name = name, .kind = FieldType::string, .required = required};
}
Field flag(const char* name) { return {.name = name, .kind = FieldType::boolean}; }
Field whole(const char* name, double low = 0, bool required = false, double high = DBL_MAX) {
    return {.name = name, .kind = FieldType::integer, .required = required, .low = low, .high = high};
}
Field real(const char* name, double low = -DBL_MAX, double high = DBL_MAX, bool required = false) {
    return {.name = name, .kind = FieldType::number, .required = required, .low = low, .high = high};
}
Field reals(const char* name, std::size_t length, double low = -DBL_MAX, double high = DBL_MAX) {
    return {.name = name, .kind = FieldType::numbers, .length = length, .low = low, .high = high};
}
Field index(const char* name, const char* section, bool required = false) {
    return {.name = name, .kind = FieldType::index, .section = section, .required = required};
}
Field indices(const char* name, const char* section, bool required = false) {
    return {.name = name, .kind = FieldType::indices, .section = section, .required = required};
}
Field object(const char* name, const ObjectSchema& schema, bool required = false) {
    return {.name = name, .kind = FieldType::object, .schema = &schema, .required = required};
}
Field list(const char* name, const ObjectSchema& schema, bool required = false) {
    return {.name = name, .kind = FieldType::list, .schema = &schema, .required = required};
}

const ObjectSchema& asset() {
    static const ObjectSchema schema = {text("version", true), text("minVersion"), text("generator"),
                                        text("copyright")};
    return schema;
}

const ObjectSchema& buffer() {
    static const ObjectSchema schema = {text("uri"), whole("byteLength", 1, true), text("name")};
    return schema;
}

const ObjectSchema& buffer_view() {
    static const ObjectSchema schema = {index("buffer", "buffers", true), whole("byteOffset"),
                                        whole("byteLength", 1, true), whole("byteStride", 4, false, 252),
                                        text("name")};
    return schema;
}

const ObjectSchema& accessor() {
    static const ObjectSchema sparse_indices = {index("bufferView", "bufferViews", true), whole("byteOffset"),
                                                whole("componentType", 0, true)};
    static const ObjectSchema sparse_values = {index("bufferView", "bufferViews", true), whole("byteOffset")};
    static const ObjectSchema sparse = {whole("count", 1, true), object("indices", sparse_indices, true),
                                        object("values", sparse_values, true)};
    static const ObjectSchema schema = {index("bufferView", "bufferViews"),
                                        whole("byteOffset"),
                                        whole("componentType", 5120, true, 5126),
                                        flag("normalized"),
                                        whole("count", 1, true),
                                        text("type", true),
                                        reals("min", 0),
                                        reals("max", 0),
                                        object("sparse", sparse),
                                        text("name")};
    return schema;
}

const ObjectSchema& primitive() {
    static const ObjectSchema schema = {
        {.name = "attributes", .kind = FieldType::index_map, .section = "accessors", .required = true},
        index("indices", "accessors"),
        index("material", "materials"),
        whole("mode", 0, false, 6),
        {.name = "targets", .kind = FieldType::list, .section = "accessors"}};
    return schema;
}

const ObjectSchema& mesh() {
    static const ObjectSchema schema = {list("primitives", primitive(), true), reals("weights", 0),
                                        text("name")};
    return schema;
}

const ObjectSchema& node() {
    static const ObjectSchema light = {index("light", "/extensions/KHR_lights_punctual/lights", true)};
    static const ObjectSchema extensions = {object("KHR_lights_punctual", light)};
    static const ObjectSchema schema = {index("camera", "cameras"),
                                        indices("children", "nodes"),
                                        index("skin", "skins"),
                                        reals("matrix", 16),
                                        index("mesh", "meshes"),
                                        reals("rotation", 4, -1.0, 1.0),
                                        reals("scale", 3),
                                        reals("translation", 3),
                                        reals("weights", 0),
                                        object("extensions", extensions),
                                        text("name")};
    return schema;
}

// A reference to a texture, with the factor that comes along with it.
const ObjectSchema& texture_info() {
    static const ObjectSchema transform = {reals("offset", 2), real("rotation"), reals("scale", 2),
                                           whole("texCoord", 0, false, 1)};
    static const ObjectSchema extensions = {object("KHR_texture_transform", transform)};
    static const ObjectSchema schema = {index("index", "textures", true), whole("texCoord", 0, false, 1),
                                        real("scale"), real("strength", 0.0, 1.0),
                                        object("extensions", extensions)};
    return schema;
}

Field texture_info(const char* name) { return object(name, texture_info()); }

const ObjectSchema& material_extensions() {
    static const ObjectSchema clearcoat = {
        real("clearcoatFactor", 0.0, 1.0), texture_info("clearcoatTexture"),
        real("clearcoatRoughnessFactor", 0.0, 1.0), texture_info("clearcoatRoughnessTexture"),
        texture_info("clearcoatNormalTexture")};
    static const ObjectSchema anisotropy = {real("anisotropyStrength", 0.0, 1.0), real("anisotropyRotation"),
                                            texture_info("anisotropyTexture")};
    static const ObjectSchema ior = {real("ior", 0.0)};
    static const ObjectSchema specular = {real("specularFactor", 0.0, 1.0), texture_info("specularTexture"),
                                          reals("specularColorFactor", 3, 0.0),
                                          texture_info("specularColorTexture")};
    static const ObjectSchema strength = {real("emissiveStrength", 0.0)};
    static const ObjectSchema schema = {
        object("KHR_materials_clearcoat", clearcoat), object("KHR_materials_anisotropy", anisotropy),
        object("KHR_materials_ior", ior), object("KHR_materials_specular", specular),
        object("KHR_materials_emissive_strength", strength)};
    return schema;
}

const ObjectSchema& material() {
    static const ObjectSchema pbr = {reals("baseColorFactor", 4, 0.0, 1.0), texture_info("baseColorTexture"),
                                     real("metallicFactor", 0.0, 1.0), real("roughnessFactor", 0.0, 1.0),
                                     texture_info("metallicRoughnessTexture")};
    static const ObjectSchema schema = {object("pbrMetallicRoughness", pbr),
                                        texture_info("normalTexture"),
                                        texture_info("occlusionTexture"),
                                        texture_info("emissiveTexture"),
                                        reals("emissiveFactor", 3, 0.0, 1.0),
                                        text("alphaMode"),
                                        real("alphaCutoff", 0.0),
                                        flag("doubleSided"),
                                        object("extensions", material_extensions()),
                                        text("name")};
    return schema;
}

const ObjectSchema& image() {
    static const ObjectSchema schema = {text("uri"), text("mimeType"), index("bufferView", "bufferViews"),
                                        text("name")};
    return schema;
}

const ObjectSchema& sampler() {
    static const ObjectSchema schema = {whole("magFilter"), whole("minFilter"), whole("wrapS"),
                                        whole("wrapT")};
    return schema;
}

const ObjectSchema& texture() {
    static const ObjectSchema schema = {index("sampler", "samplers"), index("source", "images"),
                                        text("name")};
    return schema;
}

const ObjectSchema& skin() {
    static const ObjectSchema schema = {index("inverseBindMatrices", "accessors"), index("skeleton", "nodes"),
                                        indices("joints", "nodes", true), text("name")};
    return schema;
}

const ObjectSchema& animation() {
    static const ObjectSchema target = {index("node", "nodes"), text("path", true)};
    static const ObjectSchema channel = {whole("sampler", 0, true), object("target", target, true)};
    static const ObjectSchema key_frames = {index("input", "accessors", true), text("interpolation"),
                                            index("output", "accessors", true)};
    static const ObjectSchema schema = {list("channels", channel, true), list("samplers", key_frames, true),
                                        text("name")};
    return schema;
}

const ObjectSchema& camera() {
    static const ObjectSchema perspective = {real("aspectRatio", 1e-6), real("yfov", 1e-6, 3.14159265, true),
                                             real("zfar", 1e-12), real("znear", 1e-12, DBL_MAX, true)};
    static const ObjectSchema orthographic = {
        real("xmag", -DBL_MAX, DBL_MAX, true), real("ymag", -DBL_MAX, DBL_MAX, true),
        real("zfar", 1e-12, DBL_MAX, true), real("znear", 0.0, DBL_MAX, true)};
    static const ObjectSchema schema = {text("type", true), object("perspective", perspective),
                                        object("orthographic", orthographic), text("name")};
    return schema;
}

const ObjectSchema& extensions() {
    static const ObjectSchema spot = {real("innerConeAngle", 0.0, half_pi),
                                      real("outerConeAngle", 0.0, half_pi)};
    static const ObjectSchema light = {reals("color", 3, 0.0), real("intensity", 0.0), text("type", true),
                                       real("range", 1e-12),   object("spot", spot),   text("name")};
    static const ObjectSchema punctual = {list("lights", light, true)};
    static const ObjectSchema schema = {object("KHR_lights_punctual", punctual)};
    return schema;
}

const ObjectSchema& scene() {
    static const ObjectSchema schema = {indices("nodes", "nodes"), text("name")};
    return schema;
}

}  // namespace

// Sections come before what points into them, so that the first error names the cause.
const ObjectSchema& root_schema() {
    static const ObjectSchema schema = {object("asset", asset(), true),
                                        {.name = "extensionsUsed", .kind = FieldType::strings},
                                        {.name = "extensionsRequired", .kind = FieldType::strings},
                                        list("buffers", buffer()),
                                        list("bufferViews", buffer_view()),
                                        list("accessors", accessor()),
                                        list("images", image()),
                                        list("samplers", sampler()),
                                        list("textures", texture()),
                                        list("materials", material()),
                                        list("meshes", mesh()),
                                        list("cameras", camera()),
                                        object("extensions", extensions()),
                                        list("nodes", node()),
                                        list("skins", skin()),
                                        list("animations", animation()),
                                        list("scenes", scene()),
                                        index("scene", "scenes")};
    return schema;
}

}  // namespace bolt::assets
