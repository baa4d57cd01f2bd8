#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Writes the geometry buffer: normal, material and grain, and the values of maps and colours if a part has them.
#include "shaders/frame.glsl"
#include "shaders/material.glsl"
#include "shaders/surface.glsl"
#include "shaders/cut.glsl"

layout(location = 0) out vec4 surface_out;     // normal, material, grain
layout(location = 1) out vec4 wide_color_out;  // base colour, metallic
layout(location = 2) out vec4 wide_rough_out;  // roughness, occlusion

void main() {
    if (has(SCENE_CUT) && faded(at) > 0.0) discard;  // scene.frag draws the rest of it
    const Material m = materials[material_index];
    const bool wide = has(SCENE_WIDE);
    if (wide || has(SCENE_MASK)) {
        const vec4 base = base_color(m);
        if (has(SCENE_MASK) && base.a < m.emissive.w) discard;
        const vec3 mro = metallic_roughness_occlusion(m);
        wide_color_out = vec4(base.rgb, mro.x);
        wide_rough_out = vec4(mro.y, mro.z, 0.0, 0.0);
    } else {
        wide_color_out = wide_rough_out = vec4(0.0);
    }
    const vec3 n = mapped_normal(m, plain_normal());
    const float grain = has(SCENE_ANISOTROPY) && has(SCENE_TANGENTS) ? pack_grain(n, grain_of(m, n)) : SURFACE_NO_GRAIN;
    surface_out = vec4(pack_normal(n), float(material_index | (wide ? SURFACE_WIDE : 0u)) / 65535.0, grain);
}
