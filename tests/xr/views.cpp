#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

constexpr float close = 1e-6F;

void check_same(const XrPosef& a, const XrPosef& b) {
    CHECK(std::abs(a.position.x - b.position.x) < close);
    CHECK(std::abs(a.position.y - b.position.y) < close);
    CHECK(std::abs(a.position.z - b.position.z) < close);
    CHECK(std::abs(a.orientation.x - b.orientation.x) < close);
    CHECK(std::abs(a.orientation.y - b.orientation.y) < close);
    CHECK(std::abs(a.orientation.z - b.orientation.z) < close);
    CHECK(std::abs(a.orientation.w - b.orientation.w) < close);
}

void check_at(const Pose& pose, const Vec3& position) { CHECK(glm::length(pose.position - position) < 1e-6); }

xr::HeadsetFrame frame_of(test::Program& program) {
    const std::optional<xr::HeadsetFrame> frame = program.frame();
    REQUIRE(frame.has_value());
    return *frame;
}

}  // namespace

TEST_CASE("Views: what is submitted is what was located, with canted eyes and a moving head") {
    mock::Config config;
    config.cant = 0.1;
    config.ipd = 0.07;
    const test::MockRuntime mock(config);
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    (void)program.frame();
    (void)mock->take_frames();
    for (int i = 0; i < 6; ++i) {
        mock->set_head({{{0.1 * i, 1.5, -0.2}, rotation({0.1 * i, 0.3, -0.05 * i})}});
        const xr::HeadsetFrame drawn = frame_of(program);
        const std::vector<mock::Frame> frames = mock->take_frames();
        REQUIRE(frames.size() == 1);
        const mock::Frame& frame = frames[0];
        REQUIRE(frame.has_layer);
        REQUIRE(frame.views.size() == 2);
        REQUIRE(frame.located.size() == 2);
        CHECK(frame.time == drawn.timing.display_time);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            check_same(frame.views[eye].pose, frame.located[eye].pose);
            CHECK(frame.views[eye].fov.angleLeft == config.fov[eye].left);
            CHECK(frame.views[eye].fov.angleRight == config.fov[eye].right);
            CHECK(frame.views[eye].fov.angleUp == config.fov[eye].up);
            CHECK(frame.views[eye].fov.angleDown == config.fov[eye].down);
        }
        check_at(drawn.view.head, {0.1 * i, 1.5, -0.2});
        CHECK(glm::length(drawn.view.eyes[1].pose.position - drawn.view.eyes[0].pose.position) ==
              doctest::Approx(0.07).epsilon(1e-5));
        // Each eye is turned outwards.
        const Vec3 turn =
            turn_between(drawn.view.eyes[0].pose.orientation, drawn.view.eyes[1].pose.orientation);
        CHECK(glm::length(turn) == doctest::Approx(0.2).epsilon(1e-4));
    }
}

TEST_CASE("Views: a frame that nobody sees has no layer") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->set_should_render(false);
    for (int i = 0; i < 2; ++i) (void)frame_of(program);  // one was waited for before
    (void)mock->take_frames();
    CHECK_FALSE(frame_of(program).timing.should_render);
    const std::vector<mock::Frame> hidden = mock->take_frames();
    REQUIRE(hidden.size() == 1);
    CHECK_FALSE(hidden[0].should_render);
    CHECK_FALSE(hidden[0].has_layer);
    mock->set_should_render(true);
    for (int i = 0; i < 2; ++i) (void)frame_of(program);
    CHECK(mock->take_frames().back().has_layer);
}

TEST_CASE("Views: a head that is not tracked is drawn; one that is not valid is not") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.focus().view.tracked);
    mock->set_head({{{0.0, 1.6, 0.0}}, true, false});
    const xr::HeadsetFrame estimated = frame_of(program);
    CHECK_FALSE(estimated.view.tracked);
    CHECK(estimated.view.eyes.size() == 2);
    CHECK(mock->take_frames().back().has_layer);
    mock->set_head({{{0.0, 1.6, 0.0}}, false, false});
    CHECK(frame_of(program).view.eyes.empty());
    CHECK_FALSE(mock->take_frames().back().has_layer);
    mock->set_head({{{0.0, 1.6, 0.0}}});
    CHECK(frame_of(program).view.tracked);
}

TEST_CASE(
    "Views: the base space is the stage, then the floor, then the seat; or the seat if it is preferred") {
    mock::Config config;
    config.seated_origin = {{0.5, 1.1, 0.0}};
    config.floor_origin = {{0.5, 0.0, 0.0}};
    const std::vector<XrReferenceSpaceType> least{XR_REFERENCE_SPACE_TYPE_VIEW,
                                                  XR_REFERENCE_SPACE_TYPE_LOCAL};
    struct Case {
        bool stage, floor_offered, floor_extension, seated;
        xr::BaseSpace expected;
        Vec3 head;  // of a head at (0, 1.6, 0) of the stage
    };
    const Case cases[] = {
        {true, true, true, false, xr::BaseSpace::stage, {0.0, 1.6, 0.0}},
        {false, true, true, false, xr::BaseSpace::floor, {-0.5, 1.6, 0.0}},
        {false, true, false, false, xr::BaseSpace::seated, {-0.5, 0.5, 0.0}},
        {false, false, false, false, xr::BaseSpace::seated, {-0.5, 0.5, 0.0}},
        {true, true, true, true, xr::BaseSpace::seated, {-0.5, 0.5, 0.0}},
    };
    for (const Case& c : cases) {
        config.spaces = least;
        config.extensions = mock::Config().extensions;
        if (c.stage) config.spaces.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
        if (c.floor_offered) config.spaces.push_back(mock::local_floor_space);
        if (c.floor_extension) config.extensions.emplace_back("XR_EXT_local_floor");
        const test::MockRuntime mock(config);
        xr::HeadsetOptions options;
        options.session.seated = c.seated;
        test::Program program(options);
        REQUIRE(program.connect());
        CHECK(program.headset().session().base_space() == c.expected);
        check_at(program.focus().view.head, c.head);
    }
}

