// A glTF file while it is converted to a Model: its JSON (validated by check_schema), the bytes of its
// buffers and images, and tinygltf's typed form. tinygltf trusts its input, so it sees only validated
// documents and opens no files: buffers and images are loaded here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/assets/read/tinygltf.hpp"
#include "engine/base/result.hpp"

namespace bolt::assets {

struct Document {
    std::string file;              // the name used in errors
    std::filesystem::path folder;  // external files must lie in it or below
    std::string bytes;             // the whole file
    nlohmann::json json;
    std::span<const std::uint8_t> chunk;                 // the binary chunk of a .glb
    std::vector<std::span<const std::uint8_t>> buffers;  // each of its byteLength
    std::vector<std::vector<std::uint8_t>> images;       // encoded
    std::vector<std::vector<std::uint8_t>> loaded;       // owns the external files that `buffers` refers to
    tinygltf::Model gltf;
    std::size_t budget = std::size_t{64} << 20U;  // bytes that may still be unpacked; grows with the buffers
};

// Returns an error about the value at a JSON pointer.
tl::unexpected<Error> error_at(const Document& document, std::string pointer, std::string what,
                               std::string expected = {});

// Finds the JSON and binary chunks in `bytes` and parses the JSON, at most 64 levels deep.
Status parse_document(Document& document);

// Checks the type, range and index of every value that the reader uses, and the required extensions.
Status check_schema(Document& document);

// Loads the bytes of the buffers, and those of images, which need the buffers.
Status load_buffers(Document& document);
Status load_images(Document& document);

// Unpacks accessors of any component type, stride and offset, normalised or sparse, into floats or unsigned
// integers. Every byte is bounds-checked before it is read.

// Checks that every buffer view lies in its buffer, every accessor in its view, and that types and counts are
// valid.
Status check_views(const Document& document);
Status check_accessors(const Document& document);

// The component types that are allowed where an accessor is used.
enum class NumberFormats : std::uint8_t {
    real,       // float
    unit,       // float, or integers normalised to [0, 1] or [-1, 1]
    quantized,  // every type that KHR_mesh_quantization allows
};

// Returns the elements of an accessor as floats, one component after the other, all finite. `type` is
// tinygltf's number (TINYGLTF_TYPE_VEC3), `pointer` the place where the accessor is used.
Result<std::vector<float>> unpack_floats(Document& document, int accessor, int type, NumberFormats numbers,
                                         const std::string& pointer);

// The same for unsigned integers.
Result<std::vector<std::uint32_t>> unpack_integers(Document& document, int accessor, int type,
                                                   const std::string& pointer);

// Converts the sections of a validated document to a Model.

Status read_meshes(Document& document, Model& model);
Status read_materials(const Document& document, Model& model);
Status read_textures(Document& document, Model& model);
Status read_nodes(const Document& document, Model& model);
Status read_skins(Document& document, Model& model);
Status read_animations(Document& document, Model& model);
Status read_cameras(const Document& document, Model& model);
Status read_lights(const Document& document, Model& model);

}  // namespace bolt::assets
