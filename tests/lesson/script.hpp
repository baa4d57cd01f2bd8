// A lesson driven by scripted ticks.
#pragma once

#include <cmath>
#include <initializer_list>

#include "game/lesson/judge.hpp"
#include "game/lesson/lesson.hpp"
#include "tests/support/haptic_world.hpp"

namespace bolt::test {

using namespace bolt::lesson;

// Two joints; a run-down, a pass to half and a full pass. Each call adds one or more ticks.
struct Script {
    content::Assembly assembly;
    Lesson lesson;
    servo::State state;
    servo::Output output;  // of the last tick
    world::World components;

    Script(const Script&) = delete;  // the lesson refers to the assembly
    Script& operator=(const Script&) = delete;
    ~Script() = default;
    explicit Script(Mode mode = Mode::guided, content::Strategy strategy = content::Strategy::torque) {
        for (const char* id : {"A", "B"}) {
            content::AssemblyJoint joint;
            joint.design.id = id;
            joint.spec.torque = {70.0, 63.0, 77.0};
            joint.spec.snug_torque = 10.0;
            joint.spec.strategy = strategy;
            assembly.joints.push_back(joint);
        }
        content::Pass run{content::PassKind::run_down, 1.0, {0, 1}};
        content::Pass half{content::PassKind::tighten, 0.5, {0, 1}};
        content::Pass full{content::PassKind::tighten, 1.0, {0, 1}};
        assembly.passes = {run, half, full};
        lesson = begin(assembly, mode, Task::tighten);
        state.joints.resize(2);
        state.rounded.resize(2);
        world::add_haptics(components, state);
    }
    // Begins the lesson again, with a torque wrench.
    void take_torque_wrench() {
        assembly.wrench.click_swing = 0.07;
        lesson = begin(assembly, lesson.mode, lesson.task);
    }

    void tick(int joint, servo::Grip grip, double torque, double speed = 0.0, bool clicked = false) {
        output = {};
        output.clicked = clicked;
        output.joint = static_cast<std::int16_t>(joint);
        state.engagement.joint = joint;
        state.engagement.grip = joint >= 0 ? grip : servo::Grip::none;
        const joint::JointState* turned = nullptr;
        if (joint >= 0) {
            joint::JointState& j = state.joints[static_cast<std::size_t>(joint)];
            turned = &j;
            j.nut.speed = speed;
            j.nut.angle += speed * 1e-3;

            j.torque = output.wrench_torque = torque;
            output.nut_angle = j.nut.angle;
            output.stage = j.stage;
            output.clamp = j.clamp;
        }
        for (joint::JointState& j : state.joints) wear_breakaway(j, &j == turned ? speed : 0.0);
        ++state.tick;
        observe_tick(lesson, components, state, output);
    }
    // The world, with the joints as the test has set them in `state` since the last tick.
    const world::World& present() {
        world::write_initial_state(components, state);
        return components;
    }
    [[nodiscard]] JointResult judged(std::size_t joint) { return judge_joint(lesson, joint, present()); }
    bool undo(std::size_t steps) { return undo_steps(lesson, present(), steps); }
    static void wear_breakaway(joint::JointState& j, double speed) {
        j.breakaway = speed != 0.0 ? j.breakaway * std::exp(-std::abs(speed) * 1e-3 / to_radians(2.0))
                                   : 1.0 + (j.breakaway - 1.0) * std::exp(-1e-3 / 0.3);
    }
    void idle(int ticks = 1) {
        for (int i = 0; i < ticks; ++i) tick(-1, servo::Grip::none, 0.0);
    }
    void seat(int joint) {
        tick(joint, servo::Grip::fingers, 0.1, 1.0);
        state.joints[static_cast<std::size_t>(joint)].stage = joint::Stage::transition;
        tick(joint, servo::Grip::fingers, 0.6);
        idle();
    }
    // A pull to `torque` in N·m that turns the nut by 0.1 rad, then a release.
    void pull(int joint, double torque) {
        for (int i = 0; i <= 100; ++i) tick(joint, servo::Grip::wrench, torque * i / 100.0, 1.0);
        state.joints[static_cast<std::size_t>(joint)].stage = joint::Stage::linearity;
        tick(joint, servo::Grip::wrench, torque);
        idle();
    }
    void seat_both() {
        idle();
        seat(0);
        seat(1);
    }
    [[nodiscard]] int out_of_turn() const {
        int n = 0;
        for (const JointTrack& joint : lesson.joints) n += joint.result.out_of_turn;
        return n;
    }
    [[nodiscard]] int count(EventKind kind) const {
        int n = 0;
        for (const LessonEvent& event : lesson.events) n += event.kind == kind ? 1 : 0;
        return n;
    }
};

}  // namespace bolt::test
