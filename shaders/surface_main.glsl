// Writes the geometry buffer: normal, material and grain. With MATERIAL_OUTPUTS, values that are not the
// material's constants (maps, vertex colours, tints) go to the material buffer. A shader must not write to
// targets that a frame does not have.
#include "shaders/frame.glsl"
#include "shaders/material.glsl"
#include "shaders/surface.glsl"
#include "shaders/cut.glsl"

layout(location = 0) out vec4 surface_out;     // normal, material, grain
#ifdef MATERIAL_OUTPUTS
layout(location = 1) out vec4 material_color_out;      // base colour, metallic
layout(location = 2) out vec4 material_roughness_out;  // roughness, occlusion
#endif

void main() {
    if (has(SCENE_CUT) && cut_fade(at) > 0.0) discard;  // scene.frag draws this fading region
    const Material m = materials[material_index];
    const bool per_pixel = has(SCENE_PER_PIXEL_MATERIAL);
    if (per_pixel || has(SCENE_MASK)) {
        const vec4 base = base_color(m);
        if (has(SCENE_MASK) && base.a < m.emissive.w) discard;
#ifdef MATERIAL_OUTPUTS
        const vec3 mro = metallic_roughness_occlusion(m);
        material_color_out = vec4(base.rgb, mro.x);
        material_roughness_out = vec4(mro.y, mro.z, 0.0, 0.0);
#endif
    }
    const vec3 n = mapped_normal(m, plain_normal());
    const float grain = has(SCENE_ANISOTROPY) && has(SCENE_TANGENTS) ? pack_grain(n, grain_of(m, n)) : SURFACE_NO_GRAIN;
    const uint id = material_index | (per_pixel ? SURFACE_PER_PIXEL_MATERIAL : 0u);
    surface_out = vec4(pack_normal(n), float(id) / 65535.0, grain);
}
