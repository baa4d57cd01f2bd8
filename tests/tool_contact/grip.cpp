// Contact of the jaw with a nut: play, tilt, directions in which it comes off, slipping and engaging again.
// On the M8 cover and the ZQ350 with their own wrenches.
#include <algorithm>
#include <string>
#include <vector>

#include "engine/base/random.hpp"
#include "game/lesson/lesson.hpp"
#include "haptics/joint/nut.hpp"
#include "haptics/servo/engagement.hpp"
#include "tests/support/haptic_world.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

// Limit of the change of force per tick, as a share of the greatest force. The output stage limits a jump to
// 0.1, so a change below 0.095 is not a jump that it has limited.
constexpr double leap = 0.095;

// Depth, m, of the jaw in a hexagon that contact permits for one tick: the motion within a tick is
// linearised, and a penetration within the skin is only corrected in the next tick.
constexpr double deepest_allowed = 0.1e-3;

struct Watch {
    double step = 0.0, torque_step = 0.0, greatest = 0.0, deepest = 1.0;
    double contact_step = 0.0;  // N, change of the contact force before the output stage
    bool engaged = false, was_on = false;
    int slips = 0;
    Output last;
    Vec3 contact{0.0};
    bool first = true;

    void operator()(const test::Workbench& bench, const Output& o) {
        if (!first) {
            step = std::max(step, glm::length(o.force - last.force));
            torque_step = std::max(torque_step, glm::length(o.torque - last.torque));
        }
        const Vec3 felt = bench.state.tool_contact->god_object.rendered.force;
        if (!first) contact_step = std::max(contact_step, glm::length(felt - contact));
        contact = felt;
        first = false;
        greatest = std::max(greatest, glm::length(o.force));
        engaged = o.joint >= 0;
        was_on = was_on || engaged;
        if (o.slipped >= 0) ++slips;
        const ToolContact& t = *bench.state.tool_contact;
        for (std::size_t i = 0; i < t.shapes.size() && t.in_hand; ++i) {
            Pose to_nut = inverse(t.nut_poses[i]) * t.god_object.constrained_tool;
            if (static_cast<int>(i) == t.joint_at_head) {  // beyond the play the hexagon turns with the jaw
                const NutGeometry& nut = bench.setup.nuts[i];
                const double play = half_play(bench.setup.wrench, nut.across_flats, 0.0);
                const double off =
                    collision::head_fit(bench.setup.wrench.head, shape_of(nut), to_nut).misalignment;
                const Quat back = glm::angleAxis(off - std::clamp(off, -play, play), Vec3(0, 0, 1));
                to_nut = Pose{Vec3(0.0), back} * to_nut;
            }
            for (const collision::Convex& part : t.head)
                deepest = std::min(
                    deepest, collision::separation(part, t.shape_solids[i].front(), to_nut, 0.1).distance);
        }
        last = o;
    }
};

void move(test::Workbench& bench, Watch& watch, const Pose& from, const Pose& to, double seconds) {
    test::sweep(bench, from, to, seconds, [&](const Output& o) { watch(bench, o); });
}

void hold(test::Workbench& bench, Watch& watch, const Pose& pose, int ticks) {
    for (int i = 0; i < ticks; ++i) watch(bench, bench.step(pose));
}

// The wrench at the first nut, with its handle where there is room.
Pose at_nut(const test::Workbench& bench, double above, double misfit = 0.0, const Vec3& beside = Vec3(0.0)) {
    const Vec3 towards(0, 0, bench.assembly.name == "zq350" ? -1.0 : 1.0);
    return bench.wrench(0, above, misfit, beside, towards);
}

// Holds the wrench above the nut until the output is ramped up, and lowers it onto the nut.
Pose lower_onto_nut(test::Workbench& bench, Watch& watch, double above = 0.0) {
    const Pose high = at_nut(bench, 0.03), low = at_nut(bench, above);
    for (int i = 0; i < 600; ++i) bench.step(high);
    move(bench, watch, high, low, 0.5);
    hold(bench, watch, low, 50);
    return low;
}

Pose turned(const Pose& pose, const Vec3& about, double angle) {
    return {pose.position, glm::normalize(glm::angleAxis(angle, about) * pose.orientation)};
}

// Direction of the jaw's slot to the throat, in the assembly's frame.
Vec3 slot(const test::Workbench& bench, const Pose& pose) {
    const double head = bench.setup.wrench.head_angle;
    return pose.orientation * Vec3(std::cos(head), std::sin(head), 0.0);
}

}  // namespace

