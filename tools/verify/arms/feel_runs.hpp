// A hand tests an arm with the wrench: it presses, shakes and rests on the casing, and pulls at a tightened
// nut. The criteria are those of tests/stability: no net energy out of the device, and no lasting trembling.
#pragma once

#include <string_view>
#include <vector>

#include "tools/verify/arms/arm_rig.hpp"

namespace bolt::arm_validation {

struct FeelOutcome {
    Record record;
    // Largest deviation, m, from a straight motion within 40 ms: of the point that the hand holds and, with
    // torque output, of a point 0.1 m from it. `early_swing`: right after the last motion of the hand;
    // `late_swing`: a second later.
    double early_swing = 0.0, late_swing = 0.0;
    bool touched = false;  // the hand felt the obstacle or the nut at least once
    bool held = true;      // by a hand
};

// Upper bounds, J, of the net energy out of the device: `max_energy` at any time; at the end of a run 0 with
// a hand, and without one `max_energy_of_free_arm`, the credit of the passivity controller.
inline constexpr double max_energy = 1e-3, max_energy_of_free_arm = force::max_credit;
inline constexpr double perceptible_swing = 100e-6;  // m

bool gives_energy(const FeelOutcome& outcome);
bool trembles(const FeelOutcome& outcome);
bool is_stable(const FeelOutcome& outcome);
// Returns the largest change of force or torque in a millisecond, % of the arm's limit; the greater of the
// two.
double step_percent(const FeelOutcome& outcome, const device::Description& arm);
// Returns the worse value of each member, and both swings of the outcome with the worse late swing.
FeelOutcome worse(const FeelOutcome& a, const FeelOutcome& b);

// A motion of the wrench onto the casing.
struct Press {
    std::string_view name;
    Pose start;             // of the wrench, in the assembly's frame; free
    Vec3 direction{0.0};    // unit
    double distance = 0.0;  // m from the start to the contact
};
inline constexpr std::uint64_t default_press_seed = 2018;
// Searches at random for one press of each kind: a level wrench onto the casing, a corner of its jaw, its
// handle over an edge, sideways against the casing, and near a bolt. Leaves out a kind that it does not find.
std::vector<Press> find_presses(TightenedAssembly& tightened, std::uint64_t seed = default_press_seed);

// A motion of the wrench on a nut.
enum class Pull : std::uint8_t {
    hold,       // pulls with less than the nut needs to turn, shakes, and rests
    breakaway,  // until the nut turns
    yield,      // until the bolt yields
    slip_off,   // with a jaw that holds the nut by its rim, until it slips off
};
inline constexpr std::string_view pull_names[] = {"hold", "breakaway", "yield", "slip off"};

// `options.tool` is ignored.
FeelOutcome run_press(TightenedAssembly& tightened, RigOptions options, const Press& press);
FeelOutcome run_pull(TightenedAssembly& tightened, RigOptions options, Pull pull);

}  // namespace bolt::arm_validation
