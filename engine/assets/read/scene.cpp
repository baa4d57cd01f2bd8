// Reads nodes, skins, animations, cameras and lights.
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

namespace {

// Deeper than any real model, and shallow enough for recursive code.
constexpr int node_depth_limit = 256;

// Decomposes an affine matrix without shear into translation, rotation and scale. The x scale of a reflection
// is negative.
Status decompose(const Document& document, const std::vector<double>& m, const std::string& pointer,
                 Node& node) {
    const glm::dvec3 columns[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
    glm::dvec3 scale{glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2])};
    const bool affine = m[3] == 0.0 && m[7] == 0.0 && m[11] == 0.0 && std::abs(m[15] - 1.0) < 1e-6;
    if (!affine) return error_at(document, pointer, "is not an affine matrix", "the last row 0, 0, 0, 1");
    if (std::min({scale.x, scale.y, scale.z}) < 1e-12)
        return error_at(document, pointer, "has a scale of zero", "scales other than zero");
    glm::dmat3 rotation(columns[0] / scale.x, columns[1] / scale.y, columns[2] / scale.z);
    const double shear =
        std::max({std::abs(glm::dot(rotation[0], rotation[1])), std::abs(glm::dot(rotation[1], rotation[2])),
                  std::abs(glm::dot(rotation[2], rotation[0]))});
    if (shear > 1e-3)
        return error_at(document, pointer, "contains shear", "a product of translation, rotation and scale");
    if (glm::determinant(rotation) < 0.0) {
        scale.x = -scale.x;
        rotation[0] = -rotation[0];
    }
    node.translation = {m[12], m[13], m[14]};
    node.rotation = glm::quat(glm::normalize(glm::quat_cast(rotation)));
    node.scale = scale;
    return {};
}

Status read_node(const Document& document, std::size_t index, Node& node) {
    const tinygltf::Node& from = document.gltf.nodes[index];
    const std::string pointer = fmt::format("/nodes/{}", index);
    node.name = from.name;
    node.children = from.children;
    node.mesh = from.mesh;
    node.skin = from.skin;
    node.camera = from.camera;
    if (from.matrix.size() == 16) {
        BOLT_TRY(decompose(document, from.matrix, pointer + "/matrix", node));
    } else {
        if (from.translation.size() == 3) node.translation = glm::make_vec3(from.translation.data());
        if (from.scale.size() == 3) node.scale = glm::make_vec3(from.scale.data());
        if (from.rotation.size() == 4) {
            const glm::dquat rotation(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]);
            if (std::abs(glm::length(rotation) - 1.0) > 1e-2)
                return error_at(document, pointer + "/rotation", "is not a unit quaternion");
            // Keep the bits of a quaternion that has unit length to float precision; normalise others.
            const bool exact = std::abs(glm::length(rotation) - 1.0) < 1e-5;
            node.rotation = glm::quat(exact ? rotation : glm::normalize(rotation));
        }
    }
    for (const double weight : from.weights) node.weights.push_back(static_cast<float>(weight));
    const auto light = from.extensions.find("KHR_lights_punctual");
    if (light != from.extensions.end()) node.light = light->second.Get("light").GetNumberAsInt();
    const nlohmann::json& json = document.json["nodes"][index];
    if (json.contains("extras")) node.extras = json["extras"].dump();
    return {};
}

// Checks that every node has at most one parent and is not its own descendant.
Status check_tree(const Document& document, const Model& model) {
    std::vector<int> parents(model.nodes.size(), -1);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        for (std::size_t k = 0; k < model.nodes[i].children.size(); ++k) {
            int& parent = parents[static_cast<std::size_t>(model.nodes[i].children[k])];
            if (parent >= 0)
                return error_at(
                    document, fmt::format("/nodes/{}/children/{}", i, k),
                    fmt::format("node {} is already a child of node {}", model.nodes[i].children[k], parent));
            parent = static_cast<int>(i);
        }
    }
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        int depth = 0;
        for (int node = parents[i]; node >= 0; node = parents[static_cast<std::size_t>(node)]) {
            if (node == static_cast<int>(i))
                return error_at(document, fmt::format("/nodes/{}", i), "is its own descendant",
                                "a tree of nodes");
            // The ancestors of a node below a cycle never end; the depth limit stops the loop.
            if (++depth > node_depth_limit)
                return error_at(
                    document, fmt::format("/nodes/{}", i),
                    fmt::format("is more than {} levels deep, or below a cycle", node_depth_limit));
        }
    }
    return {};
}

