// A cave of five windows on the test screen, with Vulkan validation: its pixels against pictures that are
// drawn without windows.
#include <cstdlib>

#include "engine/gpu/resources.hpp"
#include "game/view/walls.hpp"
#include "game/view/window.hpp"
#include "tests/render/support.hpp"
#include "tests/support/need.hpp"
#include "tests/support/screen_picture.hpp"
#include "tests/walls/cave.hpp"

using namespace bolt;

namespace {

constexpr std::uint64_t max_frames = 400;

render::Object object_at(const render::GpuModel& model, const glm::vec3& position, const glm::vec4& color) {
    render::Object object;
    object.model = &model;
    object.world = glm::scale(glm::translate(glm::mat4(1.0F), position), glm::vec3(0.45F));
    object.tint = color;
    return object;
}

std::size_t at(test::CaveWall wall) { return static_cast<std::size_t>(wall); }

// The part of the screen that a wall covers.
render::Picture part_of(const test::ScreenPicture& screen, const content::Wall& wall) {
    const auto x0 = static_cast<std::uint32_t>(wall.output.position->x),
               y0 = static_cast<std::uint32_t>(wall.output.position->y),
               width = static_cast<std::uint32_t>(wall.output.resolution->width),
               height = static_cast<std::uint32_t>(wall.output.resolution->height);
    REQUIRE(x0 + width <= screen.width);
    REQUIRE(y0 + height <= screen.height);
    render::Picture part{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        const auto begin = screen.rgba.begin() + 4 * (std::ptrdiff_t{y0 + y} * screen.width + x0);
        part.rgba.insert(part.rgba.end(), begin, begin + 4 * std::ptrdiff_t{width});
    }
    return part;
}

// Mean difference of a column of one picture from a column of another, levels.
double column_difference(const render::Picture& a, std::uint32_t column_a, const render::Picture& b,
                         std::uint32_t column_b) {
    double sum = 0.0;
    for (std::uint32_t y = 0; y < a.height; ++y) {
        const glm::ivec4 difference = test::pixel(a, column_a, y) - test::pixel(b, column_b, y);
        for (int channel = 0; channel < 3; ++channel) sum += std::abs(difference[channel]) / 3.0;
    }
    return sum / a.height;
}

// Spheres around the viewer, some behind the seams. Ends when the screen shows the pictures that are drawn
// without windows, or after max_frames.
class SpheresAround : public view::WindowContent {
  public:
    explicit SpheresAround(const content::DisplayFile& displays) : displays_(displays) {}

    Status start(view::GpuContext& gpu) override {
        gpu_ = &gpu;
        BOLT_TRY_ASSIGN(sphere_, render::upload_model(*gpu.device, test::sphere({})));
        scene_.background = {0.1F, 0.2F, 0.3F, 1.0F};
        render::SceneLight lamp;
        lamp.light.direction = glm::vec4(glm::normalize(glm::vec3(-0.3F, -1.0F, -0.5F)), 0.0F);
        lamp.light.color = glm::vec4(glm::vec3(2.0F), 0.0F);
        scene_.lights.push_back(lamp);
        const glm::vec4 red(0.7F, 0.2F, 0.1F, 1.0F), grey(0.5F, 0.5F, 0.5F, 1.0F);
        std::vector<glm::vec3> places{{1.9F, 1.0F, -1.7F},
                                      {0.4F, 0.3F, -1.9F},
                                      {-0.3F, 2.6F, -1.6F},
                                      {0.2F, 1.1F, -0.8F},
                                      {-1.2F, 0.2F, 0.2F}};
        // Two columns of spheres that the two heads see behind the edge of the left and the front wall.
        for (int i = 0; i < 6; ++i) {
            const float height = -0.5F + 0.9F * static_cast<float>(i);
            places.emplace_back(-3.0F, height, -3.3F);
            places.emplace_back(-3.7F, height, -1.5F);
        }
        for (const glm::vec3& place : places)
            scene_.objects.push_back(object_at(*sphere_, place, scene_.objects.size() % 2 == 0 ? red : grey));
        return {};
    }
    void release() override {
        (void)gpu_->device->idle();
        scene_ = {};
        sphere_.reset();
    }
    Status update(const view::WindowFrame& window) override {
        head_ = window.immersive->head;
        if (++frames_ < 3) return {};
        BOLT_TRY(gpu_->device->idle());
        BOLT_TRY_ASSIGN(screen_, test::read_screen());
        if (drawn_.empty()) BOLT_TRY(draw_without_windows());
        largest_ = 0;
        for (std::size_t i = 0; i < displays_.walls.size(); ++i)
            largest_ =
                std::max(largest_, test::largest_difference(part_of(screen_, displays_.walls[i]), drawn_[i]));
        return {};
    }
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override {
        for (std::uint32_t i = 0; i < window.immersive->groups.size(); ++i) {
            const view::EyeGroup& group = window.immersive->groups[i];
            BOLT_TRY(
                gpu_->renderer->render(frame, scene_, group.eyes, group.size, view::immersive_group + i));
        }
        const render::Eye eye = window.immersive->groups[at(test::CaveWall::front)].eyes.front();
        return gpu_->renderer->render(frame, scene_, std::span(&eye, 1), window.size);
    }
    [[nodiscard]] bool closed() const override {
        return frames_ >= max_frames || (!drawn_.empty() && largest_ == 0);
    }

