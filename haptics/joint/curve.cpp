#include "haptics/joint/curve.hpp"

#include <cmath>

namespace bolt::joint {

namespace {

constexpr std::size_t longest = 2'000'000;

double signed_torque(const GroupParameters& group, const JointState& joint, Direction direction) {
    if (group.law == Law::mechanistic) return joint.torque;
    return published_read(group.published, joint.published, to_degrees(joint.nut.angle), direction).torque;
}

bool spent(const JointState& joint) { return joint.condition != Condition::sound; }

// Turns on until the torque is there; gives up where the joint no longer can.
void tighten_to(const GroupParameters& group, std::vector<JointState>& joints, double torque,
                const CurveOptions& o) {
    for (std::size_t i = 0; i < longest && joints[0].torque < torque && !spent(joints[0]); ++i)
        turn_nut(group, joints, 0, joints[0].nut.angle + o.speed * o.dt, 1.0, o.dt);
    for (int i = 0; i < 10'000; ++i) step_group(group, joints, -1, Handle{}, 0.001);
}

}  // namespace

std::vector<CurveSample> torque_angle_curve(const GroupParameters& group, const CurveOptions& o) {
    std::vector<CurveSample> samples;
    std::vector<JointState> joints = initial_state(group, 1);
    JointState& joint = joints[0];
    const bool on = o.direction == Direction::tighten;
    if (!on) tighten_to(group, joints, o.torque, o);

    const double start = joint.nut.angle;
    const double step = (on ? 1.0 : -1.0) * o.speed * o.dt;
    double yield_begin = -1.0, free_begin = -1.0;
    for (std::size_t i = 0; i < longest; ++i) {
        turn_nut(group, joints, 0, start + step * static_cast<double>(i), on ? 1.0 : -1.0, o.dt);
        const double turned = std::abs(joint.nut.angle - start);
        samples.push_back({turned, joint.stage, signed_torque(group, joint, o.direction), joint.clamp});
        if (on) {
            if (joint.stage == Stage::yield && yield_begin < 0.0) yield_begin = turned;
            if (spent(joint) ||
                (yield_begin >= 0.0 && turned >= yield_begin + o.past_yield - 0.5 * std::abs(step)))
                break;
        } else {
            if (joint.stage != Stage::navigation)
                free_begin = -1.0;
            else if (free_begin < 0.0)
                free_begin = turned;
            if (free_begin >= 0.0 && turned >= free_begin + 0.5 * pi) break;
            if (joint.nut.angle <= 0.0) break;
        }
    }
    return samples;
}

}  // namespace bolt::joint
