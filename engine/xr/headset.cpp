#include "engine/xr/headset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace bolt::xr {

namespace {

// s until the next search: short while no headset is found; longer after each session that cannot be started,
// because each attempt creates all objects on the GPU again.
constexpr double short_interval = 1.0, longest_interval = 60.0;
constexpr double exit_timeout = 2.0;  // s in which the session passes through its last states

}  // namespace

void Headset::log(const std::string& line) const {
    if (options_.log) options_.log(line);
}

bool Headset::find(double now) {
    if (runtime_ || exit_requested_ || (last_search_ && now - *last_search_ < search_interval_)) return false;
    last_search_ = now;
    Result<std::unique_ptr<Runtime>> found = Runtime::open();
    if (!found) {
        // Log the same error once, not every second.
        if (!absence_ || absence_->message() != found.error().message()) log(found.error().message());
        absence_ = found.error();
        return false;
    }
    runtime_ = std::move(*found);
    absence_.reset();
    log(fmt::format("headset: {} with {}", runtime_->headset(), runtime_->name()));
    return true;
}

bool Headset::drop_on_error(const Status& status) {
    if (status) return true;
    absence_ = status.error();
    log(fmt::format("the headset is lost: {}", status.error().message()));
    drop();
    return false;
}

void Headset::drop() {
    if (session_ && session_->counts().begun > 0)
        log(fmt::format("headset: {}", describe(session_->counts())));
    if (session_ && !session_->stop()) (void)input_.release();
    input_.reset();
    session_.reset();
    runtime_.reset();
    events_.clear();
    pending_error_.reset();
}

void Headset::begin(gpu::Device& device) {
    Result<std::unique_ptr<Session>> session = Session::create(*runtime_, device, options_.session);
    search_interval_ = std::min(2.0 * search_interval_, longest_interval);
    if (!session) {
        (void)drop_on_error(fail(session.error()));
        return;
    }
    session_ = std::move(*session);
    Result<std::unique_ptr<XrInput>> input = XrInput::create(*session_, options_.names);
    if (!input) {
        (void)drop_on_error(fail(input.error()));
        return;
    }
    input_ = std::move(*input);
    search_interval_ = short_interval;
    log(fmt::format("headset: {} eye(s) of {}x{} pixels, poses relative to the {}{}",
                    runtime_->views().size(), session_->extent().width, session_->extent().height,
                    name(session_->base_space()), session_->uses_depth() ? ", with depth" : ""));
}

void Headset::end() {
    if (session_ && session_->running() && session_->request_exit()) {
        // The runtime expects frames until it has stopped the session.
        const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(exit_timeout);
        while (session_ && !session_->ended() && std::chrono::steady_clock::now() < until) {
            if (!session_->poll(events_)) break;
            const Result<std::optional<FrameTiming>> frame = session_->begin_frame(0.01);
            if (!frame) break;
            if (*frame && !session_->end_frame(**frame, {})) break;
            if (!session_->running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    drop();
}

std::optional<HeadsetFrame> Headset::begin_frame(double timeout) {
    if (pending_error_) (void)drop_on_error(fail(*std::exchange(pending_error_, std::nullopt)));
    if (!session_ || !drop_on_error(session_->poll(events_))) return std::nullopt;
    if (session_->ended()) {
        exit_requested_ = true;
        drop();
        log("the program was ended in the headset's menu");
        return std::nullopt;
    }
    const Result<std::optional<FrameTiming>> begun = session_->begin_frame(timeout);
    if (!begun) {
        (void)drop_on_error(fail(begun.error()));
        return std::nullopt;
    }
    if (!*begun) return std::nullopt;
    HeadsetFrame frame;
    frame.timing = **begun;
    frame.focused = session_->focused();
    const Result<Hands> hands = input_->read(frame.timing);
    if (!hands) {
        (void)drop_on_error(fail(hands.error()));
        return std::nullopt;
    }
    frame.hands = *hands;
    locate(frame);
    if (!session_) return std::nullopt;
    for (const Side side : {Side::left, Side::right})
        add_gestures(frame.hands[side], side, frame.view.head, pinches_[static_cast<std::size_t>(side)]);
    frame.events = take_events(frame.timing.display_time);
    return frame;
}

// The events that have happened by the time of a frame; the runtime announces a new origin before it moves
// it.
std::vector<SessionEvent> Headset::take_events(XrTime time) {
    std::vector<SessionEvent> happened, later;
    for (SessionEvent& event : events_) {
        const auto* recentred = std::get_if<Recentred>(&event);
        (recentred != nullptr && recentred->time > time ? later : happened).push_back(event);
    }
    events_ = std::move(later);
    return happened;
}

void Headset::locate(HeadsetFrame& frame) {
    if (!session_ || pending_error_) return;
    Result<HeadView> view = session_->locate(frame.timing);
    if (!view) {
        (void)drop_on_error(fail(view.error()));
        return;
    }
    frame.view = std::move(*view);
}

void Headset::record(VkCommandBuffer commands, std::span<const EyePicture> pictures) {
    if (session_ && !pending_error_) (void)drop_on_error(session_->record(commands, pictures));
}

void Headset::end_frame(const HeadsetFrame& frame, bool drawn, const DepthRange& depth) {
    if (pending_error_) (void)drop_on_error(fail(*std::exchange(pending_error_, std::nullopt)));
    if (session_)
        (void)drop_on_error(
            session_->end_frame(frame.timing, {drawn ? &frame.view : nullptr, depth, frame.passthrough}));
}

void Headset::vibrate(Side side, const Vibration& vibration) {
    if (!session_ || pending_error_ || !session_->focused()) return;
    // The session is dropped later: commands that were recorded and not submitted may use its images.
    if (const Status status = input_->vibrate(side, vibration); !status) pending_error_ = status.error();
}

}  // namespace bolt::xr
