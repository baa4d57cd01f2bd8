// The encoding of a surface in the geometry buffer: four values of 16 bits, two for the normal, one for the
// material, and one for the grain (the brushing direction of a metal).
//   Z. Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014 (octahedral
//   normals).
//   T. Duff et al., Building an Orthonormal Basis, Revisited, 2017.
// The highest bit of the material value is set if the material buffer has base colour, metallic, roughness and
// occlusion. The 15 bits below hold the material's index (max_materials in engine/render/draw_list.hpp).
#define SURFACE_PER_PIXEL_MATERIAL 32768u

vec2 pack_normal(vec3 n) {
    const vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    const vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return (n.z < 0.0 ? folded : p) * 0.5 + 0.5;
}

vec3 unpack_normal(vec2 packed) {
    const vec2 p = packed * 2.0 - 1.0;
    const float z = 1.0 - abs(p.x) - abs(p.y);
    const float t = max(-z, 0.0);
    return normalize(vec3(p.x + (p.x >= 0.0 ? -t : t), p.y + (p.y >= 0.0 ? -t : t), z));
}

// Two directions perpendicular to a normal.
void basis(vec3 n, out vec3 t, out vec3 b) {
    const float side = n.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (side + n.z), c = n.x * n.y * a;
    t = vec3(1.0 + side * n.x * n.x * a, side * c, -side * n.x);
    b = vec3(c, side + n.y * n.y * a, -n.y);
}

#define SURFACE_NO_GRAIN 1.0

// The grain has no sign, so half a turn covers all directions.
float pack_grain(vec3 n, vec3 grain) {
    vec3 t, b;
    basis(n, t, b);
    return fract(atan(dot(grain, b), dot(grain, t)) / 3.14159265358979 + 1.0) * (65534.0 / 65535.0);
}

vec3 unpack_grain(vec3 n, float packed) {
    vec3 t, b;
    basis(n, t, b);
    const float angle = packed * 3.14159265358979;
    return cos(angle) * t + sin(angle) * b;
}
