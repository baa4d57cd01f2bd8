#version 460
// Flat triangles over a picture, in pixels from the upper left corner.

layout(location = 0) in vec2 at;
layout(location = 1) in vec2 uv_in;
layout(location = 2) in vec4 srgb;

layout(push_constant) uniform Push {
    vec2 size;    // of the picture, pixels
    float layer;  // of the texture
    float kind;   // 1: the texture is coverage, 0: colours
};

layout(location = 0) out vec3 uv;
layout(location = 1) out vec4 color;
layout(location = 2) flat out float coverage;

// IEC 61966-2-1.
vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

void main() {
    gl_Position = vec4(at / size * 2.0 - 1.0, 0.0, 1.0);
    uv = vec3(uv_in, layer);
    color = vec4(srgb_to_linear(srgb.rgb) * srgb.a, srgb.a);
    coverage = kind;
}
