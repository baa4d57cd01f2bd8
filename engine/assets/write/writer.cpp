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
                             BufferTarget use, const AccessorLayout& layout, const Json& bounds) {
    const auto [place, fresh] = shared_.try_emplace({use, stride}, views_.size());
    if (fresh) views_.push_back({use, stride, {}});
    std::string& target = views_[place->second].bytes;
    Json accessor = {{"bufferView", place->second}};
    if (!target.empty()) accessor["byteOffset"] = target.size();
    accessor["componentType"] = layout.component;
    if (layout.normalized) accessor["normalized"] = true;
    accessor["count"] = count;
    accessor["type"] = layout.type;
    if (layout.bounded) accessor.update(bounds);
    target.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
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
        if (view.use == BufferTarget::vertices) {
            entry["byteStride"] = view.stride;
            entry["target"] = array_buffer;
        }
        if (view.use == BufferTarget::indices) entry["target"] = element_array_buffer;
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
std::string container(std::string json, const std::string& chunk) {
    json.resize((json.size() + 3U) & ~std::size_t{3U}, ' ');
    std::string bytes = "glTF";
    append_u32(bytes, 2);
    append_u32(bytes, 12 + 8 + json.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
    append_chunk(bytes, "JSON", json);
    if (!chunk.empty()) append_chunk(bytes, "BIN\0", chunk);
    return bytes;
}

// Writes one section of the file with `count` entries.
template <class Function>
Status section(Json& root, const char* key, std::size_t count, Function write) {
    for (std::size_t i = 0; i < count; ++i) {
        BOLT_TRY_ASSIGN(auto entry, write(i));
        root[key].push_back(std::move(entry));
    }
    return {};
}

Status write_sections(Writer& w, Json& root) {
    const Model& model = w.model;
    Json samplers = Json::array();
    Json lights = Json::array();
    for (const Light& light : model.lights) lights.push_back(write_light(light));
    if (!lights.empty()) {
        root["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
        w.used.insert("KHR_lights_punctual");
    }
    if (!model.roots.empty()) {
        root["scene"] = 0;
        root["scenes"] = {{{"nodes", model.roots}}};
    }
    Status done = section(root, "nodes", model.nodes.size(), [&](auto i) { return write_node(w, i); });
    if (done) done = section(root, "meshes", model.meshes.size(), [&](auto i) { return write_mesh(w, i); });
    if (done)
        done = section(root, "materials", model.materials.size(),
                       [&](auto i) -> Result<Json> { return write_material(w, model.materials[i]); });
    if (done)
        done = section(root, "textures", model.textures.size(),
                       [&](auto i) -> Result<Json> { return write_texture(model.textures[i], samplers); });
    if (!samplers.empty()) root["samplers"] = std::move(samplers);
    if (done) done = section(root, "images", model.images.size(), [&](auto i) { return write_image(w, i); });
    if (done)
        done = section(root, "cameras", model.cameras.size(),
                       [&](auto i) -> Result<Json> { return write_camera(model.cameras[i]); });
    if (done) done = section(root, "skins", model.skins.size(), [&](auto i) { return write_skin(w, i); });
    if (done)
        done = section(root, "animations", model.animations.size(),
                       [&](auto i) { return write_animation(w, i); });
    return done;
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
    Writer writer{model, options, {}, {}, {}};
    Json root = Json::object();
    root["asset"] = {{"version", "2.0"},
                     {"generator", model.generator.empty() ? "Boltwright" : model.generator}};
    if (!model.copyright.empty()) root["asset"]["copyright"] = model.copyright;
    if (Status done = write_sections(writer, root); !done) return fail(std::move(done.error()));
    const std::string chunk = writer.buffer.finish(root);
    writer.used.insert(writer.required.begin(), writer.required.end());
    if (!writer.used.empty()) root["extensionsUsed"] = writer.used;
    if (!writer.required.empty()) root["extensionsRequired"] = writer.required;
    std::string json;
    try {
        json = root.dump();
    } catch (const nlohmann::json::exception&) {
        return fail(error_at("", "a name or text of the model is not UTF-8"));
    }
    constexpr std::size_t limit = 0xFFFFFFFFU;
    if (json.size() + chunk.size() + 64 > limit) return fail(error_at("", "the .glb exceeds 4 GiB"));
    return container(std::move(json), chunk);
}

}  // namespace bolt::assets
