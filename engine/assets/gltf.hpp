// Reads and writes glTF 2.0 files. Reading validates everything that it uses: a malformed or hostile file
// gives an Error that names the file and the JSON pointer, never a crash. Writing gives the same bytes for
// the same model.
#pragma once

#include <filesystem>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::assets {

// Reads a .glb or .gltf file with its buffers and its images, which stay encoded (image.hpp decodes them).
Result<Model> read_gltf(const std::filesystem::path& path);

// The same for the bytes of a file in memory. Errors name `path`, and other files of the model are searched
// for in the folder of `path`.
Result<Model> parse_gltf(std::string bytes, const std::filesystem::path& path);

struct WriteOptions {
    // Store normals, tangents, texture coordinates within [0, 1], colours and weights with 16 bits
    // (KHR_mesh_quantization). Positions stay exact. The file shrinks to about two thirds.
    bool quantize = false;
};

// Writes a single .glb with 16-bit indices where they suffice and a list of all extensions used. Vertex
// streams are not interleaved: each accessor is contiguous.
Status write_glb(const std::filesystem::path& path, const Model& model);
Status write_glb(const std::filesystem::path& path, const Model& model, const WriteOptions& options);

// Returns the bytes of such a file. Errors name the JSON pointer at which the invalid value would be written.
Result<std::string> encode_glb(const Model& model, const WriteOptions& options = {});

}  // namespace bolt::assets
