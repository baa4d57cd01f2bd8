// A quad that ends at the picture's edges, instead of a triangle that extends beyond them: with several
// views, lavapipe (Mesa 22.3) draws clipped triangles into the layer of the previous view
// (tests/render/multiview.cpp).
const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(-1, 1), vec2(1, -1), vec2(1, 1));

vec4 corner(int vertex) { return vec4(corners[vertex], 0.0, 1.0); }
