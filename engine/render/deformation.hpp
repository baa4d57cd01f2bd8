// Skinning and morphing: the joints and weights of an object, and the vertex data of a deformable part. The
// GPU evaluates them in passes/deform.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/render/box.hpp"

namespace bolt::render {

// The pose of one object, created anew for every pose.
struct Deformation {
    std::vector<glm::mat4> joints;  // from the mesh in its bind pose to the object's frame; empty: no skin
    std::vector<float> weights;     // morph target weights, in order; missing ones are 0
};

// Four joints of a vertex and their weights.
struct Influences {
    std::uint16_t joints[4];
    std::uint16_t
        weights[4];  // unorm; the sum is exactly 65535: joints with one motion move the vertex by just that
};
static_assert(sizeof(Influences) == 16);

// The deformation data of a part: its ranges in the model's buffers, and bounds of the motion.
struct Deformable {
    std::uint32_t vertices = 0;         // 0: rigid
    std::uint32_t first_influence = 0;  // index into the model's influences; only if `joints` is not empty
    std::uint32_t first_delta = 0;      // index into the model's deltas, in floats; target by target
    std::uint32_t delta_floats = 0;     // per vertex: 3 position, 6 with normal, 9 with tangent
    bool own_normals = true;            // false: flat normals of triangles without shared vertices
    std::vector<BoundingBox> joints;    // bind pose, what each joint moves; boxes may be empty
    std::vector<BoundingBox> targets;   // displacement of each target at weight 1
};

// The deformation data of all parts of a model, as uploaded to the GPU.
struct DeformData {
    std::vector<Influences> influences;
    std::vector<float> deltas;
};

Influences make_influences(const glm::u16vec4& joints, const glm::vec4& weights);

// `sources`: for each drawn vertex, the vertex of the primitive that it was made from.
Deformable make_deformable(const assets::Primitive& primitive, std::span<const std::uint32_t> sources,
                           DeformData& data);

// Returns a box that contains the part in every pose, in the object's frame. `rest`: its box without
// deformation.
BoundingBox bounds(const BoundingBox& rest, const Deformable& part, const Deformation* deformation);

// The largest scale of the joints, and whether they mirror the part.
float scale_of(const Deformation* deformation);
bool mirrors(const Deformation* deformation);

}  // namespace bolt::render
