// A locking nut is run down by fingers until the bolt's end reaches its insert, and then by the tool.
#include <doctest/doctest.h>

#include <algorithm>

#include "haptics/joint/fastener.hpp"
#include "tests/lesson/played_session.hpp"

namespace bolt::lesson::locking_nut {

namespace {

// The first nut with an insert that the bolt's end reaches after `free_turns` turns.
content::Assembly first_locking_nut(double free_turns) {
    content::LoadedAssembly loaded = content::load_assembly(content::assembly_folder("first-nut").string());
    REQUIRE(loaded.ok());
    joint::JointDesign& design = loaded.assembly.joints[0].design;
    const joint::LockingNut* const nut = joint::locking_nut(design.thread.size.name);
    REQUIRE(nut != nullptr);
    design.locking_insert = true;
    design.prevailing_torque = 0.5 * nut->most_on;
    const double at_seat = design.bolt_length - design.grip_length();
    design.start_gap = at_seat - 2.0 / 3.0 * nut->height + free_turns * design.thread.thread.pitch;
    return std::move(loaded.assembly);
}

}  // namespace

TEST_CASE("Locking nut: fingers turn it until the insert drags more than they can") {
    const content::Assembly assembly = first_locking_nut(4.0);
    const session::SessionSetup at = session::prepare_session(assembly, {}).value();
    const Lesson lesson = begin(assembly, Mode::guided, Task::tighten);
    const LessonStep& run_down = lesson.steps.front();
    REQUIRE(run_down.kind == StepKind::run_down);
    const joint::MechanisticParameters& nut = at.setup.group.joints[0];
    CHECK(nut.insert_angle == doctest::Approx(4.0 * 2.0 * pi).epsilon(1e-6));
    CHECK(uses_fingers(assembly, at.setup, run_down, 0.0));
    CHECK(uses_fingers(assembly, at.setup, run_down, nut.insert_angle));
    CHECK_FALSE(uses_fingers(assembly, at.setup, run_down, nut.insert_angle + nut.insert_ramp));
    // The drag of a nut without an insert is the same everywhere.
    content::Assembly all_metal = assembly;
    all_metal.joints[0].design.locking_insert = false;
    const session::SessionSetup metal = session::prepare_session(all_metal, {}).value();
    CHECK_FALSE(uses_fingers(all_metal, metal.setup, run_down, 0.0));
}

TEST_CASE("Locking nut: a simulated trainee changes from the fingers to the wrench, and finishes") {
    const content::Assembly assembly = first_locking_nut(4.0);
    for (const char* profile : {"expert", "novice", "clumsy"}) {
        CAPTURE(profile);
        const session::LessonOptions options;
        double by_fingers = 0.0, first_by_wrench = -1.0;  // rad
        const test::PlayedSession played = test::play_and_replay(
            assembly, options, profile, test::setup_from_memory(assembly, options),
            [&](const session::ReplayTick& tick) {
                if (tick.state.engagement.joint != 0) return;
                const double angle = tick.state.joints[0].nut.angle;
                if (tick.input.grip == servo::Grip::fingers)
                    by_fingers = std::max(by_fingers, angle);
                else if (tick.input.grip == servo::Grip::wrench && first_by_wrench < 0.0)
                    first_by_wrench = angle;
            });
        CHECK(played.result.finished);
        CHECK(played.mismatches == 0);
        CHECK(by_fingers > 4.0 * 2.0 * pi);
        CHECK(first_by_wrench > 4.0 * 2.0 * pi);
    }
}

}  // namespace bolt::lesson::locking_nut
