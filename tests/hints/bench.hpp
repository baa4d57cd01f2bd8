// A scripted lesson (tests/lesson/script.hpp) with hints.
#pragma once

#include "game/lesson/hints.hpp"
#include "tests/lesson/script.hpp"

namespace bolt::test {

using namespace bolt::lesson;

// Situations whose hint may soon replace another one, because its request is fulfilled.
inline bool at_work(Situation s) {
    for (const Situation work :
         {Situation::run_down, Situation::run_down_by_wrench, Situation::pull, Situation::pull_to_yield,
          Situation::pull_to_click, Situation::pull_to_click_by_adaptor, Situation::check,
          Situation::break_loose, Situation::unscrew, Situation::ease, Situation::ease_to_yield,
          Situation::turn_on, Situation::ease_to_angle, Situation::turn_back})
        if (s == work) return true;
    return false;
}

struct Bench : Script {
    servo::Setup setup;
    servo::Output output;
    bool wrench = false;
    double free_swing = std::numeric_limits<double>::infinity();
    HintState hints;
    HapticWorld world{2};

    explicit Bench(Mode mode = Mode::guided, content::Strategy strategy = content::Strategy::torque,
                   Task task = Task::tighten)
        : Script(mode, strategy) {
        assembly.passes.push_back({content::PassKind::recheck, 1.0, {0, 1}});
        lesson = begin(assembly, mode, task);
        setup.group.joints.resize(assembly.joints.size());
        for (const double x : {0.0, 0.2}) {
            servo::NutGeometry nut;
            nut.seat = Vec3(x, 0.0, 0.0);
            nut.across_flats = 0.024;
            nut.height = 0.014;
            setup.nuts.push_back(nut);
        }
        far_away();
        if (task == Task::loosen)
            for (joint::JointState& joint : state.joints) joint.stage = joint::Stage::linearity;
    }

    void far_away() { output.constrained_tool.position = Vec3(0.1, 0.3, 0.4); }
    void near(std::size_t joint) {
        output.constrained_tool.position = setup.nuts[joint].seat + Vec3(0.0, 0.03, 0.0);
    }
    // Turns a nut for 100 ticks, up to `torque` in N·m.
    void turn(int joint, double torque, double speed = 1.0) {
        for (int i = 1; i <= 100; ++i) tick(joint, servo::Grip::wrench, torque * i / 100.0, speed);
    }
    void to_the_full_pass() {
        seat_both();
        for (const int joint : {0, 1}) pull(joint, 35.0);
        wrench = true;
    }
    // Begins the lesson again: after the pass to half, every nut is turned by 60° from its mark.
    void by_angle() {
        for (content::AssemblyJoint& joint : assembly.joints)
            joint.spec.angle = {to_radians(60.0), to_radians(50.0), to_radians(70.0)};
        assembly.passes[2].kind = content::PassKind::turn;
        lesson = begin(assembly, lesson.mode, Task::tighten);
        to_the_full_pass();
    }
    // Turns a nut by `degrees` at a constant torque in N·m.
    void turn_by(int joint, double degrees, double torque = 50.0) {
        const double speed = std::copysign(to_radians(10.0) / 1e-3, degrees);  // 10° a tick
        for (int i = 0; i < static_cast<int>(std::abs(degrees) / 10.0); ++i)
            tick(joint, servo::Grip::wrench, torque, speed);
    }
    // Begins a loosening lesson whose first pass turns every nut back by 45°.
    void turned_back() {
        assembly.loosening = {{content::PassKind::loosen, 1.0, {1, 0}, to_radians(45.0)},
                              {content::PassKind::loosen, 1.0, {1, 0}}};
        lesson = begin(assembly, lesson.mode, Task::loosen);
        idle();
    }
    // Completes all passes before the re-check.
    void to_the_check() {
        to_the_full_pass();
        for (const int joint : {0, 1}) pull(joint, 70.0);
    }

    [[nodiscard]] ObservedLesson work_state() {
        return {lesson, setup, world.write(state, output, wrench, free_swing)};
    }
    [[nodiscard]] Situation now() { return situation(work_state()); }
    const std::optional<Hint>& frame(double dt = 0.05, bool requested = false) {
        return update(hints, work_state(), dt, requested);
    }
    const std::optional<Hint>& wait(double seconds) {
        for (double t = 0.0; t < seconds - 1e-9; t += 0.05) frame();
        return hints.shown;
    }
};

}  // namespace bolt::test
