// The guide leads a hand to a nut around obstacles, with continuous force, and gives no force without a free
// path.
#include "haptics/force/guide.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/random.hpp"
#include "haptics/force/output_stage.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/random_arm.hpp"

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double dt = 1e-3;

// A box obstacle with the segment test of Kay and Kajiya (slabs).
struct Box {
    Vec3 low, high;
    [[nodiscard]] bool inside(const Vec3& p) const {
        return p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y && p.z > low.z && p.z < high.z;
    }
    [[nodiscard]] bool crosses(const Vec3& from, const Vec3& to) const {
        double begin = 0.0, end = 1.0;
        const Vec3 way = to - from;
        for (int k = 0; k < 3; ++k) {
            if (std::abs(way[k]) < 1e-15) {
                if (from[k] <= low[k] || from[k] >= high[k]) return false;
                continue;
            }
            const double a = (low[k] - from[k]) / way[k], b = (high[k] - from[k]) / way[k];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        }
        return begin < end;
    }
};

constexpr auto all_free = [](const Vec3&, const Vec3&) { return true; };

// A wall between the hand (x < 0) and the nut (x > 0); the free path leads over it.
const Box wall{Vec3(-0.05, -1.0, -1.0), Vec3(0.05, 0.25, 1.0)};
const auto over_the_wall = [](const Vec3& a, const Vec3& b) { return !wall.crosses(a, b); };

GuideTarget nut_at(const Vec3& point, int id = 0) {
    GuideTarget target;
    target.id = id;
    target.point = point;
    return target;
}

GuidedTool tool_at(const Vec3& position) {
    GuidedTool tool;
    tool.position = position;
    tool.normal = Vec3(0, 1, 0);
    return tool;
}

// Moves the hand in the direction of the force, at most at 0.2 m/s.
void follow(Vec3& hand, const Vec3& force) {
    const double pull = glm::length(force);
    if (pull > 0.0) hand += force * (std::min(0.2, 0.5 * pull) * dt / pull);
}

}  // namespace

TEST_CASE(
    "Guide: an unobstructed path is straight; a path past a wall leads over it, and each segment is free") {
    const GuideTarget target = nut_at(Vec3(0.2, 0, 0));
    CHECK(plan_path(Vec3(0.22, 0.3, 0), target, all_free).count == 2);
    CHECK(plan_path(Vec3(-0.2, 0.01, 0), target, all_free).count == 2);
    CHECK(plan_path(Vec3(-0.2, 0.1, 0), target, all_free).count == 3);
    // With no room above the nut the path is the slanted segment.
    const auto lid = [&](const Vec3& a, const Vec3& b) {
        return std::max(a.y, b.y) < 0.06 || std::min(a.x, b.x) < 0.1;
    };
    CHECK(plan_path(Vec3(-0.2, 0.05, 0), target, lid).count == 2);
    const GuidePath path = plan_path(Vec3(-0.2, 0, 0), target, over_the_wall);
    REQUIRE(path.count > 2);
    CHECK(path.points[0] == Vec3(-0.2, 0, 0));
    CHECK(path.points[path.count - 1] == target.point);
    for (std::size_t i = 1; i < path.count; ++i)
        CHECK_FALSE(wall.crosses(path.points[i - 1], path.points[i]));
    CHECK(length(path) < 1.3);
    for (double s = 0.0; s < length(path); s += 1e-3) REQUIRE_FALSE(wall.inside(point_at(path, s)));
    CHECK(point_at(path, 99.0) == target.point);
    CHECK(point_at(path, -1.0) == path.points[0]);
}

TEST_CASE("Guide: without a free path the plan is empty, after a bounded number of queries") {
    int asked = 0;
    const auto closed = [&](const Vec3&, const Vec3&) {
        ++asked;
        return false;
    };
    CHECK(plan_path(Vec3(-0.2, 0, 0), nut_at(Vec3(0.2, 0, 0)), closed).count == 0);
    // Worst case: only the segments at the target are blocked.
    int worst = 0;
    const auto nearly = [&](const Vec3& from, const Vec3&) {
        ++worst;
        return glm::length(from - Vec3(0.2, 0.08, 0)) > 1e-9 || worst < 3;
    };
    plan_path(Vec3(-0.2, 0, 0), nut_at(Vec3(0.2, 0, 0)), nearly);
    CHECK(asked <= 100);
    CHECK(worst <= 100);
}

