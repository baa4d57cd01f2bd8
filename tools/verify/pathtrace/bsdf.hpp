// The lighting model: how a surface scatters light. A real-time renderer that is held against these pictures
// implements the same formulas.
//
//   f = base · (1 − c E(coat, N·V)) + c · coat
//   base = (1 − m) · [ diffuse + specular(F0 = dielectric) ] + m · specular(F0 = base colour)
//   specular = D V F · (1 + F0 (1/E − 1)),    diffuse = base colour / π · (1 − E_F(N·V))
//
// D: Trowbridge–Reitz (GGX), V: height-correlated Smith over 4 N·L N·V, F: Schlick, with α = roughness²; F0
// and F90 of the dielectric from ior, specular and specular colour; anisotropy widens α along the tangent.
//   glTF 2.0 specification, appendix B; KHR_materials_clearcoat, _anisotropy, _ior, _specular.
//   B. Walter et al., Microfacet Models for Refraction through Rough Surfaces, EGSR 2007 (D).
//   E. Heitz, Understanding the Masking-Shadowing Function, JCGT 3(2), 2014 (V).
// E(α, N·V) is the part of the light that a white (F = 1) specular layer gives back in one scattering. What
// is missing to one was scattered more than once; the factor 1 + F0 (1/E − 1) returns it, and E_F, the albedo
// of the specular layer with F and that factor, is what the diffuse layer below does not get:
//   E. Turquin, Practical multiple scattering compensation for microfacet models, ILM 2019.
// The coat (F0 = 0.04) takes its own albedo from what is below it. So a white surface in white surroundings
// is white at every roughness (the furnace test). With anisotropy E is that of the root mean square of both
// α, which is within 7 % of the truth on average over the azimuth (a geometric mean would be 45 % off).
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace bolt::pathtrace {

struct Surface {
    glm::vec3 base_color{1.0F};
    float metallic = 0.0F;
    glm::vec2 alpha{0.25F};  // along tangent and bitangent
    glm::vec3 f0{0.04F};     // of the dielectric
    float f90 = 1.0F;
    glm::mat3 frame{1.0F};  // tangent, bitangent, shading normal in the world
    float coat = 0.0F;
    float coat_alpha = 0.0F;
    glm::mat3 coat_frame{1.0F};
    glm::vec3 emission{0.0F};
    float opacity = 1.0F;
};

// Roughness is kept above this: a perfect mirror has no density that could be weighed.
inline constexpr float min_alpha = 1e-3F;

struct Scattered {
    glm::vec3 value{0.0F};  // the part of the light from `in` that goes to `out`, times the cosine of `in`
    float density = 0.0F;   // per solid angle, with which `sample` proposes `in`
};

struct BsdfSample {
    glm::vec3 in{0.0F};
    glm::vec3 weight{0.0F};  // value / density
    float density = 0.0F;    // 0: nothing is scattered
};

// A specular layer seen under one angle: its albedos are all that the formulas need of the table.
struct Layer {
    glm::vec3 f0{0.0F};
    float f90 = 0.0F;
    glm::vec3 compensation{1.0F};  // 1 + F0 (1/E − 1)
    glm::vec3 albedo{0.0F};        // E_F
};

// A surface as it is seen from `out`: what does not depend on where light comes from is worked out once.
// `out` and `in` are unit vectors away from the surface, which must outlive this.
class Bsdf {
  public:
    Bsdf(const Surface& surface, const glm::vec3& out);

    [[nodiscard]] Scattered evaluate(const glm::vec3& in) const;

    // `pick` chooses the layer, `u` the direction.
    [[nodiscard]] BsdfSample sample(float pick, const glm::vec2& u) const;

  private:
    const Surface& surface_;
    glm::vec3 out_, coat_out_;  // in the frames of the surface and of the coat
    Layer dielectric_, metal_, coat_;
    glm::vec3 diffuse_{0.0F};  // albedo
    float below_coat_ = 1.0F;  // what the coat lets through
    float pick_coat_ = 0.0F, pick_specular_ = 0.0F, pick_diffuse_ = 0.0F;
};

}  // namespace bolt::pathtrace
