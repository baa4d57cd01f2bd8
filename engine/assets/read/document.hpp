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

}  // namespace bolt::assets