TEST_CASE("Jaw grip: on reversal the nut follows after the whole backlash") {
    for (const char* name : {"cover-m8", "zq350"}) {
        CAPTURE(name);
        test::Workbench bench(name);
        Watch watch;
        const Pose on = lower_onto_nut(bench, watch);
        REQUIRE(watch.engaged);
        const Vec3 axis = bench.setup.nuts[0].axis;
        const auto follows_at = [&](double from, double direction) {
            const double before = bench.state.joints[0].nut.angle;
            double angle = from;
            while (std::abs(bench.state.joints[0].nut.angle - before) < 1e-4 && std::abs(angle) < 1.0) {
                angle += direction * 2e-4;
                watch(bench, bench.step(turned(on, axis, -angle)));
            }
            return angle;
        };
        double forth = follows_at(0.0, 1.0);
        for (int i = 0; i < 200; ++i) {  // on to the edge of the play
            forth += 2e-4;
            watch(bench, bench.step(turned(on, axis, -forth)));
        }
        for (int i = 0; i < 200; ++i)
            watch(bench, bench.step(turned(on, axis, -forth)));  // until the nut rests
        const double back = follows_at(forth, -1.0);
        const double play = half_play(bench.setup.wrench, bench.setup.nuts[0].across_flats, 0.0);
        // The tolerance covers the wrench's deflection under the drag of the free nut, and the steps of this
        // test.
        CHECK(forth - back == doctest::Approx(2.0 * play).epsilon(0.05));
        CHECK(watch.engaged);
        CHECK(watch.step < leap * bench.setup.limits.force);
    }
}

TEST_CASE("Jaw grip: a jaw tilted by 10 degrees does not fit, at half of the possible tilt it does") {
    test::Workbench bench("cover-m8");
    for (const double degrees : {10.0, -10.0, 0.5}) {
        CAPTURE(degrees);
        Pose high = bench.wrench(0, 0.03), low = bench.wrench(0, 0.0);
        const Vec3 about = slot(bench, high);
        high = turned(high, about, to_radians(degrees));
        low = turned(low, about, to_radians(degrees));
        for (int i = 0; i < 50; ++i) bench.step(high, Grip::none);
        for (int i = 0; i < 600; ++i) bench.step(high);
        Watch watch;
        move(bench, watch, high, low, 0.6);
        hold(bench, watch, low, 100);
        CHECK(watch.engaged == (std::abs(degrees) < 1.0));
        CHECK(watch.deepest > -deepest_allowed);
        CHECK(watch.step < leap * bench.setup.limits.force);
    }
}

TEST_CASE("Jaw grip: on the nut the jaw is free upwards and out of its mouth, constrained otherwise") {
    const auto pulled = [](const Vec3& local, double far) {  // along the slot, across it, along the bolt
        test::Workbench bench("cover-m8");
        Watch watch;
        const Pose on = lower_onto_nut(bench, watch);
        REQUIRE(watch.engaged);
        const Vec3 axis = bench.setup.nuts[0].axis, along = slot(bench, on), across = glm::cross(axis, along);
        Pose to = on;
        to.position += far * (local.x * along + local.y * across + local.z * axis);
        Watch way;
        move(bench, way, on, to, 0.5);
        hold(bench, way, to, 30);
        CHECK(way.step < leap * bench.setup.limits.force);
        CHECK(way.deepest > -deepest_allowed);
        return std::pair{way, glm::dot(way.last.force, local.x * along + local.y * across + local.z * axis)};
    };
    const auto [up, up_force] = pulled({0, 0, 1}, 0.02);
    CHECK_FALSE(up.engaged);
    CHECK(up.greatest < 0.5);
    const auto [out, out_force] = pulled({1, 0, 0}, 0.04);  // along the handle
    CHECK_FALSE(out.engaged);
    CHECK(out.greatest < 1.5);
    for (const Vec3& held : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(-1, 0, 0)}) {
        const auto [way, force] = pulled(held, 5e-3);
        CHECK(way.engaged);
        CHECK(force < -5.0);
        // This causes no torque about the bolt.
        CHECK(way.last.wrench_torque == doctest::Approx(0.0).epsilon(0.05));
    }
}

TEST_CASE("Jaw grip: the nut resists tilting and releases the jaw square") {
    test::Workbench bench("zq350");
    Watch watch;
    const Pose on = lower_onto_nut(bench, watch);
    const Vec3 about = slot(bench, on);
    Watch way;
    for (const double side : {1.0, -1.0}) {
        const Pose over = turned(on, about, side * to_radians(3.0));
        move(bench, way, on, over, 0.3);
        CHECK(way.engaged);
        CHECK(glm::dot(way.last.torque, about) * side < -0.5);
        const double tilt = std::asin(
            glm::dot(bench.state.tool_contact->god_object.constrained_tool.orientation * Vec3(0, 0, 1),
                     glm::cross(bench.setup.nuts[0].axis, about)));
        CHECK(std::abs(to_degrees(tilt)) < 1.2);  // a jaw 24.2 mm wide and 10.8 mm high on 24 mm
        CHECK(std::abs(to_degrees(tilt)) > 0.5);
        move(bench, way, over, on, 0.3);
    }
    CHECK(glm::length(way.last.torque) < 0.05);
    CHECK(way.torque_step < 0.95 * bench.setup.limits.torque_slew_rate * bench.setup.dt);
}

