// A tool that is too weak for a pull bends, and the lesson reports it.
#include <doctest/doctest.h>

#include <algorithm>

#include "game/lesson/judge.hpp"
#include "game/motion/path_planning.hpp"
#include "game/session/lesson_session.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::lesson::bent_tool {

namespace {

content::Assembly cover() {
    content::LoadedAssembly loaded = content::load_assembly(content::assembly_folder("cover-m8").string());
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

}  // namespace

TEST_CASE("Bent tool: a tool bends at a fifth above its test torque, but not in older sessions") {
    const content::Assembly assembly = cover();
    // ISO 1711-1: 64.5 N·m for an open end of 13 mm.
    CHECK(session::prepare_session(assembly, {}).value().setup.wrench.yield_torque == doctest::Approx(77.4));
    session::LessonOptions older;
    older.rules.tools_yield = session::ToolYield::no_law;
    const auto rigid = session::prepare_session(assembly, older);
    CHECK(rigid.value().setup.wrench.yield_torque == 0.0);
    for (const servo::ToolSetup& tool : rigid.value().setup.tools) CHECK(tool.wrench.yield_torque == 0.0);
    // The published law has the torques of an M16 bolt for every size.
    session::LessonOptions published;
    published.law = joint::Law::published;
    CHECK(session::prepare_session(assembly, published).value().setup.wrench.yield_torque == 0.0);
    published.rules.tools_yield = session::ToolYield::all_laws;
    CHECK(session::prepare_session(assembly, published).value().setup.wrench.yield_torque > 0.0);
}

TEST_CASE(
    "Bent tool: the smallest keys yield where Unbrako's do, and one of 6 mm bears a screw of class 12.9") {
    content::WrenchDesign key;
    key.kind = content::ToolKind::hex_key;
    key.head = content::ToolHeadKind::hex_key;
    key.size = 2.0 * mm;  // of sizes in the table, scaled by the cube: 1.02 N·m at 1.5 mm
    CHECK(tool_models::yield_torque(key) == doctest::Approx(1.02 * 8.0 / 3.375).epsilon(0.2));
    key.size = 6.0 * mm;
    CHECK(tool_models::yield_torque(key) > 43.0);  // M8 of class 12.9, µ 0.12
    CHECK(tool_models::yield_torque(key, tool_models::KeyStrength::first_yield) ==
          doctest::Approx(0.188 * 216e-9 * 750e6));
}

TEST_CASE("Bent tool: it transmits no more than its yield torque, and each hold that bends it costs points") {
    const content::Assembly assembly = cover();
    auto at = session::prepare_session(assembly, {});
    REQUIRE(at);
    constexpr double limit = 12.0;  // N·m
    at->setup.wrench.yield_torque = limit;
    while (at->state.joints[0].clamp < 9000.0)
        joint::turn_nut(at->setup.group, at->state.joints, 0, at->state.joints[0].nut.angle + 1e-4, 1.0,
                        1e-3);
    at->state.joints[0].nut.speed = 0.0;
    Lesson lesson = begin(assembly, Mode::practice, Task::tighten);
    world::World world;
    world::add_haptics(world, at->state);
    const servo::NutGeometry& nut = at->setup.nuts[0];
    const double start = at->state.joints[0].rotation() + nut.sense * at->setup.wrench.head_angle;
    servo::TickInput input;
    input.dead_man = true;
    double turned = 0.0, highest = 0.0;
    const auto turn = [&](double degrees, servo::Grip grip) {
        input.grip = grip;
        for (int i = 0; i < 500; ++i) {
            turned += to_radians(degrees) / 500.0;
            const double angle = at->state.joints[0].nut.angle;
            input.commanded_tool = servo::to_commanded_tool(
                {servo::nut_centre(nut, angle), motion::tool_orientation(nut, start + turned, false)});
            const servo::Output output = servo::tick(at->setup, at->state, input);
            highest = std::max(highest, std::abs(output.wrench_torque));
            world::write_haptics(world, {at->state, input, output});
            observe(lesson, world);
        }
    };
    const auto reported = [&] {
        return std::count_if(lesson.events.begin(), lesson.events.end(), [](const LessonEvent& event) {
            return event.mistake == MistakeKind::tool_bent;
        });
    };
    const double nut_angle = at->state.joints[0].nut.angle;
    turn(15.0, servo::Grip::wrench);
    REQUIRE(at->state.engagement.joint == 0);
    CHECK(highest == doctest::Approx(limit).epsilon(1e-6));
    CHECK(at->state.joints[0].nut.angle == nut_angle);  // the nut needs more
    // The hand has turned through play and elastic deflection, and the rest has bent the tool.
    const double elastic = at->setup.wrench.half_play + limit / at->setup.wrench.stiffness;
    CHECK(at->state.bent == doctest::Approx(to_radians(15.0) - elastic).epsilon(0.02));
    CHECK(reported() == 1);
    const double bent = at->state.bent;
    turn(-5.0, servo::Grip::wrench);  // it springs back, and stays bent
    CHECK(std::abs(at->state.joints[0].torque) < 0.5 * limit);
    CHECK(at->state.bent == bent);
    const LessonResult result = judge(lesson, world, 1e-3);
    const auto deduction = std::find_if(result.reasons.begin(), result.reasons.end(), [](const Deduction& d) {
        return d.kind == DeductionKind::tool_bent;
    });
    REQUIRE(deduction != result.reasons.end());
    CHECK(deduction->points == -5.0);
}

TEST_CASE("Bent tool: corners that bear less yield before the tool") {
    servo::Wrench wrench;
    wrench.yield_torque = 100.0;
    wrench.stiffness = 1000.0;
    servo::Engagement engagement;
    engagement.joint = 0;
    engagement.grip = servo::Grip::wrench;
    engagement.hand_angle = 0.5;
    joint::NutDrive drive;
    drive.angle = 0.5;
    drive.torque_limit = 80.0;
    CHECK(servo::bend_tool(wrench, 0.0, drive, engagement) == 0.0);
    CHECK(drive.angle == 0.5);
    drive.torque_limit = 0.0;
    CHECK(servo::bend_tool(wrench, 0.0, drive, engagement) == doctest::Approx(0.4));
    CHECK(drive.angle == doctest::Approx(0.1));
    CHECK(engagement.hand_angle == doctest::Approx(0.1));
    CHECK(servo::bend_tool(wrench, 0.0, drive, engagement) == 0.0);
}

}  // namespace bolt::lesson::bent_tool
