// A stand-in for a test rig: the sensor data that a wrench with a force sensor and an encoder would give at a
// joint under the mechanistic law. It is a simulation and shows nothing about real joints; it exercises the
// whole path from raw data to a comparison, and compares one law with the other.
//
// The operator pulls in strokes and lets go in between. The hand's angle drives the nut through the elastic
// wrench (joint::step_group), so the nut sticks until the breakaway torque is reached and then slips. The
// encoder stands on an elastic arm, so its angle contains the arm's twist. The force has noise, an offset, a
// drift and an error of the gain.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::measure {

struct SensorModel {
    double rate = 500.0;             // Hz
    double lever = 0.3;              // m, as the rig's description has it
    double rest = 1.0;               // s before the first stroke, for the tare
    double force_noise = 0.4;        // N, standard deviation
    double force_offset = 3.0;       // N
    double force_drift = 0.02;       // N/s
    double force_resolution = 0.05;  // N
    double gain_error = 0.0025;      // standard deviation between runs, relative
    double angle_resolution = to_radians(0.1);
    double wrench_stiffness = 1500.0;  // N·m/rad, between hand and nut
    double arm_stiffness = 20000.0;    // N·m/rad, of the encoder's arm
    double stroke = to_radians(60.0);  // of the hand; varies by 15 %
    double speed = to_radians(40.0);   // rad/s, in the middle of a stroke; varies by 10 %
    double pause = 0.4;                // s between strokes, with the release
    double release = 0.2;              // s in which the hand gives way at the end of a stroke
};

struct SensorRow {
    double time = 0.0;   // s
    double force = 0.0;  // N
    double angle = 0.0;  // rad
};

// Tightens a bolt of the design, whose nut begins `lead_in` (rad) before its seat, until the torque reaches
// `torque` (N·m), the bolt breaks or strips, or 120 s are over. Equal seeds give equal data.
std::vector<SensorRow> simulate_run(const joint::JointDesign& design, double torque, std::uint64_t seed,
                                    const SensorModel& model = {}, double lead_in = to_radians(120.0));

// The file of a run, and the description of the rig that import_file() reads it with. `title` is one line.
std::string sensor_csv(const std::vector<SensorRow>& rows);
std::string simulated_rig_json(const SensorModel& model, const std::string& title, const std::string& thread);

// The source that is shown with such data.
inline constexpr const char* simulated_source = "SIMULATED with the mechanistic law, not measured";

}  // namespace bolt::measure
