// How the joints of a group load and unload each other: the flange as a plate on an elastic foundation.
//
// Tightening one bolt presses the flange down around it, and the bolts beside it lose stretch; a little
// further out the plate bends up and they gain some. No trustworthy coefficients for a gear casing are
// published, so this model is ours, from the flange's own numbers: a thin plate (Kirchhoff) of flexural
// rigidity D = E h³/(12 (1 − ν²)) on a foundation of stiffness k per area (the parting faces). Its deflection
// at distance r from a force F is
//
//   w(r) = −F ℓ²/(2π D) kei(r/ℓ),   ℓ = (D/k)^¼        (Hertz 1884; Timoshenko & Woinowsky-Krieger, §57)
//
// kei is the Kelvin function of order 0; kei(0) = −π/4. The operator behind it is positive, so the matrix of
// w between any points is symmetric and positive semidefinite: the coupling stores energy and never makes
// any.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::joint {

struct FlangePlate {
    double rigidity = 0.0;    // D, N·m
    double foundation = 0.0;  // k, Pa/m

    static FlangePlate make(double thickness, double E, double poisson, double interface_stiffness);
    [[nodiscard]] double length() const;                        // ℓ, m
    [[nodiscard]] double deflection_per_force(double r) const;  // w/F, m/N
};

// kei(x) = Im K0(x e^{iπ/4}), x ≥ 0; absolute error below 1e-12.
double kelvin_kei(double x);

// Symmetric compliance between joints, sparse by rows (CSR) without the diagonal: w beyond 10 ℓ is below 10⁻³
// of w(0) and left out. The own deflection, the diagonal, is the same for all.
struct CouplingMatrix {
    double own = 0.0;                      // m/N
    std::vector<std::uint32_t> row_begin;  // size joints + 1
    std::vector<std::uint32_t> column;
    std::vector<double> value;  // m/N
};

CouplingMatrix couple(const FlangePlate& plate, std::span<const Vec3> seats);

}  // namespace bolt::joint
