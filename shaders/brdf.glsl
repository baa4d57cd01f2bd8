// The lighting model of the path-traced reference (tools/verify/pathtrace/bsdf.hpp names the sources), for
// directional and image-based light. c: strength of the coat; m: metallic; E: directional albedo.
//   f = base (1 − c E_coat) + c coat
//   base = (1 − m)(diffuse + specular(F0 dielectric)) + m specular(F0 = base colour)
//   specular = D V F (1 + F0 (1/E − 1)),  diffuse = base colour / π (1 − E_F)
const float pi = 3.14159265358979;

struct Surface {
    vec3 position, normal, coat_normal, tangent, out_dir;
    vec3 base_color;
    float metallic, roughness;
    vec2 alpha;  // along tangent and bitangent
    vec3 f0;     // of the dielectric
    float f90;
    float coat, coat_roughness, coat_alpha;
    bool coated, brushed;  // compile-time constants
    float occlusion;
    vec3 emission;
};

float pow5(float x) { return x * x * x * x * x; }

// Trowbridge–Reitz with the Smith height-correlated visibility: D V.
float ggx_shape(vec3 n, vec3 t, vec2 alpha, vec3 v, vec3 l, vec3 h) {
    const vec3 b = cross(n, t);
    const vec3 lh = vec3(dot(t, h), dot(b, h), dot(n, h));
    const vec3 lv = vec3(dot(t, v), dot(b, v), max(dot(n, v), 1e-4));
    const vec3 ll = vec3(dot(t, l), dot(b, l), dot(n, l));
    const vec2 e = lh.xy / alpha;
    const float d = dot(e, e) + lh.z * lh.z;
    const float distribution = 1.0 / (pi * alpha.x * alpha.y * d * d);
    const float gv = length(vec3(alpha * lv.xy, lv.z)), gl = length(vec3(alpha * ll.xy, ll.z));
    return distribution * 0.5 / (ll.z * gv + lv.z * gl);
}

float ggx_shape(vec3 n, float alpha, vec3 v, vec3 l, vec3 h) {
    const float nh = clamp(dot(n, h), 0.0, 1.0), nv = max(dot(n, v), 1e-4), nl = dot(n, l);
    const float a2 = alpha * alpha;
    const float d = nh * nh * (a2 - 1.0) + 1.0;
    const float gv = sqrt(a2 + (1.0 - a2) * nv * nv), gl = sqrt(a2 + (1.0 - a2) * nl * nl);
    return a2 / (pi * d * d) * 0.5 / (nl * gv + nv * gl);
}

// Values from the albedo table for one view direction.
struct ViewAlbedo {
    float gain;              // 1/E − 1
    vec3 specular;           // albedo of the specular layer, for image-based light
    vec3 diffuse;            // albedo
    float coat, below_coat;  // albedo of the coat (times c), and the fraction that it transmits
};

ViewAlbedo view_albedo(Surface s, sampler2D albedo_table) {
    const float nv = clamp(dot(s.normal, s.out_dir), 0.0, 1.0);
    const vec2 size = vec2(textureSize(albedo_table, 0));
    const float roughness = sqrt(length(s.alpha) * 0.70710678);
    const vec2 ab = textureLod(albedo_table, (vec2(sqrt(nv), roughness) * (size - 1.0) + 0.5) / size, 0.0).xy;
    const float gain = 1.0 / (ab.x + ab.y) - 1.0;
    const vec3 dielectric = (s.f0 * ab.x + s.f90 * ab.y) * (1.0 + s.f0 * gain);
    const vec3 metal = (s.base_color * ab.x + ab.y) * (1.0 + s.base_color * gain);
    ViewAlbedo albedo;
    albedo.gain = gain;
    albedo.specular = mix(dielectric, metal, s.metallic);
    const float taken = max(dielectric.x, max(dielectric.y, dielectric.z));
    albedo.diffuse = s.base_color * (1.0 - s.metallic) * max(0.0, 1.0 - taken);
    albedo.coat = 0.0;
    if (s.coated) {
        const float cnv = clamp(dot(s.coat_normal, s.out_dir), 0.0, 1.0);
        const vec2 coat = textureLod(albedo_table, (vec2(sqrt(cnv), sqrt(s.coat_alpha)) * (size - 1.0) + 0.5) / size, 0.0).xy;
        albedo.coat = s.coat * (0.04 * coat.x + coat.y) * (1.0 + 0.04 * (1.0 / (coat.x + coat.y) - 1.0));
    }
    albedo.below_coat = 1.0 - albedo.coat;
    return albedo;
}

// Returns the radiance that the surface reflects to the eye from a light in direction `l`, including the
// cosine. The light has unit irradiance on a surface that faces it.
vec3 reflect_light(Surface s, ViewAlbedo albedo, vec3 l) {
    const vec3 h = normalize(s.out_dir + l);
    const float grazing = pow5(1.0 - clamp(dot(s.out_dir, h), 0.0, 1.0));
    vec3 result = vec3(0.0);
    const float nl = dot(s.normal, l);
    if (nl > 0.0) {
        const float gain = albedo.gain;
        const vec3 dielectric = (s.f0 + (vec3(s.f90) - s.f0) * grazing) * (1.0 + s.f0 * gain);
        const vec3 metal = (s.base_color + (1.0 - s.base_color) * grazing) * (1.0 + s.base_color * gain);
        const float shape = s.brushed ? ggx_shape(s.normal, s.tangent, s.alpha, s.out_dir, l, h)
                                      : ggx_shape(s.normal, s.alpha.x, s.out_dir, l, h);
        result = (albedo.diffuse / pi + mix(dielectric, metal, s.metallic) * shape) * (albedo.below_coat * nl);
    }
    const float cnl = dot(s.coat_normal, l);
    if (s.coated && cnl > 0.0)
        result += s.coat * (0.04 + 0.96 * grazing) * ggx_shape(s.coat_normal, s.coat_alpha, s.out_dir, l, h) * cnl;
    return result;
}
