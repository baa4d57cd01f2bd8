// Projection walls: a window without a frame for each output, and the pictures in it, as the tracked head
// sees the room through the wall. Poses are in the room's frame (view::Immersion), m.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "content/displays/check_displays.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "game/displays/head_source.hpp"
#include "game/view/immersion.hpp"

namespace bolt::view {

// The eyes of a head in front of a wall, the left one first; one eye in the middle for a mono wall. Empty if
// an eye is not in front of the wall: then nothing can be drawn on it.
EyeGroup wall_eyes(const content::Wall& wall, const Pose& head, double eye_separation, VkExtent2D size);

// Returns true if the point, or something in its direction, is in the picture of a wall.
bool on_a_wall(std::span<const content::Wall> walls, const Vec3& eye, const Vec3& point);

// A window that shows a wall, or the picture of one of its eyes.
struct WallWindow {
    std::string title;
    platform::DesktopArea area;
    std::size_t wall = 0;  // index in the display file
    enum class Shows : std::uint8_t { all, left_output, right_output } shows = Shows::all;
};

// The computer that the program runs on, with rank 0.
content::Computer this_computer(const platform::Desktop& desktop);

// The windows of the outputs. Fails if an output is on a monitor that is not connected, on another X display,
// or of another computer.
Result<std::vector<WallWindow>> plan_wall_windows(const content::DisplayFile& displays,
                                                  const content::Computer& computer);

// The part of a window that shows an eye: 0 is the first eye of wall_eyes().
struct EyePlace {
    std::uint32_t eye = 0;
    VkRect2D place{};  // px
};
std::vector<EyePlace> eye_places(const content::Wall& wall, WallWindow::Shows shows, VkExtent2D window);

// The windows of all walls in this process. Not movable, because the swapchains refer to their windows.
class Walls {
  public:
    // `log` receives a line when the tracker finds or loses the head; it may be empty.
    static Result<std::unique_ptr<Walls>> open(const platform::Desktop& desktop,
                                               content::DisplayFile displays, displays::HeadSource head,
                                               std::function<void(const std::string&)> log);

    // Creates the swapchains; release() destroys them before the device is destroyed.
    Status start(gpu::Device& device, const gpu::Instance& instance);
    void release();

    // Keys and requests to close from all windows, since the last call. The pointer is that of the control
    // window.
    std::vector<platform::InputEvent> poll_events();

    // The next frame: prepares the swapchains, and asks where the head is. Group i belongs to wall i.
    Result<Immersion> begin_frame(double seconds);
    // Adds the pictures that the renderer has drawn for it.
    void add_pictures(const render::Renderer& renderer, const Immersion& immersion,
                      std::vector<gpu::WindowPictures>& windows) const;

    [[nodiscard]] const content::DisplayFile& displays() const { return displays_; }
    [[nodiscard]] double refresh_rate() const;  // Hz, the lowest of the windows; 0: unknown

  private:
    explicit Walls(displays::HeadSource head) : head_(std::move(head)) {}
    struct Output {
        WallWindow plan;
        platform::Window window;
        std::unique_ptr<gpu::Swapchain> swapchain;
        VkExtent2D size{};
    };
    void tell(tracking::HeadStatus status);

    content::DisplayFile displays_;
    displays::HeadSource head_;
    std::optional<tracking::HeadStatus> told_;  // in the log
    std::function<void(const std::string&)> log_;
    std::vector<Output> outputs_;
};

}  // namespace bolt::view