Status read_roots(const Document& document, Model& model) {
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const Node& node : model.nodes)
        for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    if (document.gltf.scenes.empty()) {
        for (std::size_t i = 0; i < model.nodes.size(); ++i)
            if (!is_child[i]) model.roots.push_back(static_cast<int>(i));
        return {};
    }
    const auto scene = static_cast<std::size_t>(std::max(document.gltf.defaultScene, 0));
    std::vector<bool> listed(model.nodes.size(), false);
    const std::vector<int>& nodes = document.gltf.scenes[scene].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = static_cast<std::size_t>(nodes[i]);
        const std::string pointer = fmt::format("/scenes/{}/nodes/{}", scene, i);
        if (is_child[node])
            return error_at(document, pointer, fmt::format("node {} is not a root node", node));
        if (listed[node]) return error_at(document, pointer, fmt::format("node {} is listed twice", node));
        listed[node] = true;
        model.roots.push_back(nodes[i]);
    }
    return {};
}

// Checks that meshes use only joints of their node's skin, and that node weights match the morph targets.
Status check_skins_and_weights(const Document& document, const Model& model) {
    std::vector<int> highest(model.meshes.size(), -1);
    for (std::size_t i = 0; i < model.meshes.size(); ++i)
        for (const Primitive& primitive : model.meshes[i].primitives)
            for (const glm::u16vec4& joints : primitive.joints)
                highest[i] = std::max({highest[i], static_cast<int>(joints.x), static_cast<int>(joints.y),
                                       static_cast<int>(joints.z), static_cast<int>(joints.w)});
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = model.nodes[i];
        if (node.mesh < 0) continue;
        const auto mesh = static_cast<std::size_t>(node.mesh);
        if (!node.weights.empty() && node.weights.size() != model.meshes[mesh].primitives[0].targets.size())
            return error_at(document, fmt::format("/nodes/{}/weights", i),
                            fmt::format("has {} weights for {} morph targets", node.weights.size(),
                                        model.meshes[mesh].primitives[0].targets.size()));
        if (node.skin < 0) continue;
        const std::size_t joints = model.skins[static_cast<std::size_t>(node.skin)].joints.size();
        if (highest[mesh] >= static_cast<int>(joints))
            return error_at(
                document, fmt::format("/nodes/{}/skin", i),
                fmt::format("mesh {} uses joint {} of a skin with {} joints", mesh, highest[mesh], joints));
    }
    return {};
}

}  // namespace

Status read_nodes(const Document& document, Model& model) {
    model.nodes.resize(document.gltf.nodes.size());
    Status status;
    for (std::size_t i = 0; status && i < model.nodes.size(); ++i)
        status = read_node(document, i, model.nodes[i]);
    if (status) status = check_tree(document, model);
    if (status) status = read_roots(document, model);
    if (status) status = check_skins_and_weights(document, model);
    return status;
}

