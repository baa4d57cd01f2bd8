#include "game/scene/strain.hpp"

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

double effort(const servo::Output& output, const servo::Setup& setup, bool wrench) {
    if (output.joint < 0) return 0.0;
    const double most = wrench ? setup.wrench.stiffness * to_radians(2.5)
                               : setup.finger_torque(setup.nuts[static_cast<std::size_t>(output.joint)]);
    return std::clamp(output.wrench_torque / most, -1.0, 1.0);
}

void strain(Strain& s, const servo::Output& output, const servo::Setup& setup, bool wrench) {
    const double now = effort(output, setup, wrench);
    follow(s.quick, now, setup.dt, trembles);
    follow(s.slow, now, setup.dt, follows);
    follow(s.share, std::abs(now), setup.dt, follows);
    s.tremor = std::clamp(lively * (s.quick - s.slow), -1.0, 1.0) * std::min(1.0, 3.0 * s.share);
    if (now == 0.0 && s.share < rest && std::abs(s.slow) < rest && std::abs(s.quick) < rest) s = {};
}

}  // namespace bolt::scene
