// A session with a headset: its states, its frames, its pictures. One call sequence per frame:
//
//   poll()                        always, also while the session does not run
//   begin_frame()                 only while running(); if it returns none, draw the window and try again
//   locate(), then draw           only if FrameTiming::should_render
//   record()                      copies the pictures into the headset's, in the same command buffer
//   (submit the command buffer)
//   end_frame()
//
// xrWaitFrame blocks for up to a frame of the headset, so it runs on a thread of its own. The lesson and the
// window wait in begin_frame() at most for its timeout, and in record() at most 20 ms for each image.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/gpu/resources.hpp"
#include "engine/xr/passthrough.hpp"
#include "engine/xr/runtime.hpp"

namespace bolt::xr {

// Triangles, three corners each, that cover the part of an eye's picture that the lens hides: x right, y up,
// on the plane 1 m in front of the eye.
using HiddenArea = std::vector<glm::vec2>;

struct EyeView {
    Pose pose;  // of the eye, in the session's base space: x right, y up, z towards the viewer
    FieldOfView fov;
    std::shared_ptr<const HiddenArea> hidden = nullptr;  // null: the runtime has no mask
};

// The poses of the head and the eyes when a frame is displayed.
struct HeadView {
    Pose head;
    std::vector<EyeView> eyes;  // left, right; one for a mono display; none: the poses are not known
    bool tracked = false;       // false: estimated or held; draw with it, but do not rely on it otherwise
};

struct FrameTiming {
    XrTime display_time = 0;     // ns, on the runtime's clock
    double period = 0.0;         // s between frames of the display
    bool should_render = false;  // false: nothing that is drawn would be seen
};

// Returns the period of the display, ns. `known`: the period that was returned before; 0: none. `reported`:
// by the runtime for the next frame. Returns `known` if `reported` is a multiple of it: some runtimes, such
// as Monado, report the period of the program's frames, which grows when the program misses frames. Otherwise
// returns `reported`: the display has changed its frame rate.
XrDuration display_period(XrDuration known, XrDuration reported);

// The frames since a session was created.
struct FrameCounts {
    std::int64_t begun = 0;
    std::int64_t drawn = 0;   // with pictures
    std::int64_t missed = 0;  // in which the display showed an older picture, because the next one was late
    double seconds = 0.0;     // between the first and the last frame, on the display's clock
    double waited = 0.0;      // s for which begin_frame() waited for the runtime
};
// "812 frames in 60.0 s (13.5 a second, 800 drawn), 388 missed, 1.2 s of waiting".
std::string describe(const FrameCounts& counts);

// The base space of all poses.
enum class BaseSpace : std::uint8_t {
    stage,   // fixed in the room, origin on the floor
    floor,   // origin on the floor below where the head was at the last recentring
    seated,  // origin where the head was at the last recentring
};
constexpr const char* name(BaseSpace space) {
    switch (space) {
        case BaseSpace::stage:
            return "stage";
        case BaseSpace::floor:
            return "floor";
        default:
            return "seated";
    }
}

struct SessionOptions {
    // True: the base space is `seated`. False: it is the first available of stage, floor and seated.
    bool seated = false;
    bool submit_depth = true;    // if the runtime uses depth to correct the picture
    bool separate_eyes = false;  // a swapchain for each eye even if one with two layers can be created
};

// The events of the session. poll() appends them in the order in which the runtime reports them.
struct StateChanged {
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
};
// The origin of the stage, the floor or the seated space moves at `time`, because the user wants the scene in
// front again. When the user presses the recentre button, headsets move only some of these spaces.
struct Recentred {
    XrTime time = 0;
    // True: the origin of the base space moves. `shift`: then the pose of the new origin in the old space, if
    // the runtime reports it.
    bool base = true;
    std::optional<Pose> shift;
};
// The user has put the headset on or taken it off. Only with XR_EXT_user_presence.
struct UserPresence {
    bool worn = false;
};
struct BindingsChanged {};  // other controllers: their names and buttons differ
struct TrackersChanged {};  // a Vive tracker was connected, or has another role
struct VisibilityMaskChanged {};
struct EventsLost {};  // the runtime's queue was full; query everything again
using SessionEvent = std::variant<StateChanged, Recentred, UserPresence, BindingsChanged, TrackersChanged,
                                  VisibilityMaskChanged, EventsLost>;

// The picture of one eye. Both images must be in gpu::ResourceUse::transfer_from; `depth` may be null. The
// picture may be smaller than Session::extent(); the headset then magnifies it.
struct EyePicture {
    const gpu::Image* picture = nullptr;
    std::uint32_t layer = 0;
    const gpu::Image* depth = nullptr;
    std::uint32_t depth_layer = 0;
    VkExtent2D extent{};
};

// Distances, m, at which the depth is 1 and 0.
struct DepthRange {
    float near = 0.05F, far = 100.0F;
};

// Return the best format among those that the runtime offers; none: no format is usable. Pictures hold sRGB
// colours: they need an sRGB or a linear floating-point format, otherwise they would look darker or paler.
std::optional<VkFormat> choose_color_format(std::span<const std::int64_t> offered);
std::optional<VkFormat> choose_depth_format(std::span<const std::int64_t> offered);

class FrameWaiter;

class Session {
  public:
    // `runtime` and `device` must outlive the session; the device was created by `runtime`.
    static Result<std::unique_ptr<Session>> create(Runtime& runtime, gpu::Device& device,
                                                   const SessionOptions& options);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    ~Session();

