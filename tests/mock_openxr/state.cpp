#include "tests/mock_openxr/state.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace bolt::mock {

namespace {

// Never destroyed: when the process ends, a thread of the client may still be inside the runtime.
State& make_state() {
    State& made = *new State();
    if (const char* file = std::getenv("MOCK_OPENXR_SCRIPT"); file != nullptr && *file != '\0') {
        made.config.real_time = true;
        made.script = load_script(made, file);
        run_commands(made, 0);
        made.script.frame = 1;
    }
    return made;
}

// Writes the report when the process ends without destroying its instance.
struct ReportAtExit {
    State& reported;
    ~ReportAtExit() {
        const std::lock_guard lock(reported.mutex);
        write_report(reported);
    }
};

}  // namespace

State& state() {
    static State& the_state = make_state();
    static const ReportAtExit report{the_state};
    return the_state;
}

void violate(State& s, std::string_view function, std::string_view what) {
    s.violations.push_back(fmt::format("{}: {}", function, what));
}

XrResult refuse(State& s, std::string_view function, XrResult result, std::string_view what) {
    violate(s, function, what);
    return result;
}

XrTime now(const State& s) {
    const Config& config = s.instance ? s.instance->config : s.config;
    if (!config.real_time)
        return s.instance && s.instance->session ? s.instance->session->last_display : XrTime{1};
    timespec t{};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return XrTime{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

namespace {

std::optional<XrResult> take_injected(State& s, std::string_view function) {
    const auto found = s.injected.find(function);
    if (found == s.injected.end() || found->second.count <= 0) return std::nullopt;
    if (found->second.skip > 0) {
        --found->second.skip;
        return std::nullopt;
    }
    --found->second.count;
    return found->second.result;
}

}  // namespace

XrResult enter_destroying(State& s, std::string_view function) {
    ++s.calls[std::string(function)];
    return take_injected(s, function).value_or(XR_SUCCESS);
}

std::optional<XrResult> enter(State& s, std::string_view function, Level level) {
    ++s.calls[std::string(function)];
    if (level != Level::global && !s.instance)
        return refuse(s, function, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    if (level == Level::session && !s.instance->session)
        return refuse(s, function, XR_ERROR_HANDLE_INVALID, "is called without a session");
    Instance* instance = s.instance ? &*s.instance : nullptr;
    const bool instance_lost = level != Level::global && instance->lost;
    const bool session_lost = level == Level::session && instance->session->lost;
    if (instance_lost || session_lost) {
        // Another thread may not have learned of the loss yet.
        if (!s.notified_of_loss.insert(std::this_thread::get_id()).second)
            violate(s, function, "is called after the loss; expected only destroying");
        return instance_lost ? XR_ERROR_INSTANCE_LOST : XR_ERROR_SESSION_LOST;
    }
    const std::optional<XrResult> injected = take_injected(s, function);
    if (!injected) return std::nullopt;
    const XrResult result = *injected;
    if (result == XR_ERROR_INSTANCE_LOST && instance != nullptr) instance->lost = true;
    if (result == XR_ERROR_SESSION_LOST && instance != nullptr && instance->session)
        instance->session->lost = true;
    if (result == XR_ERROR_INSTANCE_LOST || result == XR_ERROR_SESSION_LOST) {
        s.notified_of_loss.insert(std::this_thread::get_id());
        s.changed.notify_all();
    }
    return result;
}

void queue_event(State& s, const void* event, std::size_t size) {
    if (!s.instance) return;
    XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
    std::memcpy(&buffer, event, size);
    s.instance->events.push_back(buffer);
}

void enter_state(State& s, XrSessionState to) {
    Session& session = *s.instance->session;
    session.state = to;
    XrEventDataSessionStateChanged event{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED};
    event.session = handle_of<XrSession>(session.id);
    event.state = to;
    event.time = now(s);
    queue_event(s, &event, sizeof event);
    s.changed.notify_all();
}

void advance_session(State& s) {
    if (!s.instance || !s.instance->session) return;
    Session& session = *s.instance->session;
    if (session.lost) return;
    if (session.state == XR_SESSION_STATE_IDLE && s.worn && !session.exiting)
        enter_state(s, XR_SESSION_STATE_READY);
    if (!session.running || !session.begun_once) return;
    if (session.state == XR_SESSION_STATE_READY) enter_state(s, XR_SESSION_STATE_SYNCHRONIZED);
    if (session.state == XR_SESSION_STATE_SYNCHRONIZED && s.worn && !session.exiting)
        enter_state(s, XR_SESSION_STATE_VISIBLE);
    if (session.state == XR_SESSION_STATE_VISIBLE && s.focus) enter_state(s, XR_SESSION_STATE_FOCUSED);
    if (session.state == XR_SESSION_STATE_FOCUSED && !s.focus) enter_state(s, XR_SESSION_STATE_VISIBLE);
}

void stop_session(State& s) {
    Session& session = *s.instance->session;
    if (!session.running) return;
    if (session.state == XR_SESSION_STATE_READY) enter_state(s, XR_SESSION_STATE_SYNCHRONIZED);
    if (session.state == XR_SESSION_STATE_FOCUSED) enter_state(s, XR_SESSION_STATE_VISIBLE);
    if (session.state == XR_SESSION_STATE_VISIBLE) enter_state(s, XR_SESSION_STATE_SYNCHRONIZED);
    if (session.state == XR_SESSION_STATE_SYNCHRONIZED) enter_state(s, XR_SESSION_STATE_STOPPING);
}

namespace {

template <class EventData>
void queue_plain(State& s, EventData event) {
    queue_event(s, &event, sizeof event);
}

void lose_instance(State& s) {
    XrEventDataInstanceLossPending event{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING};
    event.lossTime = now(s);
    queue_plain(s, event);
}

}  // namespace

void play(State& s, Event event) {
    if (event == Event::put_on || event == Event::taken_off) s.worn = event == Event::put_on;
    if (event == Event::user_present || event == Event::user_absent) s.sensed = event == Event::user_present;
    if (event == Event::focus_gained || event == Event::focus_lost) s.focus = event == Event::focus_gained;
    if (!s.instance) return;
    std::optional<Session>& session = s.instance->session;
    const XrSession handle = session ? handle_of<XrSession>(session->id) : nullptr;
    switch (event) {
        case Event::exit_by_user:
            if (!session) break;
            session->exiting = true;
            stop_session(s);
            break;
        case Event::session_loss:
            if (session) enter_state(s, XR_SESSION_STATE_LOSS_PENDING);
            break;
        case Event::instance_loss:
            lose_instance(s);
            break;
        case Event::profile_changed:
            queue_plain(s, XrEventDataInteractionProfileChanged{
                               XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED, nullptr, handle});
            break;
        case Event::mask_changed:
            queue_plain(s, XrEventDataVisibilityMaskChangedKHR{XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR,
                                                               nullptr, handle,
                                                               XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, 0});
            break;
        case Event::events_lost:
            queue_plain(s, XrEventDataEventsLost{XR_TYPE_EVENT_DATA_EVENTS_LOST, nullptr, 1});
            break;
        case Event::taken_off:
            if (session) stop_session(s);
            break;
        case Event::room_reinit:
        case Event::room_failed:
        case Event::room_interrupted:
        case Event::room_restored: {
            if (s.instance->extensions.count(XR_FB_PASSTHROUGH_EXTENSION_NAME) == 0) break;
            const auto bit = static_cast<unsigned>(event) - static_cast<unsigned>(Event::room_reinit);
            queue_plain(
                s, XrEventDataPassthroughStateChangedFB{XR_TYPE_EVENT_DATA_PASSTHROUGH_STATE_CHANGED_FB,
                                                        nullptr, XrPassthroughStateChangedFlagsFB{1} << bit});
            break;
        }
        case Event::user_present:
        case Event::user_absent:
            report_presence(s);
            break;
        default:
            advance_session(s);
            break;
    }
}

void report_presence(State& s) {
    if (!s.instance || !s.instance->session || s.instance->extensions.count(user_presence) == 0) return;
    UserPresenceEvent event;
    event.session = handle_of<XrSession>(s.instance->session->id);
    event.present = s.sensed ? XR_TRUE : XR_FALSE;
    queue_plain(s, event);
}

void play_recentre(State& s, XrReferenceSpaceType space, XrDuration delay, const std::optional<Pose>& shift) {
    if (!s.instance || !s.instance->session) return;
    Session& session = *s.instance->session;
    XrEventDataReferenceSpaceChangePending event{XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING};
    event.session = handle_of<XrSession>(session.id);
    event.referenceSpaceType = space;
    event.changeTime = session.last_display + delay;
    event.poseValid = shift ? XR_TRUE : XR_FALSE;
    event.poseInPreviousSpace = to_xr(shift.value_or(Pose{}));
    queue_plain(s, event);
    std::vector<Origin>& origins = session.origins[space];
    if (shift && !origins.empty()) origins.push_back({event.changeTime, origins.back().pose * *shift});
}

void count_frame(State& s) {
    if (!s.script.file.empty()) run_commands(s, s.script.frame++);
}

void write_report(const State& s) {
    if (s.script.report.empty()) return;
    std::ofstream file(s.script.report);
    const auto drawn =
        std::count_if(s.frames.begin(), s.frames.end(), [](const Frame& frame) { return frame.has_layer; });
    const auto blended = std::count_if(s.frames.begin(), s.frames.end(), [](const Frame& frame) {
        return frame.blend_mode == XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND || frame.passthrough_flags;
    });
    file << fmt::format("frames {}\ndrawn {}\nblended {}\nvibrations {}\n", s.frames.size(), drawn, blended,
                        s.vibrations.size());
    for (const std::string& violation : s.violations) file << "violation " << violation << '\n';
}

void drop_session(State& s, bool vulkan) {
    Instance& instance = *s.instance;
    if (!instance.session) return;
    for (auto& [id, swapchain] : instance.swapchains) {
        s.ended[id] = Kind::swapchain;
        if (!vulkan) continue;
        for (const SwapchainImage& image : swapchain.images) destroy_image(instance.session->vulkan, image);
    }
    if (vulkan) close_device(instance.session->vulkan);
    for (const auto& [id, space] : instance.spaces) s.ended[id] = Kind::space;
    for (const auto& [id, tracker] : instance.trackers) s.ended[id] = Kind::hand_tracker;
    instance.swapchains.clear();
    instance.spaces.clear();
    instance.trackers.clear();
    for (const auto& [id, layer] : instance.passthrough_layers) s.ended[id] = Kind::passthrough_layer;
    for (const auto& [id, passthrough] : instance.passthroughs) s.ended[id] = Kind::passthrough;
    instance.passthrough_layers.clear();
    instance.passthroughs.clear();
    s.ended[instance.session->id] = Kind::session;
    instance.session.reset();
    if (!instance.lost) s.notified_of_loss.clear();
    s.changed.notify_all();
}

void drop_instance(State& s) {
    drop_session(s, true);
    for (const auto& [id, set] : s.instance->sets) s.ended[id] = Kind::action_set;
    for (const auto& [id, action] : s.instance->actions) s.ended[id] = Kind::action;
    s.ended[s.instance->id] = Kind::instance;
    s.instance.reset();
    s.notified_of_loss.clear();
    s.changed.notify_all();
}

XrPosef to_xr(const Pose& pose) {
    const auto f = [](double x) { return static_cast<float>(x); };
    return {{f(pose.orientation.x), f(pose.orientation.y), f(pose.orientation.z), f(pose.orientation.w)},
            {f(pose.position.x), f(pose.position.y), f(pose.position.z)}};
}

Pose from_xr(const XrPosef& p) {
    const Quat q(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z);
    return {{p.position.x, p.position.y, p.position.z}, glm::normalize(q)};
}

bool is_unit(const XrQuaternionf& q) {
    return std::abs(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) - 1.0F) < 0.01F;
}

XrSpaceLocationFlags flags_of(const Tracked& at) {
    XrSpaceLocationFlags flags = 0;
    if (at.valid) flags |= XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    if (at.valid && at.tracked)
        flags |= XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
    return flags;
}

std::vector<XrView> views_at(const State& s, const Pose& base) {
    const Config& config = s.instance->config;
    std::vector<XrView> views;
    for (std::uint32_t eye = 0; eye < config.eyes; ++eye) {
        const double side = config.eyes == 1 ? 0.0 : eye == 0 ? -1.0 : 1.0;
        const Pose in_head{{0.5 * side * config.ipd, 0.0, 0.0}, rotation({0.0, -side * config.cant, 0.0})};
        const ViewAngles& fov = config.fov[eye];
        XrView view{XR_TYPE_VIEW};
        view.pose = to_xr(inverse(base) * s.head.pose * in_head);
        view.fov = {fov.left, fov.right, fov.up, fov.down};
        views.push_back(view);
    }
    return views;
}

}  // namespace bolt::mock
