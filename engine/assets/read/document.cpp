#include "engine/assets/read/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

namespace bolt::assets {

namespace {

constexpr int json_depth_limit = 64;
constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;

std::uint32_t u32(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

// JSON parsers recurse, and so do users of the parsed values: the nesting depth is checked before parsing.
bool exceeds_json_depth_limit(std::string_view text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > json_depth_limit) return true;
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return false;
}

// Splits a .glb into its chunks. `json`: the text of the first one.
Status split_glb(Document& document, std::string_view& json) {
    const std::string_view bytes = document.bytes;
    if (bytes.size() < 20) return error_at(document, "", "ends within the header of a .glb");
    if (u32(bytes, 4) != 2)
        return error_at(document, "", "is a .glb of version " + std::to_string(u32(bytes, 4)), "version 2");
    const std::size_t length = u32(bytes, 8);
    if (length > bytes.size() || length < 20)
        return error_at(document, "", "declares a length of " + std::to_string(length) + " bytes",
                        "20 to " + std::to_string(bytes.size()) + " bytes");
    std::size_t offset = 12;
    for (int chunk = 0; offset + 8 <= length; ++chunk) {
        const std::size_t size = u32(bytes, offset);
        const std::uint32_t type = u32(bytes, offset + 4);
        offset += 8;
        if (size > length - offset) return error_at(document, "", "has a chunk that is longer than the file");
        if (chunk == 0 && type != json_chunk)
            return error_at(document, "", "does not begin with a JSON chunk");
        if (chunk == 0) json = bytes.substr(offset, size);
        if (chunk == 1 && type == binary_chunk)
            document.chunk = {reinterpret_cast<const std::uint8_t*>(bytes.data()) + offset, size};
        offset += size;
        offset = (offset + 3U) & ~std::size_t{3U};
        if (offset > length) break;
    }
    return {};
}

}  // namespace

tl::unexpected<Error> error_at(const Document& document, std::string pointer, std::string what,
                               std::string expected) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = document.file;
    error.pointer = std::move(pointer);
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

Status parse_document(Document& document) {
    std::string_view text = document.bytes;
    const bool binary = text.starts_with("glTF");
    if (binary) {
        BOLT_TRY(split_glb(document, text));
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (exceeds_json_depth_limit(text))
        return error_at(document, "", "nests deeper than " + std::to_string(json_depth_limit) + " levels");
    try {
        document.json = nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        // The library's own message has a prefix that users do not understand. The byte position counts from
        // the start of the JSON.
        Error at = error_at(document, "", "is not valid JSON at byte " + std::to_string(error.byte)).value();
        if (!binary) {
            const std::string_view before = text.substr(0, std::min(error.byte, text.size()));
            at.line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
        }
        return fail(std::move(at));
    } catch (const nlohmann::json::exception&) {
        return error_at(document, "", "has a number that is too large");
    }
    return {};
}

namespace {

using tinygltf::Accessor;

std::size_t component_size(int component) {
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;  // not allowed in glTF
    }
}

std::size_t component_count(int type) {
    return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
}

// Matrix columns start at multiples of four bytes (section 3.6.2.4).
std::size_t element_size(const Accessor& accessor) {
    const std::size_t size = component_size(accessor.componentType);
    const auto padded = [&](std::size_t rows) { return rows * ((rows * size + 3U) & ~std::size_t{3U}); };
    if (accessor.type == TINYGLTF_TYPE_MAT2) return padded(2);
    if (accessor.type == TINYGLTF_TYPE_MAT3) return padded(3);
    return size * component_count(accessor.type);
}

std::string accessor_pointer(std::size_t accessor) { return "/accessors/" + std::to_string(accessor); }

// The location of elements in a buffer, `stride` bytes apart.
struct StridedBytes {
    const std::uint8_t* first = nullptr;
    std::size_t stride = 0;
};

StridedBytes locate(const Document& document, int view_index, std::size_t offset, std::size_t size) {
    const tinygltf::BufferView& view = document.gltf.bufferViews[static_cast<std::size_t>(view_index)];
    const auto buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
    return {buffer.data() + view.byteOffset + offset, view.byteStride > 0 ? view.byteStride : size};
}

// Returns whether `count` elements lie within a view. Computes in 64 bits, because products of ints could
// overflow.
bool fits(const Document& document, int view_index, std::size_t offset, std::size_t size, std::size_t count) {
    const tinygltf::BufferView& view = document.gltf.bufferViews[static_cast<std::size_t>(view_index)];
    const std::size_t stride = view.byteStride > 0 ? view.byteStride : size;
    return offset + stride * (count - 1) + size <= view.byteLength;
}

Status check_sparse(const Document& document, const Accessor& accessor, const std::string& pointer) {
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t index_size = component_size(sparse.indices.componentType);
    const bool unsigned_type = sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                               sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                               sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!unsigned_type)
        return error_at(document, pointer + "/sparse/indices/componentType",
                        std::to_string(sparse.indices.componentType) + " is not a component type for indices",
                        "5121, 5123 or 5125");
    if (count > accessor.count)
        return error_at(document, pointer + "/sparse/count", "is larger than the accessor's count",
                        "at most " + std::to_string(accessor.count));
    if (!fits(document, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
              index_size, count))
        return error_at(document, pointer + "/sparse/indices", "reaches past the end of its buffer view");
    if (!fits(document, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
              element_size(accessor), count))
        return error_at(document, pointer + "/sparse/values", "reaches past the end of its buffer view");
    return {};
}

template <class T>
T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// Converts a component to float (section 3.6.2.2 for normalised integers).
float as_float(const std::uint8_t* bytes, int component, bool normalized) {
    const auto scaled = [normalized](auto value, float range) {
        const auto number = static_cast<float>(value);
        return normalized ? std::max(number / range, -1.0F) : number;
    };
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return scaled(load<std::int8_t>(bytes), 127.0F);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return scaled(load<std::uint8_t>(bytes), 255.0F);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return scaled(load<std::int16_t>(bytes), 32767.0F);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return scaled(load<std::uint16_t>(bytes), 65535.0F);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return static_cast<float>(load<std::uint32_t>(bytes));
        default:
            return load<float>(bytes);
    }
}

