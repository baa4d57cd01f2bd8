// Reads meshes: vertex attributes, indices and morph targets.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

namespace {

using Attributes = std::map<std::string, int>;

// The attributes of a primitive or of a morph target.
struct AttributeSource {
    const Attributes& attributes;
    std::string pointer;  // of the attributes object
    std::size_t count;    // required number of elements; 0: any
    bool quantized;       // KHR_mesh_quantization is required
};

template <class Vector>
Status read_attribute(Document& document, const AttributeSource& source, const char* name,
                      NumberFormats numbers, std::vector<Vector>& to) {
    const auto attribute = source.attributes.find(name);
    if (attribute == source.attributes.end()) return {};
    const std::string pointer = source.pointer + '/' + name;
    constexpr auto width = static_cast<std::size_t>(Vector::length());
    BOLT_TRY_ASSIGN(const auto values,
                    unpack_floats(document, attribute->second, static_cast<int>(width), numbers, pointer));
    if (source.count > 0 && values.size() / width != source.count)
        return error_at(document, pointer,
                        fmt::format("has {} elements for {} vertices", values.size() / width, source.count));
    to.resize(values.size() / width);
    std::memcpy(to.data(), values.data(), values.size() * sizeof(float));
    return {};
}

// Converts RGB colours to RGBA with an alpha of one.
Status read_colors(Document& document, const AttributeSource& source, std::vector<glm::vec4>& to) {
    const auto attribute = source.attributes.find("COLOR_0");
    if (attribute == source.attributes.end()) return {};
    const auto& accessor = document.gltf.accessors[static_cast<std::size_t>(attribute->second)];
    if (accessor.type != TINYGLTF_TYPE_VEC3)
        return read_attribute(document, source, "COLOR_0", NumberFormats::unit, to);
    std::vector<glm::vec3> colors;
    const Status status = read_attribute(document, source, "COLOR_0", NumberFormats::unit, colors);
    for (const glm::vec3& color : colors) to.emplace_back(color, 1.0F);
    return status;
}

Status read_joints(Document& document, const AttributeSource& source, const std::string& name,
                   std::vector<glm::u16vec4>& to) {
    const std::string pointer = source.pointer + '/' + name;
    BOLT_TRY_ASSIGN(const auto values,
                    unpack_integers(document, source.attributes.at(name), TINYGLTF_TYPE_VEC4, pointer));
    if (values.size() != source.count * 4)
        return error_at(document, pointer,
                        fmt::format("has {} elements for {} vertices", values.size() / 4, source.count));
    for (std::size_t i = 0; i < values.size(); i += 4) {
        glm::u16vec4 joints;
        for (int c = 0; c < 4; ++c) {
            const std::uint32_t joint = values[i + static_cast<std::size_t>(c)];
            if (joint > 0xFFFFU)
                return error_at(document, pointer, fmt::format("refers to joint {}", joint),
                                "at most joint 65535");
            joints[c] = static_cast<std::uint16_t>(joint);
        }
        to.push_back(joints);
    }
    return {};
}

// Replaces four influences by the strongest four of eight, rescaled to the sum of all eight.
void keep_strongest(glm::u16vec4& joints, glm::vec4& weights, const glm::u16vec4& more_joints,
                    const glm::vec4& more_weights) {
    std::array<std::pair<float, std::uint16_t>, 8> all;
    for (int i = 0; i < 4; ++i) {
        all[static_cast<std::size_t>(i)] = {weights[i], joints[i]};
        all[static_cast<std::size_t>(i + 4)] = {more_weights[i], more_joints[i]};
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    float sum = 0.0F;
    float kept = 0.0F;
    for (const auto& [weight, joint] : all) sum += weight;
    for (std::size_t i = 0; i < 4; ++i) kept += all[i].first;
    for (int i = 0; i < 4; ++i) {
        const auto& [weight, joint] = all[static_cast<std::size_t>(i)];
        weights[i] = kept > 0.0F ? weight * (sum / kept) : 0.0F;
        joints[i] = joint;
    }
}

// Reads any number of sets of four influences; a Primitive keeps the four strongest of them.
Status read_influences(Document& document, const AttributeSource& source, Primitive& to) {
    for (int set = 0;; ++set) {
        const std::string joints_name = fmt::format("JOINTS_{}", set);
        const std::string weights_name = fmt::format("WEIGHTS_{}", set);
        const bool has_joints = source.attributes.contains(joints_name);
        if (has_joints != source.attributes.contains(weights_name))
            return error_at(document, source.pointer,
                            fmt::format("has only one of {} and {}", joints_name, weights_name),
                            "both or neither");
        if (!has_joints) return {};
        std::vector<glm::u16vec4> joints;
        std::vector<glm::vec4> weights;
        Status status = read_joints(document, source, joints_name, joints);
        if (status)
            status = read_attribute(document, source, weights_name.c_str(), NumberFormats::unit, weights);
        if (!status) return status;
        if (set == 0) {
            to.joints = std::move(joints);
            to.weights = std::move(weights);
            continue;
        }
        for (std::size_t i = 0; i < joints.size(); ++i)
            keep_strongest(to.joints[i], to.weights[i], joints[i], weights[i]);
    }
}

Status read_targets(Document& document, const tinygltf::Primitive& from, const AttributeSource& base,
                    const std::string& pointer, Primitive& to) {
    for (std::size_t i = 0; i < from.targets.size(); ++i) {
        const AttributeSource source{from.targets[i], fmt::format("{}/targets/{}", pointer, i), base.count,
                                     base.quantized};
        MorphTarget target;
        const NumberFormats numbers = source.quantized ? NumberFormats::quantized : NumberFormats::real;
        Status status = read_attribute(document, source, "POSITION", numbers, target.positions);
        if (status) status = read_attribute(document, source, "NORMAL", numbers, target.normals);
        if (status) status = read_attribute(document, source, "TANGENT", numbers, target.tangents);
        if (!status) return status;
        to.targets.push_back(std::move(target));
    }
    return {};
}

Status read_indices(Document& document, const nlohmann::json& from, const std::string& pointer,
                    Primitive& to) {
    const auto entry = from.find("indices");
    if (entry == from.end()) return {};
    BOLT_TRY_ASSIGN(auto indices,
                    unpack_integers(document, entry->get<int>(), TINYGLTF_TYPE_SCALAR, pointer + "/indices"));
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= to.positions.size())
            return error_at(document, pointer + "/indices", fmt::format("index {} is {}", i, indices[i]),
                            fmt::format("an index below {}", to.positions.size()));
    to.indices = std::move(indices);
    return {};
}

Status check_corners(const Document& document, const std::string& pointer, const Primitive& primitive) {
    const std::size_t corners =
        primitive.indices.empty() ? primitive.positions.size() : primitive.indices.size();
    const bool complete = (primitive.topology != Topology::triangles || corners % 3 == 0) &&
                          (primitive.topology != Topology::lines || corners % 2 == 0);
    if (complete) return {};
    return error_at(document, pointer,
                    fmt::format("has {} corners, which leaves an incomplete triangle or line", corners));
}

Status read_primitive(Document& document, const tinygltf::Primitive& from, const nlohmann::json& json,
                      const std::string& pointer, Primitive& to) {
    const auto& required = document.gltf.extensionsRequired;
    const bool quantized =
        std::find(required.begin(), required.end(), "KHR_mesh_quantization") != required.end();
    AttributeSource source{from.attributes, pointer + "/attributes", 0, quantized};
    if (!from.attributes.contains("POSITION")) return error_at(document, source.pointer, "has no POSITION");
    const NumberFormats numbers = quantized ? NumberFormats::quantized : NumberFormats::real;
    const NumberFormats unit = quantized ? NumberFormats::quantized : NumberFormats::unit;
    Status status = read_attribute(document, source, "POSITION", numbers, to.positions);
    source.count = to.positions.size();
    if (status) status = read_attribute(document, source, "NORMAL", numbers, to.normals);
    if (status) status = read_attribute(document, source, "TANGENT", numbers, to.tangents);
    if (status) status = read_attribute(document, source, "TEXCOORD_0", unit, to.texcoords[0]);
    if (status) status = read_attribute(document, source, "TEXCOORD_1", unit, to.texcoords[1]);
    if (status) status = read_colors(document, source, to.colors);
    if (status) status = read_influences(document, source, to);
    if (status) status = read_indices(document, json, pointer, to);
    if (status) status = read_targets(document, from, source, pointer, to);
    to.topology = static_cast<Topology>(from.mode);
    to.material = from.material;
    if (status) status = check_corners(document, pointer, to);
    return status;
}

}  // namespace

