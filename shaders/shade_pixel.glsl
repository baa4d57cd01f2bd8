// Shades the geometry buffer. Samples of a pixel on one surface are shaded once; where an edge crosses the
// pixel, each side is shaded separately. The colour is the mean of the four samples.
#include "shaders/frame.glsl"
#include "shaders/lighting.glsl"
#include "shaders/surface.glsl"
#include "shaders/sky.glsl"

layout(set = 0, binding = 7) uniform sampler2DMSArray depths;
layout(set = 0, binding = 8) uniform sampler2DMSArray surfaces;
layout(set = 0, binding = 9) uniform sampler2DMSArray material_colors;
layout(set = 0, binding = 10) uniform sampler2DMSArray material_roughness;

// Vulkan's standard sample locations, relative to the pixel's corner.
const vec2 places[4] = vec2[](vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875));
const float max_normal_difference = 0.03;  // between packed normals of one surface: 4 to 8 degrees

vec3 world_at(vec2 pixel, float depth) {
    const vec2 ndc = pixel * lit_frame.texel * 2.0 - 1.0;
    const vec4 p = lit_frame.world_from_clip * vec4(ndc, depth, 1.0);
    return p.xyz / p.w;
}

// Returns colour and alpha of a pixel of the view `pixel.z`. Set lit_frame before.
vec4 shade_pixel(ivec3 pixel) {
    const vec2 corner = vec2(pixel.xy), middle = corner + 0.5;
    vec4 color;
    float depth[4];
    vec4 packed[4];
    uint unshaded = 0u;  // samples that are not shaded yet
    uint hidden = 0u;
    for (int i = 0; i < 4; ++i) {
        depth[i] = texelFetch(depths, pixel, i).r;
        packed[i] = texelFetch(surfaces, pixel, i);
        unshaded |= depth[i] > 0.0 ? 1u << i : 0u;
        hidden |= depth[i] >= 1.0 ? 1u << i : 0u;
    }
    const float background_samples = 4.0 - float(bitCount(unshaded));
    const float alpha = has(SCENE_TRANSPARENT) ? 1.0 - 0.25 * background_samples : 1.0;
    if (has(SCENE_HIDDEN_AREA)) unshaded &= ~hidden;
    vec3 sum = vec3(0.0);
    if (background_samples > 0.0 && !has(SCENE_TRANSPARENT)) sum = background_samples * background_color(middle);
    // The loop's test is at its end: lavapipe runs a loop until none of eight pixels needs another iteration,
    // and a test at the top costs one extra iteration. Every exit must set `color`: lavapipe would take a value
    // that is set only in the body from the last iteration of all eight pixels, not from that of this pixel.
    for (;;) {
        if (unshaded == 0u) {
            color = vec4(0.25 * sum, alpha);
            break;
        }
        int first = 3;
        vec4 one = packed[3];
        float d0 = depth[3];
        for (int i = 2; i >= 0; --i)
            if ((unshaded & (1u << i)) != 0u) {
                first = i;
                one = packed[i];
                d0 = depth[i];
            }
        // The surface point at the centre of the samples that show it.
        uint group = 0u;
        vec2 facing_packed = vec2(0.0);
        vec2 place = vec2(0.0);
        float d = 0.0;
        for (int i = 0; i < 4; ++i) {
            const bool same = (unshaded & (1u << i)) != 0u && packed[i].z == one.z &&
                              all(lessThan(abs(packed[i].xy - one.xy), vec2(max_normal_difference))) &&
                              abs(depth[i] - d0) < 0.02 * d0;
            if (i != first && !same) continue;
            group |= 1u << i;
            facing_packed += packed[i].xy;
            place += places[i];
            d += depth[i];
        }
        const float share = float(bitCount(group));
        unshaded &= ~group;

        const uint id = uint(one.z * 65535.0 + 0.5);
        const Material m = materials[id & (SURFACE_PER_PIXEL_MATERIAL - 1u)];
        Surface s;
        s.position = world_at(corner + place / share, d / share);
        s.out_dir = normalize(lit_frame.eye - s.position);
        const vec3 n = unpack_normal(facing_packed / share);
        s.coat_normal = n;
        // A normal that points away from the eye is bent until it is perpendicular to the view, because
        // visible surfaces face the eye.
        const float facing = dot(n, s.out_dir);
        s.normal = facing < 0.0 ? normalize(n - facing * s.out_dir) : n;
        s.tangent = has(SCENE_ANISOTROPY) ? unpack_grain(n, one.w) : vec3(1.0, 0.0, 0.0);
        s.base_color = m.base_color.rgb;
        s.metallic = m.metallic;
        s.roughness = m.roughness;
        s.occlusion = 1.0;
        s.emission = m.emissive.rgb;
        if (has(SCENE_PER_PIXEL_MATERIAL) && (id & SURFACE_PER_PIXEL_MATERIAL) != 0u) {
            const vec4 color = texelFetch(material_colors, pixel, first);
            const vec4 rough = texelFetch(material_roughness, pixel, first);
            s.base_color = color.rgb;
            s.metallic = color.a;
            s.roughness = rough.x;
            s.occlusion = rough.y;
        }
        finish_surface(s, m);
        if (one.w == SURFACE_NO_GRAIN) s.alpha.x = s.alpha.y;
        sum += share * shade(s, middle * lit_frame.texel);
        if (unshaded == 0u) {
            color = vec4(0.25 * sum, alpha);
            break;
        }
    }
    return color;
}
