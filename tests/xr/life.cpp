#include <doctest/doctest.h>

#include <algorithm>

#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

// Draws frames and collects the states until `last` is reported.
std::vector<XrSessionState> states_until(test::Program& program, XrSessionState last) {
    std::vector<XrSessionState> states;
    for (int i = 0; i < 30; ++i) {
        const std::optional<xr::HeadsetFrame> frame = program.frame();
        if (!frame) continue;
        for (const xr::SessionEvent& event : frame->events)
            if (const auto* changed = std::get_if<xr::StateChanged>(&event)) states.push_back(changed->state);
        if (!states.empty() && states.back() == last) return states;
    }
    FAIL("the state is not reached");
    return states;
}

// Polls while the session does not run.
void idle(test::Program& program, int times) {
    for (int i = 0; i < times; ++i) (void)program.headset().begin_frame(0.0);
}

}  // namespace

TEST_CASE("Session: passes through its states to focus, and frames are submitted") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.headset().connected());
    CHECK_FALSE(program.headset().running());
    CHECK(states_until(program, XR_SESSION_STATE_FOCUSED) ==
          std::vector{XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY, XR_SESSION_STATE_SYNCHRONIZED,
                      XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED});
    CHECK(program.headset().running());
    (void)mock->take_frames();
    for (int i = 0; i < 5; ++i) {
        const std::optional<xr::HeadsetFrame> frame = program.frame();
        REQUIRE(frame.has_value());
        CHECK(frame->focused);
        CHECK(frame->timing.should_render);
        CHECK(frame->timing.period == doctest::Approx(0.011111111));
    }
    const std::vector<mock::Frame> frames = mock->take_frames();
    REQUIRE(frames.size() == 5);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        CHECK(frames[i].has_layer);
        CHECK(frames[i].blend_mode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
        if (i > 0) CHECK(frames[i].time - frames[i - 1].time == 11'111'111);
    }
}

TEST_CASE("Session: frames are counted, and the headset's log has their number when it ends") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    const xr::FrameCounts before = program.headset().session().counts();
    CHECK(before.missed == 0);
    for (int i = 0; i < 4; ++i) (void)program.frame();
    mock->delay_frame(3);
    for (int i = 0; i < 6; ++i) (void)program.frame();
    const xr::FrameCounts& counts = program.headset().session().counts();
    CHECK(counts.begun - before.begun == 10);
    CHECK(counts.drawn - before.drawn == 10);
    CHECK(counts.missed == 3);
    CHECK(counts.seconds - before.seconds == doctest::Approx(13 * 0.011111111));
    // The time without a session is no missed frame.
    mock->send(mock::Event::taken_off);
    CHECK_FALSE(program.frame().has_value());
    idle(program, 3);
    mock->delay_frame(100);
    mock->send(mock::Event::put_on);
    (void)program.focus();
    CHECK(program.headset().session().counts().missed == 3);
    program.disconnect();
    const auto& lines = program.lines();
    CHECK(std::any_of(lines.begin(), lines.end(),
                      [](const std::string& line) { return line.find("3 missed") != std::string::npos; }));
}

TEST_CASE("Session: the period is the display's, also if the runtime reports the program's") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->report_period(3);
    mock->delay_frame(2);
    for (int i = 0; i < 4; ++i) {
        const std::optional<xr::HeadsetFrame> frame = program.frame();
        REQUIRE(frame.has_value());
        CHECK(frame->timing.period == doctest::Approx(0.011111111));
    }
    CHECK(program.headset().session().counts().missed == 2);

    constexpr XrDuration at_90 = 11'111'111, at_72 = 13'888'889, at_120 = 8'333'333;
    CHECK(xr::display_period(0, at_90) == at_90);
    CHECK(xr::display_period(at_90, 2 * at_90 + 1000) == at_90);
    CHECK(xr::display_period(at_90, at_72) == at_72);
    CHECK(xr::display_period(at_90, at_120) == at_120);
    CHECK(xr::display_period(2 * at_90, at_90) == at_90);  // the first report was a multiple
    CHECK(xr::display_period(at_90, 0) == at_90);
}

TEST_CASE("Session: the user's focus on another program pauses, and returns") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->send(mock::Event::focus_lost);
    const std::optional<xr::HeadsetFrame> frame = program.frame();
    REQUIRE(frame.has_value());
    CHECK_FALSE(frame->focused);
    CHECK(program.headset().running());
    mock->send(mock::Event::focus_gained);
    CHECK(program.frame()->focused);
}

