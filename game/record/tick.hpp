// One tick as it is kept: the input exactly, the output in single precision.
#pragma once

#include <cstdint>

#include "haptics/servo/io.hpp"

namespace bolt::record {

struct TickRecord {
    servo::DeviceSample device;
    std::uint8_t grip = 0;  // servo::Grip
    std::uint8_t enabled = 0;
    std::int16_t guide = -1;
    float force[3] = {0.0F, 0.0F, 0.0F};   // N
    float torque[3] = {0.0F, 0.0F, 0.0F};  // N·m
    std::int16_t joint = -1;
    std::uint8_t stage = 0;      // joint::Stage
    float wrench_torque = 0.0F;  // N·m
    float nut_angle = 0.0F;      // rad
    float clamp = 0.0F;          // N
};

TickRecord make_record(const servo::Input& input, const servo::Output& output);
servo::Input input_of(const TickRecord& record);

// Whether every enumeration and index holds a value that its type has. A record that does not is neither
// written nor handed out, so that nobody has to check again before using a stage as an index.
bool is_valid(const TickRecord& record);

}  // namespace bolt::record
