// The result of a contact query does not depend on earlier queries: long paths of a tool among bodies that
// move, rotate and are switched on and off, compared with queries on an empty cache.
#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "haptics/collision/narrow_phase.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/sanitized.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

namespace {

bool same(const Contact& a, const Contact& b) {
    return a.distance == b.distance && a.on_tool == b.on_tool && a.on_obstacle == b.on_obstacle &&
           a.normal == b.normal && a.obstacle == b.obstacle && a.feature == b.feature;
}

// Queries with a warm cache and, if `compare` is set, requires the same result from an empty cache.
class Twins {
  public:
    Twins(const CollisionWorld& world, const ToolShape& tool)
        : world_(world),
          tool_(tool),
          warm_(make_narrow_phase(world, tool)),
          cold_(make_narrow_phase(world, tool)) {}

    std::size_t ask(const Pose& pose, double band, bool compare) {
        std::array<Contact, 32> a;
        const ContactQueryResult warm = find_contacts(world_, tool_, pose, band, warm_, a);
        if (!compare) return warm.count;
        std::array<Contact, 32> b;
        clear_cache(cold_, world_, tool_);
        const ContactQueryResult cold = find_contacts(world_, tool_, pose, band, cold_, b);
        REQUIRE(warm.count == cold.count);
        REQUIRE(warm.complete_within == cold.complete_within);
        REQUIRE(warm.truncated == cold.truncated);
        for (std::size_t i = 0; i < warm.count; ++i) REQUIRE(same(a[i], b[i]));
        ++compared;
        touching += warm.count > 0 ? 1 : 0;
        return warm.count;
    }

    int compared = 0, touching = 0;

  private:
    const CollisionWorld& world_;
    const ToolShape& tool_;
    NarrowPhaseState warm_, cold_;
};

// One sine per axis: the speed is bounded, and the incommensurable rates never repeat a pose.
Vec3 wave(double t, double phase) {
    return {std::sin(1.0 * t + phase), std::sin(1.618 * t + 2.0 * phase), std::sin(0.73 * t + 3.0 * phase)};
}

}  // namespace

TEST_CASE(
    "Narrow phase: a warm cache gives the same contacts among bodies that move and are switched on and off") {
    const ContactMesh still = casing().mesh();
    const ContactMesh block = box(Vec3(-4.0) * mm, Vec3(4.0) * mm).mesh();
    const ContactMesh round = ball(5.0 * mm, 12).mesh();
    const std::vector<Obstacle> obstacles{
        {ObstacleId::fixed(1), &still, {}, false},
        {ObstacleId::nut(2), &block, {Vec3(10.0, 26.0, 10.0) * mm, {}}, true},
        {ObstacleId::nut(3), &round, {Vec3(30.0, 24.0, 20.0) * mm, {}}, true},
        {ObstacleId::nut(4), &block, {Vec3(20.0, 40.0, 15.0) * mm, {}}, true}};
    const ContactMesh mine = wrench().mesh();
    const ToolShape tool = make_tool({&mine, 1}).value();
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CollisionWorld world = make_world(obstacles).value();
        Twins twins(world, tool);
        Random random(seed);
        const double phase = random.uniform(0.0, 6.0);
        for (int i = 0; i < (test::sanitized ? 600 : 3000); ++i) {
            const double t = 4e-3 * i;
            for (std::size_t b = 1; b < world.bodies.size(); ++b) {
                Body& body = world.bodies[b];
                if (b != 2) body.pose.position += 4e-5 * wave(0.7 * t, phase + static_cast<double>(b));
                if (b != 1) body.pose.orientation = rotation(0.5 * wave(0.3 * t, static_cast<double>(b)));
                if (random.chance(0.004)) body.enabled = !body.enabled;
            }
            const Pose pose{Vec3(20.0, 27.0, 15.0) * mm + 14.0 * mm * wave(t, phase),
                            rotation(1.5 * wave(0.37 * t, phase + 1.0))};
            // The width of the band varies as in the god-object's queries.
            const double band = random.chance(0.2) ? random.uniform(0.1, 5.0) * mm : 0.6 * mm;
            twins.ask(pose, band, random.chance(0.2));
        }
        CHECK(twins.touching > (test::sanitized ? 20 : 200));
    }
}

TEST_CASE("Narrow phase: one pose has the same contacts whichever path leads to it") {
    const ContactMesh still = casing().mesh();
    const Obstacle obstacle{ObstacleId::fixed(1), &still, {}, false};
    const CollisionWorld world = make_world({&obstacle, 1}).value();
    const ContactMesh mine = wrench().mesh();
    const ToolShape tool = make_tool({&mine, 1}).value();
    // Regression: the result at this pose once depended on the path.
    const Pose pose{Vec3(0.0163383333, 0.0236217280, 0.0167804633),
                    glm::normalize(Quat(0.2475874622, -0.0348768386, -0.9670378612, 0.0481853684))};
    Twins twins(world, tool);
    Random random(52);
    for (int way = 0; way < 100; ++way) {
        const Vec3 from = 4.0 * mm * random_direction(random);
        const Vec3 turn = 0.1 * random_direction(random);
        for (int i = 20; i > 0; --i)
            twins.ask({pose.position + from * (i / 20.0), rotation(turn * (i / 20.0)) * pose.orientation},
                      random.uniform(0.1, 2.0) * mm, false);
        twins.ask(pose, 0.6 * mm, true);
    }
    CHECK(twins.compared == 100);
    CHECK(twins.touching == 100);
}
