// Turns the files of a test rig into a record of torque over angle that `boltwright compare` reads, with the
// uncertainty of every torque, and finds the landmarks of each run.
//
// Order: values of the channels, low pass, torque from force and lever, tare, angle, checks, uncertainty.
//
// The uncertainty is a combined standard uncertainty after JCGM 100:2008 (GUM), from independent parts: the
// resolution a as a uniform distribution (a/√12), the calibration (U/2, where U is its expanded uncertainty
// with k = 2), a share of the value (U%/2, where U% is also expanded), and the lever. For a force F at the
// lever r, T = F r:
//
//   u(F)² = a²/12 + (U/2)² + (U% F/2)²,   u(T)² = (r u(F))² + (F u(r))²
//
// It contains neither the noise, which the scatter of the run already shows, nor the angle between force and
// lever.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/measure/landmarks.hpp"
#include "game/measure/rig.hpp"

namespace bolt::measure {

struct RigRun {
    std::string name;  // of the cycle: the label in the file, or the name of the file
    std::string file;
    std::vector<double> time;        // s
    std::vector<double> angle;       // rad
    std::vector<double> torque;      // N·m, tightening positive
    std::vector<double> u_torque;    // N·m, combined standard uncertainty
    double rate = 0.0;               // Hz
    double noise = 0.0;              // N·m, standard deviation, of what the low pass removed; 0 without one
    double zero = 0.0;               // N·m that the tare subtracted
    double u_angle = 0.0;            // rad, standard uncertainty of the angle
    std::size_t unjoined = 0;        // samples dropped: the angle's source does not cover their time
    std::vector<std::string> notes;  // what a person should check
    Landmarks landmarks;
};

// The texts of one file of runs. `second_text`: of the file that the angle comes from, if the rig has one.
struct RunText {
    std::string file, text;
    std::string second_file, second_text;
};

// Reads all runs of a file. An error names the place in the file, or in the rig's description if the mistake
// is probably there.
Result<std::vector<RigRun>> import_runs(const Rig& rig, const RunText& text);

// The same from the disk.
Result<std::vector<RigRun>> import_file(const Rig& rig, const std::filesystem::path& path);

// Adds " (2)" and so on to names that occur more than once, because a record distinguishes its runs by name.
void name_uniquely(std::vector<RigRun>& runs);

// While the nut turns by less than this, record_csv() writes only the first sample and the one with the
// largest torque.
inline constexpr double record_step = 0.02;  // degrees
// The record as CSV: cycle, time_s, angle_deg, torque_Nm, u_torque_Nm.
std::string record_csv(const Rig& rig, const std::vector<RigRun>& runs);

// The landmarks and the uncertainty of each run, for the terminal.
std::string summary_text(const Rig& rig, const std::vector<RigRun>& runs);

}  // namespace bolt::measure
