// The clamp force of a joint as a function of its closure, with a smooth seat, and the Wright omega function
// that it needs: the ω with ω + ln ω = x for real x.
#pragma once

#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::joint {

// One step of the fourth-order iteration of Lawrence, Corless and Jeffrey, ACM Trans. Math. Softw. 38(3)
// (2012), algorithm 917, from `w` with the residual r = x − w − ln w. The residual afterwards is (2w² − 8w −
// 1) / (72 (1 + w)⁶) r⁴.
inline double wright_omega_step(double w, double r) {
    const double w1 = 1.0 + w;
    const double t = 2.0 * w1 * (w1 + (2.0 / 3.0) * r);
    return w * (1.0 + (r / w1) * (t - r) / (t - 2.0 * r));
}

// Relative error below 1e-15 for x ≥ 0 and below 1e-15 (1 + |x|) for x < 0; 0 where ω underflows. Two
// iteration steps from a starting value; one step suffices for x > 30, where the initial residual is below
// 0.015.
inline double wright_omega(double x) {
    if (x < -36.0) return x < -700.0 ? 0.0 : std::exp(x);  // ω = e^x (1 − e^x + …)
    double w = 0.0;
    if (x < -2.0) {
        const double e = std::exp(x);
        w = e * (1.0 - e * (1.0 - 1.5 * e));
    } else if (x < 4.0) {
        const double z = x - 1.0;  // series about ω(1) = 1
        w = 1.0 + z * (0.5 + z * (1.0 / 16.0 - z * (1.0 / 192.0 + z * (1.0 / 3072.0))));
    } else {
        const double l = std::log(x);
        w = x - l + (l / x) * (1.0 + 0.5 * (l - 2.0) / x);
    }
    w = wright_omega_step(w, x - w - std::log(w));
    return x > 30.0 ? w : wright_omega_step(w, x - w - std::log(w));
}

// The same function with the same error. `near` estimates the result; if it is close, one step suffices.
inline double wright_omega(double x, double near) {
    if (!(near > 0.0)) return wright_omega(x);
    const double r = x - near - std::log(near);
    const double left = 72.0 * square(square(1.0 + near)) * near;  // |2w² − 8w − 1| < 8 (1 + w)²
    if (!(8.0 * square(square(r)) < 1e-16 * left)) return wright_omega(x);
    return wright_omega_step(near, r);
}

// Clamp force as a function of closure: an elastic joint in series with a seat of rough, misfitting faces.
//
//   x = δ F + u0 ln(F/F0)
//
// δ is the compliance of bolt and members (VDI 2230). The second part is the approach of rough faces: the
// real area of contact is proportional to the load and the load falls exponentially with the gap (Persson,
// Phys. Rev. Lett. 99 (2007) 125502; u0 ≈ 0.5 h_rms), with u0 widened by the misfit of the faces. F0 is the
// load at nominal touch, where the second part is 0. The inverse has a closed form: F = (u0/δ)
// ω(x/u0 + ln(F0 δ/u0)) with the Wright omega function. F is positive, infinitely differentiable and
// increasing from a wide gap (F → 0) to the elastic line (dF/dx → 1/δ). One formula covers navigation,
// transition and linearity without a discontinuity.

struct SeatSpring {
    double compliance = 0.0;                                     // δ, m/N
    double scale = 0.0;                                          // u0, m
    double touch_force = 0.0;                                    // F0, N
    double origin = std::log(touch_force * compliance / scale);  // ln(F0 δ/u0): ω's argument at x = 0

    struct Load {
        double force = 0.0;      // N
        double stiffness = 0.0;  // dF/dx, N/m
    };

    // `near`: N, an estimate of the force, which saves work; 0: none.
    [[nodiscard]] Load at(double closure, double near = 0.0) const {
        const double w = wright_omega(closure / scale + origin, near * compliance / scale);
        return {scale / compliance * w, w / (1.0 + w) / compliance};
    }

    // The closure that makes this force; force > 0.
    [[nodiscard]] double closure(double force) const {
        return compliance * force + scale * std::log(force / touch_force);
    }
};

}  // namespace bolt::joint