TEST_CASE("Guide: the target's own nut is no obstacle, others before and behind it are") {
    const Box nut{Vec3(-0.012, -0.007, -0.012), Vec3(0.012, 0.02, 0.012)};
    const Box behind{Vec3(0.05, -0.1, -0.1), Vec3(0.06, 0.1, 0.1)};
    const auto free = [&](const Vec3& a, const Vec3& b) {
        return !nut.crosses(a, b) && !behind.crosses(a, b);
    };
    const GuideTarget target;
    const Vec3 hand(-0.2, 0.05, 0.0);
    CHECK_FALSE(free(hand, Vec3(0.0)));
    CHECK(free_to(hand, Vec3(0.0), target, free));
    CHECK(free_to(Vec3(0.01, 0, 0), Vec3(0.0), target, free));  // from inside the nut
    CHECK_FALSE(
        free_to(hand, Vec3(0.1, 0.0, 0.0), target, free));  // through the nut and the obstacle behind it
    CHECK_FALSE(free_to(Vec3(0.2, 0, 0), Vec3(0.0), target, free));  // from behind that obstacle
    CHECK(free_to(hand, Vec3(-0.1, 0.0, 0.0), target, free));        // to a point in front of the nut
    CHECK(free_to(Vec3(0.0), Vec3(0.04, 0, 0), target, free));       // out of the nut
}

TEST_CASE("Guide: the hand is led over a wall with continuous force that never points into the wall") {
    const GuidingParameters guiding;
    GuideState state;
    Vec3 hand(-0.2, 0, 0), last(0.0);
    const GuideTarget target = nut_at(Vec3(0.2, 0, 0));
    int arrived = 0;
    for (int i = 0; i < 20'000 && arrived < 500; ++i) {
        const ForceRequest request = guide(guiding, state, tool_at(hand), target, over_the_wall, dt);
        const Vec3& force = request.command.force;
        REQUIRE(glm::length(force) <= 3.0 + 1e-9);
        REQUIRE(glm::length(force - last) <= 0.35);
        last = force;
        // The next 10 mm along the force are free of the wall.
        if (glm::length(force) > 0.0)
            REQUIRE_FALSE(wall.crosses(
                hand, hand + glm::normalize(force) * std::min(0.01, glm::length(target.point - hand))));
        follow(hand, force);
        REQUIRE_FALSE(wall.inside(hand));
        arrived += glm::length(hand - target.point) < 2e-3;
    }
    CHECK(arrived == 500);
    CHECK(glm::length(last) < 1.0);  // near the equilibrium of the spring
}

TEST_CASE(
    "Guide: in free space the force is k over the distance after 0.25 s, and a torque aligns near the "
    "target") {
    const GuidingParameters guiding;
    GuideState state;
    const GuideTarget target = nut_at(Vec3(0.0));
    const Vec3 hand(0.02, 0.3, 0.0);
    ForceRequest request;
    for (int i = 1; i <= 250; ++i) {
        request = guide(guiding, state, tool_at(hand), target, all_free, dt);
        REQUIRE(state.force_share == doctest::Approx(i / 250.0));
    }
    CHECK(glm::length(request.command.force - guiding_force(guiding, hand, Vec3(0.0))) < 1e-12);
    CHECK(request.command.torque == Vec3(0.0));
    GuidedTool near = tool_at(Vec3(0.05, 0, 0));
    near.head_direction = glm::normalize(Vec3(1.0, 0.0, -0.1));
    for (int i = 0; i < 250; ++i) request = guide(guiding, state, near, target, all_free, dt);
    CHECK(glm::length(request.command.torque - aligning_torque(guiding.max_torque, target.hexagon,
                                                               near.head_direction, near.normal)) < 1e-12);
    CHECK(request.command.torque.y < 0.0);
}

