#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
#include "shaders/frame.glsl"
#include "shaders/environment.glsl"
#include "shaders/brdf.glsl"
#include "shaders/tone.glsl"

layout(constant_id = 0) const uint bits = 0u;

layout(set = 0, binding = 3) uniform sampler2D albedo_table;
layout(set = 0, binding = 4) uniform samplerCube specular_levels;
layout(set = 0, binding = 5) uniform sampler2DShadow shadow_map;
layout(set = 0, binding = 6) uniform sampler2DArray ambient_occlusion;
layout(set = 1, binding = 0) uniform sampler2D base_map;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_map;
layout(set = 1, binding = 2) uniform sampler2D normal_map;
layout(set = 1, binding = 3) uniform sampler2D occlusion_map;
layout(set = 1, binding = 4) uniform sampler2D emissive_map;

layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec4 tangent_in;
layout(location = 3) in vec2 texcoord;
layout(location = 4) in vec4 color_in;
layout(location = 5) flat in uint instance_in;

layout(location = 0) out vec4 color_out;

vec2 uv(Material m, uint texture_index) {
    const vec3 t = vec3(texcoord, 1.0);
    return vec2(dot(m.uv[2 * texture_index].xyz, t), dot(m.uv[2 * texture_index + 1].xyz, t));
}

// The plane of a normal map where the mesh has no tangents: from how position and texture change over the picture
// (C. Schüler, Normal Mapping Without Precomputed Tangents, ShaderX5, 2006).
mat3 cotangent_frame(vec3 n, vec2 t) {
    const vec3 px = dFdx(at), py = dFdy(at);
    const vec2 tx = dFdx(t), ty = dFdy(t);
    const vec3 a = cross(py, n), b = cross(n, px);
    const vec3 tangent = a * tx.x + b * ty.x, bitangent = a * tx.y + b * ty.y;
    const float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    const float scale = longest > 0.0 ? inversesqrt(longest) : 0.0;
    return mat3(tangent * scale, bitangent * scale, n);
}

// The shadow of light 0: four comparisons, each filtered by the sampler. Points are moved off their surface along the normal
// by a little more than a texel, so that it does not shade itself.
float lit(vec3 normal) {
    const vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
    const mat4 m = frame.shadow_from_world;
    const float width = 2.0 * texel.x / length(vec3(m[0].x, m[1].x, m[2].x));
    const vec4 place = m * vec4(at + 1.5 * width * normal, 1.0);
    const vec3 p = vec3(place.xy * 0.5 + 0.5, place.z);
    const vec2 step = 0.75 * texel;
    const float sum = texture(shadow_map, vec3(p.xy + vec2(-step.x, -step.y), p.z)) +
                      texture(shadow_map, vec3(p.xy + vec2(step.x, -step.y), p.z)) +
                      texture(shadow_map, vec3(p.xy + vec2(-step.x, step.y), p.z)) +
                      texture(shadow_map, vec3(p.xy + vec2(step.x, step.y), p.z));
    const bool outside = any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)));
    return frame.shadows == 0u || outside ? 1.0 : 0.25 * sum;
}

// What arrives of a light, and from where.
vec3 arriving(Light light, out vec3 l) {
    const vec3 way = light.position.w == 0.0 ? -light.direction.xyz : light.position.xyz - at;
    const float d2 = dot(way, way);
    l = way * inversesqrt(d2);
    const float x = light.direction.w > 0.0 ? d2 / (light.direction.w * light.direction.w) : 0.0;
    const float near = clamp(1.0 - x * x, 0.0, 1.0) / max(d2, 1e-6);
    const float cone = clamp(dot(light.direction.xyz, -l) * light.cone.x + light.cone.y, 0.0, 1.0);
    const float fade = (light.position.w == 0.0 ? 1.0 : near) * (light.position.w == 2.0 ? cone * cone : 1.0);
    return light.color.rgb * fade;
}

// What is kept away comes back in part from the neighbours that keep it away, the more the brighter they are; they are taken to
// be as bright as the surface itself (Jimenez et al. 2016, as in occlusion.frag).
vec3 returned(float ao, vec3 albedo) {
    const vec3 a = 2.0404 * albedo - 0.3324, b = -4.7951 * albedo + 0.6417, c = 2.7552 * albedo + 0.6903;
    return max(vec3(ao), ((ao * a + b) * ao + c) * ao);
}

// Specular occlusion from the ambient one (S. Lagarde and C. de Rousiers, Moving Frostbite to PBR, 2014).
float mirrored_share(float nv, float ao, float roughness) {
    return clamp(pow(nv + ao, exp2(-16.0 * roughness - 1.0)) - 1.0 + ao, 0.0, 1.0);
}