Status read_meshes(Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.meshes.size(); ++i) {
        const tinygltf::Mesh& from = document.gltf.meshes[i];
        Mesh mesh;
        mesh.name = from.name;
        for (std::size_t k = 0; k < from.primitives.size(); ++k) {
            const std::string pointer = fmt::format("/meshes/{}/primitives/{}", i, k);
            Primitive primitive;
            BOLT_TRY(read_primitive(document, from.primitives[k], document.json["meshes"][i]["primitives"][k],
                                    pointer, primitive));
            if (k > 0 && primitive.targets.size() != mesh.primitives[0].targets.size())
                return error_at(
                    document, pointer, fmt::format("has {} morph targets", primitive.targets.size()),
                    fmt::format("{}, as the first primitive has", mesh.primitives[0].targets.size()));
            mesh.primitives.push_back(std::move(primitive));
        }
        for (const double weight : from.weights) mesh.weights.push_back(static_cast<float>(weight));
        if (mesh.primitives.empty())
            return error_at(document, fmt::format("/meshes/{}/primitives", i), "is empty");
        if (!mesh.weights.empty() && mesh.weights.size() != mesh.primitives[0].targets.size())
            return error_at(document, fmt::format("/meshes/{}/weights", i),
                            fmt::format("has {} weights for {} morph targets", mesh.weights.size(),
                                        mesh.primitives[0].targets.size()));
        model.meshes.push_back(std::move(mesh));
    }
    return {};
}

}  // namespace bolt::assets
