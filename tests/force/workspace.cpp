#include "haptics/force/device_mapping.hpp"

#include <doctest/doctest.h>

#include <algorithm>
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
    w.rotation = rotation(any(random));
    w.scale = random.uniform(0.5, 5.0);
    w.power_ratio = random.chance(0.5) ? 1.0 : 1.0 / w.scale;
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
        CHECK(glm::length(now.position - tool.position - w.scale * (w.rotation * shift)) < 1e-12);
        CHECK(apart({now.position, glm::normalize(rotation(w.rotation * turn) * tool.orientation)}, now) <
              1e-12);
    }
}

TEST_CASE("WorkspaceMap: the clutch holds the tool, and releasing it moves nothing") {
    Random random(2);
    const WorkspaceMap w = any_workspace(random);
    Pose device{any(random), rotation(any(random))};
    WorkspaceState s = align_workspace(w, device, {any(random), rotation(any(random))});
    Pose last = s.commanded_tool;
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

TEST_CASE(
    "WorkspaceMap: an absolute mapping returns to the pose of the hand, a held wrench keeps its grasp") {
    Random random(5);
    for (const double lever_arm : {0.0, 0.2}) {
        CAPTURE(lever_arm);
        WorkspaceMap w = any_workspace(random);
        w.scale = 1.0;
        w.return_time = 0.1;
        const Pose device{any(random), rotation(any(random))}, tool{any(random), rotation(any(random))};
        WorkspaceState s;
        s.lever_arm = lever_arm;
        realign(w, s, device, tool);
        CHECK(apart(s.commanded_tool, tool) < 1e-12);
        for (int i = 0; i < 2000; ++i) (void)to_assembly(w, s, device, false, dt);
        const Pose hand{w.rotation * device.position, glm::normalize(w.rotation * device.orientation)};
        CHECK(glm::distance(lever_end(s, s.commanded_tool), hand.position) < 1e-6);
        const Quat expected = lever_arm == 0.0 ? hand.orientation : tool.orientation;
        CHECK(glm::length(turn_between(s.commanded_tool.orientation, expected)) < 1e-6);
    }
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
        CHECK(here == doctest::Approx(w.power_ratio * there).epsilon(1e-5).scale(1.0));
    }
}

TEST_CASE("WorkspaceMap: with power 1/scale forces are unchanged") {
    WorkspaceMap w;
    w.scale = 4.0;
    w.power_ratio = 0.25;
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
        CHECK(limits.force_slew_rate / limits.force ==
              doctest::Approx(device.force_slew_rate / device.force));
        CHECK(limits.torque_slew_rate / limits.torque ==
              doctest::Approx(device.torque_slew_rate / device.torque));
    }
}

TEST_CASE(
    "WorkspaceMap: the end of the lever arm follows the device and the tool turns about it; a new heading "
    "moves nothing") {
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        const WorkspaceMap w = any_workspace(random);
        const Pose device{any(random), rotation(any(random))}, tool{any(random), rotation(any(random))};
        WorkspaceState s;
        s.lever_arm = random.uniform(0.0, 0.4);
        realign(w, s, device, tool);
        CHECK(apart(to_assembly(w, s, device, false, dt), tool) < 1e-12);
        s.heading = glm::angleAxis(random.uniform(-3.0, 3.0), Vec3(0, 1, 0));
        realign(w, s, device, tool);
        CHECK(apart(to_assembly(w, s, device, false, dt), tool) < 1e-12);

        const Vec3 end = lever_end(s, tool), shift = 0.1 * any(random), turn = 0.5 * any(random);
        const Pose there{device.position + shift, glm::normalize(rotation(turn) * device.orientation)};
        const Pose now = to_assembly(w, s, there, false, dt);
        const Vec3 moved = s.heading * (w.rotation * shift);
        CHECK(glm::length(lever_end(s, now) - end - w.scale * moved) < 1e-12);
        CHECK(apart({now.position,
                     glm::normalize(rotation(s.heading * (w.rotation * turn)) * tool.orientation)},
                    now) < 1e-12);
        // Force at the end of the lever arm: the power at the device is `power_ratio` times the power there.
        const Vec3 force = any(random);
        CHECK(glm::dot(to_device(w, s, {force, Vec3(0.0)}).force, shift) ==
              doctest::Approx(w.power_ratio * s.force_share * w.scale * glm::dot(force, moved)));
    }
}