void main() {
    const Instance instance = instances[instance_in];
    const Material m = materials[instance.material];
    const bool textured = (bits & SCENE_TEXTURED) != 0u;
    const View view = frame.views[gl_ViewIndex];

    vec4 base = m.base_color;
    if ((bits & SCENE_VERTEX_COLORS) != 0u) base *= color_in;
    if (textured && (m.textures & TEXTURE_BASE) != 0u) base *= texture(base_map, uv(m, 0u));
    if (m.emissive.w >= 0.0 && base.a < m.emissive.w) discard;
    base.rgb = mix(base.rgb, instance.tint.rgb, instance.tint.w);

    Surface s;
    s.position = at;
    s.out_dir = normalize(view.eye.xyz - at);
    vec3 n = normalize(normal_in);
    if (!gl_FrontFacing) n = -n;
    s.coat_normal = n;
    s.tangent = tangent_in.xyz;
    if (textured && (m.textures & TEXTURE_NORMAL) != 0u) {
        const vec2 t = uv(m, 2u);
        vec3 bump = texture(normal_map, t).xyz * 2.0 - 1.0;
        bump.xy *= m.normal_scale;
        const vec3 given = normalize(tangent_in.xyz - n * dot(n, tangent_in.xyz));
        const mat3 plane = dot(tangent_in.xyz, tangent_in.xyz) > 0.0 ? mat3(given, cross(n, given) * tangent_in.w, n)
                                                                     : cotangent_frame(n, t);
        n = normalize(plane * bump);
    }
    // A normal that looks away from the eye is bent back to the rim: what is seen faces the eye.
    const float facing = dot(n, s.out_dir);
    if (facing < 0.0) n = normalize(n - facing * s.out_dir);
    s.normal = n;
    s.base_color = base.rgb;
    s.metallic = m.metallic;
    float roughness = m.roughness;
    s.occlusion = 1.0;
    s.emission = m.emissive.rgb;
    if (textured) {
        if ((m.textures & TEXTURE_METALLIC_ROUGHNESS) != 0u) {
            const vec4 texel = texture(metallic_roughness_map, uv(m, 1u));
            roughness *= texel.g;
            s.metallic *= texel.b;
        }
        if ((m.textures & TEXTURE_OCCLUSION) != 0u)
            s.occlusion = 1.0 + m.occlusion_strength * (texture(occlusion_map, uv(m, 3u)).r - 1.0);
        if ((m.textures & TEXTURE_EMISSIVE) != 0u) s.emission *= texture(emissive_map, uv(m, 4u)).rgb;
    }
    const float alpha = max(roughness * roughness, 1e-3);
    s.alpha = vec2(alpha);
    if (m.anisotropy > 0.0 && dot(tangent_in.xyz, tangent_in.xyz) > 0.0) {
        const vec3 t = normalize(s.tangent - n * dot(n, s.tangent));
        const vec3 b = cross(n, t) * tangent_in.w;
        s.tangent = cos(m.anisotropy_rotation) * t + sin(m.anisotropy_rotation) * b;
        s.alpha.x = mix(alpha, 1.0, m.anisotropy * m.anisotropy);
    }
    s.f0 = min(m.f0 * m.specular_color.rgb, vec3(1.0)) * m.specular_color.w;
    s.f90 = m.specular_color.w;
    s.coat = m.coat;
    s.coat_alpha = max(m.coat_roughness * m.coat_roughness, 1e-3);

    const Seen seen = see(s, albedo_table);
    const vec2 screen = gl_FragCoord.xy * frame.picture.zw;
    const float ao = min(s.occlusion, textureLod(ambient_occlusion, vec3(screen, gl_ViewIndex), 0.0).r);
    const float nv = clamp(dot(n, s.out_dir), 0.0, 1.0);
    vec3 color = s.emission;
    color += seen.below_coat * (seen.diffuse * diffuse_light(n) * returned(ao, seen.diffuse) +
                                seen.specular * specular_light(specular_levels, reflect(-s.out_dir, n), roughness) * mirrored_share(nv, ao, roughness));
    if (s.coat > 0.0)
        color += seen.coat * specular_light(specular_levels, reflect(-s.out_dir, s.coat_normal), m.coat_roughness) * mirrored_share(nv, ao, m.coat_roughness);
    for (uint i = 0u; i < frame.light_count; ++i) {
        vec3 l;
        vec3 light = arriving(frame.lights[i], l);
        if (i == 0u) light *= lit(s.coat_normal);
        color += light * reflect_light(s, seen, l);
    }
    color = pbr_neutral(color * frame.environment.w);
    if ((instance.flags & INSTANCE_FLAT) != 0u) color = base.rgb;
    const float opacity = (m.emissive.w < -1.5 ? base.a : 1.0) * instance.opacity;
    color_out = vec4(color, 1.0) * opacity;
}
