#include "engine/assets/gltf.hpp"
#include "engine/assets/read/accessor.hpp"
#include "engine/assets/read/sections.hpp"
#include "engine/base/file.hpp"

namespace bolt::assets {

namespace {

constexpr std::size_t file_limit = std::size_t{2} << 30U;

// Accessors may share bytes, and sparse accessors expand to many zeros. A valid model may expand to this
// multiple of the file size; more is treated as an attack on memory.
constexpr std::size_t unpacking_factor = 32;

// tinygltf parses only the part of the JSON that it handles safely. Removed are buffers and images, which are
// loaded already, indices, for which it requires a buffer view, and animations, of which it drops some.
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
    if (!all) return error_at(document, "", "tinygltf omits a part of the file");
    return {};
}

Result<Model> read(Document& document) {
    Status done = parse_document(document);
    if (done) done = check_schema(document);
    if (done) done = load_buffers(document);
    if (done) done = check_views(document);
    if (done) done = load_images(document);
    if (done) done = parse_typed(document);
    if (done) done = check_accessors(document);
    for (const auto buffer : document.buffers) document.budget += unpacking_factor * buffer.size();
    Model model;
    model.generator = document.gltf.asset.generator;
    model.copyright = document.gltf.asset.copyright;
    if (done) done = read_meshes(document, model);
    if (done) done = read_materials(document, model);
    if (done) done = read_textures(document, model);
    if (done) done = read_cameras(document, model);
    if (done) done = read_lights(document, model);
    if (done) done = read_skins(document, model);
    if (done) done = read_nodes(document, model);
    if (done) done = read_animations(document, model);
    if (!done) return fail(done.error());
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
