// A quad that ends at the picture's edges, instead of a triangle that extends beyond them: with several
// views, some drivers draw clipped triangles into the layer of the previous view (multiview_works).
const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(-1, 1), vec2(1, -1), vec2(1, 1));

vec4 corner(int vertex) { return vec4(corners[vertex], 0.0, 1.0); }
