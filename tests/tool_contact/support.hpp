// The ZQ350 with everything that its wrench can bump into, and hands that move it.
#pragma once

#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"

namespace bolt::test {

struct Workbench {
    content::Assembly assembly;
    servo::Setup setup;
    servo::State state;

    explicit Workbench(const char* name, const force::OutputLimits& limits = {});

    // A wrench whose jaw is `above` the middle of a nut and `beside` its axis (m along e1 and e2), lying on
    // its flats but for `misfit` rad; of the six ways round, the one whose handle is nearest to `towards`.
    [[nodiscard]] Pose wrench(std::size_t joint, double above, double misfit = 0.0,
                              const Vec3& beside = Vec3(0.0), const Vec3& towards = Vec3(0, 0, 1)) const;
    servo::Output step(const Pose& hand, servo::Grip grip = servo::Grip::wrench);
};

// From one pose to another in a minimum-jerk motion; `look` sees every tick.
template <class Look>
void sweep(Workbench& bench, const Pose& from, const Pose& to, double seconds, Look&& look) {
    const int ticks = static_cast<int>(seconds / bench.setup.dt);
    for (int i = 1; i <= ticks; ++i) {
        const double t = static_cast<double>(i) / ticks;
        const double s = minimum_jerk(t);
        look(bench.step(
            {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)}));
    }
}

}  // namespace bolt::test
