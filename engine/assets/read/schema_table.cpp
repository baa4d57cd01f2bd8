// The schema of the glTF 2.0 specification, section 5 (properties reference), and of the supported
// extensions.
#include "engine/assets/read/schema.hpp"

namespace bolt::assets {

namespace {

constexpr double half_pi = 1.5707964;  // the next float above π/2

Property string(const char* name, bool required = false) {
    return {.name = name, .type = PropertyType::string, .required = required};
}
Property boolean(const char* name) { return {.name = name, .type = PropertyType::boolean}; }
Property integer(const char* name, double low = 0, bool required = false, double high = DBL_MAX) {
    return {.name = name, .type = PropertyType::integer, .required = required, .low = low, .high = high};
}
Property number(const char* name, double low = -DBL_MAX, double high = DBL_MAX, bool required = false) {
    return {.name = name, .type = PropertyType::number, .required = required, .low = low, .high = high};
}
Property numbers(const char* name, std::size_t length, double low = -DBL_MAX, double high = DBL_MAX) {
    return {.name = name, .type = PropertyType::numbers, .length = length, .low = low, .high = high};
}
Property index(const char* name, const char* section, bool required = false) {
    return {.name = name, .type = PropertyType::index, .section = section, .required = required};
}
Property indices(const char* name, const char* section, bool required = false) {
    return {.name = name, .type = PropertyType::indices, .section = section, .required = required};
}
Property object(const char* name, const ObjectSchema& schema, bool required = false) {
    return {.name = name, .type = PropertyType::object, .schema = &schema, .required = required};
}
Property list(const char* name, const ObjectSchema& schema, bool required = false) {
    return {.name = name, .type = PropertyType::list, .schema = &schema, .required = required};
}

const ObjectSchema& asset() {
    static const ObjectSchema schema = {string("version", true), string("minVersion"), string("generator"),
                                        string("copyright")};
    return schema;
}

const ObjectSchema& buffer() {
    static const ObjectSchema schema = {string("uri"), integer("byteLength", 1, true), string("name")};
    return schema;
}

const ObjectSchema& buffer_view() {
    static const ObjectSchema schema = {index("buffer", "buffers", true), integer("byteOffset"),
                                        integer("byteLength", 1, true), integer("byteStride", 4, false, 252),
                                        string("name")};
    return schema;
}

const ObjectSchema& accessor() {
    static const ObjectSchema sparse_indices = {index("bufferView", "bufferViews", true),
                                                integer("byteOffset"), integer("componentType", 0, true)};
    static const ObjectSchema sparse_values = {index("bufferView", "bufferViews", true),
                                               integer("byteOffset")};
    static const ObjectSchema sparse = {integer("count", 1, true), object("indices", sparse_indices, true),
                                        object("values", sparse_values, true)};
    static const ObjectSchema schema = {index("bufferView", "bufferViews"),
                                        integer("byteOffset"),
                                        integer("componentType", 5120, true, 5126),
                                        boolean("normalized"),
                                        integer("count", 1, true),
                                        string("type", true),
                                        numbers("min", 0),
                                        numbers("max", 0),
                                        object("sparse", sparse),
                                        string("name")};
    return schema;
}

const ObjectSchema& primitive() {
    static const ObjectSchema schema = {
        {.name = "attributes", .type = PropertyType::index_map, .section = "accessors", .required = true},
        index("indices", "accessors"),
        index("material", "materials"),
        integer("mode", 0, false, 6),
        {.name = "targets", .type = PropertyType::list, .section = "accessors"}};
    return schema;
}

const ObjectSchema& mesh() {
    static const ObjectSchema schema = {list("primitives", primitive(), true), numbers("weights", 0),
                                        string("name")};
    return schema;
}

const ObjectSchema& node() {
    static const ObjectSchema light = {index("light", "/extensions/KHR_lights_punctual/lights", true)};
    static const ObjectSchema extensions = {object("KHR_lights_punctual", light)};
    static const ObjectSchema schema = {index("camera", "cameras"),
                                        indices("children", "nodes"),
                                        index("skin", "skins"),
                                        numbers("matrix", 16),
                                        index("mesh", "meshes"),
                                        numbers("rotation", 4, -1.0, 1.0),
                                        numbers("scale", 3),
                                        numbers("translation", 3),
                                        numbers("weights", 0),
                                        object("extensions", extensions),
                                        string("name")};
    return schema;
}

// A reference to a texture. Normal maps have a scale, occlusion maps a strength.
const ObjectSchema& texture_info() {
    static const ObjectSchema transform = {numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                           integer("texCoord", 0, false, 1)};
    static const ObjectSchema extensions = {object("KHR_texture_transform", transform)};
    static const ObjectSchema schema = {index("index", "textures", true), integer("texCoord", 0, false, 1),
                                        number("scale"), number("strength", 0.0, 1.0),
                                        object("extensions", extensions)};
    return schema;
}

Property texture_info(const char* name) { return object(name, texture_info()); }

const ObjectSchema& material_extensions() {
    static const ObjectSchema clearcoat = {
        number("clearcoatFactor", 0.0, 1.0), texture_info("clearcoatTexture"),
        number("clearcoatRoughnessFactor", 0.0, 1.0), texture_info("clearcoatRoughnessTexture"),
        texture_info("clearcoatNormalTexture")};
    static const ObjectSchema anisotropy = {number("anisotropyStrength", 0.0, 1.0),
                                            number("anisotropyRotation"), texture_info("anisotropyTexture")};
    static const ObjectSchema ior = {number("ior", 0.0)};
    static const ObjectSchema specular = {number("specularFactor", 0.0, 1.0), texture_info("specularTexture"),
                                          numbers("specularColorFactor", 3, 0.0),
                                          texture_info("specularColorTexture")};
    static const ObjectSchema strength = {number("emissiveStrength", 0.0)};
    static const ObjectSchema schema = {
        object("KHR_materials_clearcoat", clearcoat), object("KHR_materials_anisotropy", anisotropy),
        object("KHR_materials_ior", ior), object("KHR_materials_specular", specular),
        object("KHR_materials_emissive_strength", strength)};
    return schema;
}

const ObjectSchema& material() {
    static const ObjectSchema pbr = {numbers("baseColorFactor", 4, 0.0, 1.0),
                                     texture_info("baseColorTexture"), number("metallicFactor", 0.0, 1.0),
                                     number("roughnessFactor", 0.0, 1.0),
                                     texture_info("metallicRoughnessTexture")};
    static const ObjectSchema schema = {object("pbrMetallicRoughness", pbr),
                                        texture_info("normalTexture"),
                                        texture_info("occlusionTexture"),
                                        texture_info("emissiveTexture"),
                                        numbers("emissiveFactor", 3, 0.0, 1.0),
                                        string("alphaMode"),
                                        number("alphaCutoff", 0.0),
                                        boolean("doubleSided"),
                                        object("extensions", material_extensions()),
                                        string("name")};
    return schema;
}

const ObjectSchema& image() {
    static const ObjectSchema schema = {string("uri"), string("mimeType"), index("bufferView", "bufferViews"),
                                        string("name")};
    return schema;
}

const ObjectSchema& sampler() {
    static const ObjectSchema schema = {integer("magFilter"), integer("minFilter"), integer("wrapS"),
                                        integer("wrapT")};
    return schema;
}

const ObjectSchema& texture() {
    static const ObjectSchema schema = {index("sampler", "samplers"), index("source", "images"),
                                        string("name")};
    return schema;
}

const ObjectSchema& skin() {
    static const ObjectSchema schema = {index("inverseBindMatrices", "accessors"), index("skeleton", "nodes"),
                                        indices("joints", "nodes", true), string("name")};
    return schema;
}

const ObjectSchema& animation() {
    static const ObjectSchema target = {index("node", "nodes"), string("path", true)};
    static const ObjectSchema channel = {integer("sampler", 0, true), object("target", target, true)};
    static const ObjectSchema key_frames = {index("input", "accessors", true), string("interpolation"),
                                            index("output", "accessors", true)};
    static const ObjectSchema schema = {list("channels", channel, true), list("samplers", key_frames, true),
                                        string("name")};
    return schema;
}

const ObjectSchema& camera() {
    static const ObjectSchema perspective = {number("aspectRatio", 1e-6),
                                             number("yfov", 1e-6, 3.14159265, true), number("zfar", 1e-12),
                                             number("znear", 1e-12, DBL_MAX, true)};
    static const ObjectSchema orthographic = {
        number("xmag", -DBL_MAX, DBL_MAX, true), number("ymag", -DBL_MAX, DBL_MAX, true),
        number("zfar", 1e-12, DBL_MAX, true), number("znear", 0.0, DBL_MAX, true)};
    static const ObjectSchema schema = {string("type", true), object("perspective", perspective),
                                        object("orthographic", orthographic), string("name")};
    return schema;
}

const ObjectSchema& extensions() {
    static const ObjectSchema spot = {number("innerConeAngle", 0.0, half_pi),
                                      number("outerConeAngle", 0.0, half_pi)};
    static const ObjectSchema light = {numbers("color", 3, 0.0), number("intensity", 0.0),
                                       string("type", true),     number("range", 1e-12),
                                       object("spot", spot),     string("name")};
    static const ObjectSchema punctual = {list("lights", light, true)};
    static const ObjectSchema schema = {object("KHR_lights_punctual", punctual)};
    return schema;
}

const ObjectSchema& scene() {
    static const ObjectSchema schema = {indices("nodes", "nodes"), string("name")};
    return schema;
}

}  // namespace

// A section comes before the sections that refer to it, so that the first error reported is the cause. Nodes
// and skins refer to each other.
const ObjectSchema& root_schema() {
    static const ObjectSchema schema = {object("asset", asset(), true),
                                        {.name = "extensionsUsed", .type = PropertyType::strings},
                                        {.name = "extensionsRequired", .type = PropertyType::strings},
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
