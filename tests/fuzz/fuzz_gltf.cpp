// glTF files: any bytes give a consistent model or an error that names the problem, never a crash. A loaded
// model can be written and read again.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/assets/model.hpp"

namespace {

using namespace bolt::assets;

void require(bool condition, const std::string& what) {
    if (condition) return;
    (void)std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}

bool below(int index, std::size_t count) { return index >= -1 && index < static_cast<int>(count); }

void check_primitive(const Model& model, const Primitive& p) {
    const std::size_t count = p.positions.size();
    const auto fits = [count](const auto& stream) { return stream.empty() || stream.size() == count; };
    require(count > 0 && fits(p.normals) && fits(p.tangents) && fits(p.texcoords[0]) &&
                fits(p.texcoords[1]) && fits(p.colors) && fits(p.joints) && fits(p.weights),
            "streams of different lengths");
    for (const std::uint32_t index : triangle_indices(p)) require(index < count, "an index past the end");
    require(below(p.material, model.materials.size()), "a wild material");
}

void check(const Model& model) {
    (void)world_transforms(model);
    for (const Node& node : model.nodes) {
        require(below(node.mesh, model.meshes.size()) && below(node.skin, model.skins.size()) &&
                    below(node.camera, model.cameras.size()) && below(node.light, model.lights.size()),
                "a wild reference of a node");
        for (const int child : node.children) require(below(child, model.nodes.size()), "a wild child");
    }
    for (const Mesh& mesh : model.meshes)
        for (const Primitive& primitive : mesh.primitives) check_primitive(model, primitive);
    for (const Texture& texture : model.textures)
        require(below(texture.image, model.images.size()), "a wild image");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    auto model = parse_gltf(bytes, "/nowhere/fuzz.gltf");
    if (!model) {
        require(!model.error().what.empty() && !model.error().file.empty(), "an error that says nothing");
        // tinygltf receives only checked input, so its own errors, which lack a JSON pointer, must not occur.
        require(!model.error().what.starts_with("tinygltf"), model.error().message());
        return 0;
    }
    check(*model);
    for (Bitmap image : model->images) (void)decode(image);
    for (const bool quantize : {false, true}) {
        const auto written = encode_glb(*model, {.quantize = quantize});
        require(written.has_value(), written ? "" : "cannot be written: " + written.error().message());
        const auto again = parse_gltf(*written, "/nowhere/again.glb");
        require(again.has_value(), again ? "" : "cannot be read again: " + again.error().message());
        require(again->nodes.size() == model->nodes.size() && again->meshes.size() == model->meshes.size(),
                "comes back another");
    }
    return 0;
}