TEST_CASE("Guide: the force scales with the strength and fades in 0.25 s after engagement") {
    GuidingParameters guiding;
    guiding.mode_share = 0.5;
    GuideState state;
    const GuideTarget target = nut_at(Vec3(0.0));
    const GuidedTool tool = tool_at(Vec3(0.1, 0, 0));
    ForceRequest request;
    for (int i = 0; i < 500; ++i) request = guide(guiding, state, tool, target, all_free, dt);
    CHECK(request.command.force.x == doctest::Approx(-0.5 * guiding.gain / 0.1));
    double last = glm::length(request.command.force);
    for (int i = 0; i < 125; ++i) {
        request = guide(guiding, state, tool, {}, all_free, dt);
        REQUIRE(glm::length(request.command.force) < last);
        last = glm::length(request.command.force);
    }
    CHECK(request.command.force == Vec3(0.0));
    guiding.mode_share = 0.0;
    for (int i = 0; i < 500; ++i)
        REQUIRE(guide(guiding, state, tool, target, all_free, dt).command.force == Vec3(0.0));
}

TEST_CASE("Guide: a new target waits until the old force has faded") {
    const GuidingParameters guiding;
    GuideState state;
    const GuidedTool tool = tool_at(Vec3(0.0));
    const GuideTarget left = nut_at(Vec3(-0.1, 0, 0), 0), right = nut_at(Vec3(0.1, 0, 0), 1);
    for (int i = 0; i < 500; ++i) guide(guiding, state, tool, left, all_free, dt);
    double last = -guiding.gain / 0.1;
    bool there = false;
    for (int i = 0; i < 600; ++i) {
        const double x = guide(guiding, state, tool, right, all_free, dt).command.force.x;
        REQUIRE(x >= last);
        REQUIRE(x - last < 0.0041);
        last = x;
        there = there || x > 0.0;
    }
    CHECK(there);
    CHECK(last == doctest::Approx(guiding.gain / 0.1));
}

TEST_CASE("Guide: an obstacle on the path fades the force, which then leads around it") {
    const GuidingParameters guiding;
    GuideState state;
    const GuideTarget target = nut_at(Vec3(0.2, 0, 0));
    const GuidedTool tool = tool_at(Vec3(-0.2, 0, 0));
    bool closed = false;
    const auto free = [&](const Vec3& a, const Vec3& b) { return !closed || over_the_wall(a, b); };
    Vec3 force(0.0);
    for (int i = 0; i < 500; ++i) force = guide(guiding, state, tool, target, free, dt).command.force;
    CHECK(force.x > 0.0);
    CHECK(std::abs(force.y) < 1e-12);
    closed = true;
    for (int i = 0; i < 1500; ++i) {
        const Vec3 now = guide(guiding, state, tool, target, free, dt).command.force;
        REQUIRE(glm::length(now - force) < 0.005);
        force = now;
    }
    CHECK(force.y > 0.0);  // over the wall
    const auto walled_in = [](const Vec3&, const Vec3&) { return false; };
    for (int i = 0; i < 500; ++i) force = guide(guiding, state, tool, target, walled_in, dt).command.force;
    CHECK(force == Vec3(0.0));
}

