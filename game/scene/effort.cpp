#include "game/scene/effort.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::scene {

namespace {

constexpr double follows = 0.09, trembles = 0.012;  // s, time constants
constexpr double lively = 6.0;                      // tremor of so much of a change
constexpr double rest = 1e-3;                       // below it nothing is strained any more

void follow(double& value, double to, double dt, double time) {
    value += (to - value) * (1.0 - std::exp(-dt / time));
}

}  // namespace

double effort(const servo::Setup& setup, const EffortAccess& world) {
    const std::int16_t engaged = world.only<world::ToolContact>().joint;
    if (engaged < 0) return 0.0;
    const world::Joint& joint = world::joint_at(world, static_cast<std::size_t>(engaged));
    const double most = world.only<world::Hand>().wrench ? setup.wrench.stiffness * to_radians(2.5)
                                                         : setup.finger_torque(setup.nuts[joint.index]);
    return std::clamp(joint.torque / most, -1.0, 1.0);
}

void strain(Strain& s, const servo::Setup& setup, const EffortAccess& world) {
    const double now = effort(setup, world);
    follow(s.quick, now, setup.dt, trembles);
    follow(s.slow, now, setup.dt, follows);
    follow(s.share, std::abs(now), setup.dt, follows);
    s.tremor = std::clamp(lively * (s.quick - s.slow), -1.0, 1.0) * std::min(1.0, 3.0 * s.share);
    if (now == 0.0 && s.share < rest && std::abs(s.slow) < rest && std::abs(s.quick) < rest) s = {};
}

}  // namespace bolt::scene
