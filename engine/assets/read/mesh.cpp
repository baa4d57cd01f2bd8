#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

namespace {

using Attributes = std::map<std::string, int>;

struct AttributeSource {
    const Attributes& attributes;
    std::string pointer;  // of the attributes object
    std::size_t count;    // required number of elements; 0: any
    bool quantized;       // KHR_mesh_quantization is required
};

template <class Vector>
Status take(Document& document, const AttributeSource& use, const char* name, NumberFormats numbers,
            std::vector<Vector>& to) {
    const auto attribute = use.attributes.find(name);
    if (attribute == use.attributes.end()) return {};
    const std::string pointer = use.pointer + '/' + name;
    constexpr auto width = static_cast<std::size_t>(Vector::length());
    BOLT_TRY_ASSIGN(const auto values,
                    unpack_floats(document, attribute->second, static_cast<int>(width), numbers, pointer));
    if (use.count > 0 && values.size() / width != use.count)
        return error_at(document, pointer,
                        fmt::format("has {} elements for {} vertices", values.size() / width, use.count));
    to.resize(values.size() / width);
    std::memcpy(to.data(), values.data(), values.size() * sizeof(float));
    return {};
}

// RGB colours get an alpha of one.
Status take_colors(Document& document, const AttributeSource& use, std::vector<glm::vec4>& to) {
    const auto attribute = use.attributes.find("COLOR_0");
    if (attribute == use.attributes.end()) return {};
    const auto& accessor = document.gltf.accessors[static_cast<std::size_t>(attribute->second)];
    if (accessor.type != TINYGLTF_TYPE_VEC3) return take(document, use, "COLOR_0", NumberFormats::unit, to);
    std::vector<glm::vec3> colors;
    const Status taken = take(document, use, "COLOR_0", NumberFormats::unit, colors);
    for (const glm::vec3& color : colors) to.emplace_back(color, 1.0F);
    return taken;
}

Status take_joints(Document& document, const AttributeSource& use, const std::string& name,
                   std::vector<glm::u16vec4>& to) {
    const std::string pointer = use.pointer + '/' + name;
    BOLT_TRY_ASSIGN(const auto values,
                    unpack_integers(document, use.attributes.at(name), TINYGLTF_TYPE_VEC4, pointer));
    if (values.size() != use.count * 4)
        return error_at(document, pointer,
                        fmt::format("has {} elements for {} vertices", values.size() / 4, use.count));
    for (std::size_t i = 0; i < values.size(); i += 4) {
        glm::u16vec4 joints;
        for (int c = 0; c < 4; ++c) {
            const std::uint32_t joint = values[i + static_cast<std::size_t>(c)];
            if (joint > 0xFFFFU) return error_at(document, pointer, fmt::format("names joint {}", joint));
            joints[c] = static_cast<std::uint16_t>(joint);
        }
        to.push_back(joints);
    }
    return {};
}

// Keeps the four strongest of eight influences and rescales them to the same sum.
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

// Reads any number of sets of four influences; a Primitive holds four.
Status take_influences(Document& document, const AttributeSource& use, Primitive& to) {
    for (int set = 0;; ++set) {
        const std::string joints_name = fmt::format("JOINTS_{}", set);
        const std::string weights_name = fmt::format("WEIGHTS_{}", set);
        const bool has_joints = use.attributes.contains(joints_name);
        if (has_joints != use.attributes.contains(weights_name))
            return error_at(document, use.pointer,
                            fmt::format("has not both {} and {}", joints_name, weights_name));
        if (!has_joints) return {};
        std::vector<glm::u16vec4> joints;
        std::vector<glm::vec4> weights;
        Status taken = take_joints(document, use, joints_name, joints);
        if (taken) taken = take(document, use, weights_name.c_str(), NumberFormats::unit, weights);
        if (!taken) return taken;
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
        const AttributeSource use{from.targets[i], fmt::format("{}/targets/{}", pointer, i), base.count,
                                  base.quantized};
        MorphTarget target;
        const NumberFormats numbers = use.quantized ? NumberFormats::quantized : NumberFormats::real;
        Status taken = take(document, use, "POSITION", numbers, target.positions);
        if (taken) taken = take(document, use, "NORMAL", numbers, target.normals);
        if (taken) taken = take(document, use, "TANGENT", numbers, target.tangents);
        if (!taken) return taken;
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
                            fmt::format("one of the {} vertices", to.positions.size()));
    to.indices = std::move(indices);
    return {};
}

Status check_corners(const Document& document, const std::string& pointer, const Primitive& primitive) {
    const std::size_t corners =
        primitive.indices.empty() ? primitive.positions.size() : primitive.indices.size();
    const bool whole = (primitive.topology != Topology::triangles || corners % 3 == 0) &&
                       (primitive.topology != Topology::lines || corners % 2 == 0);
    if (whole) return {};
    return error_at(document, pointer, fmt::format("has {} corners, which leaves a part over", corners));
}

Status read_primitive(Document& document, const tinygltf::Primitive& from, const nlohmann::json& json,
                      const std::string& pointer, Primitive& to) {
    const auto& required = document.gltf.extensionsRequired;
    const bool quantized =
        std::find(required.begin(), required.end(), "KHR_mesh_quantization") != required.end();
    AttributeSource use{from.attributes, pointer + "/attributes", 0, quantized};
    if (!from.attributes.contains("POSITION")) return error_at(document, use.pointer, "has no POSITION");
    const NumberFormats numbers = quantized ? NumberFormats::quantized : NumberFormats::real;
    const NumberFormats unit = quantized ? NumberFormats::quantized : NumberFormats::unit;
    Status taken = take(document, use, "POSITION", numbers, to.positions);
    use.count = to.positions.size();
    if (taken) taken = take(document, use, "NORMAL", numbers, to.normals);
    if (taken) taken = take(document, use, "TANGENT", numbers, to.tangents);
    if (taken) taken = take(document, use, "TEXCOORD_0", unit, to.texcoords[0]);
    if (taken) taken = take(document, use, "TEXCOORD_1", unit, to.texcoords[1]);
    if (taken) taken = take_colors(document, use, to.colors);
    if (taken) taken = take_influences(document, use, to);
    if (taken) taken = read_indices(document, json, pointer, to);
    if (taken) taken = read_targets(document, from, use, pointer, to);
    to.topology = static_cast<Topology>(from.mode);
    to.material = from.material;
    if (taken) taken = check_corners(document, pointer, to);
    return taken;
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
                return error_at(document, pointer, "has not as many morph targets as the first primitive");
            mesh.primitives.push_back(std::move(primitive));
        }
        for (const double weight : from.weights) mesh.weights.push_back(static_cast<float>(weight));
        if (mesh.primitives.empty())
            return error_at(document, fmt::format("/meshes/{}/primitives", i), "is empty");
        if (!mesh.weights.empty() && mesh.weights.size() != mesh.primitives[0].targets.size())
            return error_at(document, fmt::format("/meshes/{}/weights", i),
                            "has not one weight a morph target");
        model.meshes.push_back(std::move(mesh));
    }
    return {};
}

}  // namespace bolt::assets
