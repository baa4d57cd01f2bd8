// The real room as a layer below the pictures (XR_FB_passthrough).
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

constexpr XrCompositionLayerFlags blends = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;

mock::Config with_cameras() {
    mock::Config config;
    config.extensions.emplace_back(XR_FB_PASSTHROUGH_EXTENSION_NAME);
    return config;
}

// The next frame, as it was submitted.
mock::Frame submitted(test::Program& program, const test::MockRuntime& mock) {
    (void)mock->take_frames();
    REQUIRE(program.frame().has_value());
    return mock->take_frames().back();
}

void check_room_is_below(const mock::Frame& frame) {
    CHECK(frame.layers ==
          std::vector{XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB, XR_TYPE_COMPOSITION_LAYER_PROJECTION});
    CHECK(frame.passthrough_flags == blends);
    CHECK(frame.flags == blends);
    CHECK(frame.blend_mode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
}

void check_room_is_hidden(const mock::Frame& frame) {
    CHECK(frame.layers == std::vector{XR_TYPE_COMPOSITION_LAYER_PROJECTION});
    CHECK_FALSE(frame.passthrough_flags);
    CHECK(frame.flags == 0);
    CHECK(frame.blend_mode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
}

std::size_t lines_with(const test::Program& program, const char* part) {
    return static_cast<std::size_t>(
        std::count_if(program.lines().begin(), program.lines().end(),
                      [&](const std::string& line) { return line.find(part) != std::string::npos; }));
}

}  // namespace

TEST_CASE("Passthrough: the layer is below the pictures, and runs only while the setting is on") {
    const test::MockRuntime mock(with_cameras());
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.headset().session().has_passthrough());
    (void)program.focus();
    check_room_is_hidden(submitted(program, mock));
    CHECK(mock->calls("xrCreatePassthroughFB") == 0);
    for (std::uint64_t i = 1; i <= 3; ++i) {
        program.set_passthrough(true);
        check_room_is_below(submitted(program, mock));
        check_room_is_below(submitted(program, mock));
        CHECK(mock->calls("xrPassthroughStartFB") == i);
        CHECK(mock->calls("xrPassthroughLayerResumeFB") == i);
        CHECK(mock->calls("xrPassthroughLayerPauseFB") == i - 1);
        program.set_passthrough(false);
        check_room_is_hidden(submitted(program, mock));
        check_room_is_hidden(submitted(program, mock));
        CHECK(mock->calls("xrPassthroughLayerPauseFB") == i);
        CHECK(mock->calls("xrPassthroughPauseFB") == i);
    }
    CHECK(mock->calls("xrCreatePassthroughFB") == 1);
    CHECK(mock->calls("xrCreatePassthroughLayerFB") == 1);
    // The layer is destroyed before its passthrough, and that before the session: the mock checks it.
    program.set_passthrough(true);
    check_room_is_below(submitted(program, mock));
    program.disconnect();
    CHECK(mock->calls("xrDestroyPassthroughLayerFB") == 1);
    CHECK(mock->calls("xrDestroyPassthroughFB") == 1);
    CHECK(mock->take_violations().empty());
}

TEST_CASE("Passthrough: the blend mode is preferred, and cameras are needed") {
    {
        mock::Config config = with_cameras();
        config.blend_modes.push_back(XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND);
        const test::MockRuntime mock(config);
        test::Program program;
        program.set_passthrough(true);
        REQUIRE(program.connect());
        (void)program.focus();
        const mock::Frame frame = submitted(program, mock);
        CHECK(frame.blend_mode == XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND);
        CHECK(frame.layers == std::vector{XR_TYPE_COMPOSITION_LAYER_PROJECTION});
        CHECK(mock->calls("xrCreatePassthroughFB") == 0);
    }
    mock::Config config = with_cameras();
    config.has_cameras = false;
    const test::MockRuntime mock(config);
    test::Program program;
    program.set_passthrough(true);
    REQUIRE(program.connect());
    CHECK_FALSE(program.headset().session().has_passthrough());
    (void)program.focus();
    check_room_is_hidden(submitted(program, mock));
}

TEST_CASE("Passthrough: a refused call is reported once, and the headset goes on without the room") {
    for (const char* function : {"xrCreatePassthroughFB", "xrCreatePassthroughLayerFB",
                                 "xrPassthroughStartFB", "xrPassthroughLayerResumeFB"}) {
        CAPTURE(function);
        const test::MockRuntime mock(with_cameras());
        test::Program program;
        REQUIRE(program.connect());
        (void)program.focus();
        mock->fail_next(function, XR_ERROR_NOT_PERMITTED_PASSTHROUGH_FB, 1);
        program.set_passthrough(true);
        for (int i = 0; i < 3; ++i) check_room_is_hidden(submitted(program, mock));
        CHECK(program.headset().connected());
        CHECK_FALSE(program.headset().session().has_passthrough());
        const std::string line =
            std::string("the headset does not show the real room: OpenXR: ") + function +
            " returned XR_ERROR_NOT_PERMITTED_PASSTHROUGH_FB; expected a running OpenXR runtime "
            "with a connected headset that permits this";
        CHECK(lines_with(program, line.c_str()) == 1);
        CHECK(mock->calls(function) == 1);
    }
    for (const char* function : {"xrPassthroughLayerPauseFB", "xrPassthroughPauseFB"}) {
        CAPTURE(function);
        const test::MockRuntime mock(with_cameras());
        test::Program program;
        REQUIRE(program.connect());
        (void)program.focus();
        program.set_passthrough(true);
        check_room_is_below(submitted(program, mock));
        mock->fail_next(function, XR_ERROR_UNEXPECTED_STATE_PASSTHROUGH_FB, 1);
        program.set_passthrough(false);
        check_room_is_hidden(submitted(program, mock));
        CHECK(mock->calls("xrDestroyPassthroughFB") == 1);  // the cameras are off all the same
        CHECK(lines_with(program, function) == 1);
    }
}

TEST_CASE(
    "Passthrough: a session that is lost in one of its calls is dropped, and the room returns with it") {
    const test::MockRuntime mock(with_cameras());
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    program.set_passthrough(true);
    mock->fail_next("xrPassthroughStartFB", XR_ERROR_SESSION_LOST, 1);
    (void)program.frame();
    CHECK_FALSE(program.headset().connected());
    REQUIRE(program.connect());
    (void)program.focus();
    check_room_is_below(submitted(program, mock));
}

TEST_CASE("Passthrough: the runtime's reports interrupt it, restore it, have it created again, or end it") {
    const test::MockRuntime mock(with_cameras());
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    program.set_passthrough(true);
    check_room_is_below(submitted(program, mock));
    mock->send(mock::Event::room_interrupted);
    check_room_is_hidden(submitted(program, mock));
    CHECK_FALSE(program.headset().session().has_passthrough());
    CHECK(lines_with(program, "does not show the real room for now") == 1);
    mock->send(mock::Event::room_restored);
    check_room_is_below(submitted(program, mock));
    CHECK(lines_with(program, "can show the real room again") == 1);
    mock->send(mock::Event::room_reinit);
    check_room_is_below(submitted(program, mock));
    CHECK(mock->calls("xrCreatePassthroughFB") == 2);
    mock->send(mock::Event::room_failed);
    for (int i = 0; i < 3; ++i) check_room_is_hidden(submitted(program, mock));
    CHECK(mock->calls("xrDestroyPassthroughLayerFB") == 2);
    CHECK(lines_with(program, "its cameras have failed; expected") == 1);
    CHECK(program.headset().connected());
}
