#include "engine/assets/read/document.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace bolt::assets {

namespace {

constexpr int depth_limit = 64;
constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;

std::uint32_t u32(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

// JSON parsers and consumers recurse, so limit the nesting depth before parsing.
bool too_deep(std::string_view text) {
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
            if (++depth > depth_limit) return true;
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return false;
}

// Splits a .glb; `json` becomes the text of its first chunk.
Status split_glb(Document& document, std::string_view& json) {
    const std::string_view bytes = document.bytes;
    if (bytes.size() < 20) return error_at(document, "", "ends within the header of a .glb");
    if (u32(bytes, 4) != 2)
        return error_at(document, "", "is a .glb of version " + std::to_string(u32(bytes, 4)), "version 2");
    const std::size_t length = u32(bytes, 8);
    if (length > bytes.size() || length < 20)
        return error_at(
            document, "",
            "says that it has " + std::to_string(length) + " bytes and has " + std::to_string(bytes.size()));
    std::size_t place = 12;
    for (int chunk = 0; place + 8 <= length; ++chunk) {
        const std::size_t size = u32(bytes, place);
        const std::uint32_t type = u32(bytes, place + 4);
        place += 8;
        if (size > length - place) return error_at(document, "", "has a chunk that is longer than the file");
        if (chunk == 0 && type != json_chunk)
            return error_at(document, "", "does not begin with a JSON chunk");
        if (chunk == 0) json = bytes.substr(place, size);
        if (chunk == 1 && type == binary_chunk)
            document.chunk = {reinterpret_cast<const std::uint8_t*>(bytes.data()) + place, size};
        place += size;
        place = (place + 3U) & ~std::size_t{3U};
        if (place > length) break;
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
    if (too_deep(text))
        return error_at(document, "", "nests deeper than " + std::to_string(depth_limit) + " levels");
    try {
        document.json = nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        // Replace the library's prefix; the byte position counts from the start of the JSON.
        Error at = error_at(document, "", "is no valid JSON at byte " + std::to_string(error.byte)).value();
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

}  // namespace bolt::assets
