#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Covers areas that the user never sees at the nearest depth, so that nothing is drawn there.
#include "shaders/features.glsl"
#include "shaders/shared.h"

layout(location = 0) in vec3 corner;  // z: the view

void main() {
    // Triangles of other views have no area. They are not outside of the picture, because lavapipe of Mesa 22.3
    // draws what it clips into the wrong layer.
    gl_Position = int(corner.z) == view_index ? vec4(corner.xy, 1.0, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
