// Forty simulated arms press against forty walls, with one sample of delay and a quantised position. With the
// passivity controller the port delivers no net energy and the tool does not keep oscillating. Without it the
// same scenes are unstable, which shows that this test can fail.
//
// The walls are contact points on undamped springs, so only the output stage prevents oscillation.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "haptics/force/output_stage.hpp"
#include "tests/support/random_arm.hpp"
#include "tests/support/range.hpp"

namespace force_stability_test {

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double clear = 0.08;  // m, initial distance of the hand from the wall

// A tool with three contact points in front of a plane through the origin, or in the corner of two planes.
struct Scene {
    Vec3 points[3] = {Vec3(0.0, 0.012, 0.0), Vec3(0.01, -0.012, 0.004), Vec3(0.04, 0.0, 0.0)};
    Vec3 normals[2];
    int walls = 1;
    double stiffness = 1500.0;  // N/m of each contact
    Vec3 way{0.0};              // unit vector from the wall to the initial position of the hand
    double speed = 0.2;         // m/s of the hand's intended position
    double press = 5.0;         // N, intended force on the wall
    test::HandAndArmParameters arm;
};

Scene random_scene(std::uint64_t seed) {
    Random random(seed, 5);
    Scene s;
    s.arm = test::random_arm(random);
    const auto direction = [&] { return glm::normalize(normal_vector(random) + Vec3(0.0, 0.0, 1e-3)); };
    s.normals[0] = direction();
    s.walls = random.chance(0.5) ? 2 : 1;
    const Vec3 across = direction();
    s.normals[1] = glm::normalize(glm::cross(s.normals[0], across));
    s.way = s.walls == 2 ? glm::normalize(s.normals[0] + s.normals[1]) : s.normals[0];
    s.stiffness = random.uniform(1000.0, 3000.0);
    s.press = random.uniform(2.0, 12.0);
    s.speed = random.uniform(0.08, 0.4);
    return s;
}

ForceRequest wall_of(const Scene& scene, const Pose& tool) {
    ForceRequest request;
    for (int wall = 0; wall < scene.walls; ++wall) {
        const Vec3& n = scene.normals[wall];
        for (const Vec3& point : scene.points) {
            const Vec3 arm = tool.orientation * point;
            const double depth = -glm::dot(tool.position + arm, n);
            if (depth <= 0.0) continue;
            request.command.force += scene.stiffness * depth * n;
            request.command.torque += scene.stiffness * depth * glm::cross(arm, n);
            request.stored_energy += 0.5 * scene.stiffness * depth * depth;
        }
    }
    return request;
}

struct PressResult {
    double greatest_energy = 0.0, energy = 0.0;  // J delivered to the hand: maximum, and at the end
    double early_swing = 0.0, late_swing = 0.0;  // m, range of the tool's motion while the hand is still
};

enum class StoredEnergy { reported, omitted };

// The hand approaches, presses, shakes for half a second at 6 Hz and holds still for 1.5 s.
PressResult press_wall(const Scene& scene, const OutputLimits& limits, StoredEnergy energy, double dt) {
    test::ArmModel arm;
    arm.parameters = scene.arm;
    arm.parameters.delay = limits.delay;
    arm.pose.position = arm.intention.position = clear * scene.way;
    OutputStage stage;
    PressResult outcome;
    test::Range early, late;
    const int second = static_cast<int>(std::lround(1.0 / dt));
    for (int k = 0; k < 4 * second; ++k) {
        const double t = k * dt;
        double at = std::max(clear - scene.speed * t, -scene.press / scene.arm.stiffness);
        if (t > 2.0 && t < 2.5) at += 0.01 * std::sin(2.0 * pi * 6.0 * (t - 2.0));
        arm.intention.position = at * scene.way;
        DeviceInput input;
        input.pose = test::encoder_pose(arm);
        input.dead_man = true;
        ForceRequest request = wall_of(scene, input.pose);
        if (energy == StoredEnergy::omitted) request.stored_energy = 0.0;
        test::step(arm, render(limits, stage, input, request, dt), dt);
        outcome.greatest_energy = std::max(outcome.greatest_energy, arm.energy_to_hand);
        const double x = glm::dot(arm.pose.position, scene.way);
        if (t >= 2.6 && t < 2.9) early.add(x);
        if (t >= 3.7 && t < 4.0) late.add(x);
    }
    outcome.energy = arm.energy_to_hand;
    outcome.early_swing = early.width();
    outcome.late_swing = late.width();
    return outcome;
}

OutputLimits device() {
    OutputLimits limits;
    limits.ramp_up = 1e-3;  // so that the force is at full strength from the first tick
    return limits;
}

bool keeps_oscillating(const PressResult& outcome) {
    return outcome.late_swing > 50e-6 && outcome.late_swing > 0.3 * outcome.early_swing;
}

}  // namespace

