// What bends: joints and morph weights of an object, and what a part brings to be bent by them. The GPU does
// it, in passes/deform.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/render/box.hpp"

namespace bolt::render {

// Of an object, made anew for every pose.
struct Deformation {
    std::vector<glm::mat4> joints;  // from the mesh as it was bound into the object's frame; empty: no skin
    std::vector<float> weights;     // of the morph targets, first to last; what is missing is 0
};

// Of a vertex: four joints and how much each has to say.
struct Influences {
    std::uint16_t joints[4];
    std::uint16_t
        weights[4];  // unorm; their sum is exactly 65535, so that joints that move alike move it alike
};
static_assert(sizeof(Influences) == 16);

// Of a part: where what bends it stands in the model's buffers, and how far that reaches.
struct Deformable {
    std::uint32_t vertices = 0;         // 0: it is stiff
    std::uint32_t first_influence = 0;  // of the model's; only if `joints` is not empty
    std::uint32_t first_delta = 0;      // float of the model's; target by target
    std::uint32_t delta_floats = 0;     // a vertex: 3 position, 6 and normal, 9 and tangent
    bool own_normals = true;            // otherwise those of its triangles, which have no common corners
    std::vector<Box> joints;            // as it was bound, what each joint moves; may be empty boxes
    std::vector<Box> targets;           // how far each target moves it at weight 1
};

// What bends all parts of a model, as the GPU takes it.
struct DeformData {
    std::vector<Influences> influences;
    std::vector<float> deltas;
};

Influences make_influences(const glm::u16vec4& joints, const glm::vec4& weights);

// `sources`: which vertex of the primitive each drawn one comes from.
Deformable make_deformable(const assets::Primitive& primitive, std::span<const std::uint32_t> sources,
                           DeformData& data);

// Holds the part however it is bent, in the object's frame. `rest`: its box when it is not.
Box bounds(const Box& rest, const Deformable& part, const Deformation* deformation);

// How much larger a part may get by the joints' scales, and whether they turn it inside out.
float scale_of(const Deformation* deformation);
bool mirrors(const Deformation* deformation);

}  // namespace bolt::render
