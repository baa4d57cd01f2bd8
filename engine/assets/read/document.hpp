// A glTF file while it is converted to a Model: its JSON, the bytes of its buffers and images, its accessors,
// and the steps that fill the Model. tinygltf trusts its input, so it parses only JSON that check_schema has
// validated, and opens no files: buffers and images are loaded here.
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
    std::string file;              // the name in errors
    std::filesystem::path folder;  // external files must lie in it or below
    std::string bytes;             // the whole file
    nlohmann::json json;
    std::span<const std::uint8_t> chunk;                 // the binary chunk of a .glb
    std::vector<std::span<const std::uint8_t>> buffers;  // each as long as its byteLength
    std::vector<std::vector<std::uint8_t>> images;       // encoded
    std::vector<std::vector<std::uint8_t>> loaded;       // files and data URIs to which `buffers` refers
    tinygltf::Model gltf;
    std::size_t unpack_budget = std::size_t{64} << 20U;  // bytes left for unpacking; grows with the buffers
};

// Returns an error about the value at a JSON pointer.
tl::unexpected<Error> error_at(const Document& document, std::string pointer, std::string what,
                               std::string expected = {});

// Finds the JSON and binary chunks in `bytes` and parses the JSON, at most 64 levels deep.
Status parse_document(Document& document);

// Checks the type and the range of every value that the reader uses, every index, and the required
// extensions.
Status check_schema(Document& document);

// Load the bytes of the buffers and of the images. Images may be stored in buffers: call load_buffers and
// check_views first.
Status load_buffers(Document& document);
Status load_images(Document& document);

// Check that every buffer view lies in its buffer and every accessor in its view, and that types and counts
// are valid. After that, unpacking cannot read outside a buffer.
Status check_views(const Document& document);
Status check_accessors(const Document& document);

// The component types that a use of an accessor allows.
enum class NumberFormats : std::uint8_t {
    real,       // float
    unit,       // float, or integers normalised to [0, 1] or [-1, 1]
    quantized,  // every type that KHR_mesh_quantization allows
};

// Unpacks the elements of an accessor of any component type, stride and offset, normalised or sparse. Returns
// floats, one component after the other, all finite. `type`: the required element type (TINYGLTF_TYPE_VEC3).
// `pointer`: where the accessor is used.
Result<std::vector<float>> unpack_floats(Document& document, int accessor, int type, NumberFormats numbers,
                                         const std::string& pointer);

// The same for unsigned integers.
Result<std::vector<std::uint32_t>> unpack_integers(Document& document, int accessor, int type,
                                                   const std::string& pointer);

// Convert the sections of a validated document to a Model.
Status read_meshes(Document& document, Model& model);
Status read_materials(const Document& document, Model& model);
Status read_textures(Document& document, Model& model);
Status read_nodes(const Document& document, Model& model);
Status read_skins(Document& document, Model& model);
Status read_animations(Document& document, Model& model);
Status read_cameras(const Document& document, Model& model);
Status read_lights(const Document& document, Model& model);

}  // namespace bolt::assets
