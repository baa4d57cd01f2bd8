// The pictures that arrive in a headset, through OpenXR's loader and the loop of the window, are those that
// are drawn of the same scene without a headset and without a window, to the bit, also if the head moves
// while a frame is recorded.
#include <optional>

#include "game/view/shown_model.hpp"
#include "game/view/window.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"
#include "tests/support/need.hpp"

using namespace bolt;

namespace {

// A cover with its bolts in front of the user.
const Pose model_in_room{{0.0, 1.35, -0.45}, rotation({0.0, 0.5, 0.0})};

struct ShownCover {
    view::LoadedModel model;
    render::EnvironmentLight light;
    std::unique_ptr<view::ShownModel> shown;

    explicit ShownCover(gpu::Device& device) {
        view::ModelLoadResult loaded = view::load_model("cover-m8");
        REQUIRE(loaded.ok());
        model = std::move(loaded.model);
        light = test::need(render::upload_environment(device, test::need(view::load_light("studio"))));
        shown = test::need(view::show_model(device, model, light));
    }
};

std::vector<render::Eye> eyes_at_model(const view::EyeGroup& group) {
    std::vector<render::Eye> eyes;
    for (const render::Eye& eye : group.eyes) eyes.push_back(render::seen_from(eye, model_in_room));
    return eyes;
}

// Shows the cover for some frames. In each the head is at `before` until the pictures are recorded, then at
// `after`. Without `follows` the pictures stay those from `before`.
class CoverInHeadset : public view::WindowContent {
  public:
    CoverInHeadset(const test::MockRuntime& mock, const Pose& before, const Pose& after, bool follows)
        : mock_(mock), before_(before), after_(after), follows_(follows) {}

    Status start(view::GpuContext& gpu) override {
        gpu_ = &gpu;
        cover_.emplace(*gpu.device);
        return {};
    }
    void release() override {
        (void)gpu_->device->idle();
        cover_.reset();
    }
    Status update(const view::WindowFrame& window) override {
        if (window.immersive != nullptr && ++frames_ > 6) closed_ = true;
        return {};
    }
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override {
        if (window.immersive != nullptr && !window.immersive->groups.empty()) {
            recorded_ = window.immersive->groups.front();
            BOLT_TRY(gpu_->renderer->render(frame, cover_->shown->scene, eyes_at_model(recorded_),
                                            recorded_.size, view::immersive_group));
            mock_->set_head({after_});
            return {};
        }
        const render::Eye eye;
        return gpu_->renderer->render(frame, cover_->shown->scene, std::span(&eye, 1), window.size);
    }
    bool move_eyes(const view::WindowFrame& window) override {
        mock_->set_head({before_});
        latest_ = window.immersive->groups.front();
        if (follows_) gpu_->renderer->move_eyes(eyes_at_model(latest_), view::immersive_group);
        return follows_;
    }
    [[nodiscard]] bool closed() const override { return closed_; }
    // The eyes of the last frame.
    [[nodiscard]] const view::EyeGroup& recorded() const { return recorded_; }
    [[nodiscard]] const view::EyeGroup& latest() const { return latest_; }

