#include "tools/verify/arms/stable_range.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::arm_validation {

namespace {

RigOptions rig_options(const RangeQuery& query, const NamedHandImpedance& hand, double factor) {
    RigOptions options;
    options.arm = query.arm;
    options.hand = hand;
    options.controller = query.controller;
    (query.spring == TestedSpring::contact ? options.coupling_factor : options.wrench_factor) = factor;
    return options;
}

bool stable_at(TightenedAssembly& tightened, const RangeQuery& query, std::span<const Press> presses,
               double factor) {
    for (const NamedHandImpedance& hand : hand_impedances()) {
        if (hand.unheld == query.held) continue;
        const RigOptions options = rig_options(query, hand, factor);
        if (query.spring == TestedSpring::nut) {
            if (!is_stable(run_pull(tightened, options, Pull::hold))) return false;
            continue;
        }
        for (const Press& press : presses)
            if (!is_stable(run_press(tightened, options, press))) return false;
    }
    return true;
}

double used_stiffness(TightenedAssembly& tightened, const RangeQuery& query) {
    const ArmRig rig(tightened, rig_options(query, hand_impedances()[usual_hand], 1.0));
    return query.spring == TestedSpring::contact ? rig.coupling_stiffness() : rig.nut_stiffness();
}

}  // namespace

StableRange stable_range(TightenedAssembly& tightened, const RangeQuery& query,
                         std::span<const Press> presses) {
    StableRange range;
    range.used = used_stiffness(tightened, query);
    const auto stable = [&](double factor) { return stable_at(tightened, query, presses, factor); };
    // Doubles or halves from the factor in use until the border lies between two factors.
    double good = 0.0, bad = 0.0;
    for (double factor = 1.0; factor <= max_factor; factor *= 2.0) {
        if (!stable(factor)) {
            bad = factor;
            break;
        }
        good = factor;
    }
    for (double factor = 0.5; good == 0.0 && factor >= min_factor; factor *= 0.5)
        stable(factor) ? good = factor : bad = factor;
    range.open = bad == 0.0;
    while (good > 0.0 && bad > good * search_ratio) {
        const double middle = std::sqrt(good * bad);
        (stable(middle) ? good : bad) = middle;
    }
    range.stable = good * range.used;
    return range;
}

}  // namespace bolt::arm_validation
