// The binary chunk of a .glb while it is being filled: accessors of the same stride and use share a view, so
// that a file of a thousand parts has a handful of views.
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

enum class Use : std::uint8_t { indices, vertices, other };

// What an accessor says of its elements.
struct Layout {
    const char* type = "SCALAR";
    int component = 5126;  // as glTF numbers them: 5126 is float
    bool normalized = false;
    bool bounded = false;  // with min and max; float components only
};

class BufferBuilder {
  public:
    // Appends the elements and returns the accessor's index.
    template <class T>
    int add(std::span<const T> elements, Use use, const Layout& layout) {
        static_assert(std::is_trivially_copyable_v<T>);
        Json bounds;
        if (layout.bounded) {
            const auto* floats = reinterpret_cast<const float*>(elements.data());
            bounds = min_max({floats, elements.size_bytes() / sizeof(float)}, sizeof(T) / sizeof(float));
        }
        return add_bytes(std::as_bytes(elements), sizeof(T), elements.size(), use, layout, bounds);
    }

    // A view of its own, for an image file.
    int add_file(std::span<const std::uint8_t> bytes);

    // Puts "accessors", "bufferViews" and "buffers" into the root and returns the chunk.
    std::string finish(Json& root);

  private:
    struct View {
        Use use = Use::other;
        std::size_t stride = 0;
        std::string bytes;
    };

    static Json min_max(std::span<const float> floats, std::size_t width);
    int add_bytes(std::span<const std::byte> bytes, std::size_t stride, std::size_t count, Use use,
                  const Layout& layout, const Json& bounds);

    std::vector<View> views_;
    std::map<std::pair<Use, std::size_t>, std::size_t> shared_;
    Json accessors_ = Json::array();
};

}  // namespace bolt::assets
