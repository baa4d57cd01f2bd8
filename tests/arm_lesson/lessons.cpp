// A whole lesson on each emulated arm.
#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/arm_lesson/played_lesson.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::test;

namespace {

content::Assembly assembly(const char* name) {
    auto loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return loaded.assembly;
}

void play(HeldArm& arm, const char* name, double limit) {
    const Folder folder;
    session::LessonOptions options;
    options.obstacles = session::Obstacles::if_any;
    PlayedLesson lesson(arm, assembly(name), options, folder / "session.boltwright");
    const bool trace = std::getenv("TRACE") != nullptr;
    std::size_t step = SIZE_MAX;
    while (!lesson.finished() && lesson.session().time() < limit) {
        lesson.tick();
        for (const auto& event : lesson.session().events())
            if (trace) MESSAGE(lesson.session().time(), " s, joint ", event.joint, ": ", event.text);
        if (trace && lesson.session().lesson().current != step) {
            step = lesson.session().lesson().current;
            MESSAGE(lesson.session().time(), " s: step ", step);
        }
    }
    const auto outcome = lesson.finish();
    const FeltForces& felt = lesson.felt();
    MESSAGE(arm.name, ": ", lesson.session().time(), " s, score ", outcome.result.score, ", scale ",
            lesson.layout().workspace.scale, ", force ", felt.force, ", on bolt ", felt.force_on_bolt,
            ", step ", felt.force_step, ", torque ", felt.torque_on_bolt, ", clutched ", felt.clutched,
            ", losses ", lesson.report().losses, ", jump ", felt.largest_tool_jump);
    CHECK(outcome.result.finished);
}

}  // namespace

TEST_CASE("Arm lesson: Force Dimension") {
    play(*force_dimension_arm(false), std::getenv("ASM") ? std::getenv("ASM") : "first-nut",
         std::getenv("LIMIT") ? atof(std::getenv("LIMIT")) : 120.0);
}
TEST_CASE("Arm lesson: Force Dimension with wrist") {
    play(*force_dimension_arm(true), std::getenv("ASM") ? std::getenv("ASM") : "first-nut",
         std::getenv("LIMIT") ? atof(std::getenv("LIMIT")) : 120.0);
}
TEST_CASE("Arm lesson: OpenHaptics") {
    play(*open_haptics_arm(), std::getenv("ASM") ? std::getenv("ASM") : "first-nut",
         std::getenv("LIMIT") ? atof(std::getenv("LIMIT")) : 120.0);
}

TEST_CASE("Arm lesson: Haply") {
    play(*haply_arm(), std::getenv("ASM") ? std::getenv("ASM") : "first-nut",
         std::getenv("LIMIT") ? atof(std::getenv("LIMIT")) : 120.0);
}