TEST_CASE("Session: a headset that is taken off pauses, and continues when it is put on again") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    for (int round = 0; round < 3; ++round) {
        CHECK(program.focus().focused);
        mock->send(mock::Event::taken_off);
        CHECK_FALSE(program.frame().has_value());
        CHECK_FALSE(program.headset().running());
        CHECK_FALSE(mock->session_running());
        CHECK(program.headset().connected());
        idle(program, 5);
        CHECK(mock->session_state() == XR_SESSION_STATE_IDLE);
        mock->send(mock::Event::put_on);
    }
    CHECK(program.focus().focused);
    CHECK(mock->calls("xrCreateSession") == 1);
    CHECK(mock->calls("xrBeginSession") == 4);
}

TEST_CASE("Session: a headset that is not worn at the start begins when it is put on") {
    const test::MockRuntime mock;
    mock->send(mock::Event::taken_off);
    test::Program program;
    REQUIRE(program.connect());
    idle(program, 5);
    CHECK_FALSE(program.headset().running());
    CHECK(mock->calls("xrWaitFrame") == 0);
    mock->send(mock::Event::put_on);
    CHECK(program.focus().focused);
}

TEST_CASE("Session: a headset that senses that it is not worn has no focus, whatever the session's state") {
    mock::Config config;
    config.extensions.emplace_back(mock::user_presence);
    const test::MockRuntime mock(config);
    mock->send(mock::Event::user_absent);
    test::Program program;
    REQUIRE(program.connect());
    for (int i = 0; i < 10; ++i) {
        const std::optional<xr::HeadsetFrame> frame = program.frame();
        CHECK_FALSE((frame && frame->focused));
    }
    CHECK(mock->session_state() == XR_SESSION_STATE_FOCUSED);
    const auto presence = [&](bool worn) {
        mock->send(worn ? mock::Event::user_present : mock::Event::user_absent);
        const std::optional<xr::HeadsetFrame> frame = program.frame();
        REQUIRE(frame.has_value());
        REQUIRE(frame->events.size() == 1);
        CHECK(std::get<xr::UserPresence>(frame->events[0]).worn == worn);
        CHECK(frame->focused == worn);
    };
    presence(true);
    presence(false);
    presence(true);
}

TEST_CASE("Session: the user ends the program in the headset's menu") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->send(mock::Event::exit_by_user);
    for (int i = 0; i < 5; ++i) (void)program.frame();
    CHECK(program.headset().exit_requested());
    CHECK_FALSE(program.headset().connected());
    CHECK(mock->instance() == XR_NULL_HANDLE);
    // It is not searched again.
    CHECK_FALSE(program.connect());
    CHECK(program.lines().back() == "the program was ended in the headset's menu");
}

TEST_CASE("Session: the program's end passes through the last states in order") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    program.headset().end();
    CHECK(mock->calls("xrRequestExitSession") == 1);
    CHECK(mock->calls("xrEndSession") == 1);
    CHECK(mock->calls("xrDestroySession") == 1);
    CHECK(mock->instance() == XR_NULL_HANDLE);
    CHECK_FALSE(program.headset().exit_requested());
}

TEST_CASE("Session: the program's end while the headset is off requests nothing") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->send(mock::Event::taken_off);
    (void)program.frame();
    program.headset().end();
    CHECK(mock->calls("xrRequestExitSession") == 0);
    CHECK(mock->instance() == XR_NULL_HANDLE);
}

TEST_CASE("Session: a headset with one eye has one view") {
    mock::Config config;
    config.eyes = 1;
    const test::MockRuntime mock(config);
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.focus().view.eyes.size() == 1);
    (void)program.frame();
    CHECK(mock->take_frames().back().views.size() == 1);
}

TEST_CASE("Session: takes real time if the runtime does") {
    mock::Config config;
    config.real_time = true;
    config.period = 2'000'000;
    const test::MockRuntime mock(config);
    test::Program program;
    REQUIRE(program.connect());
    const XrTime first = program.focus().timing.display_time;
    XrTime last = first;
    for (int i = 0; i < 10; ++i) last = program.frame()->timing.display_time;
    CHECK(last - first >= 20'000'000);
}

TEST_CASE("Session: events of the runtime arrive in order") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    (void)program.frame();
    mock->send(mock::Event::profile_changed);
    mock->send(mock::Event::mask_changed);
    mock->send(mock::Event::events_lost);
    const std::optional<xr::HeadsetFrame> frame = program.frame();
    REQUIRE(frame.has_value());
    REQUIRE(frame->events.size() == 3);
    CHECK(std::holds_alternative<xr::BindingsChanged>(frame->events[0]));
    CHECK(std::holds_alternative<xr::VisibilityMaskChanged>(frame->events[1]));
    CHECK(std::holds_alternative<xr::EventsLost>(frame->events[2]));
    CHECK(program.frame()->events.empty());
}
