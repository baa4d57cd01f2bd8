#include "engine/assets/write/writer.hpp"

#include <algorithm>

#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"

namespace bolt::assets {

Json BufferBuilder::min_max(std::span<const float> floats, std::size_t width) {
    std::vector<double> low;
    std::vector<double> high;
    for (std::size_t i = 0; i < floats.size(); ++i) {
        const double value = static_cast<double>(floats[i]);  // exact: validators compare bits
        const std::size_t component = i % width;
        if (i < width) {
            low.push_back(value);
            high.push_back(value);
        } else {
            low[component] = std::min(low[component], value);
            high[component] = std::max(high[component], value);
        }
    }
    return {{"min", low}, {"max", high}};
}

int BufferBuilder::add_bytes(std::span<const std::byte> bytes, std::size_t stride, std::size_t count,
                             BufferTarget target, const AccessorLayout& layout, const Json& bounds) {
    const auto [view, is_new] = shared_.try_emplace({target, stride}, views_.size());
    if (is_new) views_.push_back({target, stride, {}});
    std::string& view_bytes = views_[view->second].bytes;
    Json accessor = {{"bufferView", view->second}};
    if (!view_bytes.empty()) accessor["byteOffset"] = view_bytes.size();
    accessor["componentType"] = layout.component;
    if (layout.normalized) accessor["normalized"] = true;
    accessor["count"] = count;
    accessor["type"] = layout.type;
    if (layout.bounded) accessor.update(bounds);
    view_bytes.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
}

int BufferBuilder::add_file(std::span<const std::uint8_t> bytes) {
    views_.push_back({BufferTarget::other, 0, std::string(bytes.begin(), bytes.end())});
    return static_cast<int>(views_.size()) - 1;
}

std::string BufferBuilder::finish(Json& root) {
    constexpr int array_buffer = 34962;
    constexpr int element_array_buffer = 34963;
    std::string chunk;
    Json views = Json::array();
    for (const BufferView& view : views_) {
        Json entry = {{"buffer", 0}};
        if (!chunk.empty()) entry["byteOffset"] = chunk.size();
        entry["byteLength"] = view.bytes.size();
        if (view.target == BufferTarget::vertices) {
            entry["byteStride"] = view.stride;
            entry["target"] = array_buffer;
        }
        if (view.target == BufferTarget::indices) entry["target"] = element_array_buffer;
        views.push_back(std::move(entry));
        chunk += view.bytes;
        chunk.resize((chunk.size() + 3U) & ~std::size_t{3U}, '\0');
    }
    if (!accessors_.empty()) root["accessors"] = std::move(accessors_);
    if (!views.empty()) {
        root["bufferViews"] = std::move(views);
        root["buffers"] = {{{"byteLength", chunk.size()}}};
    }
    return chunk;
}

namespace {

void append_u32(std::string& bytes, std::size_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<char>((value >> shift) & 0xFFU));
}

void append_chunk(std::string& bytes, const char (&type)[5], const std::string& chunk) {
    append_u32(bytes, chunk.size());
    bytes.append(type, 4);
    bytes += chunk;
}

// Concatenates the header, the JSON chunk padded with spaces, and the binary chunk, which is already padded.
std::string glb_container(std::string json, const std::string& chunk) {
    json.resize((json.size() + 3U) & ~std::size_t{3U}, ' ');
    std::string bytes = "glTF";
    append_u32(bytes, 2);
    append_u32(bytes, 12 + 8 + json.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
    append_chunk(bytes, "JSON", json);
    if (!chunk.empty()) append_chunk(bytes, "BIN\0", chunk);
    return bytes;
}

// Writes a section with `count` entries; `write(i)` returns entry i.
template <class Function>
Status write_section(Json& root, const char* key, std::size_t count, Function write) {
    for (std::size_t i = 0; i < count; ++i) {
        BOLT_TRY_ASSIGN(auto entry, write(i));
        root[key].push_back(std::move(entry));
    }
    return {};
}

Status write_sections(GlbWriter& w, Json& root) {
    const Model& model = w.model;
    Json samplers = Json::array();
    Json lights = Json::array();
    for (const Light& light : model.lights) lights.push_back(write_light(light));
    if (!lights.empty()) {
        root["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
        w.used_extensions.insert("KHR_lights_punctual");
    }
    if (!model.roots.empty()) {
        root["scene"] = 0;
        root["scenes"] = {{{"nodes", model.roots}}};
    }
    Status status =
        write_section(root, "nodes", model.nodes.size(), [&](auto i) { return write_node(w, i); });
    if (status)
        status = write_section(root, "meshes", model.meshes.size(), [&](auto i) { return write_mesh(w, i); });
    if (status)
        status = write_section(root, "materials", model.materials.size(),
                               [&](auto i) -> Result<Json> { return write_material(w, model.materials[i]); });
    if (status)
        status = write_section(root, "textures", model.textures.size(), [&](auto i) -> Result<Json> {
            return write_texture(model.textures[i], samplers);
        });
    if (!samplers.empty()) root["samplers"] = std::move(samplers);
    if (status)
        status =
            write_section(root, "images", model.images.size(), [&](auto i) { return write_image(w, i); });
    if (status)
        status = write_section(root, "cameras", model.cameras.size(),
                               [&](auto i) -> Result<Json> { return write_camera(model.cameras[i]); });
    if (status)
        status = write_section(root, "skins", model.skins.size(), [&](auto i) { return write_skin(w, i); });
    if (status)
        status = write_section(root, "animations", model.animations.size(),
                               [&](auto i) { return write_animation(w, i); });
    return status;
}

}  // namespace

Status write_glb(const std::filesystem::path& path, const Model& model) { return write_glb(path, model, {}); }

Status write_glb(const std::filesystem::path& path, const Model& model, const WriteOptions& options) {
    auto bytes = encode_glb(model, options);
    if (bytes) return write_file(path, *bytes);
    bytes.error().file = path.string();
    return fail(std::move(bytes.error()));
}

Result<std::string> encode_glb(const Model& model, const WriteOptions& options) {
    GlbWriter writer{model, options, {}, {}, {}};
    Json root = Json::object();
    root["asset"] = {{"version", "2.0"},
                     {"generator", model.generator.empty() ? "Boltwright" : model.generator}};
    if (!model.copyright.empty()) root["asset"]["copyright"] = model.copyright;
    BOLT_TRY(write_sections(writer, root));
    const std::string chunk = writer.buffer.finish(root);
    writer.used_extensions.insert(writer.required_extensions.begin(), writer.required_extensions.end());
    if (!writer.used_extensions.empty()) root["extensionsUsed"] = writer.used_extensions;
    if (!writer.required_extensions.empty()) root["extensionsRequired"] = writer.required_extensions;
    std::string json;
    try {
        json = root.dump();
    } catch (const nlohmann::json::exception&) {
        return fail(error_at("", "a name or another text of the model is not UTF-8"));
    }
    constexpr std::size_t limit = 0xFFFFFFFFU;
    if (json.size() + chunk.size() + 64 > limit) return fail(error_at("", "the .glb exceeds 4 GiB"));
    return glb_container(std::move(json), chunk);
}

}  // namespace bolt::assets
