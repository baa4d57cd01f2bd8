// Image-based light: specular levels in a cube map, diffuse light in spherical harmonics.
#include "shaders/lit_frame.glsl"

LitFrame lit_frame;  // main() sets it before it calls any function

// Rotates a direction from world space to the environment's frame.
vec3 to_environment(vec3 d) {
    const float c = cos(lit_frame.environment.y), s = sin(lit_frame.environment.y);
    return vec3(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

vec3 diffuse_light(vec3 normal) {
    const vec3 n = to_environment(normal);
    const vec3 sum = lit_frame.diffuse[0] + lit_frame.diffuse[1] * n.y + lit_frame.diffuse[2] * n.z +
                     lit_frame.diffuse[3] * n.x + lit_frame.diffuse[4] * (n.x * n.y) +
                     lit_frame.diffuse[5] * (n.y * n.z) + lit_frame.diffuse[6] * (3.0 * n.z * n.z - 1.0) +
                     lit_frame.diffuse[7] * (n.x * n.z) + lit_frame.diffuse[8] * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0)) * lit_frame.environment.x;
}

vec3 specular_light(samplerCube levels, vec3 direction, float roughness) {
    const float level = roughness * lit_frame.environment.z;
    return textureLod(levels, to_environment(direction), level).rgb * lit_frame.environment.x;
}
