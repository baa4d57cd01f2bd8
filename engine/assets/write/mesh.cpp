// Writes meshes: vertex attributes, optionally quantised, indices and morph targets.
#include <algorithm>
#include <cmath>

#include "engine/assets/write/writer.hpp"

namespace bolt::assets {

namespace {

constexpr int unsigned_byte = 5121;
constexpr int signed_short = 5122;
constexpr int unsigned_short = 5123;
constexpr int unsigned_int = 5125;

struct Short4 {
    std::int16_t x, y, z, w;
};

std::int16_t snorm16(float value) {
    return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0F, 1.0F) * 32767.0F));
}

std::uint16_t unorm16(float value) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 65535.0F));
}

glm::u16vec4 unorm16(const glm::vec4& v) { return {unorm16(v.x), unorm16(v.y), unorm16(v.z), unorm16(v.w)}; }

// Rounds the weights so that they sum to exactly one: the rounding remainder is added to the largest.
glm::u16vec4 unorm16_weights(const glm::vec4& v) {
    glm::u16vec4 rounded = unorm16(v);
    int largest = 0;
    int sum = 0;
    for (int i = 0; i < 4; ++i) {
        sum += rounded[i];
        if (rounded[i] > rounded[largest]) largest = i;
    }
    if (sum > 0) rounded[largest] = static_cast<std::uint16_t>(rounded[largest] + 65535 - sum);
    return rounded;
}

template <class To, class From, class Function>
std::vector<To> map(const std::vector<From>& from, Function function) {
    std::vector<To> to;
    to.reserve(from.size());
    for (const From& value : from) to.push_back(function(value));
    return to;
}

template <class T>
int add_vertices(GlbWriter& writer, const std::vector<T>& elements, const AccessorLayout& layout) {
    return writer.buffer.add(std::span<const T>(elements), BufferTarget::vertices, layout);
}

// A VEC3 of shorts has 6 bytes, but vertex elements must start at multiples of 4: the fourth value is
// padding.
int add_normals(GlbWriter& writer, const std::vector<glm::vec3>& normals) {
    if (!writer.options.quantize) return add_vertices(writer, normals, {.type = "VEC3"});
    writer.required_extensions.insert("KHR_mesh_quantization");
    const auto rounded = map<Short4>(normals, [](const glm::vec3& n) {
        return Short4{snorm16(n.x), snorm16(n.y), snorm16(n.z), 0};
    });
    return add_vertices(writer, rounded, {.type = "VEC3", .component = signed_short, .normalized = true});
}

int add_tangents(GlbWriter& writer, const std::vector<glm::vec4>& tangents) {
    if (!writer.options.quantize) return add_vertices(writer, tangents, {.type = "VEC4"});
    writer.required_extensions.insert("KHR_mesh_quantization");
    const auto rounded = map<Short4>(tangents, [](const glm::vec4& t) {
        return Short4{snorm16(t.x), snorm16(t.y), snorm16(t.z), snorm16(t.w)};
    });
    return add_vertices(writer, rounded, {.type = "VEC4", .component = signed_short, .normalized = true});
}

int add_texcoords(GlbWriter& writer, const std::vector<glm::vec2>& texcoords) {
    const bool in_unit_square = std::all_of(texcoords.begin(), texcoords.end(), [](const glm::vec2& t) {
        return t.x >= 0.0F && t.x <= 1.0F && t.y >= 0.0F && t.y <= 1.0F;
    });
    if (!writer.options.quantize || !in_unit_square) return add_vertices(writer, texcoords, {.type = "VEC2"});
    const auto rounded = map<glm::u16vec2>(
        texcoords, [](const glm::vec2& t) { return glm::u16vec2(unorm16(t.x), unorm16(t.y)); });
    return add_vertices(writer, rounded, {.type = "VEC2", .component = unsigned_short, .normalized = true});
}

int add_colors(GlbWriter& writer, const std::vector<glm::vec4>& colors) {
    if (!writer.options.quantize) return add_vertices(writer, colors, {.type = "VEC4"});
    const auto rounded = map<glm::u16vec4>(colors, [](const glm::vec4& c) { return unorm16(c); });
    return add_vertices(writer, rounded, {.type = "VEC4", .component = unsigned_short, .normalized = true});
}

int add_joints(GlbWriter& writer, const std::vector<glm::u16vec4>& joints) {
    const bool small = std::all_of(joints.begin(), joints.end(), [](const glm::u16vec4& j) {
        return std::max({j.x, j.y, j.z, j.w}) < 256;
    });
    if (!small) return add_vertices(writer, joints, {.type = "VEC4", .component = unsigned_short});
    const auto bytes = map<glm::u8vec4>(joints, [](const glm::u16vec4& j) { return glm::u8vec4(j); });
    return add_vertices(writer, bytes, {.type = "VEC4", .component = unsigned_byte});
}

int add_weights(GlbWriter& writer, const std::vector<glm::vec4>& weights) {
    if (!writer.options.quantize) return add_vertices(writer, weights, {.type = "VEC4"});
    const auto rounded = map<glm::u16vec4>(weights, unorm16_weights);
    return add_vertices(writer, rounded, {.type = "VEC4", .component = unsigned_short, .normalized = true});
}

