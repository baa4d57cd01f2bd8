// External files of a document, and models that cannot be written.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "engine/base/file.hpp"
#include "tests/assets/document.hpp"
#include "tests/assets/sample.hpp"

using namespace bolt;
using namespace bolt::assets;

namespace {

struct Folder {
    Folder() : path(TemporaryFile("folder").path) {
        std::filesystem::remove_all(path);
        std::filesystem::create_directories(path / "model" / "sub");
    }
    ~Folder() {
        std::error_code none;
        std::filesystem::remove_all(path, none);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::filesystem::path path;
};

std::string triangle_bytes() {
    const Bytes bytes =
        Bytes().add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F}).add<std::uint16_t>({0, 1, 2, 0});
    return {bytes.get().begin(), bytes.get().end()};
}

Result<Model> read_beside(const Folder& folder, const std::string& uri) {
    json document = triangle_document();
    document["buffers"][0]["uri"] = uri;
    REQUIRE(write_file(folder.path / "model" / "a.gltf", document.dump()));
    return read_gltf(folder.path / "model" / "a.gltf");
}

}  // namespace

TEST_CASE("Files: a buffer beside or below the document is found, also by a percent-encoded name") {
    const Folder folder;
    REQUIRE(write_file(folder.path / "model" / "sub" / "two words+ü.bin", triangle_bytes() + "more"));
    const auto model = read_beside(folder, "sub/two%20words+%C3%BC.bin");
    REQUIRE_MESSAGE(model, model.error().message());
    CHECK(model->meshes[0].primitives[0].positions[1] == glm::vec3(1, 0, 0));
}

TEST_CASE("Files: a missing buffer is an error that names it") {
    const Folder folder;
    const auto model = read_beside(folder, "missing.bin");
    REQUIRE_FALSE(model);
    CHECK(model.error().pointer == "/buffers/0/uri");
    CHECK(model.error().what.find("missing.bin") != std::string::npos);
    CHECK(model.error().file == (folder.path / "model" / "a.gltf").string());
}

TEST_CASE("Files: a link out of the folder is not followed") {
    const Folder folder;
    REQUIRE(write_file(folder.path / "outside.bin", triangle_bytes()));
    std::filesystem::create_symlink(folder.path / "outside.bin", folder.path / "model" / "link.bin");
    const auto model = read_beside(folder, "link.bin");
    REQUIRE_FALSE(model);
    CHECK(model.error().pointer == "/buffers/0/uri");
    // The same file inside the folder is read.
    std::filesystem::rename(folder.path / "outside.bin", folder.path / "model" / "inside.bin");
    CHECK(read_beside(folder, "inside.bin"));
}

TEST_CASE("Files: a document whose path has no folder finds its buffers beside it") {
    const Folder folder;
    REQUIRE(write_file(folder.path / "model" / "b.bin", triangle_bytes()));
    REQUIRE(write_file(folder.path / "outside.bin", triangle_bytes()));
    json document = triangle_document();
    document["buffers"][0]["uri"] = "b.bin";
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path / "model");
    const auto model = parse_gltf(document.dump(), "a.gltf");
    std::filesystem::create_symlink("../outside.bin", "link.bin");
    document["buffers"][0]["uri"] = "link.bin";
    const auto outside = parse_gltf(document.dump(), "a.gltf");
    std::filesystem::current_path(before);
    CHECK_FALSE(outside);
    CHECK_MESSAGE(model, model.error().message());
}

TEST_CASE("Files: a missing file or a folder is an error") {
    CHECK(read_gltf("nowhere/a.glb").error().file == "nowhere/a.glb");
    CHECK_FALSE(read_gltf(std::filesystem::temp_directory_path()));
}

