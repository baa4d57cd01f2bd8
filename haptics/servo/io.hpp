// What goes into a tick and what comes out of it: plain values, small, and recorded bit for bit.
#pragma once

#include <cstdint>

#include "engine/base/pose.hpp"
#include "haptics/force/watchdog.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::servo {

enum class Grip : std::uint8_t { none, fingers, wrench };

// Pose of the tool as the device asks for it, in the assembly's frame. Single precision: devices give no
// more, and a recorded sample is then exactly the sample that was used. Tool frame: origin in the middle of
// the jaw (or between the fingertips), x along the handle, z the jaw's normal.
struct DeviceSample {
    float position[3] = {0.0F, 0.0F, 0.0F};           // m
    float orientation[4] = {1.0F, 0.0F, 0.0F, 0.0F};  // unit quaternion w, x, y, z: tool to assembly
};

inline DeviceSample sample_of(const Pose& tool) {
    DeviceSample sample;
    for (int i = 0; i < 3; ++i) sample.position[i] = static_cast<float>(tool.position[i]);
    sample.orientation[0] = static_cast<float>(tool.orientation.w);
    sample.orientation[1] = static_cast<float>(tool.orientation.x);
    sample.orientation[2] = static_cast<float>(tool.orientation.y);
    sample.orientation[3] = static_cast<float>(tool.orientation.z);
    return sample;
}

// What Input::undo may ask for: the nuts as they are now are kept as a mark (the last `most_marks` are), or
// all of them go back to the n-th last mark, 1 the last one.
inline constexpr std::uint8_t most_marks = 8, keep_mark = 255;

struct Input {
    DeviceSample device;
    Grip grip = Grip::none;
    bool enabled = false;     // dead-man held: without it nothing is rendered
    std::int16_t guide = -1;  // joint that the guiding force leads to; −1: none

    bool fresh = true;        // the device gave a sample since the tick before: a silent one is let go of
    bool stop = false;        // emergency stop pressed: latches
    bool reset = false;       // ends it, with the dead-man and the stop let go
    std::uint8_t missed = 0;  // deadlines without a tick since the one before, 15 at most
    // See above; not while a nut is held, nor where the tool is so near to one that it could be in the way.
    std::uint8_t undo = 0;
    // N·m that a click-type torque wrench is set to, as its scale has it; 0: it does not click. Once it has
    // clicked nobody turns its scale before it is let go of.
    float setting = 0.0F;
};

struct Output {
    // To the device, after scaling and the limits of the output stage: N and N·m at the tool's origin.
    Vec3 force{0.0};
    Vec3 torque{0.0};

    force::Fault fault = force::Fault::none;  // why nothing is rendered, if that is so

    // The tool where obstacles let it be, to the assembly, how many hold or nearly hold it, and which one the
    // wrench lies against (Touch::touched).
    Pose tool;
    std::uint16_t contacts = 0;
    std::int16_t touched = -1;

    // True values, unscaled.
    std::int16_t joint = -1;  // engaged joint; −1: none
    joint::Stage stage = joint::Stage::navigation;
    double wrench_torque = 0.0;  // N·m about the bolt's axis, tightening positive
    double nut_angle = 0.0;      // rad from the hand-started nut, tightening positive
    double clamp = 0.0;          // N

    std::int16_t slipped = -1;  // joint over whose corners the jaw slipped in this tick; −1: none
    bool clicked = false;       // the torque wrench did, in this tick
    std::uint8_t undone = 0;    // marks that the nuts went back by in this tick
    double rounded = 0.0;       // m of its flats that the engaged or slipped nut has lost at each corner
};

}  // namespace bolt::servo
