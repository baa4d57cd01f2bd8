#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Draws and shades a part in one step: blended parts, and those that the geometry buffer cannot store.
#include "shaders/frame.glsl"
#include "shaders/lighting.glsl"
#include "shaders/material.glsl"
#include "shaders/cut.glsl"

layout(location = 0) out vec4 color_out;

// Applies the maps of specular strength and colour, anisotropy and coat.
void set_mapped_layers(inout Surface s, Material m) {
    if (has(SCENE_SPECULAR_MAPS)) {
        const float weight = m.specular_color.w * look_up(specular_map, m, 9u).a;
        s.f0 = min(m.f0 * m.specular_color.rgb * look_up(specular_color_map, m, 10u).rgb, vec3(1.0)) * weight;
        s.f90 = weight;
    }
    if (has(SCENE_ANISOTROPY_MAP) && has(SCENE_TANGENTS)) {
        const vec4 grain = mapped_grain(m, s.normal);
        s.tangent = grain.xyz;
        s.alpha.x = mix(s.alpha.y, 1.0, grain.w * grain.w);
    }
    if (has(SCENE_COAT_MAPS)) {
        s.coat *= look_up(coat_map, m, 5u).r;
        s.coat_roughness *= look_up(coat_roughness_map, m, 6u).g;
        s.coat_alpha = max(s.coat_roughness * s.coat_roughness, 1e-3);
    }
    if (has(SCENE_COAT_NORMAL_MAP)) {
        s.coat_normal = mapped_coat_normal(m, s.coat_normal);
        const float facing = dot(s.coat_normal, s.out_dir);
        if (facing < 0.0) s.coat_normal = normalize(s.coat_normal - facing * s.out_dir);
    }
}

void main() {
    lit_frame = load_lit_frame();
    const Material m = materials[material_index];
    const vec4 base = base_color(m);
    if (has(SCENE_MASK) && base.a < m.emissive.w) discard;

    Surface s;
    s.position = at;
    s.out_dir = normalize(lit_frame.eye - at);
    s.coat_normal = plain_normal();
    vec3 n = mapped_normal(m, s.coat_normal);
    // A normal that points away from the eye is bent until it is perpendicular to the view, because visible
    // surfaces face the eye.
    const float facing = dot(n, s.out_dir);
    if (facing < 0.0) n = normalize(n - facing * s.out_dir);
    s.normal = n;
    s.tangent = has(SCENE_ANISOTROPY) && has(SCENE_TANGENTS) ? grain_of(m, n) : vec3(1.0, 0.0, 0.0);
    s.base_color = base.rgb;
    const vec3 mro = metallic_roughness_occlusion(m);
    s.metallic = mro.x;
    s.roughness = mro.y;
    s.occlusion = mro.z;
    s.emission = m.emissive.rgb;
    if (has(SCENE_EMISSIVE_MAP)) s.emission *= look_up(emissive_map, m, 4u).rgb;
    finish_surface(s, m);
    set_mapped_layers(s, m);

    vec3 color = shade(s, gl_FragCoord.xy * lit_frame.texel);
    float opacity = has(SCENE_BLEND) ? base.a : 1.0;
    if (has(SCENE_TINTED)) {
        if (opacity_unlit.y > 0.5) color = base.rgb;
        opacity *= opacity_unlit.x;
    }
    if (has(SCENE_CUT)) {
        const float gone = cut_fade(at);
        if (has(SCENE_CUT_FADING) && gone == 0.0) discard;
        opacity *= 1.0 - gone;
    }
    color_out = vec4(color, 1.0) * opacity;
}
