#include "engine/assets/pose.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::assets {

namespace {

glm::quat quaternion(const float* v) { return glm::quat(v[3], v[0], v[1], v[2]); }

// Spherical linear interpolation (appendix C.3) along the shorter arc; linear if the angle is too small to
// divide by its sine.
glm::quat slerp(const glm::quat& from, const glm::quat& to, float t) {
    const float cosine = glm::dot(from, to);
    const float side = cosine < 0.0F ? -1.0F : 1.0F;
    const float angle = std::acos(std::min(std::abs(cosine), 1.0F));
    if (angle < 1e-3F) return glm::normalize(from * (1.0F - t) + to * (side * t));
    const float a = std::sin((1.0F - t) * angle), b = side * std::sin(t * angle);
    return glm::normalize((from * a + to * b) / std::sin(angle));
}

void set_rotation(std::vector<float>& value, const glm::quat& q) { value = {q.x, q.y, q.z, q.w}; }

}  // namespace

ModelPose rest_pose(const Model& model) {
    ModelPose pose;
    for (const Node& node : model.nodes) {
        NodePose node_pose{node.translation, node.rotation, node.scale, node.weights};
        if (node.mesh >= 0 && node_pose.weights.empty()) {
            const Mesh& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
            node_pose.weights = mesh.weights;
            if (node_pose.weights.empty() && !mesh.primitives.empty())
                node_pose.weights.resize(mesh.primitives.front().targets.size(), 0.0F);
        }
        pose.push_back(std::move(node_pose));
    }
    return pose;
}

std::vector<float> sample(const AnimationChannel& channel, float seconds) {
    const bool cubic = channel.interpolation == Interpolation::cubic;
    const std::size_t keys = channel.times.size();
    if (keys == 0) return {};
    const std::size_t width = channel.values.size() / keys / (cubic ? 3 : 1);
    // Returns a key's values. For cubic splines `part` selects 0: the in-tangent, 1: the value, 2: the
    // out-tangent.
    const auto at = [&](std::size_t key, std::size_t part) {
        return channel.values.data() + (cubic ? 3 * key + part : key) * width;
    };
    const auto value_at = [&](std::size_t key) { return at(key, 1); };
    const auto next = static_cast<std::size_t>(
        std::upper_bound(channel.times.begin(), channel.times.end(), seconds) - channel.times.begin());
    const std::size_t last = next == 0 ? 0 : next - 1;
    std::vector<float> value(value_at(last), value_at(last) + width);
    const bool between = next > 0 && next < keys && channel.interpolation != Interpolation::step;
    if (between) {
        const float span = channel.times[next] - channel.times[last];
        const float t = (seconds - channel.times[last]) / span;
        if (cubic) {
            const float t2 = t * t, t3 = t2 * t;
            for (std::size_t i = 0; i < width; ++i)
                value[i] = (2.0F * t3 - 3.0F * t2 + 1.0F) * at(last, 1)[i] +
                           span * (t3 - 2.0F * t2 + t) * at(last, 2)[i] +
                           (3.0F * t2 - 2.0F * t3) * at(next, 1)[i] + span * (t3 - t2) * at(next, 0)[i];
        } else if (channel.path == TargetPath::rotation) {
            set_rotation(value, slerp(quaternion(value_at(last)), quaternion(value_at(next)), t));
        } else {
            for (std::size_t i = 0; i < width; ++i)
                value[i] = (1.0F - t) * value_at(last)[i] + t * value_at(next)[i];
        }
    }
    if (channel.path == TargetPath::rotation) {
        const glm::quat q = quaternion(value.data());
        const float length = glm::length(q);
        set_rotation(value, length > 0.0F ? q / length : glm::quat(1.0F, 0.0F, 0.0F, 0.0F));
    }
    return value;
}

void apply(const Animation& animation, float seconds, ModelPose& pose) {
    for (const AnimationChannel& channel : animation.channels) {
        if (channel.node < 0 || channel.times.empty()) continue;
        NodePose& node = pose[static_cast<std::size_t>(channel.node)];
        std::vector<float> value = sample(channel, seconds);
        switch (channel.path) {
            case TargetPath::translation:
                node.translation = {value[0], value[1], value[2]};
                break;
            case TargetPath::rotation:
                node.rotation = quaternion(value.data());
                break;
            case TargetPath::scale:
                node.scale = {value[0], value[1], value[2]};
                break;
            case TargetPath::weights:
                node.weights = std::move(value);
                break;
        }
    }
}

float duration(const Animation& animation) {
    float last = 0.0F;
    for (const AnimationChannel& channel : animation.channels)
        if (!channel.times.empty()) last = std::max(last, channel.times.back());
    return last;
}

std::vector<glm::mat4> world_transforms(const Model& model, const ModelPose& pose) {
    std::vector<glm::mat4> local;
    for (const NodePose& node : pose)
        local.push_back(local_transform(node.translation, node.rotation, node.scale));
    return world_transforms(model, local);
}

std::vector<glm::mat4> joint_matrices(const Skin& skin, std::span<const glm::mat4> world) {
    std::vector<glm::mat4> matrices;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const glm::mat4& joint = world[static_cast<std::size_t>(skin.joints[i])];
        matrices.push_back(skin.inverse_bind.empty() ? joint : joint * skin.inverse_bind[i]);
    }
    return matrices;
}

void set_rest(Model& model, const ModelPose& pose) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        Node& node = model.nodes[i];
        node.translation = pose[i].translation;
        node.rotation = pose[i].rotation;
        node.scale = pose[i].scale;
        if (!pose[i].weights.empty()) node.weights = pose[i].weights;
    }
}

}  // namespace bolt::assets
