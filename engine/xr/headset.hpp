// A headset that may be absent, appear, be lost and return while the program runs. After a loss the program
// continues without it, with the GPU objects that it has; the headset returns with a new runtime instance,
// for which Vulkan's instance and device must be created again.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/xr/hand_gestures.hpp"
#include "engine/xr/headset_search.hpp"
#include "engine/xr/input.hpp"
#include "engine/xr/session.hpp"

namespace bolt::xr {

struct HeadsetOptions {
    SessionOptions session;
    ActionNames names;
    std::function<void(const std::string&)> log;  // receives one line for each change; may be empty
};

// A frame of the headset, from begin_frame() to end_frame().
struct HeadsetFrame {
    FrameTiming timing;
    HeadView view;  // without eyes: nothing can be drawn
    Hands hands;
    bool focused = false;      // Session::focused(); false: pause the lesson, output no force, hide the hands
    bool passthrough = false;  // set by the caller: show the real room behind the pictures, if possible
    // Events since the last frame. Recentred comes with the first frame whose poses are in the new space.
    std::vector<SessionEvent> events;
};

class Headset {
  public:
    explicit Headset(HeadsetOptions options) : options_(std::move(options)) {}
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;
    ~Headset() { end(); }

    // Searches for a headset if there is none, at most once a second, and less often if its session could not
    // be started. Waits at most 10 s for the runtime. Returns true if one was found. Then destroy all Vulkan
    // objects, create them with creator(), and call begin().
    bool find(double now);
    // As find(), but never waits for the runtime: returns true some calls later.
    bool find_in_background(double now);
    // The reason why there is no headset; none: there is one, or no search has ended yet.
    [[nodiscard]] const std::optional<Error>& absence() const { return absence_; }
    // Creates Vulkan's instance and device for the headset; null: none was found.
    [[nodiscard]] gpu::VulkanCreator* creator() const { return runtime_.get(); }

    // Starts the session, with a device that creator() created and that must outlive it. If this fails, the
    // headset is refused.
    void begin(gpu::Device& device);
    // Call it if creator() failed, or if the objects that it created cannot be used. The headset is then
    // absent, and find() searches for it again later. Repeated equal errors are logged once.
    void refuse(const Error& error);
    // Ends the session in the order that OpenXR requires, and releases the runtime. Call it before the device
    // is destroyed.
    void end();

    [[nodiscard]] bool connected() const { return session_ != nullptr; }
    // True if the session shows pictures. begin_frame() then determines the frame rate.
    [[nodiscard]] bool running() const { return session_ && session_->running(); }
    // The user has ended the program in the headset's own menu.
    [[nodiscard]] bool exit_requested() const { return exit_requested_; }

    // Polls the runtime's events, and begins a frame if one is due; waits at most `timeout` s for that. Call
    // it also while the session is not running, because an event starts the session.
    std::optional<HeadsetFrame> begin_frame(double timeout);
    // Updates `frame.view` to the latest prediction of the head pose: the later the call, the smaller its
    // error. Not between record() and end_frame().
    void locate(HeadsetFrame& frame);
    // Copies the pictures of the eyes, drawn for HeadsetFrame::view, into images of the headset.
    void record(VkCommandBuffer commands, std::span<const EyePicture> pictures);
    // Ends the frame, after its commands were submitted. `drawn`: record() was called.
    void end_frame(const HeadsetFrame& frame, bool drawn, const DepthRange& depth);

    void vibrate(Side side, const Vibration& vibration);

    // Valid while connected.
    [[nodiscard]] const Session& session() const { return *session_; }
    [[nodiscard]] const Runtime& runtime() const { return *runtime_; }
    [[nodiscard]] const XrInput& input() const { return *input_; }

  private:
    void log(const std::string& line) const;
    // Returns true if `status` is a success; otherwise drops the headset.
    bool drop_on_error(const Status& status);
    void drop();
    // Returns true if a search is due.
    [[nodiscard]] bool search_due(double now);
    bool take_found(double timeout);
    void finish_retired();
    std::vector<SessionEvent> take_events(XrTime time);

    HeadsetOptions options_;
    std::unique_ptr<Runtime> runtime_;
    std::unique_ptr<Session> session_;
    std::unique_ptr<XrInput> input_;
    std::array<PinchState, 2> pinches_;  // by Side
    // A lost headset whose thread has not returned from the runtime yet; destroyed once it has returned.
    struct Retired {
        std::unique_ptr<Runtime> runtime;
        std::unique_ptr<XrInput> input;
        std::unique_ptr<Session> session;
        std::chrono::steady_clock::time_point since;
    };
    std::optional<Retired> retired_;
    HeadsetSearch search_;
    std::vector<SessionEvent> events_;
    std::optional<Error> absence_;
    // Error of vibrate(). The session is dropped at the end of the frame, because commands that are recorded
    // may use its images.
    std::optional<Error> pending_error_;
    std::optional<double> last_search_;
    double search_interval_ = 1.0;  // s
    std::string refusal_;           // why the last headset that was found could not be used; empty: it could
    bool exit_requested_ = false;
};

}  // namespace bolt::xr
