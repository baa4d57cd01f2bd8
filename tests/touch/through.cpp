// Whether a wrench ever goes through something, asked of the obstacles themselves and not of who holds it
// back.
#include <algorithm>

#include "game/lesson/lesson.hpp"
#include "game/operators/operator.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/touch/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

// m, signed, of the wrench's deepest corner in what stands still. Nuts are the jaw's (jaw_grip.hpp).
double deepest(const Touch& touch, const Pose& wrench) {
    double least = 1.0;
    const contact::Body& still = touch.world.bodies[0];
    const contact::Solid& solid = touch.world.shapes[still.shape].solid;
    for (const glm::vec3& corner : touch.wrench.solid.mesh.vertices) {
        const Vec3 at = wrench * Vec3(corner);
        contact::Side side;
        least = std::min(least, contact::near_point(solid, at, 5e-3, 0.0, {&side, 1}).distance);
    }
    return least;
}

}  // namespace

TEST_CASE("a clumsy hand at the pipe flange never goes through it, and no faster than hands go" *
          doctest::skip(test::sanitized)) {
    test::Workbench bench("dn200-pn16");
    lesson::Lesson lesson = lesson::begin(bench.assembly, lesson::Mode::guided, lesson::Task::tighten);
    operators::Operator hand(operators::find_profile("clumsy").value(), 1, bench.setup);
    double least = 1.0, fastest = 0.0;
    int asked = 0, faults = 0;
    Vec3 before(0.0);
    // Into the first round with the wrench; the nuts are run down by hand before.
    while (lesson.due() != nullptr && asked < 500) {
        const Input input = hand.act(bench.setup, bench.state, lesson);
        const Output output = tick(bench.setup, bench.state, input);
        lesson::observe(lesson, bench.state, output);
        lesson.events.clear();
        const Vec3 now(input.device.position[0], input.device.position[1], input.device.position[2]);
        if (bench.state.tick > 1) fastest = std::max(fastest, glm::length(now - before) / bench.setup.dt);
        before = now;
        if (output.fault != force::Fault::none) ++faults;
        if (!bench.state.touch->in_hand || bench.state.tick % 100 != 0) continue;
        ++asked;
        least = std::min(least, deepest(*bench.state.touch, output.tool));
    }
    MESSAGE("deepest " << 1e6 * least << " um, fastest " << fastest << " m/s");
    CHECK(asked == 500);
    CHECK(least > -0.1e-3);
    CHECK(fastest < 2.0);
    CHECK(faults == 0);
}