TEST_CASE("Files: an invalid model is not written") {
    const auto refused = [](const auto& spoil) {
        Model model = sample_model();
        spoil(model);
        const auto bytes = encode_glb(model);
        REQUIRE_FALSE(bytes);
        return bytes.error().pointer;
    };
    CHECK(refused([](Model& m) { m.meshes[0].primitives.clear(); }) == "/meshes/0");
    CHECK(refused([](Model& m) { m.meshes[1].primitives[0].normals.pop_back(); }) ==
          "/meshes/1/primitives/0");
    CHECK(refused([](Model& m) { m.meshes[0].primitives[0].indices[1] = 3; }) == "/meshes/0/primitives/0");
    CHECK(refused([](Model& m) { m.meshes[0].primitives[0].indices.pop_back(); }) ==
          "/meshes/0/primitives/0");
    CHECK(refused([](Model& m) { m.meshes[0].primitives[0].positions[0].x = NAN; }) ==
          "/meshes/0/primitives/0");
    CHECK(refused([](Model& m) { m.meshes[0].primitives[0].material = 2; }) ==
          "/meshes/0/primitives/0/material");
    CHECK(refused([](Model& m) { m.nodes[1].mesh = 2; }) == "/nodes/1");
    CHECK(refused([](Model& m) { m.nodes[0].children = {9}; }) == "/nodes/0/children");
    CHECK(refused([](Model& m) { m.nodes[0].rotation.w = 2.0F; }) == "/nodes/0/rotation");
    CHECK(refused([](Model& m) { m.nodes[0].extras = "{"; }) == "/nodes/0/extras");
    CHECK(refused([](Model& m) { m.skins[0].joints = {7, 8}; }) == "/skins/0/joints");
    CHECK(refused([](Model& m) { m.animations[0].channels[0].values.pop_back(); }) == "/animations/0");
    CHECK(refused([](Model& m) { m.images[0].pixels.pop_back(); }) == "/images/0");
}

TEST_CASE("Quantization: files are smaller, and values are close") {
    Model model = sample_model();
    Primitive& many = model.meshes[0].primitives[0];
    const auto repeat = [](auto& stream) {
        const auto once = stream;
        for (int i = 1; i < 1000; ++i) stream.insert(stream.end(), once.begin(), once.end());
    };
    repeat(many.positions);
    repeat(many.normals);
    repeat(many.tangents);
    repeat(many.texcoords[0]);
    repeat(many.texcoords[1]);
    repeat(many.colors);
    const auto exact = encode_glb(model);
    const auto small = encode_glb(model, {.quantize = true});
    REQUIRE(exact);
    REQUIRE(small);
    // Normals 12 to 8 bytes, tangents 16 to 8, the first texture coordinates 8 to 4, colours 16 to 8.
    CHECK(exact->size() - small->size() == doctest::Approx(3000 * 24).epsilon(0.01));
    const auto read = parse_gltf(*small, "small.glb");
    REQUIRE_MESSAGE(read, read.error().message());
    const Primitive& a = read->meshes[1].primitives[0];
    const Primitive& b = model.meshes[1].primitives[0];
    CHECK(a.positions == b.positions);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(glm::distance(a.normals[i], b.normals[i]) < 3e-5F);
        CHECK(glm::distance(a.tangents[i], b.tangents[i]) < 3e-5F);
        CHECK(glm::distance(a.texcoords[0][i], b.texcoords[0][i]) < 1e-5F);
        CHECK(a.texcoords[1][i] == b.texcoords[1][i]);  // outside [0, 1]: kept as floats
        const float sum = a.weights[i].x + a.weights[i].y + a.weights[i].z + a.weights[i].w;
        CHECK(std::abs(sum - 1.0F) < 1e-6F);
        CHECK(glm::distance(a.weights[i], b.weights[i]) < 2e-5F);
    }
}

TEST_CASE("Writing: indices take 16 bits if the largest is below the restart value") {
    const auto size = [](std::uint32_t vertices) {
        Model model;
        Primitive p;
        p.positions.resize(vertices);
        for (std::uint32_t i = 0; i < 3000; ++i) p.indices.push_back(vertices - 1 - i);
        model.meshes = {{.name = "many", .primitives = {p}}};
        return encode_glb(model)->size();
    };
    // 65535 vertices have indices up to 65534; one more needs 32 bits: 2 × 3000 bytes and one position.
    CHECK(size(65536) - size(65535) >= 6000 + 12);
    CHECK(size(65535) - size(65534) < 100);
}
