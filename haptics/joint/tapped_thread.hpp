// The internal thread of a tapped hole, and the force at which it or the bolt's thread strips.
//
// VDI 2230-1:2015 section 5.5.5, after E. M. Alexander, SAE 770420 (1977). Threads shear along a cylinder, on
// the part of its surface that they fill. m_eff is the engaged length that carries; D2 = d2 and
// D1 = d − 1.08253 P are those of ISO 68-1:
//
//   internal, at the bolt's tips:  A = π d  (m_eff/P) (P/2 + (d − D2) tan 30°),    F = C1 C3 τ_M A
//   external, at the hole's tips:  A = π D1 (m_eff/P) (P/2 + (d2 − D1) tan 30°),   F = C1 C2 τ_S A
//
// τ_M is the shear strength of the part with the hole, τ_S that of the bolt. C1 = 1 because the part around a
// tapped hole does not dilate as a nut does. C2 and C3 account for the bending of the threads; they depend on
// R_S = τ_M A_internal / (τ_S A_external).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "haptics/joint/fastener.hpp"

namespace bolt::joint {

// The material of a part with a tapped hole. Pascals.
struct TappedMaterial {
    std::string name;
    double E = 0.0;            // Young's modulus
    double R_m = 0.0;          // tensile strength, minimum
    double shear_ratio = 0.0;  // τ_M / R_m
};

// The built-in materials. Shear ratios are the lower bounds of VDI 2230-1:2015 table 6; for castings and
// aluminium they are those of Lork and Hanke. Tensile strengths are the minima of EN 10025-2 (S235,
// S355), EN 10083-2 (C45, quenched), EN 1561 (GJL), EN 1563 (GJS), EN 755-2 (6082-T6), EN 1706 (AlSi).
std::span<const TappedMaterial> tapped_materials();

// The error names the nearest valid name.
Result<TappedMaterial> tapped_material(std::string_view name);

// τ_S / R_m of a bolt; it falls with the strength of the class (VDI 2230-1:2015 after R. Thomala,
// Konstruktion 47, 1995: 0.70 up to 6.8, 0.65, 0.62 and 0.60 for 8.8, 10.9 and 12.9; 0.80 for austenitic
// steel).
double bolt_shear_ratio(const PropertyClass& bolt);

// Engaged pitches that carry no load: chamfers of the hole and of the bolt's end (VDI 2230-1:2015: m = m_eff
// + 2 P).
inline constexpr double idle_pitches = 2.0;

struct StrippingForces {
    double internal = 0.0;  // N, of the tapped thread
    double external = 0.0;  // N, of the bolt's thread

    [[nodiscard]] double least() const { return std::min(internal, external); }
};

// `engagement`: length of the engaged thread, m, including its idle pitches. The forces are 0 if all engaged
// pitches are idle.
StrippingForces stripping_forces(const ScrewThread& thread, const PropertyClass& bolt,
                                 const TappedMaterial& part, double engagement);

// The shortest engagement, m, at which the bolt breaks before a thread strips: stripping_forces().least() is
// R_m A_s times `surplus`. VDI 2230 has 1.2, because real bolts are stronger than their class demands.
double needed_engagement(const ScrewThread& thread, const PropertyClass& bolt, const TappedMaterial& part,
                         double surplus = 1.0);

}  // namespace bolt::joint
