#include "haptics/force/device_mapping.hpp"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>

#include "engine/base/random.hpp"

namespace force_workspace_test {

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double dt = 1e-3;

Vec3 any(Random& random) { return {random.normal(), random.normal(), random.normal()}; }

WorkspaceMap any_workspace(Random& random) {
    WorkspaceMap w;
    w.turn = rotation(any(random));
    w.scale = random.uniform(0.5, 5.0);
    w.power = random.chance(0.5) ? 1.0 : 1.0 / w.scale;
    return w;
}

double apart(const Pose& a, const Pose& b) {
    return glm::length(a.position - b.position) + glm::length(turn_between(b.orientation, a.orientation));
}

}  // namespace

TEST_CASE(
    "WorkspaceMap: the tool starts at the given pose and follows the scaled and rotated motion of the hand") {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const WorkspaceMap w = any_workspace(random);
        const Pose device{any(random), rotation(any(random))}, tool{any(random), rotation(any(random))};
        WorkspaceState s = align_workspace(w, device, tool);
        CHECK(apart(to_assembly(w, s, device, false, dt), tool) < 1e-12);
        const Vec3 shift = any(random), turn = 0.3 * any(random);
        const Pose there{device.position + shift, glm::normalize(rotation(turn) * device.orientation)};
        const Pose now = to_assembly(w, s, there, false, dt);
        CHECK(glm::length(now.position - tool.position - w.scale * (w.turn * shift)) < 1e-12);
        CHECK(apart({now.position, glm::normalize(rotation(w.turn * turn) * tool.orientation)}, now) < 1e-12);
    }
}

TEST_CASE("WorkspaceMap: the clutch holds the tool, and releasing it moves nothing") {
    Random random(2);
    const WorkspaceMap w = any_workspace(random);
    Pose device{any(random), rotation(any(random))};
    WorkspaceState s = align_workspace(w, device, {any(random), rotation(any(random))});
    Pose last = s.tool;
    bool clutch = false;
    double moved = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        if (random.chance(0.01)) clutch = !clutch;
        const Vec3 shift = 1e-3 * any(random), turn = 1e-3 * any(random);
        device.position += shift;
        device.orientation = glm::normalize(rotation(turn) * device.orientation);
        const Pose now = to_assembly(w, s, device, clutch, dt);
        const double way = apart(now, last);
        if (clutch) {
            REQUIRE(way == 0.0);
        } else {
            // Also in the tick that releases the clutch the tool moves no farther than the hand.
            REQUIRE(way <= (w.scale * glm::length(shift) + glm::length(turn)) * (1 + 1e-6) + 1e-12);
        }
        moved += way;
        last = now;
    }
    CHECK(moved > 1.0);
}

TEST_CASE("WorkspaceMap: an invalid sample is passed on and leaves the state unchanged") {
    const WorkspaceMap w;
    WorkspaceState s = align_workspace(w, {}, {Vec3(1, 2, 3), rotation(Vec3(0, 1, 0))});
    Pose broken;
    broken.position.y = std::numeric_limits<double>::quiet_NaN();
    for (const bool clutch : {false, true}) {
        CHECK(std::isnan(to_assembly(w, s, broken, clutch, dt).position.y));
        CHECK(apart(to_assembly(w, s, {}, clutch, dt), {Vec3(1, 2, 3), rotation(Vec3(0, 1, 0))}) < 1e-12);
    }
}

TEST_CASE("WorkspaceMap: the power at the device is the stated multiple of the power in the assembly") {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const WorkspaceMap w = any_workspace(random);
        const Pose device{any(random), rotation(any(random))};
        WorkspaceState s = align_workspace(w, device, {any(random), rotation(any(random))});
        const Vec3 v = any(random), omega = any(random);
        const double h = 1e-7;
        const Pose before = to_assembly(w, s, device, false, dt);
        const Pose after = to_assembly(
            w, s, {device.position + h * v, glm::normalize(rotation(h * omega) * device.orientation)}, false,
            dt);
        const Vec3 tool_v = (after.position - before.position) / h;
        const Vec3 tool_omega = turn_between(before.orientation, after.orientation) / h;
        const OutputCommand on_tool{any(random), any(random)};
        const OutputCommand on_hand = to_device(w, s, on_tool);
        const double there = glm::dot(on_tool.force, tool_v) + glm::dot(on_tool.torque, tool_omega);
        const double here = glm::dot(on_hand.force, v) + glm::dot(on_hand.torque, omega);
        CHECK(here == doctest::Approx(w.power * there).epsilon(1e-5).scale(1.0));
    }
}

TEST_CASE("WorkspaceMap: with power 1/scale forces are unchanged") {
    WorkspaceMap w;
    w.scale = 4.0;
    w.power = 0.25;
    const OutputCommand out = to_device(w, {}, {Vec3(1, 2, 3), Vec3(0, 4, 0)});
    CHECK(out.force == Vec3(1, 2, 3));
    CHECK(out.torque == Vec3(0, 1, 0));
}

TEST_CASE("WorkspaceMap: forces fade out and in with the clutch") {
    const WorkspaceMap w;
    WorkspaceState s;
    const OutputCommand pressed{Vec3(10, 0, 0), Vec3(0, 1, 0)};
    double last = 10.0;
    for (int i = 1; i <= 50; ++i) {
        to_assembly(w, s, {}, true, dt);
        const double now = to_device(w, s, pressed).force.x;
        CHECK(last - now == doctest::Approx(0.2));
        last = now;
    }
    CHECK(last == doctest::Approx(0.0).scale(1.0));
    for (int i = 0; i < 25; ++i) to_assembly(w, s, {}, false, dt);
    CHECK(to_device(w, s, pressed).force.x == doctest::Approx(5.0));
    CHECK(to_device(w, s, pressed).torque.y == doctest::Approx(0.5));
}

TEST_CASE("WorkspaceMap: a command at the device's limit is at the mapped limit") {
    Random random(4);
    for (int i = 0; i < 50; ++i) {
        const WorkspaceMap w = any_workspace(random);
        const OutputLimits device, limits = in_assembly(w, device);
        const Vec3 way = glm::normalize(any(random));
        const OutputCommand out = to_device(w, {}, {limits.force * way, limits.torque * way});
        CHECK(glm::length(out.force) == doctest::Approx(device.force));
        CHECK(glm::length(out.torque) == doctest::Approx(device.torque));
        // A spring of the permitted stiffness, compressed by 1 mm of tool motion.
        const double pressed =
            glm::length(to_device(w, {}, {limits.stiffness * 1e-3 * way, Vec3(0.0)}).force);
        CHECK(pressed / (1e-3 / w.scale) == doctest::Approx(device.stiffness));
        const double braked = glm::length(to_device(w, {}, {limits.damping * 0.1 * way, Vec3(0.0)}).force);
        CHECK(braked / (0.1 / w.scale) == doctest::Approx(device.damping));
        CHECK(limits.speed / w.scale == doctest::Approx(device.speed));
        CHECK(limits.jump / w.scale == doctest::Approx(device.jump));
        CHECK(limits.angular_speed == device.angular_speed);
        const OutputCommand turned = to_device(w, {}, {Vec3(0.0), limits.torsion * 0.01 * way});
        CHECK(glm::length(turned.torque) == doctest::Approx(0.01 * device.torsion));
        CHECK(limits.force_rate / limits.force == doctest::Approx(device.force_rate / device.force));
        CHECK(limits.torque_rate / limits.torque == doctest::Approx(device.torque_rate / device.torque));
    }
}

}  // namespace force_workspace_test
