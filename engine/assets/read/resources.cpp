#include <algorithm>

#include "engine/assets/read/document.hpp"
#include "engine/base/file.hpp"

namespace bolt::assets {

namespace {

constexpr std::size_t file_limit = std::size_t{2} << 30U;

int hex(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// RFC 3986, section 2.1.
std::string percent_decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' && i + 2 < uri.size() ? hex(uri[i + 1]) : -1;
        const int low = high >= 0 ? hex(uri[i + 2]) : -1;
        if (low >= 0) {
            text += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

// Returns the file that a URI names: a relative path that stays in the folder after following symbolic links.
Result<std::filesystem::path> inside(const Document& document, const std::string& uri,
                                     const std::string& pointer) {
    const std::string decoded = percent_decoded(uri);
    const std::filesystem::path relative(decoded);
    const bool outside = relative.is_absolute() || decoded.empty() ||
                         decoded.find('\0') != std::string::npos || decoded.find('\\') != std::string::npos ||
                         decoded.find(':') != std::string::npos ||
                         std::find(relative.begin(), relative.end(), "..") != relative.end();
    std::error_code none;
    const auto folder = std::filesystem::weakly_canonical(document.folder, none);
    const auto path = std::filesystem::weakly_canonical(document.folder / relative, none);
    if (outside || none ||
        std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first != folder.end())
        return error_at(document, pointer, "names a file outside the folder of this one",
                        "a relative path below it");
    return path;
}

Result<std::vector<std::uint8_t>> load_uri(const Document& document, const std::string& uri,
                                           const std::string& pointer) {
    if (uri.starts_with("data:")) {
        std::vector<std::uint8_t> bytes;
        std::string mime_type;
        if (!tinygltf::IsDataURI(uri) || !tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false))
            return error_at(document, pointer, "is no data that can be decoded",
                            "base64 of a known media type");
        return bytes;
    }
    BOLT_TRY_ASSIGN(const auto path, inside(document, uri, pointer));
    const auto text = read_file(path, file_limit, ErrorCode::bad_content);
    if (!text) return error_at(document, pointer, "'" + uri + "' " + text.error().what);
    return std::vector<std::uint8_t>(text->begin(), text->end());
}

}  // namespace

Status load_buffers(Document& document) {
    const auto buffers = document.json.find("buffers");
    if (buffers == document.json.end()) return {};
    document.loaded.resize(buffers->size());
    for (std::size_t i = 0; i < buffers->size(); ++i) {
        const nlohmann::json& buffer = (*buffers)[i];
        const std::string pointer = "/buffers/" + std::to_string(i);
        const std::size_t length = buffer["byteLength"];
        std::span<const std::uint8_t> bytes;
        if (buffer.contains("uri")) {
            BOLT_TRY_ASSIGN(auto loaded, load_uri(document, buffer["uri"], pointer + "/uri"));
            document.loaded[i] = std::move(loaded);
            bytes = document.loaded[i];
        } else if (i == 0 && !document.chunk.empty()) {
            bytes = document.chunk;
        } else {
            return error_at(document, pointer, "has neither a 'uri' nor the binary chunk of the file");
        }
        if (bytes.size() < length)
            return error_at(document, pointer + "/byteLength", "is " + std::to_string(length),
                            "at most the " + std::to_string(bytes.size()) + " bytes that are there");
        document.buffers.push_back(bytes.first(length));
    }
    return {};
}

Status load_images(Document& document) {
    const auto images = document.json.find("images");
    if (images == document.json.end()) return {};
    for (std::size_t i = 0; i < images->size(); ++i) {
        const nlohmann::json& image = (*images)[i];
        const std::string pointer = "/images/" + std::to_string(i);
        if (image.contains("bufferView") == image.contains("uri"))
            return error_at(document, pointer, "has not one of 'uri' and 'bufferView'");
        if (image.contains("uri")) {
            BOLT_TRY_ASSIGN(auto loaded, load_uri(document, image["uri"], pointer + "/uri"));
            document.images.push_back(std::move(loaded));
            continue;
        }
        // check_views has validated the views before.
        const nlohmann::json& view = document.json["bufferViews"][image["bufferView"].get<std::size_t>()];
        const auto bytes = document.buffers[view["buffer"].get<std::size_t>()].subspan(
            view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>());
        document.images.emplace_back(bytes.begin(), bytes.end());
    }
    return {};
}

}  // namespace bolt::assets
