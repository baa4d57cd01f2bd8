// Accessors of every type, with values that can be checked by hand.
#include <doctest/doctest.h>

#include "tests/assets/document.hpp"

using namespace bolt;
using namespace bolt::assets;

namespace {

// A document of points whose positions are accessor 0; `attribute` is accessor 1, for three vertices.
json with_attribute(const char* name, const json& accessor, const Bytes& bytes) {
    json document = triangle_document();
    Bytes all;
    all.add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
    for (const std::uint8_t byte : bytes.get()) all.add({byte});
    set_buffer(document, all);
    document["accessors"][1] = accessor;
    document["accessors"][1]["bufferView"] = 0;
    document["accessors"][1]["byteOffset"] = 36;
    document["accessors"][1]["count"] = 3;
    document["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}, {name, 1}}}};
    return document;
}

const Primitive& primitive(const Model& model) { return model.meshes.at(0).primitives.at(0); }

}  // namespace

TEST_CASE("Accessors: a triangle keeps its positions and indices") {
    const Model model = read(triangle_document());
    const Primitive& p = primitive(model);
    CHECK(p.topology == Topology::triangles);
    CHECK(p.positions == std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(p.indices == std::vector<std::uint32_t>{0, 1, 2});
    CHECK(p.material == -1);
    CHECK(model.nodes[0].name == "triangle");
    CHECK(model.roots == std::vector<int>{0});
}

TEST_CASE("Accessors: indices have 8, 16 or 32 bits and are optional") {
    for (const int component : {5121, 5123, 5125}) {
        json document = triangle_document();
        Bytes bytes;
        bytes.add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
        if (component == 5121) bytes.add<std::uint8_t>({2, 0, 1, 0});
        if (component == 5123) bytes.add<std::uint16_t>({2, 0, 1, 0});
        if (component == 5125) bytes.add<std::uint32_t>({2, 0, 1});
        set_buffer(document, bytes);
        document["accessors"][1]["componentType"] = component;
        CHECK(primitive(read(document)).indices == std::vector<std::uint32_t>{2, 0, 1});
    }
    json document = triangle_document();
    document["meshes"][0]["primitives"][0].erase("indices");
    CHECK(primitive(read(document)).indices.empty());
}

TEST_CASE("Accessors: the normalised integers 255 and 65535 are read as 1") {
    const auto u8 =
        with_attribute("TEXCOORD_0", {{"componentType", 5121}, {"normalized", true}, {"type", "VEC2"}},
                       Bytes().add<std::uint8_t>({0, 255, 51, 102, 255, 0, 0, 0}));
    CHECK(primitive(read(u8)).texcoords[0] ==
          std::vector<glm::vec2>{{0.0F, 1.0F}, {51.0F / 255.0F, 102.0F / 255.0F}, {1.0F, 0.0F}});
    const auto u16 =
        with_attribute("COLOR_0", {{"componentType", 5123}, {"normalized", true}, {"type", "VEC3"}},
                       Bytes().add<std::uint16_t>({65535, 0, 13107, 0, 0, 0, 65535, 65535, 65535, 0}));
    // RGB colours get an alpha of one.
    CHECK(primitive(read(u16)).colors ==
          std::vector<glm::vec4>{{1.0F, 0.0F, 13107.0F / 65535.0F, 1.0F}, {0, 0, 0, 1}, {1, 1, 1, 1}});
}

TEST_CASE(
    "Accessors: signed bytes and shorts, normalised or not, need KHR_mesh_quantization as required "
    "extension") {
    auto document =
        with_attribute("NORMAL", {{"componentType", 5120}, {"normalized", true}, {"type", "VEC3"}},
                       Bytes().add<std::int8_t>({127, 0, -127, 0, 0, 127, -128, 0, 0, 0, 0, 0}));
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 12}, {"byteStride", 4}});
    document["accessors"][1]["bufferView"] = 1;
    document["accessors"][1]["byteOffset"] = 0;
    // Elements are four bytes apart, and three bytes are used.
    CHECK(refusal(document).pointer == "/meshes/0/primitives/0/attributes/NORMAL");
    document["extensionsUsed"] = {"KHR_mesh_quantization"};
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
    CHECK(primitive(read(document)).normals == std::vector<glm::vec3>{{1, 0, -1}, {0, 1, -1}, {0, 0, 0}});

    json shorts = triangle_document();
    set_buffer(shorts, Bytes().add<std::int16_t>({-3, 7, 1000, 0, 32767, -32768, 1, 0, 0, 0, 0, 0}));
    shorts["bufferViews"][0]["byteStride"] = 8;
    shorts["accessors"] = {{{"bufferView", 0}, {"componentType", 5122}, {"count", 3}, {"type", "VEC3"}}};
    shorts["meshes"][0]["primitives"][0].erase("indices");
    shorts["extensionsRequired"] = {"KHR_mesh_quantization"};
    CHECK(primitive(read(shorts)).positions ==
          std::vector<glm::vec3>{{-3, 7, 1000}, {32767, -32768, 1}, {0, 0, 0}});
    shorts["accessors"][0]["normalized"] = true;
    CHECK(primitive(read(shorts)).positions[1] == glm::vec3(1.0F, -1.0F, 1.0F / 32767.0F));
}

