#include <doctest/doctest.h>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "tests/assets/sample.hpp"

using namespace bolt;
using namespace bolt::assets;

namespace {

Model through_file(const Model& model, const WriteOptions& options = {}) {
    const TemporaryFile file("round_trip.glb");
    const Status written = write_glb(file.path, model, options);
    REQUIRE_MESSAGE(written, written.error().message());
    auto read = read_gltf(file.path);
    REQUIRE_MESSAGE(read, read.error().message());
    return std::move(*read);
}

std::string bytes_of(const Model& model) {
    const TemporaryFile file("bytes.glb");
    REQUIRE(write_glb(file.path, model));
    return read_file(file.path, 1U << 20U, ErrorCode::failed).value();
}

bool same(const TextureRef& a, const TextureRef& b) {
    return a.texture == b.texture && a.texcoord == b.texcoord && a.offset == b.offset &&
           a.rotation == b.rotation && a.scale == b.scale;
}

}  // namespace

TEST_CASE("Round trip: nodes are bit-identical after writing and reading a .glb") {
    const Model model = sample_model();
    const Model read = through_file(model);
    CHECK(read.generator == model.generator);
    CHECK(read.copyright == model.copyright);
    CHECK(read.roots == model.roots);
    REQUIRE(read.nodes.size() == model.nodes.size());
    for (std::size_t i = 0; i < read.nodes.size(); ++i) {
        const Node& a = read.nodes[i];
        const Node& b = model.nodes[i];
        CAPTURE(i);
        CHECK(a.name == b.name);
        CHECK(a.translation == b.translation);
        CHECK(a.rotation == b.rotation);
        CHECK(a.scale == b.scale);
        CHECK(a.children == b.children);
        CHECK(a.mesh == b.mesh);
        CHECK(a.skin == b.skin);
        CHECK(a.camera == b.camera);
        CHECK(a.light == b.light);
        CHECK(a.weights == b.weights);
        CHECK(a.extras == b.extras);
    }
}

TEST_CASE("Round trip: meshes and skins are bit-identical") {
    const Model model = sample_model();
    const Model read = through_file(model);
    REQUIRE(read.meshes.size() == model.meshes.size());
    for (std::size_t i = 0; i < read.meshes.size(); ++i) {
        REQUIRE(read.meshes[i].primitives.size() == 1);
        const Primitive& a = read.meshes[i].primitives[0];
        const Primitive& b = model.meshes[i].primitives[0];
        CHECK(read.meshes[i].name == model.meshes[i].name);
        CHECK(read.meshes[i].weights == model.meshes[i].weights);
        CHECK(a.topology == b.topology);
        CHECK(a.positions == b.positions);
        CHECK(a.normals == b.normals);
        CHECK(a.tangents == b.tangents);
        CHECK(a.texcoords == b.texcoords);
        CHECK(a.colors == b.colors);
        CHECK(a.joints == b.joints);
        CHECK(a.weights == b.weights);
        CHECK(a.indices == b.indices);
        CHECK(a.material == b.material);
        REQUIRE(a.targets.size() == b.targets.size());
        for (std::size_t k = 0; k < a.targets.size(); ++k) {
            CHECK(a.targets[k].positions == b.targets[k].positions);
            CHECK(a.targets[k].normals == b.targets[k].normals);
        }
    }
    REQUIRE(read.skins.size() == 1);
    CHECK(read.skins[0].joints == model.skins[0].joints);
    CHECK(read.skins[0].inverse_bind == model.skins[0].inverse_bind);
}

