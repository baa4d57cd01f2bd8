// Simulated trainees: how well and how fast a person of this kind works. Ours, plausible rather than
// measured; each number is a thing that an instructor could watch.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/trainees/arm.hpp"

namespace bolt::trainees {

struct Profile {
    std::string_view name;
    double reach_time;      // s, from one joint to the next
    double placing_time;    // s, to lower the tool onto the nut
    double position_noise;  // m, standard deviation of where the tool is placed
    double angle_noise;     // rad, of how the jaw is turned before it slides on
    double tremor;          // m, amplitude of physiological tremor (8–12 Hz)
    double tremor_torsion;  // rad, about the bolt while pulling
    double pull_speed;      // rad/s of the handle on a free nut
    double load_rate;       // 1/s, growth of the torque far from the goal, as a share of what is missing
    double final_rate;      // 1/s, growth at the goal, as a share of the goal
    double spin_speed;      // rad/s of the fingers
    double stroke;          // rad, longest pull before re-gripping
    double reaction;        // s between feeling a torque and answering it
    double torque_bias;     // relative, where it means to stop above the target
    double torque_noise;    // relative, standard deviation of one stop
    double anticipation;    // 0…1, how much of its own reaction time it allows for
    double feels_yield;     // chance of noticing that a bolt begins to yield
    double content;         // 0…1, how much of nut and jaw it wants to see before it goes there
    double pause;           // s of hesitation before a step, on average
    double wrong_joint;     // chance of going to another joint than the due one
    double stops_early;     // chance of letting go well below the target
    double overdoes;        // chance of pulling on well past it
    Impedance hand{};       // how it gives way
};

// "expert", "novice", "clumsy"; the error names the nearest.
Result<Profile> find_profile(std::string_view name);
std::vector<std::string> profile_names();

}  // namespace bolt::trainees
