// The glTF 2.0 specification, section 5 (properties reference), and the extensions that are read, as shapes.
#include "engine/assets/read/shape.hpp"

namespace bolt::assets {

namespace {

constexpr double half_pi = 1.5707964;  // the float above

Field text(const char* name, bool required = false) {
    return {.name = name, .kind = Kind::string, .required = required};
}
Field flag(const char* name) { return {.name = name, .kind = Kind::boolean}; }
Field whole(const char* name, double low = 0, bool required = false, double high = DBL_MAX) {
    return {.name = name, .kind = Kind::integer, .required = required, .low = low, .high = high};
}
Field real(const char* name, double low = -DBL_MAX, double high = DBL_MAX, bool required = false) {
    return {.name = name, .kind = Kind::number, .required = required, .low = low, .high = high};
}
Field reals(const char* name, std::size_t length, double low = -DBL_MAX, double high = DBL_MAX) {
    return {.name = name, .kind = Kind::numbers, .length = length, .low = low, .high = high};
}
Field index(const char* name, const char* section, bool required = false) {
    return {.name = name, .kind = Kind::index, .section = section, .required = required};
}
Field indices(const char* name, const char* section, bool required = false) {
    return {.name = name, .kind = Kind::indices, .section = section, .required = required};
}
Field object(const char* name, const Shape& shape, bool required = false) {
    return {.name = name, .kind = Kind::object, .shape = &shape, .required = required};
}
Field list(const char* name, const Shape& shape, bool required = false) {
    return {.name = name, .kind = Kind::list, .shape = &shape, .required = required};
}

const Shape& asset() {
    static const Shape shape = {text("version", true), text("minVersion"), text("generator"),
                                text("copyright")};
    return shape;
}

const Shape& buffer() {
    static const Shape shape = {text("uri"), whole("byteLength", 1, true), text("name")};
    return shape;
}

const Shape& buffer_view() {
    static const Shape shape = {index("buffer", "buffers", true), whole("byteOffset"),
                                whole("byteLength", 1, true), whole("byteStride", 4, false, 252),
                                text("name")};
    return shape;
}

const Shape& accessor() {
    static const Shape sparse_indices = {index("bufferView", "bufferViews", true), whole("byteOffset"),
                                         whole("componentType", 0, true)};
    static const Shape sparse_values = {index("bufferView", "bufferViews", true), whole("byteOffset")};
    static const Shape sparse = {whole("count", 1, true), object("indices", sparse_indices, true),
                                 object("values", sparse_values, true)};
    static const Shape shape = {index("bufferView", "bufferViews"),
                                whole("byteOffset"),
                                whole("componentType", 5120, true, 5126),
                                flag("normalized"),
                                whole("count", 1, true),
                                text("type", true),
                                reals("min", 0),
                                reals("max", 0),
                                object("sparse", sparse),
                                text("name")};
    return shape;
}

const Shape& primitive() {
    static const Shape shape = {
        {.name = "attributes", .kind = Kind::index_map, .section = "accessors", .required = true},
        index("indices", "accessors"),
        index("material", "materials"),
        whole("mode", 0, false, 6),
        {.name = "targets", .kind = Kind::list, .section = "accessors"}};
    return shape;
}

const Shape& mesh() {
    static const Shape shape = {list("primitives", primitive(), true), reals("weights", 0), text("name")};
    return shape;
}

const Shape& node() {
    static const Shape light = {index("light", "/extensions/KHR_lights_punctual/lights", true)};
    static const Shape extensions = {object("KHR_lights_punctual", light)};
    static const Shape shape = {index("camera", "cameras"),
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
    return shape;
}

// A reference to a texture, with the factor that comes along with it.
const Shape& texture_info() {
    static const Shape transform = {reals("offset", 2), real("rotation"), reals("scale", 2),
                                    whole("texCoord", 0, false, 1)};
    static const Shape extensions = {object("KHR_texture_transform", transform)};
    static const Shape shape = {index("index", "textures", true), whole("texCoord", 0, false, 1),
                                real("scale"), real("strength", 0.0, 1.0), object("extensions", extensions)};
    return shape;
}

Field texture_info(const char* name) { return object(name, texture_info()); }

const Shape& material_extensions() {
    static const Shape clearcoat = {real("clearcoatFactor", 0.0, 1.0), texture_info("clearcoatTexture"),
                                    real("clearcoatRoughnessFactor", 0.0, 1.0),
                                    texture_info("clearcoatRoughnessTexture"),
                                    texture_info("clearcoatNormalTexture")};
    static const Shape anisotropy = {real("anisotropyStrength", 0.0, 1.0), real("anisotropyRotation"),
                                     texture_info("anisotropyTexture")};
    static const Shape ior = {real("ior", 0.0)};
    static const Shape specular = {real("specularFactor", 0.0, 1.0), texture_info("specularTexture"),
                                   reals("specularColorFactor", 3, 0.0),
                                   texture_info("specularColorTexture")};
    static const Shape strength = {real("emissiveStrength", 0.0)};
    static const Shape shape = {object("KHR_materials_clearcoat", clearcoat),
                                object("KHR_materials_anisotropy", anisotropy),
                                object("KHR_materials_ior", ior), object("KHR_materials_specular", specular),
                                object("KHR_materials_emissive_strength", strength)};
    return shape;
}

const Shape& material() {
    static const Shape pbr = {reals("baseColorFactor", 4, 0.0, 1.0), texture_info("baseColorTexture"),
                              real("metallicFactor", 0.0, 1.0), real("roughnessFactor", 0.0, 1.0),
                              texture_info("metallicRoughnessTexture")};
    static const Shape shape = {object("pbrMetallicRoughness", pbr),
                                texture_info("normalTexture"),
                                texture_info("occlusionTexture"),
                                texture_info("emissiveTexture"),
                                reals("emissiveFactor", 3, 0.0, 1.0),
                                text("alphaMode"),
                                real("alphaCutoff", 0.0),
                                flag("doubleSided"),
                                object("extensions", material_extensions()),
                                text("name")};
    return shape;
}

const Shape& image() {
    static const Shape shape = {text("uri"), text("mimeType"), index("bufferView", "bufferViews"),
                                text("name")};
    return shape;
}

const Shape& sampler() {
    static const Shape shape = {whole("magFilter"), whole("minFilter"), whole("wrapS"), whole("wrapT")};
    return shape;
}

const Shape& texture() {
    static const Shape shape = {index("sampler", "samplers"), index("source", "images"), text("name")};
    return shape;
}

const Shape& skin() {
    static const Shape shape = {index("inverseBindMatrices", "accessors"), index("skeleton", "nodes"),
                                indices("joints", "nodes", true), text("name")};
    return shape;
}

const Shape& animation() {
    static const Shape target = {index("node", "nodes"), text("path", true)};
    static const Shape channel = {whole("sampler", 0, true), object("target", target, true)};
    static const Shape key_frames = {index("input", "accessors", true), text("interpolation"),
                                     index("output", "accessors", true)};
    static const Shape shape = {list("channels", channel, true), list("samplers", key_frames, true),
                                text("name")};
    return shape;
}

const Shape& camera() {
    static const Shape perspective = {real("aspectRatio", 1e-6), real("yfov", 1e-6, 3.14159265, true),
                                      real("zfar", 1e-12), real("znear", 1e-12, DBL_MAX, true)};
    static const Shape orthographic = {real("xmag", -DBL_MAX, DBL_MAX, true),
                                       real("ymag", -DBL_MAX, DBL_MAX, true),
                                       real("zfar", 1e-12, DBL_MAX, true), real("znear", 0.0, DBL_MAX, true)};
    static const Shape shape = {text("type", true), object("perspective", perspective),
                                object("orthographic", orthographic), text("name")};
    return shape;
}

const Shape& extensions() {
    static const Shape spot = {real("innerConeAngle", 0.0, half_pi), real("outerConeAngle", 0.0, half_pi)};
    static const Shape light = {reals("color", 3, 0.0), real("intensity", 0.0), text("type", true),
                                real("range", 1e-12),   object("spot", spot),   text("name")};
    static const Shape punctual = {list("lights", light, true)};
    static const Shape shape = {object("KHR_lights_punctual", punctual)};
    return shape;
}

const Shape& scene() {
    static const Shape shape = {indices("nodes", "nodes"), text("name")};
    return shape;
}

}  // namespace

// Sections come before what points into them, so that the first error names the cause.
const Shape& root_shape() {
    static const Shape shape = {object("asset", asset(), true),
                                {.name = "extensionsUsed", .kind = Kind::strings},
                                {.name = "extensionsRequired", .kind = Kind::strings},
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
    return shape;
}

}  // namespace bolt::assets
