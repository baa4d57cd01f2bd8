// What a trainee notices of the nut in its hand, late: it feels the torque that the device gives and how that
// grows while the wrench turns, and sees the nut turn. Nothing else of the joint is known to it.
#pragma once

#include <vector>

#include "haptics/force/output_limits.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::operators {

// N·m about the bolt's axis that the device lets feel, tightening positive, as the true one: a trainee knows
// how strong its device is. `handle`: unit, from the bolt to the grip.
double felt_torque(const force::TorqueRendering& rendering, const servo::NutPlace& nut, const Vec3& handle,
                   const force::OutputCommand& output);

struct Feeling {
    double torque = 0.0;       // N·m, tightening positive
    double torque_rate = 0.0;  // N·m/s, smoothed over 30 ms
    bool yields = false;       // the resistance no longer grows as it did
    double nut_speed = 0.0;    // rad/s, seen
    bool clicked = false;      // the torque wrench has given way
};

class Nerves {
  public:
    // `stiffness`: of wrench and wrists, N·m/rad. What these give is not the nut's turning.
    Nerves(double reaction, double dt, double stiffness);

    // One tick: what is so now goes in, what was so a reaction time ago comes out. `turned`: rad that the
    // hand has turned the wrench; `on`: it has hold of a nut.
    const Feeling& feel(double torque, double turned, double nut_speed, bool on, bool clicked = false);

  private:
    struct Moment {
        double torque = 0.0, turned = 0.0, nut_speed = 0.0;
        bool on = false, clicked = false;
    };
    void follow_slope(const Moment& late);

    double dt_, stiffness_;
    std::vector<Moment> line_;
    std::size_t at_ = 0;
    Feeling now_;
    Moment mark_;            // where the slope that is being felt began, `turned` that of the nut
    double steepest_ = 0.0;  // N·m/rad, since it took hold
    double hand_ = 0.0, nut_ = 0.0, hand_rate_ = 0.0, nut_rate_ = 0.0;  // rad, and rad a tick, smoothed
};

}  // namespace bolt::operators
