// A rectangle that ends at the picture's edges, not a triangle that reaches beyond: of several views, lavapipe (Mesa 22.3) draws
// what it must clip into the layer of the view before (tests/render/multiview.cpp).
const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(-1, 1), vec2(1, -1), vec2(1, 1));

vec4 corner(int vertex) { return vec4(corners[vertex], 0.0, 1.0); }