TEST_CASE("Stability: no net energy and no lasting oscillation for forty arms and walls") {
    for (const double dt : {1e-3, 0.25e-3}) {
        double most = 0.0;
        for (std::uint64_t seed = 0; seed < 40; ++seed) {
            CAPTURE(seed);
            CAPTURE(dt);
            const Scene scene = random_scene(seed);
            const PressResult outcome = press_wall(scene, device(), StoredEnergy::reported, dt);
            CHECK(outcome.energy <= 0.0);
            CHECK(outcome.greatest_energy <=
                  5e-3);  // transient, because a slew-limited force cannot recover the energy at once
            CHECK_FALSE(keeps_oscillating(outcome));
            most = std::max(most, outcome.greatest_energy);
        }
        MESSAGE("dt ", dt, ": most energy that was out at any time, mJ: ", 1e3 * most);
    }
}

TEST_CASE("Stability: a wall of 1 N/mm is rendered with at least 0.8 N/mm for every hand") {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        CAPTURE(seed);
        Scene scene = random_scene(seed);
        scene.arm.friction = 0.0;  // friction would carry a part of the force
        test::ArmModel arm;
        arm.parameters = scene.arm;
        OutputStage stage;
        // Press with 3 N, then 5 N, for three seconds each. The stiffness is the difference of force over the
        // difference of penetration.
        const Vec3& n = scene.normals[0];
        double depth_at[2] = {}, force_at[2] = {};
        for (int k = 0; k < 6000; ++k) {
            const int level = k / 3000;
            arm.intention.position = -(level == 0 ? 3.0 : 5.0) / scene.arm.stiffness * n;
            DeviceInput input;
            input.pose = test::encoder_pose(arm);
            input.dead_man = true;
            const double depth = std::max(0.0, -glm::dot(input.pose.position, n));
            const ForceRequest request{{1000.0 * depth * n, Vec3(0.0)}, 500.0 * depth * depth};
            test::step(arm, render(device(), stage, input, request, 1e-3), 1e-3);
            if (k % 3000 < 2500) continue;
            depth_at[level] -= glm::dot(arm.pose.position, n) / 500.0;
            force_at[level] +=
                scene.arm.stiffness * glm::dot(arm.pose.position - arm.intention.position, n) / 500.0;
        }
        CHECK((force_at[1] - force_at[0]) / (depth_at[1] - depth_at[0]) >= 800.0);
    }
}

TEST_CASE("Stability: the result is as stable if requests omit the springs' stored energy") {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        CAPTURE(seed);
        const PressResult outcome = press_wall(random_scene(seed), device(), StoredEnergy::omitted, 1e-3);
        CHECK(outcome.energy <= 0.0);
        CHECK(outcome.greatest_energy <= 2e-3);
        CHECK_FALSE(keeps_oscillating(outcome));
    }
}

TEST_CASE("Stability: without the controller most cases generate energy and many oscillate") {
    OutputLimits uncontrolled = device();
    uncontrolled.damping = uncontrolled.angular_damping = 0.0;
    int active = 0, oscillating = 0;
    double most = 0.0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const PressResult outcome =
            press_wall(random_scene(seed), uncontrolled, StoredEnergy::reported, 1e-3);
        active += outcome.energy > 0.0;
        oscillating += keeps_oscillating(outcome);
        most = std::max(most, outcome.energy);
    }
    CHECK(active >= 20);
    CHECK(oscillating >= 10);
    CHECK(most > 1.0);
    MESSAGE("energy came out of ", active, ", ", oscillating, " tremble on; the worst, J: ", most);
}

}  // namespace force_stability_test
