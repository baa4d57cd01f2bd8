// Clamp force over closure: an elastic joint in series with a seat whose rough, misfitting faces come to
// bear.
//
//   x = δ F + u0 ln(F/F0)
//
// δ is the compliance of bolt and members (VDI 2230). The second part is the approach of rough faces: the
// real area of contact is proportional to the load and the load falls exponentially with the gap (Persson,
// Phys. Rev. Lett. 99 (2007) 125502; u0 ≈ 0.5 h_rms), with u0 widened by the misfit of the faces. F0 is the
// load at nominal touch, x = 0. The inverse is closed: F = (u0/δ) ω(x/u0 + ln(F0 δ/u0)) with the Wright omega
// function. It is positive, smooth to every order and increasing from a wide gap (F → 0) to the elastic line
// (dF/dx → 1/δ): navigation, transition and linearity are one formula, with no switch to jump at.
#pragma once

#include <cmath>

#include "haptics/joint/wright_omega.hpp"

namespace bolt::joint {

struct SeatSpring {
    double compliance = 0.0;                                     // δ, m/N
    double scale = 0.0;                                          // u0, m
    double touch_force = 0.0;                                    // F0, N
    double origin = std::log(touch_force * compliance / scale);  // ln(F0 δ/u0): ω's argument at touch

    struct Load {
        double force = 0.0;      // N
        double stiffness = 0.0;  // dF/dx, N/m
    };

    // `near`: a force that is thought to be close, which saves work where it is; 0: none.
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
