// glTF 2.0 files to and from Model. Reading checks everything that it uses: a hostile file ends in an Error
// that names the file and the JSON pointer, never in a crash. Writing gives the same bytes for the same
// model.
#pragma once

#include <filesystem>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::assets {

// A .glb or .gltf file, with its buffers and images (encoded; image.hpp decodes them).
Result<Model> read_gltf(const std::filesystem::path& path);

// The same of bytes in memory; `path` is named in errors, and other files of the model are looked for beside
// it.
Result<Model> parse_gltf(std::string bytes, const std::filesystem::path& path);

struct WriteOptions {
    // Normals and tangents in 16 bits (KHR_mesh_quantization), texture coordinates within [0, 1], colours and
    // weights in 16 bits too. Positions stay exact. About two thirds of the size.
    bool quantize = false;
};

// A single .glb: indices as small as they can be, streams interleaved by accessor, extensions listed as used.
Status write_glb(const std::filesystem::path& path, const Model& model);
Status write_glb(const std::filesystem::path& path, const Model& model, const WriteOptions& options);

// The bytes of that file. Errors name the pointer that the wrong value would have.
Result<std::string> encode_glb(const Model& model, const WriteOptions& options = {});

}  // namespace bolt::assets