namespace {

Status set_path(const Document& document, const std::string& name, const std::string& pointer,
                TargetPath& path) {
    constexpr std::pair<const char*, TargetPath> names[] = {{"translation", TargetPath::translation},
                                                            {"rotation", TargetPath::rotation},
                                                            {"scale", TargetPath::scale},
                                                            {"weights", TargetPath::weights}};
    for (const auto& [known, value] : names) {
        if (name == known) {
            path = value;
            return {};
        }
    }
    return error_at(document, pointer, "is '" + name + "'", "translation, rotation, scale or weights");
}

Status set_interpolation(const Document& document, const std::string& name, const std::string& pointer,
                         Interpolation& interpolation) {
    if (name == "STEP") {
        interpolation = Interpolation::step;
    } else if (name == "CUBICSPLINE") {
        interpolation = Interpolation::cubic;
    } else if (name != "LINEAR") {
        return error_at(document, pointer, "is '" + name + "'", "STEP, LINEAR or CUBICSPLINE");
    }
    return {};
}

// Returns the number of floats per key of the animated property; 0: the node does not have the property.
std::size_t floats_per_key(const Model& model, const AnimationChannel& channel) {
    if (channel.path == TargetPath::rotation) return 4;
    if (channel.path != TargetPath::weights) return 3;
    const int mesh = model.nodes[static_cast<std::size_t>(channel.node)].mesh;
    return mesh < 0 ? 0 : model.meshes[static_cast<std::size_t>(mesh)].primitives[0].targets.size();
}

Status read_keys(Document& document, const Model& model, const nlohmann::json& sampler,
                 const std::string& pointer, AnimationChannel& channel) {
    BOLT_TRY(set_interpolation(document, sampler.value("interpolation", "LINEAR"), pointer + "/interpolation",
                               channel.interpolation));
    BOLT_TRY_ASSIGN(auto times, unpack_floats(document, sampler["input"], TINYGLTF_TYPE_SCALAR,
                                              NumberFormats::real, pointer + "/input"));
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] < 0.0F || (i > 0 && times[i] <= times[i - 1]))
            return error_at(document, pointer + "/input", fmt::format("key {} is at {} s", i, times[i]),
                            "increasing times from 0 on");
    const int type = channel.path == TargetPath::rotation  ? TINYGLTF_TYPE_VEC4
                     : channel.path == TargetPath::weights ? TINYGLTF_TYPE_SCALAR
                                                           : TINYGLTF_TYPE_VEC3;
    const bool may_be_quantized = channel.path == TargetPath::rotation || channel.path == TargetPath::weights;
    BOLT_TRY_ASSIGN(auto values, unpack_floats(document, sampler["output"], type,
                                               may_be_quantized ? NumberFormats::unit : NumberFormats::real,
                                               pointer + "/output"));
    if (channel.interpolation == Interpolation::cubic && times.size() < 2)
        return error_at(document, pointer + "/input", "has one key", "at least two for a cubic spline");
    const std::size_t tangents = channel.interpolation == Interpolation::cubic ? 3 : 1;
    const std::size_t expected = times.size() * floats_per_key(model, channel) * tangents;
    if (values.size() != expected || expected == 0)
        return error_at(document, pointer + "/output",
                        fmt::format("has {} numbers for {} keys", values.size(), times.size()),
                        fmt::format("{} numbers", expected));
    channel.times = std::move(times);
    channel.values = std::move(values);
    return {};
}

}  // namespace

Status read_skins(Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.skins.size(); ++i) {
        const tinygltf::Skin& from = document.gltf.skins[i];
        Skin skin;
        skin.name = from.name;
        skin.joints = from.joints;
        skin.skeleton = from.skeleton;
        if (skin.joints.empty()) return error_at(document, fmt::format("/skins/{}/joints", i), "is empty");
        if (from.inverseBindMatrices >= 0) {
            const std::string pointer = fmt::format("/skins/{}/inverseBindMatrices", i);
            BOLT_TRY_ASSIGN(const auto values,
                            unpack_floats(document, from.inverseBindMatrices, TINYGLTF_TYPE_MAT4,
                                          NumberFormats::real, pointer));
            if (values.size() < skin.joints.size() * 16)
                return error_at(
                    document, pointer,
                    fmt::format("has {} matrices for {} joints", values.size() / 16, skin.joints.size()));
            skin.inverse_bind.resize(skin.joints.size());
            for (std::size_t k = 0; k < skin.inverse_bind.size(); ++k)
                skin.inverse_bind[k] = glm::make_mat4(values.data() + 16 * k);
        }
        model.skins.push_back(std::move(skin));
    }
    return {};
}

