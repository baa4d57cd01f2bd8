// Whole guided lessons on the emulated arms.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/arm_lesson/played_lesson.hpp"
#include "tests/support/folder.hpp"

namespace arm_lessons_test {

using namespace bolt;
using namespace bolt::test;

namespace {

struct Played {
    session::LessonOutcome outcome;
    FeltForces felt;
    device::Description arm;
    double seconds = 0.0;
    std::uint64_t losses = 0;
};

content::Assembly assembly_of(const char* name) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

Played play(HeldArm& arm, const content::Assembly& assembly) {
    const Folder folder;
    session::LessonOptions options;
    options.obstacles = session::ObstacleUse::if_any;
    PlayedLesson lesson(arm, assembly, options, folder / "session.boltwright");
    constexpr double patience = 1800.0;  // s of the lesson
    while (!lesson.finished() && lesson.session().time() < patience) lesson.tick();
    Played played{lesson.finish(), lesson.felt(), *lesson.layout().mover, lesson.session().time(),
                  lesson.status().losses};
    const FeltForces& f = played.felt;
    MESSAGE(fmt::format(
        "{}, {}: {:.0f} s, score {:.0f}, {:.1f} N at most, {:.1f} N and {:.3f} N·m on bolts, {:.2f} N in a "
        "tick, clutched {} times",
        arm.name, assembly.name, played.seconds, played.outcome.result.score, f.force, f.force_on_bolt,
        f.torque_on_bolt, f.force_step, f.clutched));
    // The recording ends with the lesson.
    const auto reader = session::SessionReader::open(folder / "session.boltwright");
    REQUIRE(reader);
    CHECK(static_cast<double>(reader->tick_count()) * options.dt == doctest::Approx(played.seconds));
    return played;
}

void check(const Played& played) {
    const force::OutputLimits& limits = played.arm.limits;
    CHECK(played.outcome.result.finished);
    CHECK(played.losses == 0);
    CHECK(played.felt.force <= limits.force * (1.0 + 1e-6));
    CHECK(played.felt.torque <= limits.torque * (1.0 + 1e-6));
    // The station limits it to a tenth; a driver that fades the force of warm motors adds a little.
    CHECK(played.felt.force_step <= 0.11 * limits.force);
    // A tight joint is felt.
    CHECK(played.felt.force_on_bolt > 0.5 * limits.force);
    if (limits.torque > 0.0) CHECK(played.felt.torque_on_bolt > 0.5 * limits.torque);
}

}  // namespace

TEST_CASE("Arm lessons: a trainee finishes the reducer on each vendor's arm, with a score of 95 or more") {
    for (const auto& make : {+[] { return force_dimension_arm(false); }, +[] { return open_haptics_arm(); },
                             +[] { return haply_arm(); }}) {
        const Played played = play(*make(), assembly_of("zq350"));
        check(played);
        CHECK(played.outcome.result.score >= 95.0);
    }
}

TEST_CASE(
    "Arm lessons: a trainee finishes a cover on an arm with motors in its wrist, with a score of 95 or "
    "more") {
    const Played played = play(*force_dimension_arm(true), assembly_of("cover-m8"));
    check(played);
    CHECK(played.outcome.result.score >= 95.0);
}

TEST_CASE("Arm lessons: a trainee changes between tools of three lengths on an arm without torque") {
    content::Assembly pump = assembly_of("pump-32-160");
    std::erase_if(pump.passes, [](const content::Pass& pass) {
        return pass.kind == content::PassKind::recheck ||
               (pass.kind == content::PassKind::tighten && pass.fraction < 1.0);
    });
    // A nut of the ratchet, a socket head of the key, and a foot screw of the open end.
    for (content::Pass& pass : pump.passes) pass.order = {0, 8, 12};
    const auto arm = open_haptics_arm();
    const Played played = play(*arm, pump);
    check(played);
    CHECK(played.arm.limits.torque == 0.0);
}

// A mouse moves the hand, and its user corrects what he sees.
TEST_CASE("Arm lessons: a trainee finishes a nut and a cover on the simulated arm") {
    const Played nut = play(*simulated_arm(), assembly_of("first-nut"));
    check(nut);
    CHECK(nut.outcome.result.score >= 95.0);
    check(play(*simulated_arm(), assembly_of("cover-m8")));
}

}  // namespace arm_lessons_test