TEST_CASE(
    "Jaw grip: with little overlap it slips at the corner torque, rounds the corners and engages 60 degrees "
    "on") {
    test::Workbench bench("cover-m8");
    REQUIRE(session::pretighten(bench.assembly, bench.setup, bench.state));
    const NutGeometry& nut = bench.setup.nuts[0];
    Watch watch;
    // Less than half a millimetre of overlap with the flats.
    const auto prism = std::get<collision::HexagonPrism>(shape_of(nut));
    const auto& jaw = std::get<collision::Jaw>(bench.setup.wrench.head);
    const double top = 0.5 * nut.height - prism.corner_drop() + jaw.half_flat();
    const Pose on = lower_onto_nut(bench, watch, top - 0.4e-3);
    REQUIRE(watch.engaged);
    const double overlap = bench.state.engagement.fit.overlap;
    CHECK(overlap == doctest::Approx(0.4e-3).epsilon(0.1));
    const double side = prism.half_side();
    const double corner_torque =
        joint::corner_torque(nut.corner_pressure, {overlap, side, side, 0.0, 1e-4, 0.0});
    CHECK(corner_torque > 3.0);
    CHECK(corner_torque < 12.0);
    const double stood = bench.state.joints[0].nut.angle;
    const int first = 900;
    double most = 0.0, lost = 0.0;
    world::World world = test::make_world(bench.state);
    lesson::Lesson lesson = lesson::begin(bench.assembly, lesson::Mode::guided, lesson::Task::tighten);
    std::string message;
    int slipped_at = -1, again_at = -1;
    Watch way;
    for (int i = 1; i <= 2 * first; ++i) {  // 90 degrees at 50 degrees a second
        const double angle = to_radians(0.05) * i;
        const Output o = bench.step(turned(on, nut.axis, -angle));
        way(bench, o);
        test::observe_tick(lesson, world, bench.state, o);
        for (const lesson::LessonEvent& event : lesson.events)
            if (event.text.find("slipped") != std::string::npos) message = event.text;
        lesson.events.clear();
        most = std::max(most, o.wrench_torque);
        if (o.slipped == 0) {
            CHECK(o.rounded > 0.0);
            if (slipped_at < 0) slipped_at = i;
            lost = o.rounded;
        }
        if (slipped_at >= 0 && o.joint == 0 && again_at < 0 && i > slipped_at) again_at = i;
    }
    CHECK(most == doctest::Approx(corner_torque).epsilon(0.1));
    REQUIRE(slipped_at > 0);
    CHECK(message.find("B1: the wrench slipped, 0.") == 0);
    CHECK(lost > 1e-6);
    CHECK(lost < side);
    CHECK(bench.state.rounded[0] >= lost);
    CHECK(bench.state.joints[0].nut.angle == doctest::Approx(stood).epsilon(1e-6));
    // At the next flat, 60 degrees on less the play.
    REQUIRE(again_at > slipped_at);
    CHECK(0.05 * again_at == doctest::Approx(60.0).epsilon(0.1));
    CHECK(way.torque_step < 0.95 * bench.setup.limits.torque_slew_rate * bench.setup.dt);
    CHECK(way.step < leap * bench.setup.limits.force);
}

TEST_CASE("Jaw grip: with full overlap it reaches the joint's torque and rounds nothing") {
    test::Workbench bench("cover-m8");
    REQUIRE(session::pretighten(bench.assembly, bench.setup, bench.state));
    Watch watch;
    const Pose on = lower_onto_nut(bench, watch);
    double most = 0.0;
    for (int i = 1; i <= 700; ++i) {
        const Output o = bench.step(turned(on, bench.setup.nuts[0].axis, -to_radians(0.01) * i));
        watch(bench, o);
        most = std::max(most, o.wrench_torque);
    }
    CHECK(most > 20.0);
    CHECK(watch.slips == 0);
    CHECK(bench.state.rounded[0] == 0.0);
    CHECK(watch.torque_step < 0.95 * bench.setup.limits.torque_slew_rate * bench.setup.dt);
}

