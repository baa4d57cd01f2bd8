// The whole chain from contact to hand: forty arms, forty scenes, a god-object on a coupling and the output
// stage, with 1 sample of delay and an encoder. The energy is measured on the arm's side, without sampling.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "haptics/force/output_stage.hpp"
#include "tests/proxy/scene.hpp"
#include "tests/support/random_arm.hpp"
#include "tests/support/range.hpp"

using namespace bolt;
using namespace bolt::force;
using namespace bolt::test;

namespace {

enum class SceneKind : std::uint8_t { wall, corner, edge, row, ball };

struct Trial {
    Scene scene;
    SceneKind kind = SceneKind::wall;
    test::HandAndArmParameters arm;
    Vec3 from{0.0};  // m, start position of the hand
    double speed = 0.2, press = 5.0;
};

// Adds the points of a wrench: jaw tips, throat and handle. The origin is in the jaw.
void add_wrench(Scene& scene) {
    for (const double z : {-0.006, 0.006}) {
        for (const double y : {-0.02, 0.02}) {
            scene.points.emplace_back(0.018, y, z);
            scene.points.emplace_back(-0.02, y, z);
        }
        for (int i = 0; i <= 10; ++i)
            scene.points.emplace_back(-0.03 - 0.02 * i, 0.008 * (i % 2 == 0 ? 1 : -1), z);
    }
}

// The top of the obstacle is at z = 0, and the hand descends onto it.
Trial trial(std::uint64_t seed) {
    Random random(seed, 31);
    Trial t;
    t.arm = test::random_arm(random);
    t.kind = static_cast<SceneKind>(seed % 5);
    add_wrench(t.scene);
    switch (t.kind) {
        case SceneKind::wall:
            t.scene.obstacles.push_back(HalfSpace{{0, 0, 1}, 0.0});
            break;
        case SceneKind::corner:
            t.scene.obstacles.push_back(HalfSpace{{0, 0, 1}, 0.0});
            t.scene.obstacles.push_back(HalfSpace{{-1, 0, 0}, -0.03});
            break;
        case SceneKind::edge: {
            const test::Box box{{Vec3(0.1, 0.0, -0.05), Quat(1, 0, 0, 0)}, Vec3(0.1, 0.1, 0.05)};
            t.scene.obstacles.emplace_back(box);
            add_edges_as_pins(t.scene, box, 0.002);
            break;
        }
        case SceneKind::row:
            for (int i = -6; i <= 6; ++i)
                t.scene.obstacles.push_back(Rod{{0.03 * i, 0.0, -0.2}, {0.03 * i, 0.0, -0.008}, 0.008});
            break;
        case SceneKind::ball:
            t.scene.obstacles.push_back(Ball{{0.0, 0.0, -0.04}, 0.04});
            break;
    }
    t.from = Vec3(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0.06);
    t.speed = random.uniform(0.08, 0.4);
    t.press = random.uniform(2.0, 10.0);
    return t;
}

struct Outcome {
    double greatest_energy = 0.0, energy = 0.0;  // J out of the device: the maximum and the final value
    double early_swing = 0.0,
           late_swing = 0.0;  // m, of the jaw and the handle's end while the hand is at rest
    double deepest = 1.0;     // m
    bool touched = false;
};

GodObjectParameters coupled(double dt) {
    GodObjectParameters p;
    CouplingRange range;
    range.dt = dt;
    p.coupling = make_coupling(range);
    return p;
}

// The hand descends, presses, shakes mainly sideways for half a second at 6 Hz, and then rests.
Outcome run(const Trial& t, const GodObjectParameters& parameters, const OutputLimits& limits, double dt) {
    test::ArmModel arm;
    arm.parameters = t.arm;
    arm.parameters.delay = limits.delay;
    arm.pose.position = arm.intention.position = t.from;
    GodObjectState tool = start_god_object(arm.pose);
    OutputStage stage;
    Outcome outcome;
    Range early[2], late[2];
    const auto ticks = static_cast<int>(std::lround(5.0 / dt));
    for (int k = 0; k < ticks; ++k) {
        const double time = k * dt;
        Vec3 at = t.from;
        at.z = std::max(t.from.z - t.speed * time, -t.press / t.arm.stiffness);
        const double shake = time > 2.0 && time < 2.5 ? std::sin(2.0 * pi * 6.0 * (time - 2.0)) : 0.0;
        at += Vec3(0.01, 0.006, 0.004) * shake;
        arm.intention.position = at;
        DeviceInput input;
        input.pose = test::encoder_pose(arm);
        input.dead_man = true;
        step_god_object(parameters, tool, input.pose, t.scene, dt);
        const ForceRequest request{tool.rendered, stored_energy(parameters.coupling, tool.offset)};
        test::step(arm, render(limits, stage, input, request, dt), dt);
        outcome.greatest_energy = std::max(outcome.greatest_energy, arm.energy_to_hand);
        outcome.deepest = std::min(outcome.deepest, clearance(t.scene, tool.constrained_tool));
        outcome.touched = outcome.touched || glm::length(tool.rendered.force) > 0.2;
        const double places[] = {arm.pose.position.z, (arm.pose * Vec3(-0.23, 0, 0)).z};
        for (int i = 0; i < 2; ++i) {
            if (time >= 2.6 && time < 3.1) early[i].add(places[i]);
            if (time >= 4.5) late[i].add(places[i]);
        }
    }
    outcome.energy = arm.energy_to_hand;
    outcome.early_swing = std::max(early[0].width(), early[1].width());
    outcome.late_swing = std::max(late[0].width(), late[1].width());
    return outcome;
}

OutputLimits of_arm() {
    OutputLimits limits;
    limits.ramp_up = 1e-3;  // force from the first tick
    return limits;
}

bool keeps_oscillating(const Outcome& o) {
    return o.late_swing > 100e-6 && o.late_swing > 0.3 * o.early_swing;
}

}  // namespace

TEST_CASE("Stability: forty arms in forty scenes get no net energy and no sustained oscillation") {
    for (const double dt : {1e-3, 0.25e-3}) {
        double most = 0.0;
        int touched = 0;
        for (std::uint64_t seed = 0; seed < 40; ++seed) {
            CAPTURE(seed);
            CAPTURE(dt);
            const Outcome o = run(trial(seed), coupled(dt), of_arm(), dt);
            CHECK(o.energy <= 0.0);
            CHECK(o.greatest_energy <= 1e-3);
            CHECK_FALSE(keeps_oscillating(o));
            CHECK(o.deepest > -1e-4);
            touched += o.touched;
            most = std::max(most, o.greatest_energy);
        }
        CHECK(touched >= 39);  // the tool may miss the bolts of the row
        MESSAGE("dt ", dt, ": most energy that was out at any time, mJ: ", 1e3 * most);
    }
}

TEST_CASE("Stability: without the passivity controller energy is released and oscillation persists") {
    OutputLimits uncontrolled = of_arm();
    uncontrolled.damping = uncontrolled.angular_damping = 0.0;
    int active = 0, oscillating = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const Outcome o = run(trial(seed), coupled(1e-3), uncontrolled, 1e-3);
        active += o.energy > 0.0;
        oscillating += keeps_oscillating(o);
    }
    CHECK(active >= 10);
    CHECK(oscillating >= 5);
    MESSAGE("energy came out of ", active, ", ", oscillating, " tremble on");
}
