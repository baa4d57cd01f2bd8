// glTF documents made by hand: JSON with the buffer in it.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/assets/gltf.hpp"

namespace bolt::assets {

using nlohmann::json;

// Bytes to be, in little-endian order.
class Bytes {
  public:
    template <class T>
    Bytes& add(std::initializer_list<T> values) {
        for (const T value : values) {
            std::uint8_t raw[sizeof(T)];
            std::memcpy(raw, &value, sizeof value);
            bytes_.insert(bytes_.end(), raw, raw + sizeof value);
        }
        return *this;
    }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] const std::vector<std::uint8_t>& get() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;
};

std::string base64(const std::vector<std::uint8_t>& bytes);

// Puts the bytes into the document as its only buffer, with one view over all of it.
void set_buffer(json& document, const Bytes& bytes);

// One triangle (0,0,0), (1,0,0), (0,1,0): positions as accessor 0, indices 0, 1, 2 (16 bits) as accessor 1.
json triangle_document();

// A .glb of it, with `chunk` as binary chunk if not empty.
std::string glb(const json& document, const std::string& chunk);

// Reads the document; fails the test where that fails.
Model read(const json& document);

// The error of a document that must not be read.
Error refusal(const json& document);

}  // namespace bolt::assets
