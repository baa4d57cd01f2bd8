#version 460
// Draws an overlay. Colours are premultiplied and linear, so blending adds light as in the scene.

layout(location = 0) in vec3 uv;
layout(location = 1) in vec4 color;
layout(location = 2) flat in float coverage;

layout(set = 0, binding = 0) uniform sampler2DArray picture;
layout(location = 0) out vec4 color_out;

void main() {
    const vec4 texel = texture(picture, uv);
    // Pictures are opaque: ignore their alpha.
    color_out = color * (coverage > 0.5 ? texel.rrrr : vec4(texel.rgb, 1.0));
}
