// A hand that moves through the solid reducer with the wrench: the wrench stays outside, slides along the
// surfaces, and is not caught while a free pose nearer to the hand exists.
#include <algorithm>

#include "engine/base/random.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

constexpr double still = 1e-6;      // m and rad per tick
constexpr double clearance = 5e-3;  // m, at the beginning and end of a motion
constexpr int longest_stop = 150;   // ms

struct Puller {
    test::Workbench bench{"zq350"};
    Random random{0};

    [[nodiscard]] ToolContact& contact() { return *bench.state.tool_contact; }

    bool clear(const Pose& pose) {
        collision::clear_cache(contact().narrow_phase, contact().world, contact().wrench);
        std::array<collision::Contact, 1> any;
        return collision::find_contacts(contact().world, contact().wrench, pose, clearance,
                                        contact().narrow_phase, any)
                   .count == 0;
    }
    Pose anywhere() {
        const collision::BoundingBox& box = contact().world.shapes[contact().world.bodies[0].shape].solid.box;
        Pose pose;
        do {
            for (int k = 0; k < 3; ++k)
                pose.position[k] = random.uniform(box.low[k] - 0.05, box.high[k] + 0.05);
            pose.orientation =
                glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
        } while (!clear(pose));
        collision::clear_cache(contact().narrow_phase, contact().world, contact().wrench);
        return pose;
    }
};

}  // namespace

TEST_CASE("Tool contact: a wrench pulled through the reducer is never caught for long and never penetrates") {
    Puller puller;
    // With these seeds the wrench was once caught for a second or more, at features that the contact query
    // found from one side only.
    for (const std::uint64_t seed : {10U, 1U}) {
        if (test::sanitized && seed != 10) {
            test::skip_part("the second seed takes minutes under a sanitizer");
            continue;
        }
        CAPTURE(seed);
        puller.random = Random(seed, 5);
        Pose here = puller.anywhere();
        for (int i = 0; i < 3; ++i) puller.bench.step(here, Grip::none);
        int caught = 0, longest = 0;
        double deepest = 1.0;
        Pose before = here;
        const auto check = [&](const Output& output) {
            const proxy::GodObjectStep& step = puller.contact().last_step;
            const bool stays =
                glm::length(output.constrained_tool.position - before.position) < still &&
                glm::length(proxy::twist_between(before, output.constrained_tool).angular) < still;
            caught = step.cut_short && stays ? caught + 1 : 0;
            longest = std::max(longest, caught);
            if (output.contacts > 0) deepest = std::min(deepest, step.nearest);
            before = output.constrained_tool;
        };
        for (int leg = 0; leg < 3; ++leg) {
            const Pose next = puller.anywhere();
            test::sweep(puller.bench, here, next, 1.5, check);
            for (int i = 0; i < 200; ++i) check(puller.bench.step(next));
            here = next;
        }
        CHECK(longest < longest_stop);
        CHECK(deepest > -0.1e-3);
        MESSAGE("caught for " << longest << " ms at most, deepest " << 1e6 * deepest << " um");
    }
}
