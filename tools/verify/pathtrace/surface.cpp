// What the scene is like at a hit: the material with its textures, the frames, where rays leave.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tools/verify/pathtrace/scene.hpp"

namespace bolt::pathtrace {

namespace {

using assets::Material;
using assets::TextureRef;

glm::vec3 any_perpendicular(const glm::vec3& n) {
    const glm::vec3 axis = std::abs(n.x) < 0.7F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(axis, n));
}

glm::mat3 make_frame(const glm::vec3& normal, const glm::vec3& tangent, float handedness) {
    glm::vec3 t = tangent - glm::dot(tangent, normal) * normal;
    const float length = glm::length(t);
    t = length > 1e-12F ? t / length : any_perpendicular(normal);
    return {t, glm::cross(normal, t) * (handedness < 0.0F ? -1.0F : 1.0F), normal};
}

// The direction of growing u where a mesh has texture coordinates and no tangents; w: the side on which the
// texture's top is, against v.
glm::vec4 tangent_of(const Vertex& a, const Vertex& b, const Vertex& c, std::size_t set) {
    const glm::vec2 e1 = b.texcoords[set] - a.texcoords[set];
    const glm::vec2 e2 = c.texcoords[set] - a.texcoords[set];
    const float area = e1.x * e2.y - e2.x * e1.y;
    if (area == 0.0F) return {glm::vec3(0.0F), 1.0F};
    return {((b.position - a.position) * e2.y - (c.position - a.position) * e1.y) / area,
            area < 0.0F ? 1.0F : -1.0F};
}

// Bends the frame's normal by a normal map.
glm::mat3 bent(const glm::mat3& frame, const glm::vec4& texel, float scale, const glm::vec3& out) {
    glm::vec3 bump = 2.0F * glm::vec3(texel) - 1.0F;
    bump.x *= scale;
    bump.y *= scale;
    const glm::vec3 normal = glm::normalize(frame * bump);
    // A normal that looks away from the viewer would make the surface black.
    if (glm::dot(normal, out) <= 0.0F) return frame;
    return make_frame(normal, frame[0], 1.0F);
}

void set_base(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
              const glm::vec4& color, Surface& s) {
    const glm::vec4 base = m.base_color * color * textures.sample(m.base_color_texture, uv, true);
    s.base_color = glm::clamp(glm::vec3(base), 0.0F, 1.0F);
    s.opacity = 1.0F;
    if (m.alpha_mode == assets::AlphaMode::mask) s.opacity = base.a >= m.alpha_cutoff ? 1.0F : 0.0F;
    if (m.alpha_mode == assets::AlphaMode::blend) s.opacity = std::clamp(base.a, 0.0F, 1.0F);
    const glm::vec4 rough = textures.sample(m.metallic_roughness_texture, uv, false);
    s.metallic = std::clamp(m.metallic * rough.b, 0.0F, 1.0F);
    const float roughness = std::clamp(m.roughness * rough.g, 0.0F, 1.0F);
    s.alpha = glm::vec2(std::max(roughness * roughness, min_alpha));
    s.emission = m.emissive * m.emissive_strength * glm::vec3(textures.sample(m.emissive_texture, uv, true));
}

// KHR_materials_ior and _specular.
void set_dielectric(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
                    Surface& s) {
    const float ratio = (m.ior - 1.0F) / (m.ior + 1.0F);
    const float weight = m.specular * textures.sample(m.specular_texture, uv, false).a;
    const glm::vec3 tint = m.specular_color * glm::vec3(textures.sample(m.specular_color_texture, uv, true));
    s.f0 = glm::min(ratio * ratio * tint, glm::vec3(1.0F)) * weight;
    s.f90 = weight;
}

// KHR_materials_anisotropy: the texture's red and green are the direction, blue the strength.
void set_anisotropy(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
                    Surface& s) {
    if (m.anisotropy <= 0.0F) return;
    glm::vec2 direction(1.0F, 0.0F);
    float strength = m.anisotropy;
    if (m.anisotropy_texture.texture >= 0) {
        const glm::vec4 texel = textures.sample(m.anisotropy_texture, uv, false);
        direction = glm::vec2(texel) * 2.0F - 1.0F;
        strength *= texel.b;
    }
    const float c = std::cos(m.anisotropy_rotation);
    const float r = std::sin(m.anisotropy_rotation);
    const glm::vec2 turned(c * direction.x - r * direction.y, r * direction.x + c * direction.y);
    s.frame = make_frame(s.frame[2], s.frame[0] * turned.x + s.frame[1] * turned.y, 1.0F);
    s.alpha.x = glm::mix(s.alpha.x, 1.0F, strength * strength);
}

void set_coat(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
              const glm::vec3& out, Surface& s) {
    s.coat = std::clamp(m.clearcoat * textures.sample(m.clearcoat_texture, uv, false).r, 0.0F, 1.0F);
    if (s.coat <= 0.0F) return;
    const float roughness = std::clamp(
        m.clearcoat_roughness * textures.sample(m.clearcoat_roughness_texture, uv, false).g, 0.0F, 1.0F);
    s.coat_alpha = std::max(roughness * roughness, min_alpha);
    if (m.clearcoat_normal_texture.texture >= 0)
        s.coat_frame = bent(s.coat_frame, textures.sample(m.clearcoat_normal_texture, uv, false), 1.0F, out);
}

}  // namespace

