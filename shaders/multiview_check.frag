#version 460
#extension GL_EXT_multiview : require

layout(location = 0) out float value;

// A different value in each view.
void main() { value = gl_ViewIndex == 0 ? 1.0 : 0.5; }