std::uint32_t as_integer(const std::uint8_t* bytes, int component) {
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes);
        default:
            return load<std::uint32_t>(bytes);
    }
}

// Unpacks `count` elements. `convert(bytes)` decodes a component; `target(i)` returns where element i is
// written.
template <class T, class Convert, class Target>
void unpack_elements(const StridedBytes& from, std::size_t count, std::size_t components, std::size_t size,
                     Convert convert, Target target) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* bytes = from.first + i * from.stride;
        T* to = target(i);
        for (std::size_t c = 0; c < components; ++c) to[c] = convert(bytes + c * size);
    }
}

template <class T, class Convert>
Result<std::vector<T>> unpack(Document& document, std::size_t index, Convert convert) {
    const Accessor& accessor = document.gltf.accessors[index];
    const std::size_t components = component_count(accessor.type);
    const std::size_t size = component_size(accessor.componentType);
    const std::size_t bytes = accessor.count * components * sizeof(T);
    if (bytes > document.unpack_budget)
        return error_at(document, accessor_pointer(index) + "/count",
                        "needs more memory than a file of this size may use");
    document.unpack_budget -= bytes;
    std::vector<T> values(accessor.count * components);
    if (accessor.bufferView >= 0) {
        const StridedBytes from =
            locate(document, accessor.bufferView, accessor.byteOffset, element_size(accessor));
        if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && std::is_same_v<T, float> &&
            from.stride == components * size) {
            std::memcpy(values.data(), from.first, bytes);
        } else {
            unpack_elements<T>(from, accessor.count, components, size, convert,
                               [&](std::size_t i) { return values.data() + i * components; });
        }
    }
    if (!accessor.sparse.isSparse) return values;

    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    const StridedBytes indices =
        locate(document, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
               component_size(sparse.indices.componentType));
    std::vector<std::uint32_t> targets(count);
    for (std::size_t i = 0; i < count; ++i) {
        targets[i] = as_integer(indices.first + i * indices.stride, sparse.indices.componentType);
        if (targets[i] >= accessor.count || (i > 0 && targets[i] <= targets[i - 1]))
            return error_at(document, accessor_pointer(index) + "/sparse/indices",
                            fmt::format("has {} as its index {}", targets[i], i),
                            "rising indices below the accessor's count");
    }
    const StridedBytes from =
        locate(document, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
               element_size(accessor));
    unpack_elements<T>(from, count, components, size, convert,
                       [&](std::size_t i) { return values.data() + targets[i] * components; });
    return values;
}

bool allows(NumberFormats numbers, const Accessor& accessor) {
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return true;
    const bool small = accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (numbers == NumberFormats::unit) return small && accessor.normalized;
    return numbers == NumberFormats::quantized && small;
}

