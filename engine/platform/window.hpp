// A desktop window (GLFW). Input is returned as values (input.hpp); gpu::Swapchain presents the pictures.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/platform/input.hpp"

namespace bolt::platform {

// The connection to the desktop. GLFW supports only one at a time. It must outlive its windows. Main thread
// only.
class Desktop {
  public:
    // Fails if there is no display.
    static Result<Desktop> open();
    Desktop(Desktop&& other) noexcept
        : open_(std::exchange(other.open_, false)), lost_(std::move(other.lost_)) {}
    Desktop& operator=(Desktop&& other) noexcept {
        std::swap(open_, other.open_);
        std::swap(lost_, other.lost_);
        return *this;
    }
    ~Desktop();

    // The Vulkan extensions for windows, for gpu::InstanceOptions::extensions.
    [[nodiscard]] Result<std::vector<const char*>> vulkan_extensions() const;

  private:
    friend class Window;
    explicit Desktop(bool open) : open_(open), lost_(std::make_shared<bool>(false)) {}
    bool open_ = false;
    std::shared_ptr<bool> lost_;  // the display server has ended; Xlib's exit handler holds the address
};

// A rectangle on the desktop; the desktop extends over all monitors. In desktop units: pixels, except where
// the desktop scales windows itself.
struct DesktopArea {
    int x = 0, y = 0;  // the upper left corner
    int width = 0, height = 0;
};

struct Monitor {
    std::string name;  // as the desktop calls its output, such as "DP-1"
    DesktopArea area;
    double refresh_rate = 0.0;  // Hz; 0: unknown
};

// The connected monitors, the primary one first.
std::vector<Monitor> monitors(const Desktop& desktop);

struct WindowOptions {
    std::string title = "Boltwright";
    // Size at a content scale of 1. On X11 the window gets this many pixels times content_scale(), but no
    // more than the primary monitor's work area.
    std::uint32_t width = 1280, height = 720;
    bool full_screen = false;
    bool hidden = false;  // to query the display without showing a window
    // Covers exactly this area, without a frame, and stays there when another window has the focus: for
    // projection walls. Replaces width, height and full_screen.
    std::optional<DesktopArea> covers;
};

struct Size {
    std::uint32_t width = 0, height = 0;
};

class Window {
  public:
    static Result<Window> open(const Desktop& desktop, const WindowOptions& options);
    Window(Window&&) noexcept;
    Window& operator=(Window&&) noexcept;
    ~Window();

    // The surface must be destroyed before the window and the instance.
    [[nodiscard]] Result<gpu::Surface> make_surface(const gpu::Instance& instance) const;

    // Return the events since the last call: poll_events() at once, wait_for_events() after waiting at most
    // `seconds` for the first one. Only poll_events() reads game controllers.
    std::vector<InputEvent> poll_events();
    std::vector<InputEvent> wait_for_events(double seconds);

    // Fails if the display server has ended.
    [[nodiscard]] Status display_status() const;

    [[nodiscard]] Size pixels() const;          // framebuffer size; zero while minimised on some systems
    [[nodiscard]] float content_scale() const;  // 2 on a display with doubled text size
    [[nodiscard]] double refresh_rate() const;  // refresh rate of the window's display, Hz; 0: unknown
    void set_title(const std::string& title);
    void resize(Size size);  // in desktop units

    // Fills the display that shows most of the window. Leaving full screen restores position and size.
    void set_full_screen(bool on);
    [[nodiscard]] bool full_screen() const;

  private:
    struct State;  // GLFW holds its address
    explicit Window(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace bolt::platform
