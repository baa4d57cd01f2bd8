// The .glb file being written: JSON values, the binary chunk, and the conversion of a Model's sections.
#pragma once

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/gltf.hpp"

namespace bolt::assets {

using Json = nlohmann::ordered_json;  // keeps keys in insertion order

// Returns the double whose shortest text equals the shortest text of the float: 0.1F becomes 0.1, not
// 0.10000000149.
inline double json_number(float value) {
    char text[32];
    const auto [end, status] = std::to_chars(text, text + sizeof text - 1, value);
    if (status != std::errc{}) return static_cast<double>(value);
    *end = '\0';
    return std::strtod(text, nullptr);
}

inline Json array(const glm::vec2& v) { return {json_number(v.x), json_number(v.y)}; }
inline Json array(const glm::vec3& v) { return {json_number(v.x), json_number(v.y), json_number(v.z)}; }
inline Json array(const glm::vec4& v) {
    return {json_number(v.x), json_number(v.y), json_number(v.z), json_number(v.w)};
}
inline Json array(const glm::quat& q) {
    return {json_number(q.x), json_number(q.y), json_number(q.z), json_number(q.w)};
}

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

enum class BufferTarget : std::uint8_t { indices, vertices, other };

// The format of an accessor's elements.
struct AccessorLayout {
    const char* type = "SCALAR";
    int component = 5126;  // glTF's componentType; 5126: float
    bool normalized = false;
    bool bounded = false;  // write min and max; only for float components
};

// Builds the binary chunk of a .glb. Accessors with the same stride and target share a buffer view, so that a
// file with a thousand parts has only a few views.
class BufferBuilder {
  public:
    // Appends the elements and returns the accessor's index.
    template <class T>
    int add(std::span<const T> elements, BufferTarget target, const AccessorLayout& layout) {
        static_assert(std::is_trivially_copyable_v<T>);
        Json bounds;
        if (layout.bounded) {
            const auto* floats = reinterpret_cast<const float*>(elements.data());
            bounds = min_max({floats, elements.size_bytes() / sizeof(float)}, sizeof(T) / sizeof(float));
        }
        return add_bytes(std::as_bytes(elements), sizeof(T), elements.size(), target, layout, bounds);
    }

    // Adds a buffer view with the bytes of an image file and returns its index.
    int add_file(std::span<const std::uint8_t> bytes);

    // Writes "accessors", "bufferViews" and "buffers" to the root and returns the chunk.
    std::string finish(Json& root);

  private:
    struct BufferView {
        BufferTarget target = BufferTarget::other;
        std::size_t stride = 0;
        std::string bytes;
    };

    static Json min_max(std::span<const float> floats, std::size_t width);
    int add_bytes(std::span<const std::byte> bytes, std::size_t stride, std::size_t count,
                  BufferTarget target, const AccessorLayout& layout, const Json& bounds);

    std::vector<BufferView> views_;
    std::map<std::pair<BufferTarget, std::size_t>, std::size_t> shared_;  // (target, stride) → view
    Json accessors_ = Json::array();
};

// The state of a file being written.
struct GlbWriter {
    const Model& model;
    WriteOptions options;
    BufferBuilder buffer;
    std::set<std::string> used_extensions;
    std::set<std::string> required_extensions;  // those that a reader must support
};

// Returns an error about the value at `pointer` of the resulting file.
Error error_at(std::string pointer, std::string what, std::string expected = {});

// Convert one section, or one entry of a section, of the Model to JSON and add its data to the buffer.
// write_texture appends the texture's sampler to `samplers` unless an equal one exists.
Result<Json> write_mesh(GlbWriter& writer, std::size_t index);
Json write_material(GlbWriter& writer, const Material& material);
Result<Json> write_image(GlbWriter& writer, std::size_t index);
Json write_texture(const Texture& texture, Json& samplers);
Result<Json> write_node(GlbWriter& writer, std::size_t index);
Result<Json> write_skin(GlbWriter& writer, std::size_t index);
Result<Json> write_animation(GlbWriter& writer, std::size_t index);
Json write_camera(const Camera& camera);
Json write_light(const Light& light);

}  // namespace bolt::assets
