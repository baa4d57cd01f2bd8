// A window of the desktop, by GLFW. What people do to it comes as values (input.hpp); what it shows is
// gpu::Swapchain's.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/surface.hpp"
#include "engine/platform/input.hpp"

namespace bolt::platform {

// The desktop. GLFW knows only one, so there is one of these at a time; it goes after its windows. Everything
// here belongs to the main thread.
class Desktop {
  public:
    // Fails where there is no display.
    static Result<Desktop> open();
    Desktop(Desktop&& other) noexcept
        : open_(std::exchange(other.open_, false)), gone_(std::move(other.gone_)) {}
    Desktop& operator=(Desktop&& other) noexcept {
        std::swap(open_, other.open_);
        std::swap(gone_, other.gone_);
        return *this;
    }
    ~Desktop();

    // What Vulkan needs for windows here: gpu::InstanceOptions::extensions.
    [[nodiscard]] Result<std::vector<const char*>> vulkan_extensions() const;

  private:
    friend class Window;
    explicit Desktop(bool open) : open_(open), gone_(std::make_shared<bool>(false)) {}
    bool open_ = false;
    std::shared_ptr<bool> gone_;  // its display server has ended; at an address that stays
};

struct WindowOptions {
    std::string title = "Boltwright";
    std::uint32_t width = 1280, height = 720;  // in the units of the desktop
    bool full_screen = false;
    bool hidden = false;  // to ask what it could show
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

    // A surface goes before its window and its instance.
    [[nodiscard]] Result<gpu::Surface> make_surface(const gpu::Instance& instance) const;

    // What has happened since the last call: at once, or after at most `seconds` of nothing.
    std::vector<Event> events();
    std::vector<Event> wait_for_events(double seconds);

    // Why nothing is seen and heard of people any more, if the display server has ended.
    [[nodiscard]] Status there() const;

    [[nodiscard]] Size pixels() const;  // of what is drawn; zero while it is minimised on some systems
    [[nodiscard]] float content_scale() const;  // 2 on a display where text is to be twice as large
    [[nodiscard]] double refresh() const;       // pictures a second of the display that it is on; 0: unknown
    void set_title(const std::string& title);
    void resize(Size size);  // in the units of the desktop

    // All of the display that most of the window is on, and back to where the window was.
    void set_full_screen(bool on);
    [[nodiscard]] bool full_screen() const;

  private:
    struct State;  // its address is GLFW's
    explicit Window(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace bolt::platform
