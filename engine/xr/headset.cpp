#include "engine/xr/headset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace bolt::xr {

namespace {

// Pause before the next search, s: short while no headset is found; longer after each session that cannot be
// started, because each attempt creates all objects on the GPU again.
constexpr double short_interval = 1.0, longest_interval = 60.0;
constexpr double search_timeout = 10.0;  // s, for find()
// The longest wait, s, for the thread of a lost headset: about a frame. The thread may stay longer in a
// runtime that hangs, but the lesson does not wait for it.
constexpr double lost_wait = 0.03;
constexpr std::chrono::seconds retired_timeout{2};
constexpr double exit_timeout = 2.0;  // s in which the session passes through its last states

}  // namespace

void Headset::log(const std::string& line) const {
    if (options_.log) options_.log(line);
}

bool Headset::search_due(double now) {
    finish_retired();
    if (runtime_ || retired_ || search_.runs() || exit_requested_) return false;
    if (last_search_ && now - *last_search_ < search_interval_) return false;
    last_search_ = now;
    return true;
}

bool Headset::take_found(double timeout) {
    std::optional<Result<std::unique_ptr<Runtime>>> found = search_.take(timeout);
    if (!found) return false;
    if (!*found) {
        const Error& error = found->error();
        // Log the same error once, not every second.
        if (!absence_ || absence_->message() != error.message()) log(error.message());
        absence_ = error;
        return false;
    }
    runtime_ = std::move(**found);
    absence_.reset();
    if (refusal_.empty()) log(fmt::format("headset: {} with {}", runtime_->headset(), runtime_->name()));
    return true;
}

bool Headset::find(double now) {
    if (!search_due(now)) return false;
    search_.start(now);
    return take_found(search_timeout);
}

bool Headset::find_in_background(double now) {
    if (search_due(now)) search_.start(now);
    return take_found(0.0);
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
    events_.clear();
    pending_error_.reset();
    if (session_ && !session_->stop(lost_wait)) {
        retired_.emplace(Retired{std::move(runtime_), std::move(input_), std::move(session_),
                                 std::chrono::steady_clock::now()});
        return;
    }
    input_.reset();
    session_.reset();
    runtime_.reset();
}

// Destroys a retired headset if its thread has returned. After `retired_timeout` it is abandoned.
void Headset::finish_retired() {
    if (!retired_) return;
    const bool finished = retired_->session->stop(0.0);
    if (!finished && std::chrono::steady_clock::now() - retired_->since < retired_timeout) return;
    if (!finished) {
        retired_->session->abandon();
        (void)retired_->input.release();
    }
    retired_->input.reset();
    retired_->session.reset();
    retired_.reset();
}

void Headset::refuse(const Error& error) {
    search_interval_ = std::min(2.0 * search_interval_, longest_interval);
    absence_ = error;
    if (std::exchange(refusal_, error.message()) != error.message())
        log(fmt::format("the headset cannot be used, and the window is used without it: {}",
                        error.message()));
    drop();
}

void Headset::begin(gpu::Device& device) {
    Result<std::unique_ptr<Session>> session = Session::create(*runtime_, device, options_.session);
    if (!session) return refuse(session.error());
    session_ = std::move(*session);
    Result<std::unique_ptr<XrInput>> input = XrInput::create(*session_, options_.names);
    if (!input) return refuse(input.error());
    input_ = std::move(*input);
    search_interval_ = short_interval;
    refusal_.clear();
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
    while (retired_) {
        finish_retired();
        if (retired_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    search_.stop();
}

std::optional<HeadsetFrame> Headset::begin_frame(double timeout) {
    finish_retired();
    if (pending_error_) (void)drop_on_error(fail(*std::exchange(pending_error_, std::nullopt)));
    if (!session_ || !drop_on_error(session_->poll(events_))) return std::nullopt;
    for (const SessionEvent& event : events_)
        if (std::holds_alternative<TrackersChanged>(event) || std::holds_alternative<EventsLost>(event))
            input_->trackers_changed();
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

// Returns and removes the events that have happened by the time of a frame. A change of the origin stays
// queued until then, because the runtime announces it in advance.
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
    if (session_)
        for (const std::string& line : session_->take_passthrough_messages()) log(line);
}

void Headset::vibrate(Side side, const Vibration& vibration) {
    if (!session_ || pending_error_ || !session_->focused()) return;
    // The session is dropped later: commands that were recorded and not submitted may use its images.
    if (const Status status = input_->vibrate(side, vibration); !status) pending_error_ = status.error();
}

}  // namespace bolt::xr