TEST_CASE("Guide: the force fades when the hand is stuck at a corner, and returns when a path exists") {
    const GuidingParameters guiding;
    GuideState state;
    const GuideTarget target = nut_at(Vec3(0.2, 0, 0));
    Vec3 hand(-0.2, 0, 0);
    bool closed = false;
    int asked = 0;
    const auto free = [&](const Vec3& a, const Vec3& b) {
        ++asked;
        return over_the_wall(a, b) && !(closed && (a.x > -0.15 || b.x > -0.15));
    };
    const auto lead = [&](int ticks) {
        bool off = false;
        for (int i = 0; i < ticks; ++i) {
            const ForceRequest request = guide(guiding, state, tool_at(hand), target, free, dt);
            follow(hand, request.command.force);
            off = off || (request.command.force == Vec3(0.0) && state.force_share == 0.0);
        }
        return off;
    };
    lead(10);
    REQUIRE(state.path.count > 2);
    closed = true;
    CHECK(lead(8000));
    CHECK(hand.x < -0.1);
    // Without a free path the search is repeated four times a second, not in every tick.
    asked = 0;
    lead(1000);
    CHECK(asked < 500);
    CHECK(asked > 0);
    closed = false;
    lead(20'000);
    CHECK(glm::length(hand - target.point) < 2e-3);
}

TEST_CASE("Guide: a descending nut is followed without a step of force") {
    const GuidingParameters guiding;
    GuideState state;
    GuideTarget target = nut_at(Vec3(0.0));
    const GuidedTool tool = tool_at(Vec3(0.02, 0.01, 0));
    Vec3 last(0.0);
    for (int i = 0; i < 1000; ++i) {
        target.point.y -= 2e-6;
        const Vec3 force = guide(guiding, state, tool, target, all_free, dt).command.force;
        REQUIRE(glm::length(force - last) < 0.0125);
        last = force;
    }
    CHECK(glm::length(last - guiding_force(guiding, tool.position, target.point)) < 1e-12);
}

TEST_CASE("Guide: a hand beside the nut is led up or level until it is near the nut's axis") {
    const GuidingParameters guiding;
    const GuideTarget target = nut_at(Vec3(0.0));
    int outside = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        CAPTURE(seed);
        Random random(seed, 4);
        const double about = 2.0 * pi * random.uniform(), aside = 0.03 + 0.3 * random.uniform();
        Vec3 hand(aside * std::cos(about), 0.02 + 0.2 * random.uniform(), aside * std::sin(about));
        GuideState state;
        Vec3 last(0.0);
        int arrived = 0;
        for (int i = 0; i < 10'000 && arrived < 100; ++i) {
            const Vec3 force = guide(guiding, state, tool_at(hand), target, all_free, dt).command.force;
            REQUIRE(glm::length(force - last) < 0.4);
            last = force;
            // Below the approach point and more than 6 degrees from the axis.
            if (hand.y < target.approach_height && std::hypot(hand.x, hand.z) > 4e-3 + 0.1 * hand.y) {
                REQUIRE(force.y > -0.05);
                ++outside;
            }
            follow(hand, force);
            arrived += glm::length(hand) < 2e-3;
        }
        CHECK(arrived == 100);
    }
    CHECK(outside > 5000);
}

TEST_CASE("Guide: the passivity controller does not count guiding work as generated energy") {
    // Passive arms without stiffness, which yield to the guiding force.
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        CAPTURE(seed);
        Random random(seed, 9);
        test::ArmModel arm;
        arm.parameters = test::random_arm(random);
        arm.parameters.stiffness = arm.parameters.angular_stiffness = 0.0;  // the hand yields
        arm.parameters.damping = std::min(arm.parameters.damping, 3.0);
        arm.parameters.friction = arm.parameters.angular_friction = 0.0;
        arm.pose.position = Vec3(-0.2, 0.02 * random.normal(), 0.05 * random.normal());
        arm.pose.orientation = rotation(Vec3(0.3 * random.normal(), 0.2, 0.3 * random.normal()));
        const GuideTarget target = nut_at(Vec3(0.2, 0, 0));
        const GuidingParameters guiding;
        GuideState state;
        OutputStage stage;
        const OutputLimits limits;
        for (int i = 0; i < 30'000; ++i) {
            DeviceInput port;
            port.pose = test::encoder_pose(arm);
            port.dead_man = true;
            const GuidedTool tool{port.pose.position, port.pose.orientation * Vec3(1, 0, 0),
                                  port.pose.orientation * Vec3(0, 1, 0)};
            const ForceRequest request = guide(guiding, state, tool, target, over_the_wall, dt);
            test::step(arm, render(limits, stage, port, request, dt), dt);
            REQUIRE(stage.watchdog.fault == Fault::none);
        }
        CHECK(glm::length(arm.pose.position - target.point) < 1e-3);
        CHECK(glm::length(arm.velocity) < 5e-3);
        CHECK(arm.energy_to_hand > 0.2);  // the guide does work on the hand
        CHECK(stage.passivity.removed < 0.15 * arm.energy_to_hand);
    }
}

TEST_CASE("Guide: guiding and planning do not allocate") {
    const GuidingParameters guiding;
    const GuideTarget target = nut_at(Vec3(0.2, 0, 0));
    CHECK(test::forbidden_in([&] {
              GuideState state;
              Vec3 hand(-0.2, 0, 0);
              for (int i = 0; i < 3000; ++i)
                  follow(hand, guide(guiding, state, tool_at(hand), target, over_the_wall, dt).command.force);
          }).all() == 0);
}
