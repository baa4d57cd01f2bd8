// Runs the content of a desktop window: calls it for every frame, and restarts it after the loss of the GPU.
#pragma once

#include <functional>

#include "engine/platform/window.hpp"
#include "game/view/camera.hpp"
#include "game/view/pictures.hpp"

namespace bolt::view {

// The content of a window. All its GPU objects can be released and created again after a lost GPU.
class WindowContent {
  public:
    WindowContent() = default;
    WindowContent(const WindowContent&) = delete;
    WindowContent& operator=(const WindowContent&) = delete;
    virtual ~WindowContent() = default;

    // Creates all GPU objects. Called at the beginning and after release().
    virtual Status start(GpuContext& gpu_context) = 0;
    // Releases all GPU objects, before the GPU context is destroyed.
    virtual void release() = 0;
    // Records a frame; the picture is the renderer's picture 0. `scale`: px per point. `seconds`: since the
    // last frame.
    virtual Status frame(gpu::FrameContext& frame, std::span<const platform::InputEvent> events,
                         VkExtent2D size, float scale, double seconds) = 0;
    // Replaces frame() while the window is minimised.
    virtual Status frame_while_hidden() { return {}; }
    // The window closes, or drawing has failed for good.
    virtual Status end() { return {}; }

    [[nodiscard]] virtual bool closed() const = 0;
    // True once after each request to switch between window and full screen.
    [[nodiscard]] virtual bool take_full_screen_request() { return false; }
};

// Moves an orbit with the mouse: left button turns, right or middle button moves the target, the wheel zooms.
class OrbitControl {
  public:
    struct PictureShape {
        double height = 1.0;  // px
        double aspect = 1.0;  // width / height
    };
    // Returns true if the orbit moved. `box`: of the model.
    bool apply(std::span<const platform::InputEvent> events, const PictureShape& picture, Orbit& orbit,
               const render::BoundingBox& box);
    // Ends a drag, for example because the pointer is over a panel.
    void stop();

  private:
    enum class Drag : std::uint8_t { none, turn, pan };
    Drag drag_ = Drag::none;
    platform::Button held_ = platform::Button::other;
    glm::dvec2 cursor_{0.0};
};

// How run_in_window() runs the content.
struct WindowRunOptions {
    std::string gpu;             // part of the name of the GPU to use; empty: the best
    std::function<bool()> stop;  // polled every frame; true closes the window
};

// Returns when the window is closed. After the loss of the GPU it creates a new GPU context and restarts the
// content, unless the GPU was lost shortly before (gpu::DeviceLossPolicy).
Status run_in_window(WindowContent& content, platform::Window& window, const gpu::Instance& instance,
                     const WindowRunOptions& options = {});

}  // namespace bolt::view
