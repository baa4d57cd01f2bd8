// The Trowbridge–Reitz (GGX) distribution: evaluation, sampling and directional albedo. Directions are unit
// vectors in tangent space, with the normal as z: `out` towards the eye, `in` towards the light, `half`
// halfway between them. `alpha` is the square of a material's roughness; a vec2 gives it along x and y.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace bolt::shading {

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16U) | (x >> 16U);
    x = ((x & 0x00FF00FFU) << 8U) | ((x & 0xFF00FF00U) >> 8U);
    x = ((x & 0x0F0F0F0FU) << 4U) | ((x & 0xF0F0F0F0U) >> 4U);
    x = ((x & 0x33333333U) << 2U) | ((x & 0xCCCCCCCCU) >> 2U);
    return ((x & 0x55555555U) << 1U) | ((x & 0xAAAAAAAAU) >> 1U);
}

// Maps to [0, 1). Uses 24 bits, because with more the float could be rounded to one.
inline float unit_float(std::uint32_t x) { return static_cast<float>(x >> 8U) * 0x1p-24F; }

// Returns number `i` of the van der Corput sequence in base 2, which covers the unit interval evenly.
inline float radical_inverse(std::uint32_t i) { return unit_float(reverse_bits(i)); }

inline float pow5(float x) { return x * x * x * x * x; }

// The distribution D of microfacet normals.
inline float ggx(const glm::vec3& half, const glm::vec2& alpha) {
    const float x = half.x / alpha.x;
    const float y = half.y / alpha.y;
    const float t = x * x + y * y + half.z * half.z;
    return 1.0F / (std::numbers::pi_v<float> * alpha.x * alpha.y * t * t);
}

// The length of v after scaling by the roughness: the square root in Smith's functions.
inline float stretched(const glm::vec3& v, const glm::vec2& alpha) {
    return std::sqrt(alpha.x * alpha.x * v.x * v.x + alpha.y * alpha.y * v.y * v.y + v.z * v.z);
}

// Smith's height-correlated G2 over 4 N·L N·V (Heitz 2014, eq. 99).
inline float visibility(const glm::vec3& out, const glm::vec3& in, const glm::vec2& alpha) {
    return 0.5F / (in.z * stretched(out, alpha) + out.z * stretched(in, alpha));
}

// Smith's masking function G1.
inline float masking(const glm::vec3& v, const glm::vec2& alpha) {
    return 2.0F * v.z / (v.z + stretched(v, alpha));
}

// Samples a half vector from the normals visible from `out` (E. Heitz, Sampling the GGX Distribution of
// Visible Normals, JCGT 7(4), 2018). `u`: two uniform random numbers in [0, 1).
inline glm::vec3 sample_half(const glm::vec3& out, const glm::vec2& alpha, const glm::vec2& u) {
    const glm::vec3 v = glm::normalize(glm::vec3(alpha.x * out.x, alpha.y * out.y, out.z));
    const float flat = v.x * v.x + v.y * v.y;
    const glm::vec3 t1 = flat > 1e-12F ? glm::vec3(-v.y, v.x, 0.0F) / std::sqrt(flat) : glm::vec3(1, 0, 0);
    const glm::vec3 t2 = glm::cross(v, t1);
    const float radius = std::sqrt(u.x);
    const float angle = 2.0F * std::numbers::pi_v<float> * u.y;
    const float x = radius * std::cos(angle);
    const float s = 0.5F * (1.0F + v.z);
    const float y = (1.0F - s) * std::sqrt(std::max(0.0F, 1.0F - x * x)) + s * radius * std::sin(angle);
    const glm::vec3 n = x * t1 + y * t2 + std::sqrt(std::max(0.0F, 1.0F - x * x - y * y)) * v;
    return glm::normalize(glm::vec3(alpha.x * n.x, alpha.y * n.y, std::max(1e-7F, n.z)));
}

// The probability density of sample_half, per solid angle of the reflected direction.
inline float half_density(const glm::vec3& out, const glm::vec3& half, const glm::vec2& alpha) {
    return masking(out, alpha) * ggx(half, alpha) / (4.0F * out.z);
}

// The directional albedo E = x + y of a GGX layer, split into the parts that scale with F0 and F90:
// x = ∫ D V (1 − (1 − V·H)⁵) cos, y = ∫ D V (1 − V·H)⁵ cos. With single scattering, a specular layer reflects
// the fraction F0 x + F90 y. `cosine` is N·V. Interpolated in a table; accurate within 0.006 if the cosine is
// at least 0.05.
glm::vec2 directional_albedo(float alpha, float cosine);

// The same by numerical integration over `count` directions; used to build the table.
glm::vec2 integrate_albedo(float alpha, float cosine, unsigned count);

}  // namespace bolt::shading
