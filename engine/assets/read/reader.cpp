// read_gltf: the order of the reading steps, the loading of buffers and images, and tinygltf's parsing.
#include <algorithm>

#include "engine/assets/gltf.hpp"
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

// Decodes percent-encoding (RFC 3986, section 2.1).
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

// Returns the file that a URI refers to. Fails unless it is a relative path that, after following symbolic
// links, stays in the document's folder.
Result<std::filesystem::path> resolve_uri(const Document& document, const std::string& uri,
                                          const std::string& pointer) {
    const std::string decoded = percent_decoded(uri);
    const std::filesystem::path relative(decoded);
    const bool forbidden =
        relative.is_absolute() || decoded.empty() || decoded.find('\0') != std::string::npos ||
        decoded.find('\\') != std::string::npos || decoded.find(':') != std::string::npos ||
        std::find(relative.begin(), relative.end(), "..") != relative.end();
    std::error_code failed;
    const auto folder = std::filesystem::weakly_canonical(document.folder, failed);
    const auto path = std::filesystem::weakly_canonical(document.folder / relative, failed);
    if (forbidden || failed ||
        std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first != folder.end())
        return error_at(document, pointer, "refers to a file outside the folder of this file",
                        "a relative path within the folder");
    return path;
}

Result<std::vector<std::uint8_t>> load_uri(const Document& document, const std::string& uri,
                                           const std::string& pointer) {
    if (uri.starts_with("data:")) {
        std::vector<std::uint8_t> bytes;
        std::string mime_type;
        if (!tinygltf::IsDataURI(uri) || !tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false))
            return error_at(document, pointer, "cannot be decoded", "base64 data of a known media type");
        return bytes;
    }
    BOLT_TRY_ASSIGN(const auto path, resolve_uri(document, uri, pointer));
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
            return error_at(document, pointer, "has neither a 'uri' nor a binary chunk in this file");
        }
        if (bytes.size() < length)
            return error_at(document, pointer + "/byteLength", "is " + std::to_string(length),
                            "at most the " + std::to_string(bytes.size()) + " bytes available");
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
            return error_at(document, pointer,
                            image.contains("uri") ? "has both 'uri' and 'bufferView'"
                                                  : "has neither 'uri' nor 'bufferView'",
                            "one of them");
        if (image.contains("uri")) {
            BOLT_TRY_ASSIGN(auto loaded, load_uri(document, image["uri"], pointer + "/uri"));
            document.images.push_back(std::move(loaded));
            continue;
        }
        // check_views has validated the views.
        const nlohmann::json& view = document.json["bufferViews"][image["bufferView"].get<std::size_t>()];
        const auto bytes = document.buffers[view["buffer"].get<std::size_t>()].subspan(
            view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>());
        document.images.emplace_back(bytes.begin(), bytes.end());
    }
    return {};
}

namespace {

// Accessors may share bytes, and sparse accessors may expand to many zeros. A model may expand to this
// multiple of its buffers' size, plus 64 MiB. A larger one is refused, because a small file could exhaust the
// memory.
constexpr std::size_t unpacking_factor = 32;

// Lets tinygltf parse the part of the JSON that it handles correctly. Buffers and images are removed before,
// because they are already loaded; indices, because tinygltf requires a buffer view for them; and animations,
// because it drops some.
Status parse_typed(Document& document) {
    nlohmann::json json = document.json;
    json.erase("buffers");
    json.erase("images");
    json.erase("animations");
    if (json.contains("meshes"))
        for (nlohmann::json& mesh : json["meshes"])
            for (nlohmann::json& primitive : mesh["primitives"]) primitive.erase("indices");
    const std::string text = json.dump();
    std::string errors;
    std::string warnings;
    tinygltf::TinyGLTF parser;
    try {
        if (!parser.LoadASCIIFromString(&document.gltf, &errors, &warnings, text.c_str(),
                                        static_cast<unsigned>(text.size()), ""))
            return error_at(document, "", "tinygltf: " + errors.substr(0, errors.find('\n')));
    } catch (const std::exception& error) {
        return error_at(document, "", std::string("tinygltf: ") + error.what());
    }
    // tinygltf omits entries that it cannot parse, which would shift the indices.
    const auto kept = [&](const char* section, std::size_t count) {
        return count == (json.contains(section) ? json[section].size() : 0);
    };
    bool all =
        kept("accessors", document.gltf.accessors.size()) && kept("nodes", document.gltf.nodes.size()) &&
        kept("bufferViews", document.gltf.bufferViews.size()) &&
        kept("cameras", document.gltf.cameras.size()) && kept("meshes", document.gltf.meshes.size()) &&
        kept("materials", document.gltf.materials.size()) && kept("skins", document.gltf.skins.size()) &&
        kept("samplers", document.gltf.samplers.size()) && kept("textures", document.gltf.textures.size());
    for (std::size_t i = 0; all && i < document.gltf.meshes.size(); ++i)
        all = json["meshes"][i]["primitives"].size() == document.gltf.meshes[i].primitives.size();
    if (!all) return error_at(document, "", "has an entry that the glTF parser cannot read");
    return {};
}

Result<Model> read(Document& document) {
    Status status = parse_document(document);
    if (status) status = check_schema(document);
    if (status) status = load_buffers(document);
    if (status) status = check_views(document);
    if (status) status = load_images(document);
    if (status) status = parse_typed(document);
    if (status) status = check_accessors(document);
    for (const auto buffer : document.buffers) document.unpack_budget += unpacking_factor * buffer.size();
    Model model;
    model.generator = document.gltf.asset.generator;
    model.copyright = document.gltf.asset.copyright;
    if (status) status = read_meshes(document, model);
    if (status) status = read_materials(document, model);
    if (status) status = read_textures(document, model);
    if (status) status = read_cameras(document, model);
    if (status) status = read_lights(document, model);
    if (status) status = read_skins(document, model);
    if (status) status = read_nodes(document, model);
    if (status) status = read_animations(document, model);
    if (!status) return fail(status.error());
    return model;
}

}  // namespace

Result<Model> parse_gltf(std::string bytes, const std::filesystem::path& path) {
    Document document;
    document.file = path.string();
    document.folder = path.has_parent_path() ? path.parent_path() : ".";
    document.bytes = std::move(bytes);
    return read(document);
}

Result<Model> read_gltf(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(auto bytes, read_file(path, file_limit, ErrorCode::bad_content));
    return parse_gltf(std::move(bytes), path);
}

}  // namespace bolt::assets
