#version 460
#extension GL_GOOGLE_include_directive : require
// Shades the geometry buffer, as light.frag does.
#include "shaders/compute.glsl"
#include "shaders/shade_pixel.glsl"

layout(set = 0, binding = 11, rgba8) uniform writeonly image2DArray picture;

// The encoding of the picture, which a storage image does not apply (IEC 61966-2-1).
vec3 srgb(vec3 linear) {
    const vec3 c = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
    const ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(pixel.xy, imageSize(picture).xy))) return;
    lit_frame = load_lit_frame();
    const vec4 color = shade_pixel(pixel);
    imageStore(picture, pixel, vec4(srgb(color.rgb), color.a));
}
