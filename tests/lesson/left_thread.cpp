// Lessons with left-hand and right-hand threads, by simulated trainees, and their replay.
#include <doctest/doctest.h>

#include <algorithm>

#include "game/motion/path_planning.hpp"
#include "game/session/export.hpp"
#include "tests/lesson/left_threads.hpp"
#include "tests/lesson/played_session.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

namespace bolt::lesson::left_thread {

namespace {

struct Played {
    test::PlayedSession session;
    int wrong_turns = 0;  // ticks in which a pull turned the handle against the direction of the thread
    int pulls = 0;        // ticks in which a pull turned the nut
};

bool is_left(std::size_t joint) {
    return std::find(test::left_threads.begin(), test::left_threads.end(), joint) != test::left_threads.end();
}

// Plays the lesson of a file and replays its session from its own text.
Played play(const content::Assembly& cover, const char* profile, const session::LessonOptions& options) {
    Played played;
    Pose before;
    double angle_before = 0.0;
    int held = -1;
    const auto watch = [&](const session::ReplayTick& tick) {
        const servo::Output& out = tick.output;
        const bool pulls = out.joint >= 0 && out.joint == held && tick.input.grip == servo::Grip::wrench;
        if (pulls && std::abs(out.nut_angle - angle_before) > 1e-5) {
            const auto joint = static_cast<std::size_t>(out.joint);
            const Vec3 turn = turn_between(before.orientation, out.constrained_tool.orientation);
            // Seen against the axis, a turn about it is counter-clockwise.
            const double counter_clockwise = glm::dot(turn, tick.setup.nuts[joint].axis);
            const double tightening = is_left(joint) ? counter_clockwise : -counter_clockwise;
            ++played.pulls;
            if (tightening * (out.nut_angle - angle_before) < 0.0) ++played.wrong_turns;
        }
        held = out.joint;
        angle_before = out.nut_angle;
        before = out.constrained_tool;
    };
    const test::ReplaySetup own_setup = [](const session::SessionReader& r) {
        return session::restore_setup(r);
    };
    played.session = test::play_and_replay(cover, options, profile, own_setup, watch);
    const std::string table = session::summary_table(cover, played.session.result);
    CHECK(table.find("\nB1       M8 LH ") != std::string::npos);
    CHECK(table.find("\nB2       M8    ") != std::string::npos);
    return played;
}

}  // namespace

TEST_CASE(
    "Left-hand thread: every trainee finishes with each tool, and the session replays to the same bits") {
    for (const char* tool : {"", "ring", "ratchet"}) {
        const test::Folder folder;
        const content::Assembly all_passes = test::cover_with_left_threads(folder, tool);
        // Among obstacles rings and sockets take the longest.
        const test::Folder other_folder;
        const content::Assembly one_pass = test::cover_with_left_threads(other_folder, tool, true);
        for (std::size_t i = 0; i < all_passes.joints.size(); ++i)
            REQUIRE((all_passes.joints[i].design.thread_direction == joint::ThreadDirection::left) ==
                    is_left(i));
        for (const char* profile : {"expert", "novice", "clumsy"})
            for (const auto obstacles : {session::ObstacleUse::none, session::ObstacleUse::required}) {
                const bool among_obstacles = obstacles == session::ObstacleUse::required;
                if (among_obstacles && profile != std::string_view("expert")) continue;  // takes long
                if (test::sanitized && among_obstacles) {
                    test::skip_part("a lesson among obstacles takes minutes under a sanitizer");
                    continue;
                }
                CAPTURE(tool);
                CAPTURE(profile);
                session::LessonOptions options;
                options.seed = 2;
                options.obstacles = obstacles;
                const bool once = among_obstacles && *tool != '\0';
                const Played played = play(once ? one_pass : all_passes, profile, options);
                CHECK(played.session.result.finished);
                REQUIRE(played.session.result.joints.size() == 4);
                for (const JointResult& joint : played.session.result.joints)
                    CHECK(joint.torque_verdict != Verdict::low);
                CHECK(played.session.mismatches == 0);
                CHECK(played.pulls > 1000);
                // A trembling hand turns back by a little now and then.
                CHECK(played.wrong_turns < 0.05 * played.pulls);
            }
    }
}

TEST_CASE("Left-hand thread: a lesson is taken apart with the ratchet's lever the other way") {
    const test::Folder folder;
    const content::Assembly cover = test::cover_with_left_threads(folder, "ratchet");
    session::LessonOptions options;
    options.task = Task::loosen;
    const Played played = play(cover, "expert", options);
    CHECK(played.session.result.finished);
    CHECK(played.session.mismatches == 0);
    CHECK(played.wrong_turns < 0.05 * played.pulls);
}

TEST_CASE("Left-hand thread: a pull to the wrong side loosens, and is reported as a mistake") {
    // The lesson sees only angles that are positive in the direction that tightens, so a trainee that turns
    // every thread clockwise loosens the left-hand ones.
    const test::Folder folder;
    const content::Assembly cover = test::cover_with_left_threads(folder);
    auto prepared = session::prepare_session(cover, {});
    REQUIRE(prepared);
    REQUIRE(session::pretighten(prepared->assembly, prepared->setup, prepared->state));
    const servo::NutGeometry& nut = prepared->setup.nuts[0];
    const double angle = prepared->state.joints[0].nut.angle;
    const double fits = angle + nut.sense * prepared->setup.wrench.head_angle;
    servo::TickInput input;
    input.dead_man = true;
    input.grip = servo::Grip::wrench;
    const auto hold = [&](double clockwise) {
        const Pose held{servo::nut_centre(nut, prepared->state.joints[0].nut.angle),
                        glm::normalize(glm::angleAxis(-clockwise, nut.axis) *
                                       motion::tool_orientation(nut, fits, false))};
        input.commanded_tool = servo::to_commanded_tool(held);
        return servo::tick(prepared->setup, prepared->state, input);
    };
    REQUIRE(hold(0.0).joint == 0);
    servo::Output out;
    for (int i = 1; i <= 600; ++i) out = hold(1e-3 * i);
    CHECK(out.joint == 0);
    CHECK(out.nut_angle < angle - 0.1);
    CHECK(out.clamp < 100.0);
}

}  // namespace bolt::lesson::left_thread
