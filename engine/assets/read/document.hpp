// A glTF file on its way to a Model: its JSON, checked in its shape (check_shape), the bytes of its buffers
// and images, and the typed form of it that tinygltf makes. tinygltf itself trusts files, so it never sees a
// document that was not checked, nor any file but this one: buffers and images are loaded here.
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
    std::string file;              // as named in errors
    std::filesystem::path folder;  // external files lie in it or below
    std::string bytes;             // the whole file
    nlohmann::json json;
    std::span<const std::uint8_t> chunk;                 // the binary chunk of a .glb
    std::vector<std::span<const std::uint8_t>> buffers;  // each of its byteLength
    std::vector<std::vector<std::uint8_t>> images;       // encoded
    std::vector<std::vector<std::uint8_t>> loaded;       // owns what `buffers` shows of other files
    tinygltf::Model gltf;
    std::size_t budget = std::size_t{64} << 20U;  // bytes that may still be unpacked; grows with the buffers
};

// The error about a value of the document.
tl::unexpected<Error> bad(const Document& document, std::string pointer, std::string what,
                          std::string expected = {});

// Finds JSON and binary chunk in `bytes` and parses the JSON, no deeper than 64 levels.
Status parse_document(Document& document);

// Types, ranges and indices of every value that the reader uses; extensions that it needs and lacks.
Status check_shape(Document& document);

// The bytes of the buffers, and those of images once buffers are there.
Status load_buffers(Document& document);
Status load_images(Document& document);

}  // namespace bolt::assets
