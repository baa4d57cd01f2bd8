// Builds the binary chunk of a .glb. Accessors with the same stride and target share a buffer view, so that a
// file with a thousand parts has only a few views.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/write/json.hpp"

namespace bolt::assets {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

enum class BufferTarget : std::uint8_t { indices, vertices, other };

// The format of an accessor's elements.
struct AccessorLayout {
    const char* type = "SCALAR";
    int component = 5126;  // glTF's number: 5126 is float
    bool normalized = false;
    bool bounded = false;  // with min and max; only for float components
};

class BufferBuilder {
  public:
    // Appends the elements and returns the accessor's index.
    template <class T>
    int add(std::span<const T> elements, BufferTarget use, const AccessorLayout& layout) {
        static_assert(std::is_trivially_copyable_v<T>);
        Json bounds;
        if (layout.bounded) {
            const auto* floats = reinterpret_cast<const float*>(elements.data());
            bounds = min_max({floats, elements.size_bytes() / sizeof(float)}, sizeof(T) / sizeof(float));
        }
        return add_bytes(std::as_bytes(elements), sizeof(T), elements.size(), use, layout, bounds);
    }

    // Adds a buffer view for an image file and returns its index.
    int add_file(std::span<const std::uint8_t> bytes);

    // Writes "accessors", "bufferViews" and "buffers" to the root and returns the chunk.
    std::string finish(Json& root);

  private:
    struct BufferView {
        BufferTarget use = BufferTarget::other;
        std::size_t stride = 0;
        std::string bytes;
    };

    static Json min_max(std::span<const float> floats, std::size_t width);
    int add_bytes(std::span<const std::byte> bytes, std::size_t stride, std::size_t count, BufferTarget use,
                  const AccessorLayout& layout, const Json& bounds);

    std::vector<BufferView> views_;
    std::map<std::pair<BufferTarget, std::size_t>, std::size_t> shared_;
    Json accessors_ = Json::array();
};

}  // namespace bolt::assets
