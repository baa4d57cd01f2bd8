// An assembly with contact simulation, and motions of the hand that holds the wrench.
#pragma once

#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"

namespace bolt::test {

struct Workbench {
    content::Assembly assembly;
    servo::Setup setup;
    servo::State state;

    explicit Workbench(const char* name, const force::OutputLimits& limits = {});
    explicit Workbench(content::Assembly lesson, const force::OutputLimits& limits = {});

    // Pose of a wrench whose jaw is `above` (m) the middle of a nut and `beside` its axis (m along e1 and
    // e2), aligned with its flats except for `misfit` rad. Among the six possible angles it takes the one
    // whose handle is nearest to `towards`.
    [[nodiscard]] Pose wrench(std::size_t joint, double above, double misfit = 0.0,
                              const Vec3& beside = Vec3(0.0), const Vec3& towards = Vec3(0, 0, 1)) const;
    servo::Output step(const Pose& hand, servo::Grip grip = servo::Grip::wrench);
};

// The turned part of the joint B1, drawn as a prism on its seat: m, `sides` corners at `radius`.
struct PartOnPlate {
    const char* node;
    double radius = 0.0, height = 0.0;
    int sides = 6;
};

// A plate with its upper face at y = 0, and the part on it. The socket of a head is closed form and not
// drawn.
assets::Model plate_with(const PartOnPlate& part);

// Moves the hand from one pose to another in a minimum-jerk motion. Calls `visit` with the output of every
// tick.
template <class Visit>
void sweep(Workbench& bench, const Pose& from, const Pose& to, double seconds, Visit&& visit) {
    const int ticks = static_cast<int>(seconds / bench.setup.dt);
    for (int i = 1; i <= ticks; ++i) {
        const double t = static_cast<double>(i) / ticks;
        const double s = minimum_jerk(t);
        visit(bench.step(
            {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)}));
    }
}

}  // namespace bolt::test
