#version 460
#extension GL_GOOGLE_include_directive : require
// Deforms a part's vertices by morph targets and joints; the output replaces the model's positions and
// attributes. Sources: glTF 2.0 specification, 3.7.2.2 (morph targets come first) and 3.7.3.3 (skins).
#include "shaders/shared.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Attributes { uint attributes[]; };
layout(set = 0, binding = 2, std430) readonly buffer AllInfluences { uvec4 influences[]; };
layout(set = 0, binding = 3, std430) readonly buffer Deltas { float deltas[]; };
layout(set = 0, binding = 4, std430) readonly buffer Joints { mat4 joints[]; };
layout(set = 0, binding = 5, std430) readonly buffer Weights { float weights[]; };
layout(set = 0, binding = 6, std430) writeonly buffer Deformed { uint deformed[]; };
layout(push_constant) uniform Push { DeformPart part; };

const uint attribute_words = 7u;  // VertexAttributes: normal 2, tangent 2, texture coordinates 2, colour 1

// The targets' contribution to a vertex's position (stream 0), normal (1) or tangent (2).
vec3 morph(uint vertex, uint stream) {
    vec3 sum = vec3(0.0);
    if (3u * stream >= part.delta_floats) return sum;
    for (uint target = 0u; target < part.targets; ++target) {
        const uint at = part.first_delta + (target * part.vertices + vertex) * part.delta_floats + 3u * stream;
        sum += weights[target] * vec3(deltas[at], deltas[at + 1u], deltas[at + 2u]);
    }
    return sum;
}

mat4 skin(uint vertex) {
    if (part.skinned == 0u) return mat4(1.0);
    const uvec4 packed = influences[part.first_influence + vertex];
    const vec4 share = vec4(unpackUnorm2x16(packed.z), unpackUnorm2x16(packed.w));
    return share.x * joints[packed.x & 65535u] + share.y * joints[packed.x >> 16] + share.z * joints[packed.y & 65535u] +
           share.w * joints[packed.y >> 16];
}

vec3 place(uint vertex, mat4 m) {
    const uint at = 3u * (part.first_vertex + vertex);
    const vec3 rest = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    return (m * vec4(rest + morph(vertex, 0u), 1.0)).xyz;
}

vec3 unit(vec3 v, vec3 otherwise) {
    const float d2 = dot(v, v);
    return d2 > 0.0 ? v * inversesqrt(d2) : otherwise;
}

void main() {
    const uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= part.vertices) return;
    const mat4 m = skin(vertex);
    const vec3 moved = place(vertex, m);
    const uint at = part.positions + 3u * vertex;
    deformed[at] = floatBitsToUint(moved.x);
    deformed[at + 1u] = floatBitsToUint(moved.y);
    deformed[at + 2u] = floatBitsToUint(moved.z);

    const uint from = attribute_words * (part.first_vertex + vertex);
    const vec3 rest = vec3(unpackSnorm2x16(attributes[from]), unpackSnorm2x16(attributes[from + 1u]).x);
    const vec4 tangent = vec4(unpackSnorm2x16(attributes[from + 2u]), unpackSnorm2x16(attributes[from + 3u]));
    // Transform normals by the cofactor matrix, so that they follow the triangles' winding as in scene.vert.
    const mat3 a = mat3(m);
    const mat3 cofactors = mat3(cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1]));
    const float side = dot(a[0], cofactors[0]) < 0.0 ? -1.0 : 1.0;
    vec3 normal = unit(cofactors * (rest + morph(vertex, 1u)), rest);
    if (part.own_normals == 0u) {
        const uint first = vertex - vertex % 3u;
        const vec3 p = place(first, skin(first)), q = place(first + 1u, skin(first + 1u)), r = place(first + 2u, skin(first + 2u));
        normal = unit(cross(q - p, r - p), rest);
    }
    const vec3 along = unit(a * (tangent.xyz + morph(vertex, 2u)), tangent.xyz);
    const uint to = part.attributes + attribute_words * vertex;
    deformed[to] = packSnorm2x16(normal.xy);
    deformed[to + 1u] = packSnorm2x16(vec2(normal.z, 0.0));
    deformed[to + 2u] = packSnorm2x16(along.xy);
    deformed[to + 3u] = packSnorm2x16(vec2(along.z, side * tangent.w));
    for (uint word = 4u; word < attribute_words; ++word) deformed[to + word] = attributes[from + word];
}
