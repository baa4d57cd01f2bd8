#include "engine/render/deformation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <numeric>

namespace bolt::render {

namespace {

// The weights of a vertex sum to one, so its position is a mean of the positions that its joints alone would
// give. The union of the joints' boxes therefore contains all vertices.
void add_joint_boxes(const assets::Primitive& p, std::span<const std::uint32_t> sources,
                     std::span<const Influences> influences, Deformable& part) {
    for (std::size_t i = 0; i < influences.size(); ++i)
        for (int k = 0; k < 4; ++k) {
            if (influences[i].weights[k] == 0) continue;
            const std::size_t joint = influences[i].joints[k];
            if (part.joints.size() <= joint) part.joints.resize(joint + 1);
            part.joints[joint].add(p.positions[sources[i]]);
        }
}

void add_targets(const assets::Primitive& p, std::span<const std::uint32_t> sources, DeformData& data,
                 Deformable& part) {
    const auto any = [&](auto stream) {
        return std::any_of(p.targets.begin(), p.targets.end(),
                           [&](const assets::MorphTarget& t) { return !(t.*stream).empty(); });
    };
    part.delta_floats = any(&assets::MorphTarget::tangents) ? 9 : any(&assets::MorphTarget::normals) ? 6 : 3;
    part.first_delta = static_cast<std::uint32_t>(data.deltas.size());
    for (const assets::MorphTarget& target : p.targets) {
        const std::array streams{&target.positions, &target.normals, &target.tangents};
        BoundingBox box;
        for (const std::uint32_t source : sources) {
            for (std::size_t s = 0; s < part.delta_floats / 3; ++s) {
                const glm::vec3 delta = streams[s]->empty() ? glm::vec3(0.0F) : (*streams[s])[source];
                data.deltas.insert(data.deltas.end(), {delta.x, delta.y, delta.z});
                if (s == 0) box.add(delta);
            }
        }
        part.targets.push_back(box);
    }
}

}  // namespace

Influences make_influences(const glm::u16vec4& joints, const glm::vec4& weights) {
    std::array<float, 4> share{};
    for (int i = 0; i < 4; ++i) share[static_cast<std::size_t>(i)] = std::max(weights[i], 0.0F);
    float sum = std::accumulate(share.begin(), share.end(), 0.0F);
    if (!(sum > 0.0F)) share[0] = sum = 1.0F;  // the vertex follows its first joint
    Influences to{};
    int left = 65535;
    for (std::size_t i = 0; i < 4; ++i) {
        const int part = std::min(left, static_cast<int>(std::lround(share[i] / sum * 65535.0F)));
        to.joints[i] = joints[static_cast<int>(i)];
        to.weights[i] = static_cast<std::uint16_t>(part);
        left -= part;
    }
    // Add the rounding remainder to the largest weight.
    *std::max_element(std::begin(to.weights), std::end(to.weights)) += static_cast<std::uint16_t>(left);
    return to;
}

Deformable make_deformable(const assets::Primitive& p, std::span<const std::uint32_t> sources,
                           DeformData& data) {
    Deformable part;
    if (p.joints.empty() && p.targets.empty()) return part;
    part.vertices = static_cast<std::uint32_t>(sources.size());
    part.own_normals = !p.normals.empty();
    if (!p.joints.empty()) {
        part.first_influence = static_cast<std::uint32_t>(data.influences.size());
        for (const std::uint32_t source : sources)
            data.influences.push_back(make_influences(p.joints[source], p.weights[source]));
        add_joint_boxes(p, sources, std::span(data.influences).subspan(part.first_influence), part);
    }
    if (!p.targets.empty()) add_targets(p, sources, data, part);
    return part;
}

BoundingBox bounds(const BoundingBox& rest, const Deformable& part, const Deformation* deformation) {
    if (deformation == nullptr || part.vertices == 0) return rest;
    glm::vec3 low(0.0F), high(0.0F);  // displacements by the targets
    for (std::size_t i = 0; i < part.targets.size() && i < deformation->weights.size(); ++i) {
        const glm::vec3 a = deformation->weights[i] * part.targets[i].low,
                        b = deformation->weights[i] * part.targets[i].high;
        low += glm::min(a, b);
        high += glm::max(a, b);
    }
    const auto morphed = [&](const BoundingBox& box) { return BoundingBox{box.low + low, box.high + high}; };
    if (deformation->joints.empty() || part.joints.empty()) return morphed(rest);
    BoundingBox box;
    for (std::size_t i = 0; i < part.joints.size() && i < deformation->joints.size(); ++i) {
        if (part.joints[i].empty()) continue;
        const BoundingBox moved = transformed(morphed(part.joints[i]), deformation->joints[i]);
        box.add(moved.low);
        box.add(moved.high);
    }
    return box;
}

float scale_of(const Deformation* deformation) {
    if (deformation == nullptr || deformation->joints.empty()) return 1.0F;
    float largest = 0.0F;
    for (const glm::mat4& joint : deformation->joints)
        largest = std::max(largest, std::cbrt(std::abs(glm::determinant(glm::mat3(joint)))));
    return largest;
}

bool mirrors(const Deformation* deformation) {
    return deformation != nullptr && !deformation->joints.empty() &&
           glm::determinant(glm::mat3(deformation->joints.front())) < 0.0F;
}

}  // namespace bolt::render