// The largest value of each index type is the primitive restart value and cannot be an index.
int add_indices(GlbWriter& writer, const std::vector<std::uint32_t>& indices) {
    const std::uint32_t highest = *std::max_element(indices.begin(), indices.end());
    if (highest >= 65535U)
        return writer.buffer.add(std::span<const std::uint32_t>(indices), BufferTarget::indices,
                                 {.component = unsigned_int});
    const auto small =
        map<std::uint16_t>(indices, [](std::uint32_t i) { return static_cast<std::uint16_t>(i); });
    return writer.buffer.add(std::span<const std::uint16_t>(small), BufferTarget::indices,
                             {.component = unsigned_short});
}

template <class T>
bool finite(const std::vector<T>& elements) {
    return std::all_of(elements.begin(), elements.end(), [](const T& element) {
        for (int i = 0; i < T::length(); ++i)
            if (!std::isfinite(element[i])) return false;
        return true;
    });
}

// Returns why the primitive is invalid; empty: it is valid.
std::string invalid_reason(const Primitive& p) {
    const std::size_t count = p.positions.size();
    if (count == 0) return "has no positions";
    const auto fits = [count](const auto& stream) { return stream.empty() || stream.size() == count; };
    bool all_fit = fits(p.normals) && fits(p.tangents) && fits(p.texcoords[0]) && fits(p.texcoords[1]) &&
                   fits(p.colors) && fits(p.joints) && p.weights.size() == p.joints.size();
    for (const MorphTarget& t : p.targets)
        all_fit = all_fit && fits(t.positions) && fits(t.normals) && fits(t.tangents);
    if (!all_fit) return "has vertex streams that are not as long as its positions";
    if (!finite(p.positions) || !finite(p.normals) || !finite(p.tangents) || !finite(p.texcoords[0]) ||
        !finite(p.texcoords[1]) || !finite(p.colors) || !finite(p.weights))
        return "has numbers that are not finite";
    for (const std::uint32_t index : p.indices)
        if (index >= count) return "has an index past its last vertex";
    const std::size_t corners = p.indices.empty() ? count : p.indices.size();
    if (p.topology == Topology::triangles && corners % 3 != 0) return "has an incomplete triangle";
    return {};
}

Json write_targets(GlbWriter& writer, const std::vector<MorphTarget>& targets) {
    Json json = Json::array();
    for (const MorphTarget& target : targets) {
        Json entry = Json::object();
        if (!target.positions.empty())
            entry["POSITION"] = add_vertices(writer, target.positions, {.type = "VEC3", .bounded = true});
        if (!target.normals.empty()) entry["NORMAL"] = add_vertices(writer, target.normals, {.type = "VEC3"});
        if (!target.tangents.empty())
            entry["TANGENT"] = add_vertices(writer, target.tangents, {.type = "VEC3"});
        json.push_back(std::move(entry));
    }
    return json;
}

Json write_primitive(GlbWriter& writer, const Primitive& p) {
    Json attributes = {{"POSITION", add_vertices(writer, p.positions, {.type = "VEC3", .bounded = true})}};
    if (!p.normals.empty()) attributes["NORMAL"] = add_normals(writer, p.normals);
    if (!p.tangents.empty()) attributes["TANGENT"] = add_tangents(writer, p.tangents);
    if (!p.texcoords[0].empty()) attributes["TEXCOORD_0"] = add_texcoords(writer, p.texcoords[0]);
    if (!p.texcoords[1].empty()) attributes["TEXCOORD_1"] = add_texcoords(writer, p.texcoords[1]);
    if (!p.colors.empty()) attributes["COLOR_0"] = add_colors(writer, p.colors);
    if (!p.joints.empty()) {
        attributes["JOINTS_0"] = add_joints(writer, p.joints);
        attributes["WEIGHTS_0"] = add_weights(writer, p.weights);
    }
    Json json = {{"attributes", std::move(attributes)}};
    if (!p.indices.empty()) json["indices"] = add_indices(writer, p.indices);
    if (p.material >= 0) json["material"] = p.material;
    if (p.topology != Topology::triangles) json["mode"] = static_cast<int>(p.topology);
    if (!p.targets.empty()) json["targets"] = write_targets(writer, p.targets);
    return json;
}

}  // namespace

Result<Json> write_mesh(GlbWriter& writer, std::size_t index) {
    const Mesh& mesh = writer.model.meshes[index];
    const std::string pointer = "/meshes/" + std::to_string(index);
    if (mesh.primitives.empty()) return fail(error_at(pointer, "mesh '" + mesh.name + "' has no primitives"));
    Json json = Json::object();
    if (!mesh.name.empty()) json["name"] = mesh.name;
    json["primitives"] = Json::array();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const Primitive& primitive = mesh.primitives[i];
        if (const std::string why = invalid_reason(primitive); !why.empty())
            return fail(error_at(pointer + "/primitives/" + std::to_string(i),
                                 "a primitive of mesh '" + mesh.name + "' " + why));
        if (primitive.material >= static_cast<int>(writer.model.materials.size()))
            return fail(error_at(pointer + "/primitives/" + std::to_string(i) + "/material",
                                 "there is no material " + std::to_string(primitive.material)));
        json["primitives"].push_back(write_primitive(writer, primitive));
    }
    if (!mesh.weights.empty()) {
        json["weights"] = Json::array();
        for (const float weight : mesh.weights) json["weights"].push_back(json_number(weight));
    }
    return json;
}

}  // namespace bolt::assets
