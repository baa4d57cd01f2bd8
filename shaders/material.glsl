// Evaluates a part's material and maps at a point.
layout(set = 1, binding = 0) uniform sampler2D base_map;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_map;
layout(set = 1, binding = 2) uniform sampler2D normal_map;
layout(set = 1, binding = 3) uniform sampler2D occlusion_map;
layout(set = 1, binding = 4) uniform sampler2D emissive_map;
layout(set = 1, binding = 5) uniform sampler2D coat_map;
layout(set = 1, binding = 6) uniform sampler2D coat_roughness_map;
layout(set = 1, binding = 7) uniform sampler2D coat_normal_map;
layout(set = 1, binding = 8) uniform sampler2D anisotropy_map;
layout(set = 1, binding = 9) uniform sampler2D specular_map;
layout(set = 1, binding = 10) uniform sampler2D specular_color_map;

layout(location = 0) in vec3 at;
layout(location = 1) centroid in vec3 normal_in;
layout(location = 2) in vec4 tangent_in;
layout(location = 3) in vec4 texcoord;  // both sets
layout(location = 4) in vec4 color_in;
layout(location = 5) flat in vec4 tint;
layout(location = 6) flat in vec2 opacity_unlit;

layout(push_constant) uniform Draw { uint material_index; };

// `t`: both sets of texture coordinates, or their derivatives; `one`: 1 for coordinates, 0 for derivatives.
vec2 uv(Material m, uint texture_index, vec4 t, float one) {
    const vec4 row = m.uv[2 * texture_index];
    const vec3 p = vec3(has(SCENE_SECOND_UV) && row.w > 0.5 ? t.zw : t.xy, one);
    return vec2(dot(row.xyz, p), dot(m.uv[2 * texture_index + 1].xyz, p));
}

// Computes the mip level from the interpolated coordinates, not from those transformed by the material:
// lavapipe does not read the material for helper pixels outside the triangle, and edges would use the
// coarsest level.
vec4 look_up(sampler2D map, Material m, uint texture_index) {
    return textureGrad(map, uv(m, texture_index, texcoord, 1.0), uv(m, texture_index, dFdx(texcoord), 0.0),
                       uv(m, texture_index, dFdy(texcoord), 0.0));
}

// The tangent frame of a normal map for meshes without tangents, from screen derivatives of position and
// texture coordinates (C. Schüler, Normal Mapping Without Precomputed Tangents, ShaderX5, 2006). `tx`, `ty`:
// the derivatives of the texture coordinates. The bitangent points up in the texture, against v.
mat3 cotangent_frame(vec3 n, vec2 tx, vec2 ty) {
    const vec3 px = dFdx(at), py = dFdy(at);
    const vec3 a = cross(py, n), b = cross(n, px);
    const vec3 tangent = a * tx.x + b * ty.x, bitangent = a * tx.y + b * ty.y;
    const float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    // Rows of the picture go down, so the triangle (at, px, py) has the opposite winding.
    const float scale = longest > 0.0 ? inversesqrt(longest) * sign(dot(px, a)) : 0.0;
    return mat3(tangent * scale, -bitangent * scale, n);
}

vec4 base_color(Material m) {
    vec4 base = m.base_color;
    if (has(SCENE_VERTEX_COLORS)) base *= color_in;
    if (has(SCENE_BASE_MAP)) base *= look_up(base_map, m, 0u);
    if (has(SCENE_TINTED)) base.rgb = mix(base.rgb, tint.rgb, tint.w);
    return base;
}

vec3 plain_normal() {
    const vec3 n = normalize(normal_in);
    return gl_FrontFacing ? n : -n;
}

// Tangent, bitangent and normal at this point.
mat3 tangent_frame(Material m, vec3 n, uint map) {
    if (!has(SCENE_TANGENTS)) return cotangent_frame(n, uv(m, map, dFdx(texcoord), 0.0), uv(m, map, dFdy(texcoord), 0.0));
    const vec3 given = normalize(tangent_in.xyz - n * dot(n, tangent_in.xyz));
    return mat3(given, cross(n, given) * tangent_in.w, n);
}

vec3 mapped_normal(Material m, vec3 n) {
    if (!has(SCENE_NORMAL_MAP)) return n;
    const vec3 bump = look_up(normal_map, m, 2u).xyz * 2.0 - 1.0;
    return normalize(tangent_frame(m, n, 2u) * vec3(bump.xy * m.normal_scale, bump.z));
}

vec3 mapped_coat_normal(Material m, vec3 n) {
    return normalize(tangent_frame(m, n, 7u) * (look_up(coat_normal_map, m, 7u).xyz * 2.0 - 1.0));
}

// Metallic, roughness, occlusion.
vec3 metallic_roughness_occlusion(Material m) {
    vec3 v = vec3(m.metallic, m.roughness, 1.0);
    if (has(SCENE_METALLIC_ROUGHNESS_MAP)) v.xy *= look_up(metallic_roughness_map, m, 1u).bg;
    if (has(SCENE_OCCLUSION_MAP)) v.z += m.occlusion_strength * (look_up(occlusion_map, m, 3u).r - 1.0);
    return v;
}

// The brushing direction of the metal.
vec3 grain_of(Material m, vec3 n) {
    const vec3 t = normalize(tangent_in.xyz - n * dot(n, tangent_in.xyz));
    const vec3 b = cross(n, t) * tangent_in.w;
    return cos(m.anisotropy_rotation) * t + sin(m.anisotropy_rotation) * b;
}

// The same, rotated by a map; w: the strength of the anisotropy.
vec4 mapped_grain(Material m, vec3 n) {
    const vec3 texel = look_up(anisotropy_map, m, 8u).rgb;
    const vec3 t = grain_of(m, n);
    const vec3 b = cross(n, t) * tangent_in.w;
    const vec2 turn = texel.rg * 2.0 - 1.0;
    const vec3 grain = turn.x * t + turn.y * b;
    return vec4(dot(grain, grain) > 0.0 ? normalize(grain) : t, m.anisotropy * texel.b);
}
