// Every situation that does not depend on time: how it arises in a scripted lesson, and its hint.
#pragma once

#include "tests/hints/bench.hpp"

namespace bolt::test {

using servo::Grip;
inline constexpr auto torque = content::Strategy::torque;
inline constexpr auto yield = content::Strategy::yield;

struct Case {
    Situation situation;
    const char* text;
    HintMotion motion;
    void (*arrange)(Bench&);
    content::Strategy strategy = torque;
    Task task = Task::tighten;
};

inline const Case cases[] = {
    {Situation::take_wrench, "hint.take_wrench", HintMotion::take, [](Bench& b) { b.seat_both(); }},
    {Situation::put_wrench_away, "hint.put_wrench_away", HintMotion::put_away,
     [](Bench& b) {
         b.idle();
         b.wrench = true;
     }},
    {Situation::put_wrench_away, "hint.put_wrench_away", HintMotion::put_away,
     [](Bench& b) { b.tick(0, Grip::wrench, 0.2, 0.5); }},
    {Situation::find_by_wrench, "hint.find_by_wrench", HintMotion::approach,
     [](Bench& b) {
         b.seat_both();
         b.wrench = true;
     }},
    {Situation::find_by_fingers, "hint.find_by_fingers", HintMotion::reach, [](Bench& b) { b.idle(); }},
    {Situation::set_on, "hint.set_on", HintMotion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.wrench = true;
         b.near(0);
     }},
    {Situation::set_on_again, "hint.set_on_again", HintMotion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.pull(0, 20.0);
         b.wrench = true;
         b.near(0);
     }},
    {Situation::set_on_rounded, "hint.set_on_rounded", HintMotion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.state.rounded[0] = 0.4e-3;
         b.wrench = true;
         b.near(0);
     }},
    {Situation::counter_hold, "hint.hold_held_part", HintMotion::counter_hold,
     [](Bench& b) {
         b.assembly.joints[0].design.counter_hold = joint::CounterHold::second_wrench;
         b.seat_both();
         b.wrench = true;
         b.near(0);
     }},
    {Situation::counter_hold, "hint.hold_held_part", HintMotion::counter_hold,
     [](Bench& b) {
         b.assembly.joints[0].design.counter_hold = joint::CounterHold::second_wrench;
         b.seat_both();
         b.tick(0, Grip::wrench, 5.0, 0.5);
     }},
    {Situation::grip_nut, "hint.grip_nut", HintMotion::grip_nut,
     [](Bench& b) {
         b.idle();
         b.near(0);
     }},
    {Situation::run_down, "hint.run_down", HintMotion::spin,
     [](Bench& b) { b.tick(0, Grip::fingers, 0.1, 1.0); }},
    {Situation::run_down_by_wrench, "hint.run_down_by_wrench", HintMotion::pull_on,
     [](Bench& b) {
         b.setup.group.joints[0].prevailing_torque = 6.0;
         b.tick(0, Grip::wrench, 6.0, 1.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) {
         b.setup.group.joints[0].prevailing_torque = 6.0;
         b.tick(0, Grip::fingers, 0.7, 0.0);
     }},
    {Situation::twist_back, "hint.twist_back", HintMotion::twist_back,
     [](Bench& b) {
         b.tick(0, Grip::fingers, 0.1, 1.0);
         b.free_swing = 0.01;
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::spin,
     [](Bench& b) { b.tick(0, Grip::fingers, -0.1, -1.0); }},
    {Situation::seated, "hint.seated", HintMotion::let_go,
     [](Bench& b) {
         b.tick(0, Grip::fingers, 0.1, 1.0);
         b.state.joints[0].stage = joint::Stage::transition;
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::pull, "hint.pull", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 10.0);
     }},
    {Situation::pull_to_yield, "hint.pull_to_yield", HintMotion::pull_on,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 40.0);
     },
     yield},
    {Situation::pull_to_click, "hint.pull_to_click", HintMotion::pull_on,
     [](Bench& b) {
         b.take_torque_wrench();
         b.seat_both();
         b.turn(0, 30.0);
     }},
    {Situation::pull_to_click_by_adaptor, "hint.pull_to_click_by_adaptor", HintMotion::pull_on,
     [](Bench& b) {
         b.assembly.wrench.handle_length = 0.3;
         b.assembly.wrench.adaptor_length = 0.06;
         b.take_torque_wrench();
         b.seat_both();
         b.turn(0, 30.0);
     }},
    {Situation::stop_at_click, "hint.stop_at_click", HintMotion::lift,
     [](Bench& b) {
         b.take_torque_wrench();
         b.seat_both();
         b.turn(0, 35.0);
         b.tick(0, Grip::wrench, 34.0, 0.0, true);
         b.tick(0, Grip::wrench, 17.0);
     }},
    {Situation::set_back, "hint.set_back", HintMotion::set_back,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 10.0);
         b.free_swing = 0.02;
     }},
    {Situation::ease, "hint.ease", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 27.0);
     }},
    {Situation::ease_to_yield, "hint.ease_to_yield", HintMotion::pull_on,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 66.0);
     },
     yield},
    {Situation::stop, "hint.stop", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 33.0);
     }},
    {Situation::stop_at_yield, "hint.stop_at_yield", HintMotion::lift,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 66.0);
         b.state.joints[0].stage = joint::Stage::yield;
         b.tick(0, Grip::wrench, 67.0, 1.0);
     },
     yield},
    {Situation::stop_too_much, "hint.stop_too_much", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
     }},
    {Situation::take_off, "hint.take_off", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 33.0);
         b.tick(0, Grip::wrench, 3.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) {
         b.seat_both();
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, -4.0, -1.0);
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.tick(0, Grip::wrench, -20.0);  // the nut does not move
     }},
    {Situation::wrong_joint, "hint.wrong_joint", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.tick(1, Grip::wrench, 0.2);
     }},
    {Situation::wrong_joint, "hint.wrong_joint", HintMotion::let_go,
     [](Bench& b) { b.tick(1, Grip::fingers, 0.0); }},
    {Situation::leave_broken, "hint.leave_broken", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
         b.state.joints[0].condition = joint::JointCondition::broken;
         b.tick(0, Grip::wrench, 0.0);
     }},
    {Situation::leave_stripped, "hint.leave_stripped", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
         b.state.joints[0].condition = joint::JointCondition::stripped;
         b.tick(0, Grip::wrench, 0.0);
     }},
    {Situation::check, "hint.check", HintMotion::pull_on,
     [](Bench& b) {
         b.to_the_check();
         b.tick(0, Grip::wrench, 30.0);
     }},
    {Situation::checked, "hint.checked", HintMotion::lift,
     [](Bench& b) {
         b.to_the_check();
         b.turn(0, 60.0, 0.1);  // the nut moves below the window
     }},
    {Situation::checked, "hint.checked", HintMotion::lift,
     [](Bench& b) {
         b.to_the_check();
         b.tick(0, Grip::wrench, 64.0);  // it does not move within the window
     }},
    {Situation::take_wrench, "hint.take_wrench", HintMotion::take, [](Bench& b) { b.idle(); }, torque,
     Task::loosen},
    {Situation::break_loose, "hint.break_loose", HintMotion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, -40.0); }, torque, Task::loosen},
    {Situation::unscrew, "hint.turn_off", HintMotion::pull_off, [](Bench& b) { b.turn(1, -20.0, -1.0); },
     torque, Task::loosen},
    {Situation::other_way_off, "hint.other_way_off", HintMotion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, 20.0); }, torque, Task::loosen},
    {Situation::other_way_off, "hint.other_way_off", HintMotion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, 3.0, 0.5); }, torque, Task::loosen},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) { b.tick(1, Grip::fingers, -0.5); }, torque, Task::loosen},
    {Situation::set_back, "hint.set_back", HintMotion::set_back,
     [](Bench& b) {
         b.tick(1, Grip::wrench, -40.0);
         b.free_swing = 0.0;
     },
     torque, Task::loosen},
    {Situation::free, "hint.free", HintMotion::lift,
     [](Bench& b) {
         b.turn(1, -20.0, -1.0);
         b.state.joints[1].stage = joint::Stage::navigation;
         b.tick(1, Grip::wrench, -0.1, -1.0);
     },
     torque, Task::loosen},
    {Situation::turn_on, "hint.turn_on", HintMotion::pull_on,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 20.0);
     }},
    {Situation::ease_to_angle, "hint.ease_to_angle", HintMotion::pull_on,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 40.0);
         b.tick(0, Grip::wrench, 50.0, to_radians(2.0) / 1e-3);
     }},
    {Situation::stop_at_angle, "hint.stop_at_angle", HintMotion::lift,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 60.0);
     }},
    {Situation::stop_too_far, "hint.stop_too_far", HintMotion::lift,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 80.0);
     }},
    {Situation::take_off, "hint.take_off", HintMotion::lift,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 60.0);
         b.tick(0, Grip::wrench, 5.0);
     }},
    {Situation::set_back, "hint.set_back", HintMotion::set_back,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 20.0);
         b.free_swing = 0.02;
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, -10.0, -30.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) {
         b.by_angle();
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::turn_back, "hint.turn_back", HintMotion::pull_off,
     [](Bench& b) {
         b.turned_back();
         b.turn_by(1, -20.0, -20.0);
     },
     torque, Task::loosen},
    {Situation::turned_back, "hint.turned_back", HintMotion::lift,
     [](Bench& b) {
         b.turned_back();
         b.turn_by(1, -50.0, -20.0);
     },
     torque, Task::loosen},
    {Situation::all_done, "hint.all_done", HintMotion::none,
     [](Bench& b) {
         b.to_the_check();
         for (const int joint : {0, 1}) b.pull(joint, 70.0);
     }},
};

}  // namespace bolt::test
