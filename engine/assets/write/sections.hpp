// Converts the sections of a Model to JSON and adds their data to the buffer.
#pragma once

#include <set>

#include "engine/assets/gltf.hpp"
#include "engine/assets/write/buffer.hpp"

namespace bolt::assets {

struct Writer {
    const Model& model;
    WriteOptions options;
    BufferBuilder buffer;
    std::set<std::string> used;      // extensions
    std::set<std::string> required;  // extensions that a reader must support
};

// Returns an error about the value at `pointer` of the resulting file.
Error error_at(std::string pointer, std::string what, std::string expected = {});

Result<Json> write_mesh(Writer& writer, std::size_t index);
Json write_material(Writer& writer, const Material& material);
Result<Json> write_image(Writer& writer, std::size_t index);
Json write_texture(const Texture& texture, Json& samplers);
Result<Json> write_node(Writer& writer, std::size_t index);
Result<Json> write_skin(Writer& writer, std::size_t index);
Result<Json> write_animation(Writer& writer, std::size_t index);
Json write_camera(const Camera& camera);
Json write_light(const Light& light);

}  // namespace bolt::assets