TEST_CASE("Round trip: materials are bit-identical") {
    const Model model = sample_model();
    const Model read = through_file(model);
    REQUIRE(read.materials.size() == 2);
    const Material& a = read.materials[0];
    const Material& b = model.materials[0];
    CHECK(a.name == b.name);
    CHECK(a.base_color == b.base_color);
    CHECK(a.metallic == b.metallic);
    CHECK(a.roughness == b.roughness);
    CHECK(a.normal_scale == b.normal_scale);
    CHECK(a.occlusion_strength == b.occlusion_strength);
    CHECK(a.emissive == b.emissive);
    CHECK(a.emissive_strength == b.emissive_strength);
    CHECK(a.alpha_mode == b.alpha_mode);
    CHECK(a.alpha_cutoff == b.alpha_cutoff);
    CHECK(a.double_sided == b.double_sided);
    CHECK(a.clearcoat == b.clearcoat);
    CHECK(a.clearcoat_roughness == b.clearcoat_roughness);
    CHECK(a.anisotropy == b.anisotropy);
    CHECK(a.anisotropy_rotation == b.anisotropy_rotation);
    CHECK(a.ior == b.ior);
    CHECK(a.specular == b.specular);
    CHECK(a.specular_color == b.specular_color);
    CHECK(same(a.base_color_texture, b.base_color_texture));
    CHECK(same(a.metallic_roughness_texture, b.metallic_roughness_texture));
    CHECK(same(a.normal_texture, b.normal_texture));
    CHECK(same(a.occlusion_texture, b.occlusion_texture));
    CHECK(same(a.emissive_texture, b.emissive_texture));
    CHECK(same(a.clearcoat_texture, b.clearcoat_texture));
    CHECK(same(a.clearcoat_roughness_texture, b.clearcoat_roughness_texture));
    CHECK(same(a.clearcoat_normal_texture, b.clearcoat_normal_texture));
    CHECK(same(a.anisotropy_texture, b.anisotropy_texture));
    CHECK(same(a.specular_texture, b.specular_texture));
    CHECK(same(a.specular_color_texture, b.specular_color_texture));
    const Material& plain = read.materials[1];
    CHECK(plain.base_color == glm::vec4(1.0F));
    CHECK(plain.ior == 1.5F);
    CHECK(plain.clearcoat == 0.0F);
    CHECK(plain.base_color_texture.texture == -1);
}

TEST_CASE("Round trip: images, lights, cameras and animations are bit-identical") {
    const Model model = sample_model();
    Model read = through_file(model);
    REQUIRE(read.images.size() == 1);
    CHECK(read.images[0].mime_type == "image/png");
    REQUIRE(decode(read.images[0]));
    CHECK(read.images[0].width == 2);
    CHECK(read.images[0].channels == 3);
    CHECK(read.images[0].pixels == model.images[0].pixels);
    REQUIRE(read.textures.size() == 1);
    CHECK(read.textures[0].mag == Filter::nearest);
    CHECK(read.textures[0].min == Filter::linear);
    CHECK(read.textures[0].mipmapped);
    CHECK(read.textures[0].wrap_s == Wrap::clamp);
    CHECK(read.textures[0].wrap_t == Wrap::mirror);
    REQUIRE(read.lights.size() == model.lights.size());
    for (std::size_t i = 0; i < read.lights.size(); ++i) {
        CHECK(read.lights[i].name == model.lights[i].name);
        CHECK(read.lights[i].type == model.lights[i].type);
        CHECK(read.lights[i].color == model.lights[i].color);
        CHECK(read.lights[i].intensity == model.lights[i].intensity);
        CHECK(read.lights[i].range == model.lights[i].range);
    }
    CHECK(read.lights[2].inner_cone == 0.2F);
    CHECK(read.lights[2].outer_cone == 0.4F);
    REQUIRE(read.cameras.size() == 2);
    CHECK(read.cameras[0].yfov == 0.7F);
    CHECK(read.cameras[0].aspect == 1.5F);
    CHECK(read.cameras[0].zfar == 50.0F);
    CHECK_FALSE(read.cameras[1].perspective);
    CHECK(read.cameras[1].ymag == 0.25F);
    REQUIRE(read.animations.size() == 1);
    REQUIRE(read.animations[0].channels.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        const AnimationChannel& a = read.animations[0].channels[i];
        const AnimationChannel& b = model.animations[0].channels[i];
        CHECK(a.node == b.node);
        CHECK(a.path == b.path);
        CHECK(a.interpolation == b.interpolation);
        CHECK(a.times == b.times);
        CHECK(a.values == b.values);
    }
}

TEST_CASE("Round trip: equal models give equal bytes, and different models give different bytes") {
    Model model = sample_model();
    const std::string bytes = bytes_of(model);
    CHECK(bytes == bytes_of(sample_model()));
    CHECK(bytes == bytes_of(through_file(model)));
    model.nodes[1].translation.x = 1e-7F;
    CHECK(bytes != bytes_of(model));
}
