#version 460
// Writes the premultiplied colour of the outline.
layout(location = 0) flat in vec4 outline;
layout(location = 0) out vec4 color_out;

void main() { color_out = vec4(outline.rgb * outline.a, outline.a); }