glm::vec3 Scene::normal(const Hit& hit) const {
    const Triangle& t = triangles_[hit.triangle];
    const glm::vec3& a = vertices_[t.corners[0]].position;
    const glm::vec3 n =
        glm::cross(vertices_[t.corners[1]].position - a, vertices_[t.corners[2]].position - a);
    return glm::normalize(n);
}

Surface Scene::surface(const Hit& hit, const glm::vec3& out) const {
    const Triangle& t = triangles_[hit.triangle];
    const Vertex& a = vertices_[t.corners[0]];
    const Vertex& b = vertices_[t.corners[1]];
    const Vertex& c = vertices_[t.corners[2]];
    const glm::vec3 w(1.0F - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x, hit.barycentric.y);
    const auto blend = [&](const auto& x, const auto& y, const auto& z) {
        return x * w.x + y * w.y + z * w.z;
    };
    const Material& m = materials_[t.material];
    const std::array<glm::vec2, 2> uv = {blend(a.texcoords[0], b.texcoords[0], c.texcoords[0]),
                                         blend(a.texcoords[1], b.texcoords[1], c.texcoords[1])};
    glm::vec3 face = normal(hit);
    glm::vec3 shading = blend(a.normal, b.normal, c.normal);
    const float length = glm::length(shading);
    shading = length > 1e-6F ? shading / length : face;
    // Both sides are seen: the back of a triangle is shaded as its front.
    if (glm::dot(face, out) < 0.0F) {
        face = -face;
        shading = -shading;
    }
    // At a silhouette the smooth normal may look away; it is turned until it does not.
    const float facing = glm::dot(shading, out);
    if (facing < 1e-3F) shading = glm::normalize(shading + (1e-3F - facing) * out);
    glm::vec4 tangent = blend(a.tangent, b.tangent, c.tangent);
    Surface s;
    const auto set = static_cast<std::size_t>(m.normal_texture.texcoord & 1);
    if (tangent == glm::vec4(0.0F)) tangent = tangent_of(a, b, c, set);
    s.frame = make_frame(shading, glm::vec3(tangent), tangent.w);
    s.coat_frame = s.frame;
    if (m.normal_texture.texture >= 0)
        s.frame = bent(s.frame, textures_.sample(m.normal_texture, uv, false), m.normal_scale, out);
    set_base(m, textures_, uv, blend(a.color, b.color, c.color), s);
    set_dielectric(m, textures_, uv, s);
    set_anisotropy(m, textures_, uv, s);
    set_coat(m, textures_, uv, out, s);
    return s;
}

// J. Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, 2021: the point is lifted from the triangle
// to the curved surface that its normals describe, so that a coarse cylinder throws no facets of shadow on
// itself.
glm::vec3 Scene::departure(const Hit& hit, const glm::vec3& side) const {
    const Triangle& t = triangles_[hit.triangle];
    const glm::vec3 w(1.0F - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x, hit.barycentric.y);
    const glm::vec3 flat = w.x * vertices_[t.corners[0]].position + w.y * vertices_[t.corners[1]].position +
                           w.z * vertices_[t.corners[2]].position;
    glm::vec3 lift(0.0F);
    glm::vec3 face = normal(hit);
    const float sign = glm::dot(face, side) < 0.0F ? -1.0F : 1.0F;
    for (int i = 0; i < 3; ++i) {
        const Vertex& vertex = vertices_[t.corners[static_cast<std::size_t>(i)]];
        const glm::vec3 n = sign * vertex.normal;
        lift -= w[i] * std::min(0.0F, glm::dot(flat - vertex.position, n)) * n;
    }
    const float scale = std::max({std::abs(flat.x), std::abs(flat.y), std::abs(flat.z), 0.01F});
    return flat + lift + sign * face * (scale * 4e-6F);
}

}  // namespace bolt::pathtrace
