// Projection walls: for each output (the part of a monitor that one projector shows) a window without a
// border, and the pictures in it, as the tracked head sees the room through the wall. Poses are in the room's
// frame (view::ImmersiveFrame), m.
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
#include "game/head_tracking/head_source.hpp"
#include "game/view/immersive_frame.hpp"
#include "game/view/wall_cluster.hpp"

namespace bolt::view {

// The eyes of a head in front of a wall, the left one first; one eye in the middle for a mono wall. Empty if
// an eye is not in front of the wall: then nothing can be drawn on it.
EyeGroup wall_eyes(const content::Wall& wall, const Pose& head, double eye_separation, VkExtent2D size);

// Returns true if the ray from `eye` through `point` hits a wall from the front.
bool on_a_wall(std::span<const content::Wall> walls, const Vec3& eye, const Vec3& point);

// A window that shows a wall, or the picture of one of its eyes.
struct WallWindow {
    std::string title;
    platform::DesktopArea area;
    std::size_t wall = 0;  // index in the display file
    enum class Shows : std::uint8_t { all, left_output, right_output } shows = Shows::all;
};

// The monitors that this process can use, and its number. `cluster`: null: it is the only process.
content::DisplayHost this_host(const platform::Desktop& desktop, const cluster::Cluster* cluster = nullptr);

// The windows of the outputs of this process. Fails if an output is on a monitor that is not connected, on
// another X display, or of a process that does not exist. A process other than the first needs an output.
Result<std::vector<WallWindow>> plan_wall_windows(const content::DisplayFile& displays,
                                                  const content::DisplayHost& host);

// The part of a window that shows an eye: 0 is the first eye of wall_eyes().
struct EyeViewport {
    std::uint32_t eye = 0;
    VkRect2D area{};  // px
};
std::vector<EyeViewport> eye_viewports(const content::Wall& wall, WallWindow::Shows shows, VkExtent2D window);

struct WallsOptions {
    content::DisplayFile displays;
    std::optional<head_tracking::HeadSource> head;  // none in the processes that follow the first one
    cluster::Cluster* cluster = nullptr;            // null: this process shows all walls
    // Receives a line when the tracker finds or loses the head, or a process is slow; may be empty.
    std::function<void(const std::string&)> log;
};

// The windows of the walls of this process. Not movable, because the swapchains refer to their windows.
class Walls {
  public:
    static Result<std::unique_ptr<Walls>> open(const platform::Desktop& desktop, WallsOptions options);
    // Ends the other processes, if this is the first one of several.
    ~Walls();
    Walls(const Walls&) = delete;
    Walls& operator=(const Walls&) = delete;

    // Waits until the other processes have opened their walls (WallLeader::begin). Does nothing if this is
    // the only process. `fingerprint`: of program and display file; it must be equal in all processes.
    Status wait_for_processes(std::uint64_t fingerprint, StopWaiting stop);

    // Creates the swapchains; release() destroys them before the device is destroyed.
    Status start(gpu::Device& device, const gpu::Instance& instance);
    void release();

    // Keys and requests to close from the windows of all processes, since the last call. Events of the
    // pointer come only from the control window, which the first process has.
    std::vector<platform::InputEvent> poll_events();

    // The next frame: prepares the swapchains, and reads the pose of the head at the time `now`, s on the
    // steady clock. Group i belongs to wall i; it is empty for a wall of another process.
    Result<ImmersiveFrame> begin_frame(double now);
    // As above, with a head that another process has read.
    Result<ImmersiveFrame> begin_frame(const Pose& head, bool tracked);
    // Adds the pictures that the renderer has drawn for the frame to `windows`.
    void add_pictures(const render::Renderer& renderer, const ImmersiveFrame& immersive,
                      std::vector<gpu::WindowPictures>& windows) const;

    // Null: this is not the first of several processes.
    [[nodiscard]] WallLeader* leader() { return leader_ ? &*leader_ : nullptr; }
    // Sends the frame to the other processes. `content`, `bulk`: from WindowContent::share.
    Status share(const ImmersiveFrame& immersive, const cluster::Message& content,
                 const cluster::Message& bulk);
    // Waits until the other processes have drawn the frame, and permits all to present it.
    Status wait_for_others();

    [[nodiscard]] const content::DisplayFile& displays() const { return displays_; }
    [[nodiscard]] double refresh_rate() const;  // Hz, the lowest of the windows; 0: unknown
    // Makes the surface of this process's first window, with which a GPU that can present there is chosen.
    // Call it only in a process with a wall.
    [[nodiscard]] Result<gpu::Surface> make_surface(const gpu::Instance& instance);

  private:
    Walls() = default;
    struct Output {
        WallWindow plan;
        platform::Window window;
        std::unique_ptr<gpu::Swapchain> swapchain;
        VkExtent2D size{};
    };
    void log_status(tracking::HeadStatus status);

    content::DisplayFile displays_;
    std::optional<PanelPlace> panel_;
    std::optional<head_tracking::HeadSource> head_;
    cluster::Cluster* cluster_ = nullptr;
    std::optional<WallLeader> leader_;
    std::uint64_t frame_ = 0;                             // number of the frame that was sent last
    std::vector<platform::InputEvent> events_of_others_;  // since the last call of poll_events()
    std::optional<tracking::HeadStatus> logged_status_;   // in the log
    std::function<void(const std::string&)> log_;
    std::vector<Output> outputs_;
};

}  // namespace bolt::view
