// One tick as it is kept: the input exactly, the output in single precision.
#pragma once

#include <cstdint>

#include "haptics/servo/io.hpp"

namespace bolt::record {

struct TickRecord {
    servo::DeviceSample device;
    std::uint8_t grip = 0;   // servo::Grip
    std::uint8_t flags = 0;  // see below
    std::int16_t guide = -1;
    float force[3] = {0.0F, 0.0F, 0.0F};   // N
    float torque[3] = {0.0F, 0.0F, 0.0F};  // N·m
    std::int16_t joint = -1;
    std::uint8_t stage = 0;      // joint::Stage
    float wrench_torque = 0.0F;  // N·m
    float nut_angle = 0.0F;      // rad
    float clamp = 0.0F;          // N

    // Since format 2; sessions of format 1 have the defaults.
    std::uint16_t contacts = 0;  // of the wrench
    std::int16_t touched = -1;   // obstacle that it lies against, named in Header::obstacle_names
    std::uint8_t fault = 0;      // force::Fault of the output stage

    std::uint8_t undo = 0;  // Input::undo; since format 3
    float setting = 0.0F;   // N·m, Input::setting; since format 4
};

// Of the input's small values; above them four bits of missed deadlines.
inline constexpr std::uint8_t flag_enabled = 1, flag_silent = 2, flag_stop = 4, flag_reset = 8;

TickRecord make_record(const servo::Input& input, const servo::Output& output);
servo::Input input_of(const TickRecord& record);

// Whether the servo put out the same, bit by bit: what is not a number is the same as itself.
bool same_output(const TickRecord& a, const TickRecord& b);

// Whether every enumeration and index holds a value that its type has. A record that does not is neither
// written nor handed out, so that nobody has to check again before using a stage as an index.
bool is_valid(const TickRecord& record);

}  // namespace bolt::record
