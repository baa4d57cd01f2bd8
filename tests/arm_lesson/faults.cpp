// Each fault of each emulated arm in the middle of a pull: the hand feels no more force within 20 ms, and the
// lesson is finished when the arm works again.
#include <doctest/doctest.h>

#include "tests/arm_lesson/played_lesson.hpp"
#include "tests/support/folder.hpp"

namespace arm_faults_test {

using namespace bolt;
using namespace bolt::test;

namespace {

constexpr double latest_release = 0.02;  // s after a fault, until which the hand feels no more force
constexpr double fault_time = 0.4;       // s
constexpr double patience = 60.0;        // s of the lesson

struct FaultOutcome {
    double limit = 0.0;           // N, of the arm
    double before = 0.0;          // N on the hand before the fault
    double released_after = 0.0;  // s from the fault until the last force on the hand, while it lasts
    double most = 0.0;            // N on the hand, at any time of the lesson
    double step = 0.0;            // N from one tick to the next while the force returns
    double again = 0.0;           // N on the hand after it was let go, while the fault lasts
    double back = -1.0;           // s from the end of the fault until the arm renders a force again
    double tool_moved = 0.0;      // m that the wrench moved during the fault
    bool finished = false;
};

bool pulls(const PlayedLesson& lesson, const HeldArm& arm) {
    return lesson.latest().output.joint >= 0 &&
           static_cast<double>(lesson.latest().output.wrench_torque) > 8.0 &&
           glm::length(arm.force().force) > 0.25 * lesson.layout().mover->limits.force;
}

FaultOutcome inject(HeldArm& arm, const ArmFault& fault) {
    const auto loaded = content::load_assembly("first-nut");
    REQUIRE(loaded.ok());
    const Folder folder;
    PlayedLesson lesson(arm, loaded.assembly, {}, folder / "session.boltwright");
    while (!pulls(lesson, arm) && !lesson.finished() && lesson.session().time() < patience) lesson.tick();
    FaultOutcome outcome;
    outcome.limit = lesson.layout().mover->limits.force;
    outcome.before = glm::length(arm.force().force);
    const Vec3 wrench = lesson.latest().output.constrained_tool.position;
    fault.begin();
    lesson.hand_rests = true;
    const double began = lesson.session().time();
    bool released = false;
    while (lesson.session().time() < began + fault_time) {
        lesson.tick();
        const double since = lesson.session().time() - began;
        if (!released && glm::length(arm.force().force) > 0.0) outcome.released_after = since;
        released = released || glm::length(arm.force().force) == 0.0;
        if (!fault.lasts && outcome.back < 0.0 && released && glm::length(arm.force().force) > 0.0)
            outcome.back = since;
        if (fault.lasts && released) outcome.again = std::max(outcome.again, glm::length(arm.force().force));
        outcome.tool_moved = std::max(
            outcome.tool_moved, glm::distance(lesson.latest().output.constrained_tool.position, wrench));
    }
    fault.end();
    const double ended = lesson.session().time();
    double last = glm::length(arm.force().force);
    while (!lesson.finished() && lesson.session().time() < ended + patience) {
        lesson.tick();
        const double force = glm::length(arm.force().force), since = lesson.session().time() - ended;
        if (since < 1.0) outcome.step = std::max(outcome.step, force - last);
        if (outcome.back < 0.0 && force > 0.0) outcome.back = since;
        lesson.hand_rests = since < 1.5;
        last = force;
    }
    outcome.most = lesson.felt().force;
    outcome.finished = lesson.finish().result.finished;
    return outcome;
}

void check_faults(HeldArm& arm) {
    for (const ArmFault& fault : arm.faults) {
        CAPTURE(fault.name);
        const FaultOutcome o = inject(arm, fault);
        MESSAGE(arm.name, ", ", fault.name, ": ", o.before, " N, last force ", 1e3 * o.released_after,
                " ms, most ", o.most, " N, back after ", o.back, " s, step ", o.step, " N, wrench moved ",
                1e3 * o.tool_moved, " mm");
        CHECK(o.before > 0.0);
        CHECK(o.released_after <= latest_release);
        CHECK(o.again == 0.0);
        CHECK(o.back > 0.0);
        CHECK(o.most <= o.limit * (1.0 + 1e-6));
        CHECK(o.step <= 0.1 * o.limit);
        CHECK(o.tool_moved < 0.005);
        CHECK(o.finished);
    }
}

}  // namespace

TEST_CASE("Arm faults: Force Dimension: the force ends within 20 ms, and the lesson is finished") {
    check_faults(*force_dimension_arm(false));
}
TEST_CASE("Arm faults: Haply: the force ends within 20 ms, and the lesson is finished") {
    check_faults(*haply_arm());
}
TEST_CASE("Arm faults: OpenHaptics: the force ends within 20 ms, and the lesson is finished") {
    check_faults(*open_haptics_arm());
}

}  // namespace arm_faults_test
