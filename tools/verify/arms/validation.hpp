// All measurements of the validation, on several threads. Each run is independent and begins from the same
// state, so results do not depend on the number of threads.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tools/verify/arms/approaches.hpp"
#include "tools/verify/arms/stable_range.hpp"

namespace bolt::arm_validation {

// Stiffnesses of one kind of spring.
struct SpringResult {
    // `held`: held by a hand. `uncontrolled`: held, with the passivity controller off. `free`: not held.
    StableRange held, uncontrolled, free;
};

// The stable stiffnesses of one arm, and the worst outcomes of all motions at its announced limits.
struct ArmResult {
    const ArmFacts* arm = nullptr;
    SpringResult contact, nut;
    FeelOutcome held, free;
    double swing_at_rim = 0.0;  // m, late swing of a held jaw that hangs on the nut by its rim
};

// The worst outcome over the hands that hold the arm, or over the arm that no hand holds. A jaw on the nut's
// rim (Pull::slip_off) counts with its energy and its steps; its swing goes to `swing_at_rim`.
FeelOutcome feel_of(TightenedAssembly& tightened, const RigOptions& options, bool held,
                    std::span<const Press> presses, double& swing_at_rim);
// Runs everything for one arm on the calling thread, 10 s.
ArmResult measure(TightenedAssembly& tightened, const ArmFacts& arm);

struct ApproachResult {
    const ArmFacts* arm = nullptr;
    ApproachSummary free, guided;
};

struct ValidationOptions {
    std::string assembly = "zq350";
    std::vector<const ArmFacts*> arms;
    int approaches = 200;  // of each arm, with and without guiding; 0: none
    unsigned threads = 1;
};

struct ValidationResult {
    std::vector<ArmResult> arms;
    std::vector<ApproachResult> approaches;  // of those requested arms for which runs_approaches() is true
};

// True for the arms that run the approaches (approaches.hpp): one for each kind of arm.
bool runs_approaches(const ArmFacts& arm);
// Fails if the assembly cannot be loaded.
Result<ValidationResult> validate(const ValidationOptions& options);

}  // namespace bolt::arm_validation
