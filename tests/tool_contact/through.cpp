// A simulated hand cannot push the wrench through an obstacle. The depth is measured by the contact oracle,
// independently of the contact queries that constrain the wrench.
#include <algorithm>

#include "game/lesson/lesson.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/haptic_world.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tool_contact/support.hpp"
#include "tools/verify/contact/scene.hpp"

namespace tool_contact_through_test {

using namespace bolt;
using namespace bolt::servo;

namespace {

// The greatest depth, m, of the wrench in static obstacles. Contact with nuts belongs to the jaw
// (haptics/servo/engagement.hpp).
double depth_in_casing(const contact_validation::ContactScene& scene, const ToolContact& contact,
                       const Pose& wrench) {
    double most = 0.0;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        if (scene.parts[i].body != 0) continue;
        const Pose to_part = inverse(contact.world.bodies[0].pose) * wrench;
        most = std::max(most, contact_oracle::depth(scene.parts[i].surface, scene.tool, to_part,
                                                    contact_oracle::from_50_um));
    }
    return most;
}

// Pose with a corner of the wrench 0.5 mm below the centre of the largest triangle of the static obstacles.
Pose half_a_millimetre_in(const contact_validation::ContactScene& scene) {
    const auto part = std::find_if(scene.parts.begin(), scene.parts.end(),
                                   [](const contact_validation::ObstaclePart& p) { return p.body == 0; });
    const auto area = [](const geometry::Triangle& t) { return glm::length(geometry::normal_of(t)); };
    const std::vector<geometry::Triangle>& triangles = part->surface.tree.triangles();
    const geometry::Triangle& t = *std::max_element(
        triangles.begin(), triangles.end(), [&](const auto& a, const auto& b) { return area(a) < area(b); });
    const Vec3 at = (t.a + t.b + t.c) / 3.0 - 0.5e-3 * glm::normalize(geometry::normal_of(t));
    return {at - scene.tool.tree.triangles()[0].a, Quat(1, 0, 0, 0)};
}

}  // namespace

TEST_CASE("Tool contact: a clumsy hand never passes through the pipe flange, nor moves faster than a hand") {
    if (test::sanitized) return test::skip_rest("a round of the flange takes minutes under a sanitizer");
    test::Workbench bench("dn200-pn16");
    world::World world = test::make_world(bench.state);
    lesson::Lesson lesson = lesson::begin(bench.assembly, lesson::Mode::guided, lesson::Task::tighten);
    trainees::SimulatedTrainee hand(trainees::find_profile("clumsy").value(), 1, bench.setup);
    const contact_validation::ContactScene scene =
        contact_validation::make_scene(bench.state.tool_contact->world, bench.state.tool_contact->wrench);
    double depth = 0.0, fastest = 0.0;
    int samples = 0, faults = 0;
    Vec3 before(0.0);
    // Includes the first round with the wrench, after the nuts were run down by hand.
    while (lesson.due() != nullptr && samples < 500 && bench.state.tick < 10'000'000) {
        const TickInput input = hand.act(bench.setup, bench.state, lesson);
        const Output output = tick(bench.setup, bench.state, input);
        test::observe_tick(lesson, world, bench.state, output);
        lesson.events.clear();
        const Vec3 now(input.commanded_tool.position[0], input.commanded_tool.position[1],
                       input.commanded_tool.position[2]);
        if (bench.state.tick > 1) fastest = std::max(fastest, glm::length(now - before) / bench.setup.dt);
        before = now;
        if (output.fault != force::Fault::none) ++faults;
        if (!bench.state.tool_contact->in_hand || bench.state.tick % 100 != 0) continue;
        ++samples;
        depth = std::max(depth, depth_in_casing(scene, *bench.state.tool_contact, output.constrained_tool));
    }
    MESSAGE("deepest " << 1e6 * depth << " um, fastest " << fastest << " m/s");
    CHECK(samples == 500);
    CHECK(depth < 0.1e-3);
    CHECK(depth_in_casing(scene, *bench.state.tool_contact, half_a_millimetre_in(scene)) >
          0.4e-3);  // verifies that the check can fail
    CHECK(fastest < 2.0);
    CHECK(faults == 0);
}

}  // namespace tool_contact_through_test
