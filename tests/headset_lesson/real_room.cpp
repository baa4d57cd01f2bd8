// A user switches the real room on and off in the settings, on the panel in a headset whose runtime shows it
// as a layer (XR_FB_passthrough).
#include <algorithm>

#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;

namespace {

// The user's head, and a right hand that points at the panel.
class PanelUser {
  public:
    PanelUser(test::HeadsetDriver& driver, const test::MockRuntime& mock) : driver_(driver), mock_(mock) {}

    void wait(int frames) {
        for (int i = 0; i < frames; ++i) driver_.frame(head, hands_);
    }

    void press(words::TextKey label) {
        wait(4);  // until the panel has its final size
        const auto widgets = driver_.app().drawn_widgets();
        const auto found =
            std::find_if(widgets.begin(), widgets.end(),
                         [&](const trainer::DrawnWidget& widget) { return widget.label == label; });
        REQUIRE_MESSAGE(found != widgets.end(), label.row().name);
        const Pose panel = *driver_.app().room()->panel;
        const glm::dvec2 points = glm::dvec2(found->middle) / static_cast<double>(trainer::panel_scale) -
                                  0.5 * trainer::panel_points;
        const Vec3 target =
            panel * Vec3(points.x * trainer::point_size, -points.y * trainer::point_size, 0.0);
        const Vec3 hand = panel * Vec3(0.1, -0.4, 0.5), along = glm::normalize(target - hand);
        xr::HandInput& right = hands_[Side::right];
        right.active = true;
        right.aim = right.grip = xr::ReportedPose{
            {hand, glm::normalize(Quat(1.0 - along.z, glm::cross(Vec3(0.0, 0.0, -1.0), along)))}, true};
        for (const float select : {0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F, 0.0F, 0.0F, 0.0F}) {
            right.select = select;
            wait(1);
        }
        wait(4);
    }

    // The last frame that the runtime got.
    mock::Frame shown() {
        (void)mock_->take_frames();
        wait(2);
        const std::vector<mock::Frame> frames = mock_->take_frames();
        REQUIRE(!frames.empty());
        return frames.back();
    }

    Pose head{{0.0, 1.6, 0.0}};

  private:
    test::HeadsetDriver& driver_;
    const test::MockRuntime& mock_;
    xr::Hands hands_;
};

}  // namespace

TEST_CASE(
    "Headset lesson: a user shows and hides the real room in the settings, and reads if it is refused") {
    mock::Config config;
    config.extensions.emplace_back(XR_FB_PASSTHROUGH_EXTENSION_NAME);
    const test::Folder folder;
    trainer::AppOptions options = test::headset_lesson_options("first-nut", folder.path());
    options.menu = true;
    options.settings_file = folder.path() / "settings.json";
    content::TraineeSettings settings;
    settings.language = "en";
    settings.trainee = "Ada";
    test::need(write_file(options.settings_file, content::settings_text(settings)));
    const test::MockRuntime mock(config);
    test::Program program(std::move(options), platform::Size{160, 120});
    const auto send = [&](const Pose& head, const xr::Hands& hands) {
        mock->set_head({head});
        mock::Hand none;
        none.active = false;
        mock->set_hand(mock::Side::left, none);
        const xr::HandInput& right = hands[Side::right];
        mock::Hand pointing;
        pointing.active = right.active;
        pointing.trigger = right.select;
        if (right.aim) pointing.aim.pose = pointing.grip.pose = right.aim->pose;
        mock->set_hand(mock::Side::right, pointing);
        return Status();
    };
    test::HeadsetDriver driver(*program.app, send, {});
    PanelUser user(driver, mock);
    const std::vector<XrStructureType> pictures{XR_TYPE_COMPOSITION_LAYER_PROJECTION},
        room_below{XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB, XR_TYPE_COMPOSITION_LAYER_PROJECTION};
    std::vector<std::string> log;
    const auto refusals = [&] {
        return std::count_if(log.begin(), log.end(), [](const std::string& line) {
            return line.find(
                       "the headset does not show the real room: OpenXR: xrPassthroughStartFB returned") !=
                   std::string::npos;
        });
    };
    const Status run = test::play_in_headset(program, driver, log, [&] {
        for (int i = 0; i < 100 && (!driver.app().room() || !driver.app().room()->panel); ++i) user.wait(1);
        user.press("menu.settings");
        CHECK(user.shown().layers == pictures);
        CHECK(user.shown().flags == 0);
        user.press("menu.surroundings");
        CHECK(driver.wants_passthrough());
        CHECK(user.shown().layers == room_below);
        CHECK(user.shown().flags == XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT);
        user.press("menu.surroundings");
        CHECK(user.shown().layers == pictures);
        CHECK(mock->calls("xrPassthroughPauseFB") == 1);
        CHECK(refusals() == 0);
        mock->fail_next("xrPassthroughStartFB", XR_ERROR_NOT_PERMITTED_PASSTHROUGH_FB, 1);
        user.press("menu.surroundings");
        CHECK(user.shown().layers == pictures);
        CHECK(user.shown().flags == 0);
        CHECK(refusals() == 1);
        // The lesson goes on in the workshop.
        user.press("menu.back");
        user.press("menu.start");
        CHECK(driver.app().screen() == trainer::ShownScreen::lesson);
        CHECK(user.shown().layers == pictures);
    });
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
}
