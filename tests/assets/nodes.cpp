// Conversion of nodes, cameras, lights, skins, animations and materials from JSON to the model.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/assets/document.hpp"

using namespace bolt;
using namespace bolt::assets;

TEST_CASE("Nodes: a matrix is decomposed into translation, rotation and scale, also with a reflection") {
    json document = triangle_document();
    // Rotated by 90° about Z, scaled by 2, 3, 4, moved to 5, 6, 7; by columns.
    document["nodes"][0]["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
    const Node node = read(document).nodes[0];
    CHECK(node.translation == glm::vec3(5, 6, 7));
    CHECK(node.scale == glm::vec3(2, 3, 4));
    CHECK(node.rotation.z == doctest::Approx(std::sqrt(0.5)));
    CHECK(node.rotation.w == doctest::Approx(std::sqrt(0.5)));
    document["nodes"][0]["matrix"] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    CHECK(read(document).nodes[0].scale == glm::vec3(-1, 1, 1));
    document["nodes"][0]["matrix"] = {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    CHECK(refusal(document).pointer == "/nodes/0/matrix");
}

TEST_CASE(
    "Nodes: the roots are those of the default scene, or the nodes without a parent if no scene exists") {
    json document = triangle_document();
    document["nodes"] = {{{"name", "a"}}, {{"name", "b"}, {"children", {0}}}, {{"name", "c"}}};
    document.erase("scenes");
    document.erase("scene");
    CHECK(read(document).roots == std::vector<int>{1, 2});
    document["scenes"] = {{{"nodes", {1}}}, {{"nodes", {2}}}};
    CHECK(read(document).roots == std::vector<int>{1});
    document["scene"] = 1;
    CHECK(read(document).roots == std::vector<int>{2});
}

TEST_CASE("Nodes: extras are kept as JSON") {
    json document = triangle_document();
    document["nodes"][0]["extras"] = {{"joint", "B1"}, {"torque_Nm", 210.5}};
    CHECK(json::parse(read(document).nodes[0].extras) == document["nodes"][0]["extras"]);
}

TEST_CASE("Cameras: perspective cameras with an infinite far plane and orthographic cameras are read") {
    json document = triangle_document();
    document["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.125}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 4}}}}};
    document["nodes"][0]["camera"] = 1;
    const Model model = read(document);
    REQUIRE(model.cameras.size() == 2);
    CHECK(model.cameras[0].perspective);
    CHECK(model.cameras[0].yfov == 0.5F);
    CHECK(model.cameras[0].zfar == 0.0F);
    CHECK(model.cameras[0].aspect == 0.0F);
    CHECK_FALSE(model.cameras[1].perspective);
    CHECK(model.cameras[1].xmag == 2.0F);
    CHECK(model.cameras[1].zfar == 4.0F);
    CHECK(model.nodes[0].camera == 1);
}

TEST_CASE("Lights: types, defaults and the node's reference are read") {
    json document = triangle_document();
    document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}, {"intensity", 3.5}, {"color", {1.0, 0.5, 0.25}}},
        {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"range", 9}}};
    document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
    const Model model = read(document);
    REQUIRE(model.lights.size() == 2);
    CHECK(model.lights[0].type == LightType::directional);
    CHECK(model.lights[0].intensity == 3.5F);
    CHECK(model.lights[0].color == glm::vec3(1.0F, 0.5F, 0.25F));
    CHECK(model.lights[1].type == LightType::spot);
    CHECK(model.lights[1].intensity == 1.0F);
    CHECK(model.lights[1].range == 9.0F);
    CHECK(model.lights[1].inner_cone == 0.0F);
    CHECK(model.lights[1].outer_cone == 0.5F);
    CHECK(model.nodes[0].light == 1);
}

