// Computes the radiance that a surface sends to the eye, from image-based light and all lights, tone-mapped.
// Features that a pipeline does not need are compiled out (SCENE_… bits).
#include "shaders/environment.glsl"
#include "shaders/brdf.glsl"
#include "shaders/tone.glsl"

layout(set = 0, binding = 3) uniform sampler2D albedo_table;
layout(set = 0, binding = 4) uniform samplerCube specular_levels;
layout(set = 0, binding = 5) uniform sampler2DShadow shadow_map;
layout(set = 0, binding = 6) uniform sampler2DArray ambient_occlusion;

// Returns the fraction of light 0 that reaches a point: the mean of four comparisons, each filtered by the
// sampler. The point is offset along the normal by slightly more than a texel plus the error of its level of
// detail, to avoid self-shadowing.
float shadow_visibility(vec3 at, vec3 normal) {
    const vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
    const float width = 2.0 * texel.x / length(lit_frame.shadow[0].xyz);
    const float off = lit_frame.level_error_per_metre * dot(lit_frame.w_row, vec4(at, 1.0));
    const vec4 from = vec4(at + (1.5 * width + off) * normal, 1.0);
    const vec2 place = vec2(dot(lit_frame.shadow[0], from), dot(lit_frame.shadow[1], from));
    const vec3 p = vec3(place * 0.5 + 0.5, dot(lit_frame.shadow[2], from));
    const vec2 step = 0.75 * texel;
    const float sum = textureLod(shadow_map, vec3(p.xy + vec2(-step.x, -step.y), p.z), 0.0) +
                      textureLod(shadow_map, vec3(p.xy + vec2(step.x, -step.y), p.z), 0.0) +
                      textureLod(shadow_map, vec3(p.xy + vec2(-step.x, step.y), p.z), 0.0) +
                      textureLod(shadow_map, vec3(p.xy + vec2(step.x, step.y), p.z), 0.0);
    const bool outside = any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)));
    return outside ? 1.0 : 0.25 * sum;
}

// Returns the irradiance from a light; `l`: the direction towards it.
vec3 irradiance_from(Light light, vec3 at, out vec3 l) {
    const vec3 to_light = light.position.w == 0.0 ? -light.direction.xyz : light.position.xyz - at;
    const float d2 = dot(to_light, to_light);
    l = to_light * inversesqrt(d2);
    const float x = light.direction.w > 0.0 ? d2 / (light.direction.w * light.direction.w) : 0.0;
    const float near = clamp(1.0 - x * x, 0.0, 1.0) / max(d2, 1e-6);
    const float cone = clamp(dot(light.direction.xyz, -l) * light.cone.x + light.cone.y, 0.0, 1.0);
    const float fade = (light.position.w == 0.0 ? 1.0 : near) * (light.position.w == 2.0 ? cone * cone : 1.0);
    return light.color.rgb * fade;
}

// Returns the visibility for diffuse light. It exceeds `ao`, because neighbours that occlude also reflect
// light; they are assumed to have the same albedo (Jimenez et al. 2016, as in occlusion.glsl).
vec3 multi_bounce_visibility(float ao, vec3 albedo) {
    const vec3 a = 2.0404 * albedo - 0.3324, b = -4.7951 * albedo + 0.6417, c = 2.7552 * albedo + 0.6903;
    return max(vec3(ao), ((ao * a + b) * ao + c) * ao);
}

// Returns the visibility for specular light, derived from ambient occlusion (S. Lagarde and C. de Rousiers,
// Moving Frostbite to PBR, 2014).
float specular_visibility(float nv, float ao, float roughness) {
    return clamp(pow(nv + ao, exp2(-16.0 * roughness - 1.0)) - 1.0 + ao, 0.0, 1.0);
}

// Derives the alphas from roughness and anisotropy, and sets reflectances and coat from the material.
void finish_surface(inout Surface s, Material m) {
    const float alpha = max(s.roughness * s.roughness, 1e-3);
    s.alpha = vec2(alpha);
    s.brushed = has(SCENE_ANISOTROPY) && has(SCENE_TANGENTS);
    if (s.brushed) s.alpha.x = mix(alpha, 1.0, m.anisotropy * m.anisotropy);
    s.f0 = min(m.f0 * m.specular_color.rgb, vec3(1.0)) * m.specular_color.w;
    s.f90 = m.specular_color.w;
    s.coated = has(SCENE_COAT);
    s.coat = m.coat;
    s.coat_roughness = m.coat_roughness;
    s.coat_alpha = max(m.coat_roughness * m.coat_roughness, 1e-3);
}

const uint light_count = (features >> SCENE_LIGHTS_SHIFT) & 15u;

vec3 from_light(Light lamp, Surface s, ViewAlbedo albedo, float shadow) {
    vec3 l;
    const vec3 light = irradiance_from(lamp, s.position, l);
    return shadow * light * reflect_light(s, albedo, l);
}

vec3 shade(Surface s, vec2 screen) {
    const ViewAlbedo albedo = view_albedo(s, albedo_table);
    float ao = s.occlusion;
    if (has(SCENE_OCCLUSION)) ao = min(ao, textureLod(ambient_occlusion, vec3(screen, view_index), 0.0).r);
    const bool occluded = has(SCENE_OCCLUSION) || has(SCENE_OCCLUSION_MAP);
    vec3 diffuse = albedo.diffuse * diffuse_light(s.normal);
    vec3 specular = albedo.specular * specular_light(specular_levels, reflect(-s.out_dir, s.normal), s.roughness);
    if (occluded) {
        const float nv = clamp(dot(s.normal, s.out_dir), 0.0, 1.0);
        diffuse *= multi_bounce_visibility(ao, albedo.diffuse);
        specular *= specular_visibility(nv, ao, s.roughness);
    }
    vec3 color = s.emission + albedo.below_coat * (diffuse + specular);
    if (s.coated) {
        vec3 coat = albedo.coat * specular_light(specular_levels, reflect(-s.out_dir, s.coat_normal), s.coat_roughness);
        if (occluded) coat *= specular_visibility(clamp(dot(s.coat_normal, s.out_dir), 0.0, 1.0), ao, s.coat_roughness);
        color += coat;
    }
    if (light_count > 0u)
        color += from_light(lit_frame.light_0, s, albedo,
                            has(SCENE_SHADOW) ? shadow_visibility(s.position, s.coat_normal) : 1.0);
    if (light_count > 1u) color += from_light(lit_frame.light_1, s, albedo, 1.0);
    // Unrolled by hand: lavapipe does not unroll loops and would execute the whole body for every light.
    if (light_count > 2u) color += from_light(frame.lights[2], s, albedo, 1.0);
    if (light_count > 3u) color += from_light(frame.lights[3], s, albedo, 1.0);
    if (light_count > 4u) color += from_light(frame.lights[4], s, albedo, 1.0);
    if (light_count > 5u) color += from_light(frame.lights[5], s, albedo, 1.0);
    if (light_count > 6u) color += from_light(frame.lights[6], s, albedo, 1.0);
    if (light_count > 7u) color += from_light(frame.lights[7], s, albedo, 1.0);
    return pbr_neutral(color * lit_frame.environment.w);
}
