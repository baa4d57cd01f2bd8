// The lighting model: how a surface scatters light. The real-time renderer that is compared with these images
// implements the same formulas.
//
//   f = base · (1 − c E(coat, N·V)) + c · coat
//   base = (1 − m) · [ diffuse + specular(F0 = dielectric) ] + m · specular(F0 = base colour)
//   specular = D V F · (1 + F0 (1/E − 1)),    diffuse = base colour / π · (1 − E_F(N·V))
//
// m: metallic, c: clearcoat strength, D: Trowbridge–Reitz (GGX), V: height-correlated Smith over 4 N·L N·V,
// F: Schlick, with α = roughness²; F0 and F90 of the dielectric from ior, specular and specular colour;
// anisotropy widens α along the tangent.
//   glTF 2.0 specification, appendix B; KHR_materials_clearcoat, _anisotropy, _ior, _specular.
//   B. Walter et al., Microfacet Models for Refraction through Rough Surfaces, EGSR 2007 (D).
//   E. Heitz, Understanding the Masking-Shadowing Function, JCGT 3(2), 2014 (V).
// E(α, N·V) is the fraction of the light that a white (F = 1) specular layer reflects in one scattering. The
// rest, 1 − E, scatters more than once; the factor 1 + F0 (1/E − 1) restores it. E_F is the albedo of the
// specular layer with F and that factor; the diffuse layer below receives 1 − E_F:
//   E. Turquin, Practical multiple scattering compensation for microfacet models, ILM 2019.
// The coat (F0 = 0.04) attenuates the layers below it by its own albedo. A white surface in white
// surroundings is therefore white at every roughness (the furnace test). With anisotropy, E is taken at the
// root mean square of both α; averaged over the azimuth this is within 7 % of the exact value (a geometric
// mean would be 45 % off).
#pragma once

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace bolt::pathtrace {

// Returns the largest component.
inline float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

// The material at one point of a surface.
struct ShadingPoint {
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

// Lower bound of α: a perfect mirror has no finite density for importance sampling.
inline constexpr float min_alpha = 1e-3F;

struct BsdfValue {
    glm::vec3 value{0.0F};  // BSDF times the cosine of `in`
    float density = 0.0F;   // probability density of `in` in sample(), per solid angle
};

struct BsdfSample {
    glm::vec3 in{0.0F};
    glm::vec3 weight{0.0F};  // value / density
    float density = 0.0F;    // 0: no direction was sampled
};

// A specular layer at one viewing angle, with the values from the albedo table.
struct Layer {
    glm::vec3 f0{0.0F};
    float f90 = 0.0F;
    glm::vec3 compensation{1.0F};  // 1 + F0 (1/E − 1)
    glm::vec3 albedo{0.0F};        // E_F
};

// The BSDF of a surface for one outgoing direction `out`; the constructor computes what does not depend on
// `in`. `out` and `in` are unit vectors away from the surface. The surface must outlive this object.
class Bsdf {
  public:
    Bsdf(const ShadingPoint& surface, const glm::vec3& out);

    [[nodiscard]] BsdfValue evaluate(const glm::vec3& in) const;

    // Samples `in`. `pick` in [0, 1) selects the layer, `u` the direction.
    [[nodiscard]] BsdfSample sample(float pick, const glm::vec2& u) const;

  private:
    const ShadingPoint& surface_;
    glm::vec3 out_, coat_out_;  // in the frames of the surface and of the coat
    Layer dielectric_, metal_, coat_;
    glm::vec3 diffuse_{0.0F};  // albedo
    float below_coat_ = 1.0F;  // transmittance of the coat
    // Probabilities with which sample() selects each layer.
    float pick_coat_ = 0.0F, pick_specular_ = 0.0F, pick_diffuse_ = 0.0F;
};

}  // namespace bolt::pathtrace
