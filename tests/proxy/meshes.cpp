// The god-object with the mesh narrow phase. Brute force decides whether the tool penetrates.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/collision/narrow_phase.hpp"
#include "haptics/proxy/god_object.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/forbidden.hpp"

namespace proxy_meshes_test {

using namespace bolt;
using namespace bolt::collision;
using namespace bolt::proxy;

namespace {

constexpr double dt = 1e-3;

struct Bench {
    CollisionWorld world;
    ToolShape tool;
    NarrowPhaseState near;
    contact_test::ClosedSurface obstacle, moving;
    ContactMesh wrench;

    explicit Bench(const ContactMesh& mesh) : wrench(contact_test::wrench().mesh()) {
        const Obstacle still{ObstacleId::fixed(1), &mesh, {}, false};
        Result<CollisionWorld> made = make_world({&still, 1});
        REQUIRE(made);
        world = std::move(*made);
        Result<ToolShape> shape = make_tool({&wrench, 1}, {.samples = {.on_faces = 2000}});
        REQUIRE(shape);
        tool = std::move(*shape);
        near = make_narrow_phase(world, tool);
        obstacle = contact_test::surface_of(mesh);
        moving = contact_test::surface_of(wrench);
    }

    GodObjectStep step(const GodObjectParameters& p, GodObjectState& state, const Pose& device) {
        return step_god_object(
            p, state, device,
            [&](const Pose& pose, double band, std::span<Contact> out) {
                return find_contacts(world, tool, pose, band, near, out);
            },
            dt);
    }

    // Returns true if the tool penetrates by more than 0.1 mm.
    [[nodiscard]] bool deep(const Pose& pose) const {
        return contact_oracle::depth(obstacle, moving, pose, contact_oracle::from_50_um) > 1e-4;
    }
};

GodObjectParameters for_tool(const ToolShape& tool) {
    GodObjectParameters p;
    p.coupling = proxy::make_coupling({});
    p.radius = tool.origin_radius();
    return p;
}

}  // namespace

TEST_CASE("God-object on meshes: a wrench flicked at 2 m/s does not tunnel through a rib of 1 mm") {
    Bench bench(contact_test::box(Vec3(-0.5e-3, -0.2, -0.2), Vec3(0.5e-3, 0.2, 0.2)).mesh());
    const GodObjectParameters p = for_tool(bench.tool);
    Random random(21);
    int deep = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const Quat turn = random_turn(random);
        const Vec3 start(-0.03 - random.uniform(0.0, 2e-3), 0.0, 0.0);
        const Vec3 velocity =
            2.0 * glm::normalize(Vec3(1.0, random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)));
        GodObjectState state = start_god_object({start, turn});
        for (int i = 0; i < 60; ++i) {
            bench.step(p, state, {start + velocity * (i * dt), turn});
            for (const glm::vec3& v : bench.wrench.vertices)
                REQUIRE((state.constrained_tool * Vec3(v)).x < 0.0);
        }
        deep += bench.deep(state.constrained_tool) ? 1 : 0;
        CHECK(glm::length(state.rendered.force) > 15.0);
    }
    CHECK(deep == 0);
}

TEST_CASE("God-object on meshes: a wrench never penetrates a casing with a rib, pockets and sharp edges") {
    Bench bench(contact_test::casing().mesh());
    const GodObjectParameters p = for_tool(bench.tool);
    int touching = 0, deep = 0, most = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        const Vec3 start(0.02, 0.06, 0.015);
        GodObjectState state = start_god_object({start, random_turn(random)});
        const Quat turn = state.constrained_tool.orientation;
        Vec3 from = start, to = start;
        int left = 0, total = 1;
        for (int i = 0; i < 1500; ++i) {
            if (left == 0) {
                from = state.commanded_tool.position;
                to = Vec3(random.uniform(-0.01, 0.05), random.uniform(0.008, 0.03),
                          random.uniform(-0.01, 0.04));
                total = left =
                    static_cast<int>(glm::length(to - from) / (dt * random.uniform(0.05, 0.4))) + 1;
            }
            --left;
            Pose device{glm::mix(to, from, static_cast<double>(left) / total),
                        rotation(0.6 * Vec3(std::sin(3e-3 * i), std::sin(2e-3 * i), 0)) * turn};
            // A hand yields: it leads the tool by at most 8 mm, so it presses with no more than about 20 N.
            const Vec3 ahead = device.position - state.constrained_tool.position;
            device.position =
                state.constrained_tool.position + ahead * std::min(1.0, 8e-3 / (1e-9 + glm::length(ahead)));
            const GodObjectStep step = bench.step(p, state, device);
            REQUIRE(step.nearest > -1e-4);
            most = std::max(most, step.queries);
            if (step.contacts == 0) continue;
            ++touching;
            if (i % 5 == 0) deep += bench.deep(state.constrained_tool) ? 1 : 0;
        }
    }
    CHECK(touching > 2000);
    CHECK(most <= p.max_queries);
    CHECK(deep == 0);
}

TEST_CASE("God-object on meshes: a step makes no call that is forbidden in a tick") {
    Bench bench(contact_test::casing().mesh());
    const GodObjectParameters p = for_tool(bench.tool);
    GodObjectState state = start_god_object({Vec3(0.02, 0.06, 0.015), Quat(1, 0, 0, 0)});
    std::size_t most = 0;
    const test::Forbidden seen = test::forbidden_in([&] {
        for (int i = 0; i < 800; ++i) {
            const Vec3 at(0.02 + 0.01 * std::sin(5e-3 * i), 0.06 - 6e-5 * i, 0.015);
            most = std::max(most, bench.step(p, state, {at, state.commanded_tool.orientation}).contacts);
        }
    });
    CHECK(most > 0);
    CHECK(seen.all() == 0);
}

}  // namespace proxy_meshes_test
