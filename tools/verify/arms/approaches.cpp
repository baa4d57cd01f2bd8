#include "tools/verify/arms/approaches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "game/motion/path_planning.hpp"
#include "game/session/lesson_session.hpp"
#include "haptics/collision/narrow_phase.hpp"

namespace bolt::arm_validation {

namespace {

// A person reaches at about 0.35 m/s in the mean; aim and settling are chosen for a hand that is guided by
// memory (8 mm: the error of a hand that reaches without seeing, van Beers et al. 1999, in game/motion).
constexpr double mean_speed = 0.35, min_duration = 0.4, settling = 0.3;  // m/s, s, s
constexpr double aim_error = 8e-3, tilt_error = 0.05;                    // m, rad; standard deviations
constexpr double nearest_start = 0.13, farthest_start = 0.20;            // m from the nut
constexpr double lowest_start = to_radians(15.0), highest_start = to_radians(75.0);  // above the nut's plane
constexpr double at_nut = 0.010;       // m from the middle of the jaw to the middle of the nut
constexpr double beside_nut = 0.030;   // m; contacts nearer to the nut are no bumps: the hand places the jaw
constexpr double felt_bump = 0.2;      // N
constexpr double between_bumps = 0.1;  // s
constexpr double raise = 0.04;         // m that the hand rises after a failed attempt, before it tries again
constexpr int attempts = 4;
constexpr int max_starts = 200;

bool is_free(servo::ToolContact& contact, const Pose& pose) {
    constexpr double band = 5e-3;
    std::array<collision::Contact, proxy::max_contacts> found;
    return collision::find_contacts(contact.world, contact.wrench, pose, band, contact.narrow_phase, found)
               .count == 0;
}

struct ReachTask {
    std::size_t joint = 0;
    Vec3 nut{0.0};  // m, its middle
    Vec3 axis{0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};  // of the wrench on the nut
    Pose start;
};

ReachTask draw_reach_task(TightenedAssembly& tightened, Random& random) {
    const servo::Setup setup = session::make_setup(tightened.assembly, tightened.assembly.law, {}, 1, 1e-3);
    servo::ToolContact& contact = *tightened.state.tool_contact;
    ReachTask task;
    task.joint = std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(setup.nuts.size())),
                          setup.nuts.size() - 1);
    const servo::NutGeometry& nut = setup.nuts[task.joint];
    const double angle = tightened.state.joints[task.joint].nut.angle;
    const motion::HandleAngle handle = motion::choose_handle_angle(
        setup, &contact, task.joint, tightened.state.joints[task.joint], angle, 1.0, to_radians(30.0));
    task.nut = servo::nut_centre(nut, angle);
    task.axis = nut.axis;
    task.orientation = motion::tool_orientation(nut, handle.angle, handle.flipped);
    for (int i = 0; i < max_starts; ++i) {
        const double around = random.uniform(0.0, 2.0 * pi),
                     above = random.uniform(lowest_start, highest_start);
        const Vec3 to = std::cos(above) * (std::cos(around) * nut.e1 + std::sin(around) * nut.e2) +
                        std::sin(above) * nut.axis;
        const Quat turned = rotation(tilt_error * normal_vector(random));
        task.start = {task.nut + random.uniform(nearest_start, farthest_start) * to,
                      glm::normalize(turned * task.orientation)};
        if (is_free(contact, task.start)) break;
    }
    return task;
}

class Reach {
  public:
    Reach(ArmRig& rig, const ReachTask& task)
        : rig_(rig), task_(task), before_(rig.output().constrained_tool.position) {
        approach_.straight = glm::distance(task.nut, before_);
    }

    // Moves the hand to `to` with minimum jerk and lets it settle; ends early at the nut.
    void move(const Pose& to) {
        const Pose from = rig_.output().constrained_tool;
        const double way = glm::distance(from.position, to.position);
        const double duration = std::max(way / mean_speed, min_duration), begin = rig_.time;
        while (!approach_.reached && rig_.time - begin < duration + settling) {
            const double s = minimum_jerk((rig_.time - begin) / duration);
            rig_.arm.intention = rig_.device_pose(motion::arc_pose(from, to, s, Vec3(0.0)));
            rig_.tick();
            note();
        }
    }
    Approach finish() {
        approach_.force = rig_.record.greatest_force;
        approach_.step = rig_.record.step;
        approach_.time = rig_.time;
        return approach_;
    }
    [[nodiscard]] bool reached() const { return approach_.reached; }

  private:
    void note() {
        const servo::Output& output = rig_.output();
        approach_.way += glm::distance(output.constrained_tool.position, before_);
        before_ = output.constrained_tool.position;
        const double left = glm::distance(before_, task_.nut), force = rig_.contact_force();
        approach_.contact_force = std::max(approach_.contact_force, force);
        const bool touches = force > felt_bump && output.touched != collision::ObstacleId() &&
                             !(output.touched == collision::ObstacleId::nut(task_.joint));
        if (touches && left > beside_nut) {
            if (rig_.time - last_touch_ > between_bumps) ++approach_.bumps;
            last_touch_ = rig_.time;
        }
        approach_.reached = left < at_nut;
    }

    ArmRig& rig_;
    const ReachTask& task_;
    Vec3 before_;  // m, where the jaw was
    double last_touch_ = -1.0;
    Approach approach_;
};

}  // namespace

Approach run_approach(TightenedAssembly& tightened, const ArmFacts& arm, std::uint64_t seed, bool guided) {
    Random random(seed, 77);
    const ReachTask task = draw_reach_task(tightened, random);
    RigOptions options;
    options.arm = &arm;
    options.hand = hand_impedances()[usual_hand];
    options.tool = task.start;
    options.guided_joint = guided ? static_cast<int>(task.joint) : -1;
    ArmRig rig(tightened, options);
    Reach reach(rig, task);
    for (int i = 0; i < attempts && !reach.reached(); ++i) {
        // Drawn in every attempt, so that with and without guiding the attempts have the same errors.
        const Vec3 error = aim_error * normal_vector(random);
        const Quat turned = rotation(tilt_error * normal_vector(random));
        if (i > 0)
            reach.move({rig.output().constrained_tool.position + raise * task.axis,
                        rig.output().constrained_tool.orientation});
        reach.move({task.nut + error, glm::normalize(turned * task.orientation)});
    }
    return reach.finish();
}

ApproachSummary summarize(std::span<const Approach> approaches) {
    ApproachSummary s;
    s.count = approaches.size();
    std::vector<double> ways, times, forces, steps;
    for (const Approach& a : approaches) {
        s.missed += !a.reached;
        s.bumps += a.bumps / static_cast<double>(std::max<std::size_t>(s.count, 1));
        forces.push_back(a.contact_force);
        steps.push_back(a.step);
        if (!a.reached) continue;
        ways.push_back(a.way / a.straight);
        times.push_back(a.time);
    }
    s.way_ratio = quantile(ways, 0.5);
    s.time = quantile(times, 0.5);
    s.force_median = quantile(forces, 0.5);
    s.force_p95 = quantile(forces, 0.95);
    s.force_max = quantile(forces, 1.0);
    s.step_p95 = quantile(steps, 0.95);
    s.step_max = quantile(steps, 1.0);
    return s;
}

}  // namespace bolt::arm_validation