Status read_animations(Document& document, Model& model) {
    const auto animations = document.json.find("animations");
    if (animations == document.json.end()) return {};
    for (std::size_t i = 0; i < animations->size(); ++i) {
        const nlohmann::json& from = (*animations)[i];
        const nlohmann::json& samplers = from["samplers"];
        Animation animation;
        animation.name = from.value("name", "");
        for (std::size_t k = 0; k < from["channels"].size(); ++k) {
            const nlohmann::json& source = from["channels"][k];
            const std::string pointer = fmt::format("/animations/{}/channels/{}", i, k);
            const std::size_t sampler = source["sampler"];
            if (sampler >= samplers.size())
                return error_at(document, pointer + "/sampler",
                                fmt::format("there is no sampler {}", sampler),
                                fmt::format("an index below {}", samplers.size()));
            // A channel without a node belongs to an extension and is ignored.
            if (!source["target"].contains("node")) continue;
            AnimationChannel channel;
            channel.node = source["target"]["node"];
            Status read =
                set_path(document, source["target"]["path"], pointer + "/target/path", channel.path);
            if (read)
                read = read_keys(document, model, samplers[sampler],
                                 fmt::format("/animations/{}/samplers/{}", i, sampler), channel);
            if (!read) return read;
            animation.channels.push_back(std::move(channel));
        }
        if (!animation.channels.empty()) model.animations.push_back(std::move(animation));
    }
    return {};
}

Status read_cameras(const Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.cameras.size(); ++i) {
        const tinygltf::Camera& from = document.gltf.cameras[i];
        Camera camera;
        camera.name = from.name;
        camera.perspective = from.type == "perspective";
        if (camera.perspective) {
            camera.yfov = static_cast<float>(from.perspective.yfov);
            camera.aspect = static_cast<float>(from.perspective.aspectRatio);
            camera.znear = static_cast<float>(from.perspective.znear);
            camera.zfar = static_cast<float>(from.perspective.zfar);
        } else {
            camera.xmag = static_cast<float>(from.orthographic.xmag);
            camera.ymag = static_cast<float>(from.orthographic.ymag);
            camera.znear = static_cast<float>(from.orthographic.znear);
            camera.zfar = static_cast<float>(from.orthographic.zfar);
            if (camera.xmag == 0.0F || camera.ymag == 0.0F)
                return error_at(document, fmt::format("/cameras/{}/orthographic", i),
                                "has a width or height of zero", "xmag and ymag other than zero");
        }
        if (camera.zfar != 0.0F && camera.zfar <= camera.znear)
            return error_at(document, fmt::format("/cameras/{}/{}/zfar", i, from.type),
                            "is not larger than znear");
        model.cameras.push_back(std::move(camera));
    }
    return {};
}

Status read_lights(const Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.lights.size(); ++i) {
        const tinygltf::Light& from = document.gltf.lights[i];
        const std::string pointer = fmt::format("/extensions/KHR_lights_punctual/lights/{}", i);
        Light light;
        light.name = from.name;
        if (from.type == "directional") light.type = LightType::directional;
        if (from.type == "spot") light.type = LightType::spot;
        if (from.color.size() == 3) light.color = {from.color[0], from.color[1], from.color[2]};
        light.intensity = static_cast<float>(from.intensity);
        light.range = static_cast<float>(from.range);
        light.inner_cone = static_cast<float>(from.spot.innerConeAngle);
        light.outer_cone = static_cast<float>(from.spot.outerConeAngle);
        if (light.type == LightType::spot && light.inner_cone >= light.outer_cone)
            return error_at(document, pointer + "/spot",
                            "has an inner cone that is not smaller than the outer one");
        model.lights.push_back(std::move(light));
    }
    return {};
}

}  // namespace bolt::assets