TEST_CASE("Accessors: positions and normals are read from an interleaved view") {
    json document = triangle_document();
    set_buffer(document, Bytes().add({0.F, 1.F, 2.F, 0.F, 0.F, 1.F, 3.F, 4.F, 5.F, 0.F, 1.F, 0.F, 6.F, 7.F,
                                      8.F, 1.F, 0.F, 0.F}));
    document["bufferViews"][0]["byteStride"] = 24;
    document["accessors"] = {
        {{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
        {{"bufferView", 0}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}};
    document["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
    const Model model = read(document);
    CHECK(primitive(model).positions == std::vector<glm::vec3>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
    CHECK(primitive(model).normals == std::vector<glm::vec3>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}});
}

TEST_CASE("Accessors: sparse accessors replace some elements of a view or of zeros") {
    json document = triangle_document();
    set_buffer(document, Bytes()
                             .add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
                             .add<std::uint16_t>({0, 1, 2, 0})
                             .add({5.0F, 6.0F, 7.0F, 8.0F, 9.0F, 10.0F})
                             .add<std::uint8_t>({0, 2, 0, 0}));
    document["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", 0}, {"byteOffset", 68}, {"componentType", 5121}}},
        {"values", {{"bufferView", 0}, {"byteOffset", 44}}}};
    CHECK(primitive(read(document)).positions == std::vector<glm::vec3>{{5, 6, 7}, {1, 0, 0}, {8, 9, 10}});
    document["accessors"][0].erase("bufferView");
    CHECK(primitive(read(document)).positions == std::vector<glm::vec3>{{5, 6, 7}, {0, 0, 0}, {8, 9, 10}});
}

TEST_CASE("Accessors: an accessor without a view yields zeros, for indices too") {
    json document = triangle_document();
    document["accessors"][1].erase("bufferView");
    document["accessors"][1].erase("byteOffset");
    CHECK(primitive(read(document)).indices == std::vector<std::uint32_t>{0, 0, 0});
}

TEST_CASE("Accessors: an integer may be written as 3.0") {
    json document = triangle_document();
    document["accessors"][0]["count"] = 3.0;
    document["meshes"][0]["primitives"][0]["indices"] = 1.0;
    CHECK(primitive(read(document)).positions.size() == 3);
    document["accessors"][0]["count"] = 2.5;
    CHECK(refusal(document).pointer == "/accessors/0/count");
}

TEST_CASE(
    "Morph targets: positions, normals and tangents are read, and so are the weights of mesh and node") {
    json document = triangle_document();
    document["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}, {{"NORMAL", 0}, {"TANGENT", 0}}};
    document["meshes"][0]["weights"] = {0.25, 0.5};
    document["nodes"][0]["weights"] = {1.0, 0.0};
    const Model model = read(document);
    REQUIRE(primitive(model).targets.size() == 2);
    CHECK(primitive(model).targets[0].positions[1] == glm::vec3(1, 0, 0));
    CHECK(primitive(model).targets[0].normals.empty());
    CHECK(primitive(model).targets[1].tangents[2] == glm::vec3(0, 1, 0));
    CHECK(model.meshes[0].weights == std::vector<float>{0.25F, 0.5F});
    CHECK(model.nodes[0].weights == std::vector<float>{1.0F, 0.0F});
}

TEST_CASE("Skins: the four strongest of eight influences are kept and normalised to a sum of 1") {
    json document = triangle_document();
    Bytes bytes;
    bytes.add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
    bytes.add<std::uint16_t>({0, 1, 2, 0});
    for (int vertex = 0; vertex < 3; ++vertex) bytes.add<std::uint8_t>({1, 2, 3, 4});
    for (int vertex = 0; vertex < 3; ++vertex) bytes.add<std::uint8_t>({5, 6, 7, 8});
    for (int vertex = 0; vertex < 3; ++vertex) bytes.add({0.25F, 0.0625F, 0.0625F, 0.0F});
    for (int vertex = 0; vertex < 3; ++vertex) bytes.add({0.125F, 0.375F, 0.125F, 0.0F});
    set_buffer(document, bytes);
    auto& attributes = document["meshes"][0]["primitives"][0]["attributes"];
    const char* names[] = {"JOINTS_0", "JOINTS_1", "WEIGHTS_0", "WEIGHTS_1"};
    for (int i = 0; i < 4; ++i) {
        attributes[names[i]] = 2 + i;
        document["accessors"].push_back({{"bufferView", 0},
                                         {"byteOffset", i < 2 ? 44 + 12 * i : 68 + 48 * (i - 2)},
                                         {"componentType", i < 2 ? 5121 : 5126},
                                         {"count", 3},
                                         {"type", "VEC4"}});
    }
    const Model model = read(document);
    CHECK(primitive(model).joints[2] == glm::u16vec4(6, 1, 5, 7));
    // The four largest weights are 0.375, 0.25, 0.125 and 0.125; their sum is 0.875.
    CHECK(primitive(model).weights[2].x == doctest::Approx(0.375 / 0.875));
    CHECK(primitive(model).weights[2].w == doctest::Approx(0.125 / 0.875));
    document["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_1");
    CHECK(refusal(document).pointer == "/meshes/0/primitives/0/attributes");
}