    // Draws one wall as a head elsewhere would see it.
    Result<render::Picture> draw_wall(const content::Wall& wall, const Vec3& eye_at) {
        const render::Eye eye = render::make_wall_eye(
            glm::vec3(eye_at), glm::vec3(wall.lower_left), glm::vec3(wall.lower_right),
            glm::vec3(wall.lower_left + wall.upper_right - wall.lower_right), 0.05F, 100.0F);
        const VkExtent2D size{static_cast<std::uint32_t>(wall.output.resolution->width),
                              static_cast<std::uint32_t>(wall.output.resolution->height)};
        BOLT_TRY_ASSIGN(auto pictures, render::take_pictures(*gpu_->device, *gpu_->frames, *gpu_->renderer,
                                                             scene_, std::span(&eye, 1), size));
        return std::move(pictures.front());
    }
    Status draw_without_windows() {
        for (const content::Wall& wall : displays_.walls) {
            BOLT_TRY_ASSIGN(auto picture, draw_wall(wall, head_.position));
            drawn_.push_back(std::move(picture));
        }
        BOLT_TRY_ASSIGN(elsewhere_, draw_wall(displays_.walls[at(test::CaveWall::left)],
                                              head_.position + Vec3(0.2, 0.0, 0.0)));
        return {};
    }

    [[nodiscard]] const std::vector<render::Picture>& drawn() const { return drawn_; }
    [[nodiscard]] const render::Picture& elsewhere() const { return elsewhere_; }
    [[nodiscard]] const test::ScreenPicture& screen() const { return screen_; }
    [[nodiscard]] int largest() const { return largest_; }

  private:
    const content::DisplayFile& displays_;
    view::GpuContext* gpu_ = nullptr;
    std::optional<render::GpuModel> sphere_;
    render::Scene scene_;
    Pose head_;
    std::uint64_t frames_ = 0;
    test::ScreenPicture screen_;
    std::vector<render::Picture> drawn_;
    render::Picture elsewhere_;
    int largest_ = 0;
};

// Runs the cave for a viewer at `head` until its screen is complete.
void run_cave(const Vec3& head, const std::function<void(const SpheresAround&)>& check) {
    content::DisplayFile displays = test::small_cave();
    displays.head.fixed_head.position = head;
    const platform::Desktop desktop = test::need(platform::Desktop::open());
    platform::WindowOptions window_options;
    window_options.width = 200;
    window_options.height = 150;
    platform::Window window = test::need(platform::Window::open(desktop, window_options));
    view::WallsOptions walls_options;
    walls_options.displays = displays;
    walls_options.head.emplace(test::need(head_tracking::HeadSource::open(displays.head, ".")));
    const auto walls = test::need(view::Walls::open(desktop, std::move(walls_options)));
    gpu::InstanceOptions options;
    options.validation = true;
    const std::vector<const char*> extensions = test::need(desktop.vulkan_extensions());
    options.extensions = extensions;
    gpu::Instance instance = test::need(gpu::Instance::create(options));
    SpheresAround content(displays);
    const Status run = view::run_in_window(content, window, instance, {.walls = walls.get()});
    REQUIRE_MESSAGE(run.has_value(), run.error().message());
    check(content);
    for (const std::string& message : instance.log().messages) FAIL_CHECK(message);
}

}  // namespace

TEST_CASE(
    "Cave: five windows show the pictures that are drawn without windows, from two positions of the head") {
    std::vector<std::uint8_t> first;
    for (const Vec3 head : {Vec3(0.0, 1.65, 0.3), Vec3(0.7, 1.3, -0.4)}) {
        CAPTURE(head.x);
        run_cave(head, [&](const SpheresAround& content) {
            REQUIRE(content.drawn().size() == test::cave_walls);
            CHECK(content.largest() == 0);
            const render::Picture& left = content.drawn()[at(test::CaveWall::left)];
            const render::Picture& front = content.drawn()[at(test::CaveWall::front)];
            const double across = column_difference(left, left.width - 1, front, 0);
            const double inside = std::max(column_difference(left, left.width - 2, left, left.width - 1),
                                           column_difference(front, 0, front, 1));
            MESSAGE("columns beside the seam differ by " << across << " levels, their neighbours by "
                                                         << inside);
            CHECK(across < inside + 1.0);
            // A control: as if the left wall did not follow the head.
            CHECK(column_difference(content.elsewhere(), left.width - 1, front, 0) > 2.0 * (inside + 1.0));
            CHECK(front.rgba != first);
            first = front.rgba;
        });
    }
}