TEST_CASE(
    "Jaw grip: under load the two flanks do not press against each other, so nothing rubs along the bolt") {
    test::Workbench bench("cover-m8");
    REQUIRE(session::pretighten(bench.assembly, bench.setup, bench.state));
    Watch watch;
    const Pose on = lower_onto_nut(bench, watch);
    const Vec3 axis = bench.setup.nuts[0].axis;
    const Pose loaded = turned(on, axis, -to_radians(5.0));
    move(bench, watch, on, loaded, 0.5);
    REQUIRE(watch.last.wrench_torque > 10.0);
    Pose up = loaded;
    up.position += 2e-3 * axis;
    Watch way;
    double rubs = 0.0;
    for (int i = 1; i <= 200; ++i) {
        const Output o = bench.step({glm::mix(loaded.position, up.position, i / 200.0), loaded.orientation});
        if (i > 60)  // clear of the washer, and the force of its contact has faded
            rubs = std::max(rubs, std::abs(glm::dot(o.force, axis)));
    }
    MESSAGE("along the bolt " << rubs << " N");
    CHECK(rubs < 0.1);
}

namespace {

// A random pose around the nut, mostly near it and mostly aligned.
Pose anywhere(const test::Workbench& bench, Random& random) {
    const double angle =
        random.uniform(0.0, 1.0) < 0.6 ? random.uniform(-0.02, 0.02) : random.uniform(-0.5, 0.5);
    const double near = random.uniform(0.0, 1.0) < 0.6 ? 0.3e-3 : 4e-3;
    Pose pose = bench.wrench(0, random.uniform(-2e-3, 0.02), angle,
                             {near * random.normal(), near * random.normal(), 0});
    const double tilt = random.uniform(0.0, 1.0) < 0.6 ? 0.01 : 0.1;
    return turned(pose, glm::normalize(Vec3(random.normal(), random.normal(), random.normal())),
                  tilt * random.normal());
}

Watch wander(std::uint64_t seed, int legs, std::vector<double>* trace = nullptr,
             bool invalidate_cache = false) {
    test::Workbench bench("cover-m8");
    Random random(seed);
    Pose at = bench.wrench(0, 0.03);
    for (int i = 0; i < 600; ++i) bench.step(at);
    Watch watch;
    for (int leg = 0; leg < legs; ++leg) {
        // An engaged wrench is mostly turned.
        const bool turns = watch.engaged && random.uniform(0.0, 1.0) < 0.6;
        const Pose to =
            turns ? turned(at, bench.setup.nuts[0].axis, random.uniform(-0.6, 0.6)) : anywhere(bench, random);
        const double way = glm::distance(at.position, to.position) + (turns ? 0.02 : 0.0);
        // The peak speed of a minimum-jerk motion is 1.875 times its mean.
        const double speed = random.uniform(0.05, 0.5), seconds = 1.875 * way / speed + 0.02;
        test::sweep(bench, at, to, seconds, [&](const Output& o) {
            watch(bench, o);
            if (invalidate_cache)
                bench.state.tool_contact->cache.nuts_unchanged =
                    bench.state.tool_contact->cache.meshes_unchanged = false;
            if (trace != nullptr) trace->insert(trace->end(), {o.force.x, o.torque.y, o.nut_angle});
        });
        at = to;
    }
    return watch;
}

}  // namespace

TEST_CASE(
    "Jaw grip: random motion on and around the nut at up to 0.5 m/s causes no jump and no penetration") {
    Watch all;
    for (std::uint64_t seed = 1; seed <= (test::sanitized ? 2 : 12); ++seed) {
        CAPTURE(seed);
        const Watch one = wander(seed, 60);
        CHECK(one.was_on);
        CHECK(one.deepest > -deepest_allowed);
        CHECK(one.contact_step < 0.1 * 20.0);
        all.step = std::max(all.step, one.step);
        all.contact_step = std::max(all.contact_step, one.contact_step);
        all.torque_step = std::max(all.torque_step, one.torque_step);
        all.deepest = std::min(all.deepest, one.deepest);
        all.slips += one.slips;
    }
    MESSAGE("greatest step " << all.step << " N (" << all.contact_step << " N of contact) and "
                             << all.torque_step << " N m, deepest " << all.deepest * 1e6 << " um, slips "
                             << all.slips);
}

TEST_CASE("Jaw grip: the same random motion gives the same bits") {
    std::vector<double> first, second;
    wander(3, 30, &first);
    wander(3, 30, &second);
    CHECK(first.size() > 1000);
    CHECK(first == second);
}

TEST_CASE("Contact cache: cached contacts are used only while they are valid") {
    std::vector<double> first, second;
    const Watch cached = wander(5, 40, &first);
    const Watch uncached = wander(5, 40, &second, true);
    CHECK(cached.was_on);
    CHECK(uncached.was_on);
    CHECK(first == second);
}
