// Structures that CPU and GPU share. They are compiled as GLSL and as C++ (sizes and offsets are asserted in
// engine/render/gpu_model.cpp). std430 and std140 agree: members are vec4, mat4 or scalars in groups of four;
// DeformPart has only scalars.
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

// The view of an eye, or through a wall or screen.
struct View {
    mat4 clip_from_world;
    mat4 world_from_clip;
    vec4 eye;  // metres; w unused
};

struct Light {
    vec4 position;   // w: 0 directional, 1 point, 2 spot
    vec4 direction;  // in which the light shines; w: range, m, 0: unlimited
    vec4 color;      // times intensity; w unused
    vec4 cone;       // spot: its light is scaled by clamp(x · cosine of the angle from the axis + y, 0, 1)²
};

#define MAX_VIEWS 4
#define MAX_LIGHTS 8

// The values that all draws of a batch of views share.
struct FrameData {
    View views[MAX_VIEWS];
    Light lights[MAX_LIGHTS];
    vec4 diffuse[9];         // environment: nine spherical harmonics, rgb (shading::Harmonics)
    mat4 shadow_from_world;  // of light 0, if it casts a shadow
    vec4 environment;        // x: intensity, y: rotation about Y, rad, z: highest specular level, w: exposure
    vec4 picture;            // width, height, 1/width, 1/height
    // x: radius of ambient occlusion, m; y: allowed error of levels of detail, m per m of distance
    vec4 occlusion;
    vec4 background;     // rgb; w: 1 show it, 0 show the environment
    vec4 cut;            // focus of the cut-away, world; w: radius, m
    float cut_strength;  // 0: no fading … 1: full fading
    float outline_px;    // width of outlines, pixels
    uint shadows;        // 1: light 0 casts a shadow
    uint unused;
};

struct Instance {
    mat4 world_from_object;
    vec4 tint;     // w: fraction of the material's colour that rgb replaces
    vec4 outline;  // colour of the line around the object; w: opacity, 0: no line
    uint flags;    // INSTANCE_…
    float opacity;  // below 1: a ghost
    uint unused_a;
    uint unused_b;
};

#define INSTANCE_FLAT 1u  // unlit

struct Material {
    vec4 base_color;
    vec4 emissive;        // including strength; w: alpha cutoff
    vec4 specular_color;  // w: strength of the specular reflection
    float metallic;
    float roughness;
    float coat;
    float coat_roughness;
    float f0;  // ((ior − 1) / (ior + 1))²
    float anisotropy;
    float anisotropy_rotation;
    float normal_scale;
    float occlusion_strength;
    uint unused_a;
    uint unused_b;
    uint unused_c;
    // For each map the two rows of the matrix that transforms its texture coordinates. Maps: base colour,
    // metallic-roughness, normal, occlusion, emissive, coat, coat roughness, coat normal, anisotropy,
    // specular, specular colour. w of the first row: the set of texture coordinates.
    vec4 uv[22];
};

// Push constants of deform.comp: a part, and the positions of its data and results in the buffers.
struct DeformPart {
    uint vertices;         // number of vertices
    uint first_vertex;     // index into the model's vertices
    uint first_influence;  // index into the model's influences (joints and weights of a vertex)
    uint skinned;          // 1: has joints
    uint first_delta;      // index into the displacements by morph targets, in floats
    uint delta_floats;     // floats per vertex and target: 3 position, 6 with normal, 9 with tangent
    uint targets;          // number of morph targets
    uint own_normals;      // 0: use face normals
    uint positions;        // where the positions are written, in words of 4 bytes
    uint attributes;       // where the attributes are written, in words of 4 bytes
};

// Bits of the specialization constant of scene pipelines. Features that a part does not need are compiled out
// (engine/render/draw_list.hpp).
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
#define SCENE_MASK 512u                  // transparent where alpha is below the cutoff
#define SCENE_BLEND 1024u                // opacity is the base colour's alpha
#define SCENE_TINTED 2048u               // tinted, translucent or unlit
#define SCENE_SHADOW 4096u               // light 0 casts a shadow
#define SCENE_OCCLUSION 8192u            // ambient occlusion is on
#define SCENE_PER_PIXEL_MATERIAL 16384u  // values from the material buffer, not the material's constants
#define SCENE_CUT 32768u                 // fades where it hides the cut-away's focus
#define SCENE_CUT_FADING 1048576u   // draws only the fading region; the opaque region is drawn as a surface
#define SCENE_LIGHTS_SHIFT 16u      // the number of lights, four bits
#define SCENE_COAT_MAPS (1u << 21)  // of the coat's strength or roughness
#define SCENE_COAT_NORMAL_MAP (1u << 22)
#define SCENE_ANISOTROPY_MAP (1u << 23)
#define SCENE_SPECULAR_MAPS (1u << 24)     // of the dielectric's strength or colour
#define SCENE_SECOND_UV (1u << 25)         // a map uses the second set of texture coordinates
#define SCENE_VIEWS (1u << 26)             // several views are drawn at once
#define SCENE_COLOR_BACKGROUND (1u << 27)  // the background is one colour, not the environment
#define SCENE_TRANSPARENT (1u << 28)       // the background has alpha 0
#define SCENE_HIDDEN_AREA (1u << 29)       // samples of depth 1 are never seen (hidden.vert)
// Maps that the geometry buffer cannot store.
#define SCENE_FORWARD_MAPS \
    (SCENE_COAT_MAPS | SCENE_COAT_NORMAL_MAP | SCENE_ANISOTROPY_MAP | SCENE_SPECULAR_MAPS)

#ifdef __cplusplus
}  // namespace bolt::render::shared
#endif
#endif