  private:
    const test::MockRuntime& mock_;
    Pose before_, after_;
    bool follows_;
    view::GpuContext* gpu_ = nullptr;
    std::optional<ShownCover> cover_;
    view::EyeGroup recorded_, latest_;
    int frames_ = 0;
    bool closed_ = false;
};

// The pictures of the last frame that the headset got, and the eyes that they were recorded and submitted
// for.
struct InHeadset {
    std::vector<mock::Picture> pictures;
    Vec3 eye;  // m, position of the first one, as submitted
    view::EyeGroup recorded, latest;
};

InHeadset show_in_headset(const Pose& before, const Pose& after, bool follows = true) {
    mock::Config config;
    config.width = config.max_width = 320;
    config.height = config.max_height = 300;
    const test::MockRuntime mock(config);
    mock->set_head({before});
    mock->set_capture(true);
    platform::Desktop desktop = test::need(platform::Desktop::open());
    platform::Window window =
        test::need(platform::Window::open(desktop, {"Stereo pictures", 160, 120, false}));
    const std::vector<const char*> extensions = test::need(desktop.vulkan_extensions());
    gpu::InstanceOptions options;
    options.validation = true;
    options.extensions = extensions;
    gpu::Instance instance = test::need(gpu::Instance::create(options));
    xr::Headset headset(xr::HeadsetOptions{});
    view::WindowRunOptions run;
    run.headset = &headset;
    run.adapts_resolution = false;
    run.instance = options;
    CoverInHeadset content(mock, before, after, follows);
    const Status done = view::run_in_window(content, window, instance, run);
    REQUIRE_MESSAGE(done, (done ? "" : done.error().message()));
    for (const std::string& message : instance.log().messages) FAIL_CHECK(message);
    InHeadset shown{{}, {}, content.recorded(), content.latest()};
    for (const mock::Frame& frame : mock->take_frames()) {
        if (frame.views.empty()) continue;
        shown.pictures.clear();
        const XrVector3f& at = frame.views.front().pose.position;
        shown.eye = {at.x, at.y, at.z};
        for (const mock::SubmittedView& view : frame.views) shown.pictures.push_back(view.picture);
    }
    return shown;
}

std::vector<render::Picture> draw_without_headset(const view::EyeGroup& group) {
    const gpu::Instance instance = test::need(gpu::Instance::create({}));
    render::RendererOptions renderer;
    renderer.level_error_px = view::window_level_error;
    renderer.keep_depth = true;
    const view::GpuContext gpu = test::need(view::make_gpu_context(instance, {}, renderer));
    std::vector<render::Picture> pictures;
    {
        const ShownCover cover(*gpu.device);
        pictures = test::need(render::take_pictures(*gpu.device, *gpu.frames, *gpu.renderer,
                                                    cover.shown->scene, eyes_at_model(group), group.size));
    }
    return pictures;
}

}  // namespace

TEST_CASE("Stereo pictures: those in the headset are those that are drawn without one, from two positions") {
    std::vector<std::uint8_t> before;
    for (const Pose& head : {Pose{{0.0, 1.6, 0.0}, rotation({-0.4, 0.0, 0.0})},
                             Pose{{0.2, 1.5, -0.1}, rotation({-0.2, 0.4, 0.1})}}) {
        const InHeadset shown = show_in_headset(head, head);
        REQUIRE(shown.pictures.size() == 2);
        const std::vector<render::Picture> drawn = draw_without_headset(shown.latest);
        REQUIRE(drawn.size() == 2);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            CHECK(shown.pictures[eye].width == drawn[eye].width);
            CHECK(shown.pictures[eye].rgba == drawn[eye].rgba);
        }
        // The mock's visibility mask hides the upper left corner, a part of which is in both pictures.
        const auto black = [&](std::size_t eye, std::size_t x, std::size_t y) {
            const std::uint8_t* pixel = &drawn[eye].rgba[4 * (y * drawn[eye].width + x)];
            return pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
        };
        CHECK(black(0, 8, 11));
        CHECK(black(1, 7, 7));
        CHECK_FALSE(black(0, 100, 11));
        CHECK_FALSE(black(1, 100, 7));
        // Controls: the eyes differ, and so do the positions.
        CHECK(drawn[0].rgba != drawn[1].rgba);
        CHECK(drawn[0].rgba != before);
        before = drawn[0].rgba;
    }
}

TEST_CASE("Stereo pictures: a head that moves while they are recorded sees them from where it is then") {
    const Pose before{{0.0, 1.6, 0.0}, rotation({-0.4, 0.0, 0.0})};
    const Pose after{{0.004, 1.601, -0.002}, rotation({-0.395, 0.008, 0.001})};
    const InHeadset shown = show_in_headset(before, after);
    REQUIRE(shown.pictures.size() == 2);
    const std::vector<render::Picture> drawn = draw_without_headset(shown.latest),
                                       as_recorded = draw_without_headset(shown.recorded);
    for (std::size_t eye = 0; eye < 2; ++eye) {
        CHECK(shown.pictures[eye].rgba == drawn[eye].rgba);
        CHECK(drawn[eye].rgba != as_recorded[eye].rgba);  // control
    }
    // The runtime gets the pose that they were drawn for, half the distance of the eyes beside the head.
    const auto left_eye = [](const Pose& head) {
        return head.position - 0.032 * (head.orientation * Vec3(1.0, 0.0, 0.0));
    };
    CHECK(glm::length(shown.eye - left_eye(after)) < 1e-6);
    // Also if the content cannot move its eyes.
    const InHeadset still = show_in_headset(before, after, false);
    REQUIRE(still.pictures.size() == 2);
    CHECK(still.pictures[0].rgba == as_recorded[0].rgba);
    CHECK(glm::length(still.eye - left_eye(before)) < 1e-6);
}
