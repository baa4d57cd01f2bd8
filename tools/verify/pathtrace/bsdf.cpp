#include "tools/verify/pathtrace/bsdf.hpp"

#include "tools/verify/pathtrace/sampler.hpp"

namespace bolt::pathtrace {

using namespace shading;

namespace {

constexpr float coat_f0 = 0.04F;

glm::vec3 local(const glm::mat3& frame, const glm::vec3& v) {
    return {glm::dot(frame[0], v), glm::dot(frame[1], v), glm::dot(frame[2], v)};
}

Layer make_layer(const glm::vec3& f0, float f90, const glm::vec2& ab) {
    const glm::vec3 compensation = 1.0F + f0 * (1.0F / (ab.x + ab.y) - 1.0F);
    return {f0, f90, compensation, (f0 * ab.x + f90 * ab.y) * compensation};
}

// Returns Schlick's Fresnel term with the compensation for multiple scattering.
glm::vec3 fresnel(const Layer& layer, float along) {
    return (layer.f0 + (glm::vec3(layer.f90) - layer.f0) * pow5(1.0F - along)) * layer.compensation;
}

glm::vec3 reflected(const glm::mat3& frame, const glm::vec3& out, const glm::vec2& alpha,
                    const glm::vec2& u) {
    const glm::vec3 half = sample_half(out, alpha, u);
    return frame * (2.0F * glm::dot(out, half) * half - out);
}

glm::vec3 cosine_distributed(const glm::mat3& frame, const glm::vec2& u) {
    const float radius = std::sqrt(u.x);
    const float angle = 2.0F * pi_float * u.y;
    return frame * glm::vec3(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1.0F - u.x));
}

}  // namespace

Bsdf::Bsdf(const ShadingPoint& surface, const glm::vec3& out)
    : surface_(surface), out_(local(surface.frame, out)), coat_out_(local(surface.coat_frame, out)) {
    const glm::vec2 ab =
        directional_albedo(glm::length(surface.alpha) / std::numbers::sqrt2_v<float>, out_.z);
    dielectric_ = make_layer(surface.f0, surface.f90, ab);
    metal_ = make_layer(surface.base_color, 1.0F, ab);
    diffuse_ =
        surface.base_color * (1.0F - surface.metallic) * std::max(0.0F, 1.0F - largest(dielectric_.albedo));
    if (surface.coat > 0.0F && coat_out_.z > 0.0F) {
        coat_ = make_layer(glm::vec3(coat_f0), 1.0F, directional_albedo(surface.coat_alpha, coat_out_.z));
        pick_coat_ = surface.coat * coat_.albedo.x;
    }
    below_coat_ = 1.0F - pick_coat_;
    pick_specular_ = below_coat_ * largest(glm::mix(dielectric_.albedo, metal_.albedo, surface.metallic));
    pick_diffuse_ = below_coat_ * largest(diffuse_);
    const float sum = pick_coat_ + pick_specular_ + pick_diffuse_;
    if (sum <= 0.0F) return;
    pick_coat_ /= sum;
    pick_specular_ /= sum;
    pick_diffuse_ /= sum;
}

BsdfValue Bsdf::evaluate(const glm::vec3& direction) const {
    BsdfValue result;
    if (out_.z <= 0.0F) return result;
    const glm::vec3 in = local(surface_.frame, direction);
    if (in.z > 0.0F) {
        const glm::vec3 half = glm::normalize(out_ + in);
        const float along = std::clamp(glm::dot(out_, half), 0.0F, 1.0F);
        const glm::vec3 reflectance =
            glm::mix(fresnel(dielectric_, along), fresnel(metal_, along), surface_.metallic);
        const float shape = ggx(half, surface_.alpha) * visibility(out_, in, surface_.alpha);
        result.value = (diffuse_ / pi_float + reflectance * shape) * (below_coat_ * in.z);
        result.density =
            pick_diffuse_ * in.z / pi_float + pick_specular_ * half_density(out_, half, surface_.alpha);
    }
    const glm::vec3 coat_in = local(surface_.coat_frame, direction);
    if (pick_coat_ > 0.0F && coat_in.z > 0.0F) {
        const glm::vec2 alpha(surface_.coat_alpha);
        const glm::vec3 half = glm::normalize(coat_out_ + coat_in);
        const float along = std::clamp(glm::dot(coat_out_, half), 0.0F, 1.0F);
        const float shape = ggx(half, alpha) * visibility(coat_out_, coat_in, alpha);
        result.value += fresnel(coat_, along) * (surface_.coat * shape * coat_in.z);
        result.density += pick_coat_ * half_density(coat_out_, half, alpha);
    }
    return result;
}

BsdfSample Bsdf::sample(float pick, const glm::vec2& u) const {
    if (out_.z <= 0.0F) return {};
    glm::vec3 in;
    if (pick < pick_coat_) {
        in = reflected(surface_.coat_frame, coat_out_, glm::vec2(surface_.coat_alpha), u);
    } else if (pick < pick_coat_ + pick_specular_) {
        in = reflected(surface_.frame, out_, surface_.alpha, u);
    } else {
        in = cosine_distributed(surface_.frame, u);
    }
    in = glm::normalize(in);
    const BsdfValue scattered = evaluate(in);
    if (scattered.density <= 0.0F) return {};
    return {in, scattered.value / scattered.density, scattered.density};
}

}  // namespace bolt::pathtrace
