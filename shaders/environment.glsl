// Image-based light: specular levels in a cube map, diffuse light in spherical harmonics.
#include "shaders/lit_frame.glsl"

LitFrame here;  // main() sets it before it calls any function

vec3 turned(vec3 d) {
    const float c = cos(here.environment.y), s = sin(here.environment.y);
    return vec3(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

vec3 diffuse_light(vec3 normal) {
    const vec3 n = turned(normal);
    const vec3 sum = here.diffuse[0] + here.diffuse[1] * n.y + here.diffuse[2] * n.z +
                     here.diffuse[3] * n.x + here.diffuse[4] * (n.x * n.y) + here.diffuse[5] * (n.y * n.z) +
                     here.diffuse[6] * (3.0 * n.z * n.z - 1.0) + here.diffuse[7] * (n.x * n.z) +
                     here.diffuse[8] * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0)) * here.environment.x;
}

vec3 specular_light(samplerCube levels, vec3 direction, float roughness) {
    return textureLod(levels, turned(direction), roughness * here.environment.z).rgb * here.environment.x;
}