    // Takes the runtime's events and follows its state. Fails with Error::lost if the session or the runtime
    // is lost: destroy the session, then try to create another one.
    Status poll(std::vector<SessionEvent>& events);

    [[nodiscard]] XrSessionState state() const { return state_; }
    [[nodiscard]] bool running() const { return running_; }
    // True if the user wears the headset and sees the picture. If false, pause the lesson and end all forces.
    // With some runtimes a headset on a table keeps its focus. Only runtimes with XR_EXT_user_presence report
    // that it is not worn.
    [[nodiscard]] bool focused() const { return state_ == XR_SESSION_STATE_FOCUSED && worn_; }
    // True if the runtime has asked the program to end its session; do not create another one.
    [[nodiscard]] bool ended() const { return ended_; }

    // Begins the next frame if the runtime has released it; waits at most `timeout` s for that.
    Result<std::optional<FrameTiming>> begin_frame(double timeout);
    // Views and head at the time of the frame. Call it as late as possible.
    Result<HeadView> locate(const FrameTiming& frame);
    // Copies the pictures, one for each eye, into images of the headset.
    Status record(VkCommandBuffer commands, std::span<const EyePicture> pictures);
    struct Drawn {
        const HeadView* view = nullptr;  // the views that were drawn and recorded; null: none
        DepthRange depth;
        // Show the real room behind the pictures if the headset can. The pictures then have premultiplied
        // alpha.
        bool passthrough = false;
    };
    // Ends the frame.
    Status end_frame(const FrameTiming& frame, const Drawn& drawn);
    [[nodiscard]] const FrameCounts& counts() const { return counts_; }

    // Largest size of an eye's picture.
    [[nodiscard]] VkExtent2D extent() const { return extent_; }
    // True if the headset can show the real room behind the pictures; false also after the runtime has
    // refused to.
    [[nodiscard]] bool has_passthrough() const {
        return runtime_->passthrough().has_value() || passthrough_.available();
    }
    // Lines for the user about the real room, since the last call.
    std::vector<std::string> take_passthrough_messages() { return passthrough_.take_messages(); }
    [[nodiscard]] bool uses_depth() const { return !depth_.empty(); }
    [[nodiscard]] BaseSpace base_space() const { return base_; }
    [[nodiscard]] XrSpace space() const { return space_.get(); }
    [[nodiscard]] XrSession get() const { return session_.get(); }
    [[nodiscard]] Runtime& runtime() const { return *runtime_; }

    // Requests the end of the session, which then passes through its remaining states.
    Status request_exit();
    // Ends the thread that waits for frames; afterwards the session can only be destroyed. Returns false if
    // the thread has not returned from the runtime after `timeout` s; call it again later, or abandon().
    bool stop(double timeout);
    // Leaves the session's objects and the runtime to the operating system, because the thread never
    // returned. Do not destroy the session's XrInput either.
    void abandon();

  private:
    struct Swapchain {
        XrSwapchainHandle handle;
        std::vector<VkImage> images;
        VkExtent2D extent{};
        VkFormat format = VK_FORMAT_UNDEFINED;
        std::optional<std::uint32_t> acquired;  // image that is acquired and not released
        bool ready = false;                     // the runtime no longer reads that image
    };

    Session() = default;
    Status create_session();
    Status create_spaces();
    Status create_swapchains();
    Result<Swapchain> make_swapchain(VkFormat format, std::uint32_t layers, XrSwapchainUsageFlags usage);
    Status handle_state_change(const XrEventDataSessionStateChanged& event);
    Status end_if_stopping(double timeout);
    void count(XrTime display_time);
    void find_hidden_areas();
    Status acquire(Swapchain& swapchain);
    Status release(Swapchain& swapchain);
    template <class Visit>
    Status each_swapchain(const Visit& visit);
    [[nodiscard]] XrSwapchainSubImage sub_image(const std::vector<Swapchain>& swapchains,
                                                std::size_t eye) const;

    Runtime* runtime_ = nullptr;
    gpu::Device* device_ = nullptr;
    SessionOptions options_;
    SessionHandle session_;
    SpaceHandle space_, head_;
    PassthroughLayer passthrough_;
    BaseSpace base_ = BaseSpace::stage;
    VkExtent2D extent_{};
    std::vector<Swapchain> color_, depth_;  // one with a layer per eye, or one per eye; depth may be empty
    std::vector<VkExtent2D> drawn_;         // sizes of the pictures that record() copied
    bool depth_drawn_ = false;              // record() also copied their depth
    std::shared_ptr<FrameWaiter> waiter_;
    FrameCounts counts_;
    XrDuration period_ = 0;                    // of the display, ns
    std::optional<XrTime> last_display_time_;  // of this run of the session
    XrSessionState state_ = XR_SESSION_STATE_UNKNOWN;
    bool running_ = false, ended_ = false, abandoned_ = false;
    bool stopping_ = false;  // the runtime waits for xrEndSession, which waits for the thread
    bool worn_ = true;       // false only if the runtime reports it
    std::array<std::shared_ptr<const HiddenArea>, 2> hidden_;  // by eye
    bool hidden_known_ = false;                                // queried since the last change
};

}  // namespace bolt::xr
