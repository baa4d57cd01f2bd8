// Runs the content of a desktop window, and of a headset or of projection walls if there are any: calls it
// for every frame, and restarts it after the loss of the GPU, and when a headset was found.
#pragma once

#include <functional>

#include "engine/cluster/message.hpp"
#include "engine/platform/window.hpp"
#include "game/view/camera.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/immersive_frame.hpp"

namespace bolt::view {

class Walls;
class WallFollower;

// The input of one frame of a window.
struct WindowFrame {
    std::span<const platform::InputEvent> events;
    VkExtent2D size{};                          // px, of the window
    float scale = 1.0F;                         // px per point
    double seconds = 0.0;                       // since the last frame
    const ImmersiveFrame* immersive = nullptr;  // null: the window is the only display
    // The share of the window's width and height at which a scene is drawn, below 1 if the GPU is too slow
    // for all pixels. The interface is always drawn with all pixels.
    float resolution = 1.0F;
};

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
    // Applies the input and advances by the time of the frame.
    virtual Status update(const WindowFrame& window) = 0;
    // Records the commands of the frame. Without an immersive frame, and on walls, it makes window_picture().
    // With an immersive frame, each group of eyes is drawn as a group of the renderer. The poses of the eyes
    // may be newer than those of update().
    virtual Status draw(gpu::FrameContext& frame, const WindowFrame& window) = 0;
    // Called between draw() and the submission of a headset's frame, with its newest eyes. Moves the recorded
    // pictures to them (Renderer::move_eyes). Returns false if they stay where draw() had them.
    virtual bool move_eyes(const WindowFrame&) { return false; }
    // The picture for the window, valid after draw(). On walls the control window shows all of it; the window
    // of a headset does not use it.
    [[nodiscard]] virtual render::ImageLayer window_picture(const render::Renderer& renderer) const {
        return renderer.picture(0);
    }
    // For the window of a headset: which pictures it shows, and the panel, if there is one.
    [[nodiscard]] virtual Mirror mirror() const { return Mirror::left_eye; }
    [[nodiscard]] virtual std::optional<render::ImageLayer> panel_picture() const { return std::nullopt; }
    // On walls of several processes, the first one calls share() after update(), to write what the others
    // need to draw the frame. The others call follow() before update(), to read it. Contents that only one
    // process shows need neither.
    // The state of a frame stays below 4 KiB; what is larger, and rarely changes, is in `bulk`.
    virtual Status share(cluster::MessageWriter& /*state*/, cluster::MessageWriter& /*bulk*/) { return {}; }
    virtual Status follow(cluster::MessageReader& /*state*/, cluster::MessageReader& /*bulk*/) { return {}; }
    // Called instead of update() and draw() while the window is minimised and is the only display.
    virtual Status frame_while_hidden() { return {}; }
    // Called once, when the window closes or drawing has failed permanently.
    virtual Status end() { return {}; }

    [[nodiscard]] virtual bool closed() const = 0;
    // True while the content is to be shown on another display: run_in_window() then returns without a call
    // of end(), and the caller runs it again with that display.
    [[nodiscard]] virtual bool wants_other_display() const { return false; }
    // The picture of the window uses WindowFrame::resolution at the moment.
    [[nodiscard]] virtual bool scales_scene() const { return false; }
    // The background of immersive pictures is transparent, to show the real room in a headset with
    // passthrough.
    [[nodiscard]] virtual bool wants_passthrough() const { return false; }
    // True once after each request to switch between window and full screen.
    [[nodiscard]] virtual bool take_full_screen_request() { return false; }
};

// px, error allowed for coarser levels of detail in windows and on walls (RendererOptions::level_error_px).
inline constexpr float window_level_error = 0.7F;

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

// The options of run_in_window().
struct WindowRunOptions {
    std::string gpu{};               // part of the name of the GPU to use; empty: the best
    std::function<bool()> stop{};    // polled every frame; true closes the window
    xr::Headset* headset = nullptr;  // null: none is used
    // True: the run fails with ErrorCode::no_device if the first headset cannot be used. False: the window
    // shows the content instead. A headset that fails later never ends the run.
    bool needs_headset = false;
    Walls* walls = nullptr;  // null: there are none; not together with a headset
    // True: lowers the resolution of a headset if the GPU cannot keep its frame rate, and that of scenes in
    // the window if it cannot draw 30 frames a second.
    bool adapts_resolution = true;
    // With a headset: the options with which the instance of run_in_window() was created. When a headset is
    // found, its runtime creates the instance again with these options and the same log.
    gpu::InstanceOptions instance{};
};

// Creates the Vulkan instance; if a headset was found, its runtime creates it. If the runtime cannot, fails
// with ErrorCode::no_device if `needs_headset`; otherwise creates the instance without the headset, which is
// then not used.
Result<gpu::Instance> make_instance(gpu::InstanceOptions instance_options, xr::Headset* headset,
                                    bool needs_headset);

// Returns when the window is closed, or the content wants another display. After the loss of the GPU it
// creates a new GPU context and restarts the content, unless the GPU was lost shortly before
// (gpu::DeviceLossPolicy). A headset may be found, be lost and return at any time; meanwhile the content is
// shown in the window.
Status run_in_window(WindowContent& content, platform::Window& window, gpu::Instance& instance,
                     WindowRunOptions options = {});

// Shows the walls of this process in step with the first process, until the first process ends. `gpu`: part
// of the name of the GPU to use; empty: the best.
Status follow_on_walls(WindowContent& content, Walls& walls, WallFollower& follower,
                       const gpu::Instance& instance, const std::string& gpu);

}  // namespace bolt::view
