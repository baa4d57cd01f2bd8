#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Draws the areas that the user never sees, at the nearest depth, so that nothing else is drawn there.
#include "shaders/features.glsl"
#include "shaders/shared.h"

layout(location = 0) in vec3 corner;  // z: the view

void main() {
    // Triangles of other views get no area. They are not moved outside the picture, because lavapipe of Mesa
    // 22.3 draws clipped triangles into the wrong layer.
    gl_Position = int(corner.z) == view_index ? vec4(corner.xy, 1.0, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