TEST_CASE("Hidden areas: the triangles of the runtime's mask, queried again when it changes") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    const xr::HeadsetFrame frame = program.focus();
    const xr::HiddenArea expected{{-1.0F, 1.0F}, {-0.6F, 1.0F}, {-1.0F, 0.6F}};
    REQUIRE(frame.view.eyes.size() == 2);
    for (const xr::EyeView& eye : frame.view.eyes) {
        REQUIRE(eye.hidden != nullptr);
        CHECK(*eye.hidden == expected);
    }
    const auto queries = [&] { return mock->calls("xrGetVisibilityMaskKHR"); };
    const std::uint64_t before = queries();
    (void)frame_of(program);
    CHECK(queries() == before);
    mock->send(mock::Event::mask_changed);
    (void)frame_of(program);
    CHECK(queries() == before + 4);  // sizes and triangles of two eyes
    mock->send(mock::Event::events_lost);
    (void)frame_of(program);
    CHECK(queries() == before + 8);
}

TEST_CASE(
    "Hidden areas: none without the extension, without a mask, or of a mask that is not made of triangles") {
    mock::Config without, empty, torn;
    without.extensions.erase(
        std::find(without.extensions.begin(), without.extensions.end(), "XR_KHR_visibility_mask"));
    empty.hidden_triangles.clear();
    torn.hidden_triangles.push_back({0.0F, 0.0F});
    for (const mock::Config& config : {without, empty, torn}) {
        const test::MockRuntime mock(config);
        test::Program program;
        REQUIRE(program.connect());
        for (const xr::EyeView& eye : program.focus().view.eyes) CHECK(eye.hidden == nullptr);
    }
}

TEST_CASE("Recentring: that of each space is reported, for the base space with its shift if it is known") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    const XrTime now = program.focus().timing.display_time;
    (void)frame_of(program);
    // The recentre button of many headsets moves these spaces only; poses in the stage stay as they are.
    for (const XrReferenceSpaceType space : {XR_REFERENCE_SPACE_TYPE_LOCAL, mock::local_floor_space}) {
        mock->recentre(space, 0, Pose{{1.0, 0.0, 0.0}});
        const xr::HeadsetFrame moved = frame_of(program);
        REQUIRE(moved.events.size() == 1);
        CHECK_FALSE(std::get<xr::Recentred>(moved.events[0]).base);
        CHECK_FALSE(std::get<xr::Recentred>(moved.events[0]).shift.has_value());
        check_at(moved.view.head, {0.0, 1.6, 0.0});
    }
    mock->recentre(XR_REFERENCE_SPACE_TYPE_VIEW, 0, std::nullopt);
    CHECK(frame_of(program).events.empty());

    constexpr XrDuration delay = 40'000'000;
    const Pose shift{{0.2, 0.0, -0.1}, rotation({0.0, 0.4, 0.0})};
    mock->recentre(XR_REFERENCE_SPACE_TYPE_STAGE, delay, shift);
    // The event comes with the first frame whose poses follow the new origin, not when it is announced.
    const Vec3 before{0.0, 1.6, 0.0};
    xr::HeadsetFrame frame = frame_of(program);
    int old_frames = 0;
    for (; frame.events.empty() && old_frames < 20; ++old_frames) {
        check_at(frame.view.head, before);
        frame = frame_of(program);
    }
    CHECK(old_frames > 0);
    REQUIRE(frame.events.size() == 1);
    const auto* recentred = std::get_if<xr::Recentred>(&frame.events[0]);
    REQUIRE(recentred != nullptr);
    CHECK(recentred->base);
    CHECK(recentred->time > now);
    CHECK(frame.timing.display_time >= recentred->time);
    REQUIRE(recentred->shift.has_value());
    check_at(*recentred->shift, shift.position);
    CHECK(glm::length(turn_between(recentred->shift->orientation, shift.orientation)) < 1e-6);
    check_at(frame.view.head, inverse(*recentred->shift) * before);
    CHECK(frame_of(program).events.empty());

    mock->recentre(XR_REFERENCE_SPACE_TYPE_STAGE, 0, std::nullopt);
    const xr::HeadsetFrame unknown = frame_of(program);
    REQUIRE(unknown.events.size() == 1);
    CHECK_FALSE(std::get<xr::Recentred>(unknown.events[0]).shift.has_value());
}
