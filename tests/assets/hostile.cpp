// Hostile files: each gives an error that names the place.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "engine/assets/image.hpp"
#include "tests/assets/document.hpp"

using namespace bolt;
using namespace bolt::assets;

namespace {

struct Hostile {
    const char* what;
    const char* pointer;
    std::function<void(json&)> spoil;
};

json& primitive(json& document) { return document["meshes"][0]["primitives"][0]; }

// The triangle with NaN as its second x.
void not_a_number(json& document) {
    set_buffer(document, Bytes()
                             .add({0.0F, 0.0F, 0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F,
                                   0.0F, 1.0F, 0.0F})
                             .add<std::uint16_t>({0, 1, 2, 0}));
}

void set_sparse(json& document, int count, int component, int index_offset, int value_offset) {
    document["accessors"][0]["sparse"] = {
        {"count", count},
        {"indices", {{"bufferView", 0}, {"byteOffset", index_offset}, {"componentType", component}}},
        {"values", {{"bufferView", 0}, {"byteOffset", value_offset}}}};
}

void add_animation(json& document, const char* path, const char* interpolation, int input, int output) {
    document["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
}

const std::vector<Hostile> structure = {
    {"the root is no object", "", [](json& d) { d = json::array(); }},
    {"no asset", "", [](json& d) { d.erase("asset"); }},
    {"no version", "/asset", [](json& d) { d["asset"].erase("version"); }},
    {"version 1", "/asset/version", [](json& d) { d["asset"]["version"] = "1.0"; }},
    {"version as a number", "/asset/version", [](json& d) { d["asset"]["version"] = 2.0; }},
    {"a newer version", "/asset/minVersion", [](json& d) { d["asset"]["minVersion"] = "2.1"; }},
    {"an extension that is not known", "/extensionsRequired/1",
     [](json& d) {
         d["extensionsRequired"] = {"KHR_materials_ior", "KHR_draco_mesh_compression"};
     }},
    {"extensions that are no list", "/extensionsRequired", [](json& d) { d["extensionsRequired"] = 1; }},
    {"meshes that are no list", "/meshes", [](json& d) { d["meshes"] = json::object(); }},
    {"a mesh that is no object", "/meshes/0", [](json& d) { d["meshes"][0] = "cube"; }},
    {"a mesh without primitives", "/meshes/0/primitives",
     [](json& d) { d["meshes"][0]["primitives"] = json::array(); }},
    {"a name that is a number", "/nodes/0/name", [](json& d) { d["nodes"][0]["name"] = 7; }},
    {"a negative index", "/nodes/0/mesh", [](json& d) { d["nodes"][0]["mesh"] = -1; }},
    {"a wild mesh", "/nodes/0/mesh", [](json& d) { d["nodes"][0]["mesh"] = 1; }},
    {"an index beyond 32 bits", "/nodes/0/mesh", [](json& d) { d["nodes"][0]["mesh"] = 4294967296; }},
    {"a wild material", "/meshes/0/primitives/0/material", [](json& d) { primitive(d)["material"] = 0; }},
    {"a wild accessor", "/meshes/0/primitives/0/attributes/POSITION",
     [](json& d) { primitive(d)["attributes"]["POSITION"] = 2; }},
    {"a wild accessor of indices", "/meshes/0/primitives/0/indices",
     [](json& d) { primitive(d)["indices"] = 1000000; }},
    {"a wild accessor of a target", "/meshes/0/primitives/0/targets/0/POSITION",
     [](json& d) {
         primitive(d)["targets"] = {{{"POSITION", 9}}};
     }},
    {"a slash in a name", "/meshes/0/primitives/0/attributes/_A~1B~0",
     [](json& d) { primitive(d)["attributes"]["_A/B~"] = 9; }},
    {"a wild scene", "/scene", [](json& d) { d["scene"] = 1; }},
    {"a wild root", "/scenes/0/nodes/0", [](json& d) { d["scenes"][0]["nodes"][0] = 5; }},
    {"a wild camera", "/nodes/0/camera", [](json& d) { d["nodes"][0]["camera"] = 0; }},
    {"a wild light", "/nodes/0/extensions/KHR_lights_punctual/light",
     [](json& d) { d["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; }},
    {"a wild texture", "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
     [](json& d) {
         d["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
     }},
    {"a third set of texture coordinates", "/materials/0/normalTexture/texCoord",
     [](json& d) {
         d["textures"] = json::array({json::object()});
         d["materials"] = {{{"normalTexture", {{"index", 0}, {"texCoord", 2}}}}};
     }},
    {"a colour of three", "/materials/0/pbrMetallicRoughness/baseColorFactor",
     [](json& d) {
         d["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1}}}}}};
     }},
    {"a roughness of two", "/materials/0/pbrMetallicRoughness/roughnessFactor",
     [](json& d) {
         d["materials"] = {{{"pbrMetallicRoughness", {{"roughnessFactor", 2}}}}};
     }},
    {"an alpha mode that is none", "/materials/0/alphaMode",
     [](json& d) {
         d["materials"] = {{{"alphaMode", "GLASS"}}};
     }},
    {"an index of refraction below one", "/materials/0/extensions/KHR_materials_ior/ior",
     [](json& d) {
         d["materials"] = {{{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}}};
     }},
    {"a sampler that is none", "/samplers/0/wrapS",
     [](json& d) {
         d["samplers"] = {{{"wrapS", 1}}};
         d["textures"] = {{{"sampler", 0}}};
     }},
    {"an image that is none", "/images/0",
     [](json& d) {
         d["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
         d["textures"] = {{{"source", 0}}};
     }},
    {"an image that is nowhere", "/images/0", [](json& d) { d["images"] = json::array({json::object()}); }},
    {"a number that no float holds", "/nodes/0/translation/1",
     [](json& d) {
         d["nodes"][0]["translation"] = {0, 1e300, 0};
     }},
    {"a rotation that is none", "/nodes/0/rotation",
     [](json& d) {
         d["nodes"][0]["rotation"] = {0, 0, 0, 0};
     }},
    {"a matrix that flattens", "/nodes/0/matrix",
     [](json& d) { d["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }},
    {"a perspective of no angle", "/cameras/0/perspective/yfov",
     [](json& d) {
         d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}}};
     }},
    {"a far plane before the near one", "/cameras/0/perspective/zfar",
     [](json& d) {
         d["cameras"] = {
             {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 2}, {"zfar", 1}}}}};
     }},
    {"a spot light without a spot", "/extensions/KHR_lights_punctual/lights/0",
     [](json& d) {
         d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
     }},
    {"a camera of no type", "/cameras/0/type",
     [](json& d) {
         d["cameras"] = {{{"type", "fisheye"}}};
     }},
    {"a camera without a lens", "/cameras/0",
     [](json& d) {
         d["cameras"] = {{{"type", "perspective"}}};
     }},
    {"an accessor of no type", "/accessors/0/type", [](json& d) { d["accessors"][0]["type"] = "VEC5"; }},
    {"a light of no type", "/extensions/KHR_lights_punctual/lights/0/type",
     [](json& d) {
         d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "candle"}}};
     }},
};

const std::vector<Hostile> hierarchy = {
    {"a node that is its own child", "/nodes/0",
     [](json& d) {
         d["nodes"][0]["children"] = {0};
         d["scenes"][0]["nodes"] = json::array();
     }},
    {"a ring of nodes", "/nodes/0",
     [](json& d) {
         d["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
         d["scenes"][0]["nodes"] = json::array();
     }},
    {"a child of two", "/nodes/1/children/0",
     [](json& d) {
         d["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, json::object()};
     }},
    {"a root that is a child", "/scenes/0/nodes/1",
     [](json& d) {
         d["nodes"] = {{{"children", {1}}}, json::object()};
         d["scenes"][0]["nodes"] = {0, 1};
     }},
    {"a root that is listed twice", "/scenes/0/nodes/1",
     [](json& d) {
         d["scenes"][0]["nodes"] = {0, 0};
     }},
    {"a chain of 300 nodes", "/nodes/257",
     [](json& d) {
         d["nodes"] = json::array({json::object()});
         for (int i = 1; i < 300; ++i) {
             d["nodes"][static_cast<std::size_t>(i - 1)]["children"] = {i};
             d["nodes"].push_back(json::object());
         }
     }},
    {"a skin without joints", "/skins/0/joints",
     [](json& d) {
         d["skins"] = {{{"joints", json::array()}}};
     }},
    {"a skin of wild joints", "/skins/0/joints/1",
     [](json& d) {
         d["skins"] = {{{"joints", {0, 1}}}};
     }},
    {"bind matrices that are vectors", "/skins/0/inverseBindMatrices",
     [](json& d) {
         d["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 0}}};
     }},
    {"weights without targets", "/meshes/0/weights", [](json& d) { d["meshes"][0]["weights"] = {1}; }},
    {"weights of a node without targets", "/nodes/0/weights",
     [](json& d) { d["nodes"][0]["weights"] = {1}; }},
};

const std::vector<Hostile> bytes = {
    {"a wild buffer", "/bufferViews/0/buffer", [](json& d) { d["bufferViews"][0]["buffer"] = 1; }},
    {"a buffer that is nowhere", "/buffers/0", [](json& d) { d["buffers"][0].erase("uri"); }},
    {"a buffer of no bytes", "/buffers/0/byteLength", [](json& d) { d["buffers"][0]["byteLength"] = 0; }},
    {"a buffer that is longer than its data", "/buffers/0/byteLength",
     [](json& d) { d["buffers"][0]["byteLength"] = 45; }},
    {"a buffer that is no base64", "/buffers/0/uri",
     [](json& d) { d["buffers"][0]["uri"] = "data:application/octet-stream;base64,"; }},
    {"data of an unknown type", "/buffers/0/uri", [](json& d) { d["buffers"][0]["uri"] = "data:,abc"; }},
    {"a buffer in the parent folder", "/buffers/0/uri",
     [](json& d) { d["buffers"][0]["uri"] = "../secret.bin"; }},
    {"a buffer in the parent folder, disguised", "/buffers/0/uri",
     [](json& d) { d["buffers"][0]["uri"] = "a/%2e%2e/%2E%2E/secret.bin"; }},
    {"a buffer by its full path", "/buffers/0/uri", [](json& d) { d["buffers"][0]["uri"] = "/etc/passwd"; }},
    {"a buffer on the net", "/buffers/0/uri",
     [](json& d) { d["buffers"][0]["uri"] = "https://example.com/a.bin"; }},
    {"a buffer that would be a command", "/buffers/0/uri",
     [](json& d) { d["buffers"][0]["uri"] = "$(touch owned).bin"; }},
    {"a view past the end", "/bufferViews/0", [](json& d) { d["bufferViews"][0]["byteOffset"] = 1; }},
    {"a view whose end wraps round", "/bufferViews/0/byteLength",
     [](json& d) { d["bufferViews"][0]["byteLength"] = 18446744073709551615U; }},
    {"a stride below an element", "/bufferViews/0/byteStride",
     [](json& d) { d["bufferViews"][0]["byteStride"] = 4; }},
    {"a stride off the grid", "/bufferViews/0/byteStride",
     [](json& d) { d["bufferViews"][0]["byteStride"] = 14; }},
    {"an accessor past the end", "/accessors/0", [](json& d) { d["accessors"][0]["count"] = 4; }},
    {"an accessor far past the end", "/accessors/0",
     [](json& d) { d["accessors"][0]["count"] = 2147483647; }},
    {"a count beyond 32 bits", "/accessors/0/count",
     [](json& d) { d["accessors"][0]["count"] = 1000000000000; }},
    {"zeros without end", "/accessors/0/count",
     [](json& d) {
         d["accessors"][0]["count"] = 2147483647;
         d["accessors"][0].erase("bufferView");
     }},
    {"a negative count as a float", "/accessors/0/count", [](json& d) { d["accessors"][0]["count"] = -3.0; }},
    {"an accessor of nothing", "/accessors/0/count", [](json& d) { d["accessors"][0]["count"] = 0; }},
    {"a component type that is none", "/accessors/0/componentType",
     [](json& d) { d["accessors"][0]["componentType"] = 5124; }},
    {"a component type far from any", "/accessors/1/componentType",
     [](json& d) { d["accessors"][1]["componentType"] = 1253; }},
    {"positions that are no vectors", "/meshes/0/primitives/0/attributes/POSITION",
     [](json& d) {
         d["accessors"][0]["type"] = "SCALAR";
         d["accessors"][0]["count"] = 9;
     }},
    {"positions of whole numbers", "/meshes/0/primitives/0/attributes/POSITION",
     [](json& d) {
         d["accessors"][0]["componentType"] = 5122;
         d["bufferViews"][0]["byteStride"] = 8;
         d["accessors"][1] = d["accessors"][0];
     }},
    {"positions that are not there", "/meshes/0/primitives/0/attributes",
     [](json& d) {
         primitive(d)["attributes"] = {{"NORMAL", 0}};
     }},
    {"normals for some vertices", "/meshes/0/primitives/0/attributes/NORMAL",
     [](json& d) {
         d["accessors"].push_back(
             {{"bufferView", 0}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}});
         primitive(d)["attributes"]["NORMAL"] = 2;
     }},
    {"joints without weights", "/meshes/0/primitives/0/attributes",
     [](json& d) {
         d["accessors"].push_back(
             {{"bufferView", 0}, {"componentType", 5121}, {"count", 3}, {"type", "VEC4"}});
         primitive(d)["attributes"]["JOINTS_0"] = 2;
     }},
    {"an index past the last vertex", "/meshes/0/primitives/0/indices",
     [](json& d) {
         set_buffer(d, Bytes()
                           .add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
                           .add<std::uint16_t>({0, 1, 3, 0}));
     }},
    {"two corners of a triangle", "/meshes/0/primitives/0", [](json& d) { d["accessors"][1]["count"] = 2; }},
    {"a position that is no number", "/accessors/0", not_a_number},
    {"sparse indices past the end", "/accessors/0/sparse/indices",
     [](json& d) { set_sparse(d, 2, 5125, 40, 0); }},
    {"sparse values past the end", "/accessors/0/sparse/values",
     [](json& d) { set_sparse(d, 2, 5121, 36, 24); }},
    {"more sparse elements than elements", "/accessors/0/sparse/count",
     [](json& d) { set_sparse(d, 4, 5121, 36, 0); }},
    {"sparse indices that fall", "/accessors/0/sparse/indices",
     [](json& d) { set_sparse(d, 2, 5121, 0, 0); }},
    {"sparse indices that are floats", "/accessors/0/sparse/indices/componentType",
     [](json& d) { set_sparse(d, 2, 5126, 0, 0); }},
    {"an animation that moves the impossible", "/animations/0/channels/0/target/path",
     [](json& d) { add_animation(d, "colour", "LINEAR", 0, 0); }},
    {"an animation of vectors of time", "/animations/0/samplers/0/input",
     [](json& d) { add_animation(d, "translation", "LINEAR", 0, 0); }},
    {"an animation without such an interpolation", "/animations/0/samplers/0/interpolation",
     [](json& d) { add_animation(d, "translation", "EASE", 1, 0); }},
    {"a channel without its sampler", "/animations/0/channels/0/sampler",
     [](json& d) {
         add_animation(d, "translation", "LINEAR", 0, 0);
         d["animations"][0]["channels"][0]["sampler"] = 1;
     }},
    {"keys that do not rise", "/animations/0/samplers/0/input",
     [](json& d) {
         d["accessors"].push_back(
             {{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
         add_animation(d, "translation", "LINEAR", 2, 0);
     }},
    {"fewer values than keys", "/animations/0/samplers/0/output",
     [](json& d) {
         d["accessors"].push_back({{"bufferView", 0},
                                   {"byteOffset", 8},
                                   {"componentType", 5126},
                                   {"count", 2},
                                   {"type", "SCALAR"}});
         add_animation(d, "translation", "LINEAR", 2, 0);
     }},
    {"a tensor of images", "/images/0/bufferView",
     [](json& d) {
         d["images"] = {{{"bufferView", 3}}};
     }},
};

void try_all(const std::vector<Hostile>& files) {
    for (const Hostile& hostile : files) {
        const std::string what = hostile.what;
        CAPTURE(what);
        json document = triangle_document();
        hostile.spoil(document);
        const Error error = refusal(document);
        CAPTURE(error.message());
        CHECK(error.pointer == hostile.pointer);
    }
}

Error refused(const std::string& text) {
    const auto model = parse_gltf(text, "hostile.glb");
    REQUIRE_FALSE(model);
    CHECK(model.error().file == "hostile.glb");
    return model.error();
}

}  // namespace

TEST_CASE("Hostile files: invalid structure is an error with its pointer") { try_all(structure); }
TEST_CASE("Hostile files: invalid hierarchies are errors with their pointer") { try_all(hierarchy); }
TEST_CASE("Hostile files: invalid bytes are errors with their pointer") { try_all(bytes); }

TEST_CASE("Hostile files: an unsupported required extension is named") {
    json document = triangle_document();
    document["extensionsRequired"] = {"EXT_meshopt_compression"};
    CHECK(refusal(document).what.find("EXT_meshopt_compression") != std::string::npos);
    // An extension that is used but not required is ignored.
    document.erase("extensionsRequired");
    document["extensionsUsed"] = {"EXT_meshopt_compression"};
    CHECK(parse_gltf(document.dump(), "used.gltf"));
}

TEST_CASE("Hostile files: an integer with a sign or a fraction is quoted, with the range that is expected") {
    json document = triangle_document();
    document["accessors"][0]["count"] = -3.0;
    CHECK(refusal(document).what == "is -3.0");
    document["accessors"][0]["count"] = 1.5;
    const Error error = refusal(document);
    CHECK(error.what == "is 1.5");
    CHECK(error.expected == "an integer from 1 to 2147483647");
    document["accessors"][0]["count"] = 3.0;  // an integer, in JSON and in glTF
    CHECK(parse_gltf(document.dump(), "integer.gltf"));
}

TEST_CASE("Hostile files: an image with too many pixels is refused before it is decoded") {
    const std::uint8_t grey[] = {128};
    std::string png = encode_png(1, 1, 1, grey).value();
    png.replace(16, 4, std::string("\0\0\x40\x01", 4));  // the width in IHDR: 16385
    Bitmap image;
    image.encoded.assign(png.begin(), png.end());
    const Status decoded = decode(image);
    REQUIRE_FALSE(decoded);
    CHECK(decoded.error().what == "the image has 16385 × 1 pixels");
    CHECK(decoded.error().expected == "at most 16384 pixels a side and 67108864 pixels in total");
}

TEST_CASE("Hostile files: invalid JSON is an error with its line") {
    CHECK(refused("").what.find("not valid JSON") != std::string::npos);
    CHECK(refused("{\n\"asset\": {},\n!}").line == 3);
    CHECK(refused("{\"asset\": \"\xFF\"}").line == 1);
    CHECK(refused("{\"asset\": 1e999}").what.find("too large") != std::string::npos);
    CHECK(refused("null").what.find("null") != std::string::npos);
}

TEST_CASE("Hostile files: the nesting limit protects the parser's stack") {
    CHECK(refused(std::string(1000000, '[')).what.find("deeper") != std::string::npos);
    std::string text = R"({"asset":{"version":"2.0","extras":)";
    text += std::string(100, '[') + std::string(100, ']') + "}}";
    CHECK(refused(text).what.find("deeper") != std::string::npos);
    CHECK(parse_gltf(R"({"asset":{"version":"2.0","generator":"[[[[[[\"[["}})", "brackets.gltf"));
}

TEST_CASE("Hostile files: a .glb truncated at any length is an error") {
    json document = triangle_document();
    document["buffers"][0].erase("uri");
    std::string chunk(44, '\0');
    const float x = 1.0F;
    std::memcpy(chunk.data() + 12, &x, 4);
    const std::string whole = glb(document, chunk);
    const auto model = parse_gltf(whole, "whole.glb");
    REQUIRE_MESSAGE(model, model.error().message());
    CHECK(model->meshes[0].primitives[0].positions[1] == glm::vec3(1, 0, 0));
    for (std::size_t size = 0; size < whole.size(); ++size)
        CHECK_FALSE(parse_gltf(whole.substr(0, size), "cut.glb"));
}

TEST_CASE("Hostile files: a .glb with wrong lengths is an error") {
    json document = triangle_document();
    document["buffers"][0].erase("uri");
    const std::string whole = glb(document, std::string(44, '\0'));
    const auto with = [&](std::size_t offset, std::uint32_t value) {
        std::string changed = whole;
        std::memcpy(changed.data() + offset, &value, 4);
        return changed;
    };
    const std::size_t second = whole.size() - 44 - 8;
    CHECK(refused(with(4, 1)).what.find("version") != std::string::npos);
    CHECK_FALSE(refused(with(8, 0xFFFFFFFFU)).what.empty());
    CHECK_FALSE(refused(with(8, 12)).what.empty());
    CHECK_FALSE(refused(with(12, 0xFFFFFFFCU)).what.empty());
    CHECK_FALSE(refused(with(16, 0x004E4942U)).what.empty());
    // The chunk claims eight bytes more than the file has, or fewer than its buffer.
    CHECK_FALSE(refused(with(second, 52)).what.empty());
    CHECK(refused(with(second, 40)).pointer == "/buffers/0/byteLength");
    CHECK(refused(with(second + 4, 0)).pointer == "/buffers/0");
}
