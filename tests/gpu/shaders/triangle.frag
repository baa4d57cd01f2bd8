#version 460
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 color;
layout(constant_id = 0) const uint bits = 0;
layout(set = 0, binding = 2) uniform sampler2D image[2];
layout(set = 1, binding = 0) readonly buffer Colors { vec4 colors[]; };

void main() {
    color = (bits & 1u) != 0u ? vec4(0.0, 1.0, 0.0, 1.0) : colors[1] + 0.0 * (texture(image[0], at) + texture(image[1], at));
}
