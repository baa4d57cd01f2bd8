// What CPU and GPU share: compiled as GLSL (std430 and std140 lay these out alike: every member is a vec4, a mat4 or four
// scalars) and as C++ (offsets asserted in engine/render/shared.cpp).
#ifndef BOLT_SHADERS_SHARED_H
#define BOLT_SHADERS_SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace bolt::render::shared {
using uint = std::uint32_t;
using vec4 = glm::vec4;
using mat4 = glm::mat4;
#endif

// One eye, wall or screen.
struct View {
    mat4 clip_from_world;
    mat4 world_from_clip;
    vec4 eye;  // metres; w unused
};

struct Light {
    vec4 position;   // w: 0 directional, 1 point, 2 spot
    vec4 direction;  // in which it shines; w: range, 0: unlimited
    vec4 color;      // times intensity; w unused
    vec4 cone;       // spot: scale and offset of the cosine
};

#define MAX_VIEWS 4
#define MAX_LIGHTS 8

struct Frame {
    View views[MAX_VIEWS];
    Light lights[MAX_LIGHTS];
    vec4 diffuse[9];        // of the environment: shading::Harmonics
    mat4 shadow_from_world; // of light 0, when it casts a shadow
    vec4 environment;       // x: intensity, y: turn about Y, rad, z: highest level of the specular chain, w: exposure
    vec4 picture;           // width, height, 1/width, 1/height
    vec4 occlusion;         // x: radius of ambient occlusion, m; y: how far levels of detail may be off, m a metre of distance
    vec4 background;        // rgb; w: 1 show it, 0 show the environment
    vec4 cut;               // what is to be seen, world; w: radius kept free around it, m
    float cut_strength;     // 0: nothing fades … 1: what hides it goes
    float outline_px;       // width of outlines
    uint light_count;
    uint shadows;           // 1: light 0 casts a shadow
    uint view_count;
    uint unused_a;
    uint unused_b;
    uint unused_c;
};

struct Instance {
    mat4 world_from_object;
    vec4 tint;      // w: 0 as it is … 1 replaced by rgb
    vec4 outline;   // w: opacity of the line
    uint flags;     // INSTANCE_…
    float opacity;
    uint unused_a;
    uint unused_b;
};

#define INSTANCE_FLAT 1u   // no light: the colour itself (guides, marks)

struct Material {
    vec4 base_color;
    vec4 emissive;           // strength included; w: alpha cutoff
    vec4 specular_color;     // rgb; w: specular
    float metallic;
    float roughness;
    float coat;
    float coat_roughness;
    float f0;                // ((ior − 1) / (ior + 1))²
    float anisotropy;
    float anisotropy_rotation;
    float normal_scale;
    float occlusion_strength;
    uint unused_a;
    uint unused_b;
    uint unused_c;
    // Two rows a map: base, metallic-roughness, normal, occlusion, emissive, coat, coat roughness, coat normal, anisotropy,
    // specular, specular colour. w of the first: the set of texture coordinates.
    vec4 uv[22];
};

// Push constants of deform.comp: a part, and where what bends it and what comes of it stand in the buffers.
struct DeformPart {
    uint vertices;
    uint first_vertex;
    uint first_influence;
    uint skinned;       // 1: by joints
    uint first_delta;   // float
    uint delta_floats;  // a vertex
    uint targets;
    uint own_normals;   // 0: those of its triangles
    uint positions;     // word of the result
    uint attributes;    // word of the result
};

// Bits of the scene pipelines' specialization constant: what a pipeline is for. What a part does not need is not in its
// shader at all (engine/render/draw_list.hpp).
#define SCENE_BASE_MAP 1u
#define SCENE_METALLIC_ROUGHNESS_MAP 2u
#define SCENE_NORMAL_MAP 4u
#define SCENE_OCCLUSION_MAP 8u
#define SCENE_EMISSIVE_MAP 16u
#define SCENE_ANY_MAP (31u | SCENE_FORWARD_MAPS)
#define SCENE_VERTEX_COLORS 32u
#define SCENE_TANGENTS 64u
#define SCENE_COAT 128u
#define SCENE_ANISOTROPY 256u
#define SCENE_MASK 512u       // transparent below the cutoff
#define SCENE_BLEND 1024u     // as opaque as the base colour's alpha
#define SCENE_MARKED 2048u    // tinted, ghostly or without light
#define SCENE_SHADOW 4096u    // light 0 casts one
#define SCENE_OCCLUSION 8192u // ambient occlusion on the screen
#define SCENE_WIDE 16384u     // maps or colours of its own: more than a material's numbers
#define SCENE_CUT 32768u      // fades where it hides what is to be seen
#define SCENE_CUT_REST 1048576u // only what has faded in part; elsewhere it is a surface like any other
#define SCENE_LIGHTS_SHIFT 16u // the number of lights, four bits
#define SCENE_COAT_MAPS (1u << 21)        // of the coat's strength or roughness
#define SCENE_COAT_NORMAL_MAP (1u << 22)
#define SCENE_ANISOTROPY_MAP (1u << 23)
#define SCENE_SPECULAR_MAPS (1u << 24)    // of the dielectric's strength or colour
#define SCENE_SECOND_UV (1u << 25)        // a map has texture coordinates of its own
#define SCENE_VIEWS (1u << 26)            // several views are drawn at once
#define SCENE_PLAIN (1u << 27)            // one colour lies behind everything, not the environment
// Of maps that the geometry buffer has no room for.
#define SCENE_FORWARD_MAPS (SCENE_COAT_MAPS | SCENE_COAT_NORMAL_MAP | SCENE_ANISOTROPY_MAP | SCENE_SPECULAR_MAPS)

#ifdef __cplusplus
}  // namespace bolt::render::shared
#endif
#endif
