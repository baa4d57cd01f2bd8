#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// The vertex stage of parts with materials.
#include "shaders/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 texcoord;
layout(location = 4) in vec4 color;
layout(location = 5) in vec2 second_texcoord;

invariant gl_Position;  // a ghost's depth is drawn before its colour
layout(location = 0) out vec3 at;
// Centroid interpolation: extrapolation to the centre of a partly covered pixel would make rounded edges
// sparkle.
layout(location = 1) centroid out vec3 normal_out;
layout(location = 2) out vec4 tangent_out;
layout(location = 3) out vec4 texcoord_out;  // both sets
layout(location = 4) out vec4 color_out;
layout(location = 5) flat out vec4 tint;
layout(location = 6) flat out vec2 opacity_unlit;  // opacity; 1: unlit

void main() {
    const mat4 world_from_object = instances[gl_InstanceIndex].world_from_object;
    const vec4 world = world_from_object * vec4(position, 1.0);
    const mat3 m = mat3(world_from_object);
    // Transform normals by the cofactor matrix, which is correct for every scale. Normals of mirrored parts
    // point inward, consistent with gl_FrontFacing, because their winding is reversed.
    const mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    const float side = dot(m[0], cofactors[0]) < 0.0 ? -1.0 : 1.0;
    at = world.xyz;
    normal_out = cofactors * normal.xyz;
    tangent_out = has(SCENE_TANGENTS) ? vec4(m * tangent.xyz, side * tangent.w) : vec4(0.0);
    texcoord_out = vec4(has(SCENE_ANY_MAP) ? texcoord : vec2(0.0), has(SCENE_SECOND_UV) ? second_texcoord : vec2(0.0));
    color_out = has(SCENE_VERTEX_COLORS) ? color : vec4(1.0);
    tint = vec4(0.0);
    opacity_unlit = vec2(1.0, 0.0);
    if (has(SCENE_TINTED)) {
        tint = instances[gl_InstanceIndex].tint;
        opacity_unlit.x = instances[gl_InstanceIndex].opacity;
        opacity_unlit.y = (instances[gl_InstanceIndex].flags & INSTANCE_FLAT) != 0u ? 1.0 : 0.0;
    }
    gl_Position = frame.views[view_index].clip_from_world * world;
}
