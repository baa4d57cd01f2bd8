// Hand-made glTF documents: JSON with an embedded buffer.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/assets/gltf.hpp"

namespace bolt::assets {

using nlohmann::json;

// A little-endian byte buffer.
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

// Embeds the bytes as the document's only buffer, with one view of all of it.
void set_buffer(json& document, const Bytes& bytes);

// One triangle (0,0,0), (1,0,0), (0,1,0): positions as accessor 0, indices 0, 1, 2 (16 bits) as accessor 1.
json triangle_document();

// Returns the document as a .glb, with `chunk` as the binary chunk if it is not empty.
std::string glb(const json& document, const std::string& chunk);

// Reads the document; the test fails if that fails.
Model read(const json& document);

// Returns the error of an invalid document.
Error refusal(const json& document);

}  // namespace bolt::assets