std::string type_name(int type) {
    constexpr const char* vectors[] = {"", "", "VEC2", "VEC3", "VEC4"};
    if (type >= 2 && type <= 4) return vectors[type];
    return type == TINYGLTF_TYPE_SCALAR ? "SCALAR"
           : type == TINYGLTF_TYPE_MAT2 ? "MAT2"
           : type == TINYGLTF_TYPE_MAT3 ? "MAT3"
                                        : "MAT4";
}

Status check_type(const Document& document, const Accessor& accessor, int type, const std::string& pointer) {
    if (accessor.type == type) return {};
    return error_at(document, pointer, "refers to an accessor of type " + type_name(accessor.type),
                    "type " + type_name(type));
}

}  // namespace

Status check_views(const Document& document) {
    const auto views = document.json.find("bufferViews");
    if (views == document.json.end()) return {};
    for (std::size_t i = 0; i < views->size(); ++i) {
        const nlohmann::json& view = (*views)[i];
        if (view.value("byteStride", 0) % 4 != 0)
            return error_at(document, fmt::format("/bufferViews/{}/byteStride", i), "is not a multiple of 4");
        const std::size_t end =
            view.value("byteOffset", std::size_t{0}) + view["byteLength"].get<std::size_t>();
        const std::size_t length = document.buffers[view["buffer"].get<std::size_t>()].size();
        if (end > length)
            return error_at(document, fmt::format("/bufferViews/{}", i), fmt::format("ends at byte {}", end),
                            fmt::format("an end within the {} bytes of its buffer", length));
    }
    return {};
}

Status check_accessors(const Document& document) {
    for (std::size_t i = 0; i < document.gltf.accessors.size(); ++i) {
        const Accessor& accessor = document.gltf.accessors[i];
        if (component_size(accessor.componentType) == 0)
            return error_at(document, accessor_pointer(i) + "/componentType",
                            std::to_string(accessor.componentType) + " is not a component type",
                            "5120, 5121, 5122, 5123, 5125 or 5126");
        const std::size_t size = element_size(accessor);
        if (accessor.bufferView >= 0) {
            const auto& view = document.gltf.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
            if (view.byteStride > 0 && view.byteStride < size)
                return error_at(
                    document, fmt::format("/bufferViews/{}/byteStride", accessor.bufferView),
                    fmt::format("is less than the {} bytes of an element of accessor {}", size, i));
            if (!fits(document, accessor.bufferView, accessor.byteOffset, size, accessor.count))
                return error_at(document, accessor_pointer(i), "reaches past the end of its buffer view");
        }
        if (!accessor.sparse.isSparse) continue;
        BOLT_TRY(check_sparse(document, accessor, accessor_pointer(i)));
    }
    return {};
}

Result<std::vector<float>> unpack_floats(Document& document, int index, int type, NumberFormats numbers,
                                         const std::string& pointer) {
    const auto accessor_index = static_cast<std::size_t>(index);
    const Accessor& accessor = document.gltf.accessors[accessor_index];
    BOLT_TRY(check_type(document, accessor, type, pointer));
    if (!allows(numbers, accessor))
        return error_at(
            document, pointer,
            fmt::format("refers to an accessor of component type {}{}, which is not allowed here",
                        accessor.componentType, accessor.normalized ? " (normalised)" : ""),
            numbers == NumberFormats::real ? "5126 (float)" : "5126 (float) or normalised integers");
    BOLT_TRY_ASSIGN(auto values, unpack<float>(document, accessor_index, [&](const std::uint8_t* bytes) {
                        return as_float(bytes, accessor.componentType, accessor.normalized);
                    }));
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            return error_at(document, accessor_pointer(accessor_index),
                            fmt::format("component {} of element {} is not finite", i % component_count(type),
                                        i / component_count(type)));
    return values;
}

Result<std::vector<std::uint32_t>> unpack_integers(Document& document, int index, int type,
                                                   const std::string& pointer) {
    const auto accessor_index = static_cast<std::size_t>(index);
    const Accessor& accessor = document.gltf.accessors[accessor_index];
    BOLT_TRY(check_type(document, accessor, type, pointer));
    const bool unsigned_type = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                               accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                               accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!unsigned_type || accessor.normalized)
        return error_at(document, pointer, "refers to an accessor whose numbers are not indices",
                        "5121, 5123 or 5125, not normalised");
    return unpack<std::uint32_t>(document, accessor_index, [&](const std::uint8_t* bytes) {
        return as_integer(bytes, accessor.componentType);
    });
}

}  // namespace bolt::assets
