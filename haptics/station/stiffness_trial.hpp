// Measures the stiffness that an arm renders stably, with a hand on it and on this computer: a weak spring
// around the handle becomes stiffer in steps until the handle keeps oscillating or gives energy to the hand.
// All forces pass the output stage. Pure, of fixed dt, without clock and I/O.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/device/device.hpp"
#include "haptics/force/output_stage.hpp"

namespace bolt::station {

inline constexpr int stiffness_levels = 10;          // the last one has the stiffness that the arm reports
inline constexpr double stiffness_level_time = 1.0;  // s
inline constexpr double trial_force_share = 0.2;     // of the arm's largest force; the trial renders no more

// The reason for the end of a trial.
enum class TrialEnd : std::uint8_t {
    none,                  // it continues
    rendered_as_reported,  // the arm renders the stiffness that it reports
    oscillation,           // an oscillation that a step of the spring has excited does not decay
    energy,                // a spring at rest gives energy to the hand
    fault,                 // the output stage has blocked the force (Fault)
};

struct StiffnessTrial {
    force::OutputLimits limits;  // of the arm, with the trial's lower force and no torque
    Vec3 direction{0.0};         // unit, along which the spring steps
    force::OutputStage output_stage;

    TrialEnd end = TrialEnd::none;
    force::Fault fault = force::Fault::none;  // for TrialEnd::fault
    int level = 0;                            // the present level, 0 … stiffness_levels − 1
    double stable = 0.0;                      // N/m, largest stiffness that has passed; 0: none

    // s from the first command of a step until the handle has moved visibly, one for each level at which it
    // has moved. Includes the inertia of arm and hand.
    std::vector<double> responses;

    // The present level:
    double time = 0.0;               // s since its step; 0: the force still ramps up
    Vec3 centre{0.0}, offset{0.0};   // m, spring centre before the step, and the step
    std::optional<double> moved_at;  // s from the step until the handle moved visibly
    std::vector<Vec3> early, late;   // m, positions right after the step and at the end of the level
    double generated = 0.0;          // J that the spring has given to the hand in the late part
    double energy_before = 0.0;      // J, stored at the last sample
    bool has_centre = false;
};

// `arm` must render a force along at least one axis.
StiffnessTrial begin_stiffness_trial(const device::Description& arm);

// One tick of dt. Returns the command for the arm. The trial advances only while `input.dead_man` is set;
// after an interruption the level begins again. After the end the command falls to zero.
force::OutputCommand step(StiffnessTrial& trial, const force::DeviceInput& input, double dt);

// The stiffness of a level, N/m.
double stiffness_of(const StiffnessTrial& trial, int level);

// The median of the responses, s; none: no step has moved the handle.
std::optional<double> median_response(const StiffnessTrial& trial);

}  // namespace bolt::station
