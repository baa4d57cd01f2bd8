// The largest stiffness that an arm renders stably (its Z-width), by bisection over hands and motions.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "tools/verify/arms/feel_runs.hpp"

namespace bolt::arm_validation {

enum class TestedSpring : std::uint8_t {
    contact,  // the coupling: wrench and casing
    nut,      // the wrench on a tightened nut, as torque or as force at the handle
};

// The search covers these factors on the stiffness in use. It stops when the ratio of an unstable to a stable
// factor is at most search_ratio.
inline constexpr double min_factor = 1.0 / 16.0, max_factor = 16.0, search_ratio = 1.06;

struct StableRange {
    double used = 0.0;    // N/m or N·m/rad as the device feels it
    double stable = 0.0;  // the largest stable one that was found; 0: even `min_factor` · used is unstable
    bool open = false;    // stable even at `max_factor`
};

struct RangeQuery {
    const ArmFacts* arm = nullptr;
    TestedSpring spring = TestedSpring::contact;
    bool controller = true;
    bool held = true;  // by a loose, a usual and a stiff hand; false: by no hand
};

// `presses`: of find_presses() for the same assembly. Assumes that a stiffer spring is never more stable: an
// unstable range between two tested factors stays unnoticed.
StableRange stable_range(TightenedAssembly& tightened, const RangeQuery& query,
                         std::span<const Press> presses);

}  // namespace bolt::arm_validation