TEST_CASE("Materials: extensions are read, and missing values have their defaults") {
    json document = triangle_document();
    document["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"] = {json::parse(R"({"extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
            "clearcoatTexture": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
                {"offset": [0.5, 0.75], "rotation": 0.125, "scale": [2, 4], "texCoord": 0}}}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.75, "anisotropyRotation": -1.5},
        "KHR_materials_ior": {"ior": 1.75},
        "KHR_materials_specular": {"specularFactor": 0.125, "specularColorFactor": [0.25, 0.5, 2.0],
            "specularColorTexture": {"index": 0}},
        "KHR_materials_emissive_strength": {"emissiveStrength": 8}}})"),
                             json::object()};
    const Model model = read(document);
    const Material& m = model.materials[0];
    CHECK(m.clearcoat == 0.5F);
    CHECK(m.clearcoat_roughness == 0.25F);
    CHECK(m.clearcoat_texture.texture == 0);
    CHECK(m.clearcoat_texture.texcoord == 0);  // the transform's value takes precedence
    CHECK(m.clearcoat_texture.offset == glm::vec2(0.5F, 0.75F));
    CHECK(m.clearcoat_texture.rotation == 0.125F);
    CHECK(m.clearcoat_texture.scale == glm::vec2(2.0F, 4.0F));
    CHECK(m.anisotropy == 0.75F);
    CHECK(m.anisotropy_rotation == -1.5F);
    CHECK(m.ior == 1.75F);
    CHECK(m.specular == 0.125F);
    CHECK(m.specular_color == glm::vec3(0.25F, 0.5F, 2.0F));
    CHECK(m.specular_color_texture.texture == 0);
    CHECK(m.emissive_strength == 8.0F);
    const Material& plain = model.materials[1];
    CHECK(plain.metallic == 1.0F);
    CHECK(plain.roughness == 1.0F);
    CHECK(plain.alpha_mode == AlphaMode::opaque);
    CHECK(plain.alpha_cutoff == 0.5F);
    CHECK(plain.emissive_strength == 1.0F);
    CHECK(plain.normal_scale == 1.0F);
}

TEST_CASE("Skins: inverse bind matrices are stored by columns and are optional") {
    json document = triangle_document();
    Bytes bytes;
    bytes.add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
    bytes.add<std::uint16_t>({0, 1, 2, 0});
    bytes.add({1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, 2.F, 3.F, 4.F, 1.F});
    set_buffer(document, bytes);
    document["accessors"].push_back(
        {{"bufferView", 0}, {"byteOffset", 44}, {"componentType", 5126}, {"count", 1}, {"type", "MAT4"}});
    document["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 2}, {"skeleton", 0}}, {{"joints", {0}}}};
    const Model model = read(document);
    REQUIRE(model.skins.size() == 2);
    CHECK(model.skins[0].joints == std::vector<int>{0});
    CHECK(model.skins[0].inverse_bind.at(0)[3] == glm::vec4(2, 3, 4, 1));
    CHECK(model.skins[1].inverse_bind.empty());
}

TEST_CASE("Animations: every target has one channel, and channels without a node are ignored") {
    json document = triangle_document();
    // Accessor 0, the positions, is the output of the sampler; accessor 2 holds three key times.
    Bytes bytes;
    bytes.add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F});
    bytes.add<std::uint16_t>({0, 1, 2, 0});
    bytes.add({0.0F, 0.5F, 2.0F});
    set_buffer(document, bytes);
    document["accessors"].push_back(
        {{"bufferView", 0}, {"byteOffset", 44}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
    document["animations"] = json::array({json::parse(R"({"name": "slide",
        "samplers": [{"input": 2, "output": 0, "interpolation": "STEP"}],
        "channels": [{"sampler": 0, "target": {"path": "pointer"}},
                     {"sampler": 0, "target": {"node": 0, "path": "translation"}}]})")});
    const Model model = read(document);
    REQUIRE(model.animations.size() == 1);
    REQUIRE(model.animations[0].channels.size() == 1);
    const AnimationChannel& channel = model.animations[0].channels[0];
    json foreign = document;
    foreign["animations"][0]["channels"].erase(1);
    CHECK(read(foreign).animations.empty());
    CHECK(channel.node == 0);
    CHECK(channel.interpolation == Interpolation::step);
    CHECK(channel.times == std::vector<float>{0.0F, 0.5F, 2.0F});
    CHECK(channel.values == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
}

TEST_CASE("Nodes: a nearly unit rotation is normalised and can be written again") {
    json document = triangle_document();
    document["nodes"][0]["rotation"] = {0.0, 0.0, 0.6, 0.805};
    const Model model = read(document);
    CHECK(glm::length(model.nodes[0].rotation) == doctest::Approx(1.0).epsilon(1e-6));
    CHECK(encode_glb(model));
}

TEST_CASE("Images: an image of an optional extension is ignored") {
    json document = triangle_document();
    document["images"] = {{{"uri", "data:application/octet-stream;base64,UklGRg=="}},
                          {{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
    document["textures"] = {{{"source", 1}, {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    const Model model = read(document);
    CHECK(model.textures[0].image == 1);
    CHECK(model.images[1].mime_type == "image/png");
}