TEST_CASE(
    "Pivot: the handle points to the end of the lever arm, the jaw stays on an arc's centre, and the tilt is "
    "kept") {
    Random random(8);
    for (int i = 0; i < 200; ++i) {
        const Pivot pivot{any(random), glm::normalize(any(random))};
        const double length = random.uniform(0.1, 0.5), angle = random.uniform(-3.0, 3.0);
        // Square to the bolt, with the jaw on it.
        const Vec3 across = glm::normalize(glm::cross(pivot.axis, any(random)));
        const Pose held{
            pivot.centre,
            glm::normalize(glm::quat_cast(glm::dmat3(across, glm::cross(pivot.axis, across), pivot.axis)))};
        const Quat swung = glm::angleAxis(angle, pivot.axis);
        const Pose on_arc = pivoted(pivot, held, length, pivot.centre + length * (swung * across));
        CHECK(apart(on_arc, {pivot.centre, glm::normalize(swung * held.orientation)}) < 1e-9);
        // An end beside the arc moves the jaw along the handle, one above it along the bolt, and neither
        // tilts.
        const double out = random.uniform(-0.02, 0.02), up = random.uniform(-0.02, 0.02);
        const Pose off =
            pivoted(pivot, held, length, pivot.centre + (length + out) * (swung * across) + up * pivot.axis);
        CHECK(glm::length(off.position - pivot.centre - out * (swung * across) - up * pivot.axis) < 1e-9);
        CHECK(apart({Vec3(0.0), off.orientation}, {Vec3(0.0), on_arc.orientation}) < 1e-9);
        // On the axis there is no direction to point to.
        const Pose none = pivoted(pivot, held, length, pivot.centre + 0.1 * pivot.axis);
        CHECK(apart({Vec3(0.0), none.orientation}, {Vec3(0.0), held.orientation}) < 1e-12);
    }
}

TEST_CASE(
    "fitted_scale: a swing of 60 degrees fits an omega, a Touch and an Inverse3, and no scale is below 1") {
    const Vec3 omega(0.075), touch(0.080, 0.060, 0.035), inverse3(0.10), large(0.5), unknown(0.0);
    for (const Vec3& reach : {omega, touch, inverse3, large, unknown}) {
        for (const double length : {0.14, 0.23, 0.38, 0.4345}) {
            CAPTURE(reach.x);
            CAPTURE(length);
            const double scale = fitted_scale(reach, length);
            CHECK(scale >= 1.0);
            if (reach.x <= 0.0 || reach.x >= 0.5) {
                CHECK(scale == 1.0);
                continue;
            }
            // The arc of the handle's end in the device's frame, in the middle of the reach.
            const double radius = length / scale, middle = 0.5 * radius * (1.0 + std::cos(pi / 6.0));
            double widest = 0.0;
            for (int degrees = -30; degrees <= 30; ++degrees) {
                const double a = to_radians(degrees);
                const double x = radius * std::sin(a), z = radius * std::cos(a) - middle;
                widest = std::max({widest, std::abs(x) / reach.x, std::abs(z) / reach.z});
            }
            CHECK(widest <= 0.9 + 1e-12);
            if (scale > 1.0) CHECK(widest == doctest::Approx(0.9));
        }
    }
}

TEST_CASE(
    "rotated_half_workspace: the farthest point on each of the user's axes is at the edge of the device's "
    "reach") {
    Random random(12);
    const Vec3 reach(0.08, 0.06, 0.035);
    CHECK(rotated_half_workspace({1, 0, 0, 0}, reach) == reach);
    const Vec3 quarter = rotated_half_workspace(rotation(Vec3(0.0, 0.5 * pi, 0.0)), reach);
    CHECK(glm::length(quarter - Vec3(0.035, 0.06, 0.08)) < 1e-12);
    for (int i = 0; i < 200; ++i) {
        const Quat turn = random_turn(random);
        const Vec3 turned = rotated_half_workspace(turn, reach);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 end(0.0);
            end[axis] = turned[axis];
            const Vec3 at = glm::abs(glm::conjugate(turn) * end) / reach;
            CHECK(std::max({at.x, at.y, at.z}) == doctest::Approx(1.0));
        }
        CHECK(rotated_half_workspace(turn, Vec3(0.0)) == Vec3(0.0));
    }
}

}  // namespace force_workspace_test
