// The state of the mock runtime: one instance with its objects, the headset and its user. Every function here
// expects the lock on State::mutex.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <string_view>
#include <thread>

#include "tests/mock_openxr/script.hpp"
#include "tests/mock_openxr/vulkan.hpp"

namespace bolt::mock {

enum class Kind : std::uint8_t {
    instance,
    session,
    space,
    swapchain,
    action_set,
    action,
    hand_tracker,
    passthrough,
    passthrough_layer,
};

// The origin of a reference space from a time on, relative to the stage.
struct Origin {
    XrTime from = 0;
    Pose pose;
};

struct Space {
    std::uint64_t session = 0;
    std::optional<XrReferenceSpaceType> reference;  // none: of an action
    std::uint64_t action = 0;
    std::size_t side = 0;
    std::string role;  // path of a Vive tracker's role; empty: of a hand
    Pose offset;
};

struct Swapchain {
    std::uint64_t session = 0;
    XrSwapchainCreateInfo info{};
    std::vector<SwapchainImage> images;
    std::deque<std::uint32_t> acquired;  // not released, the oldest first
    bool waited = false;                 // the oldest may be written
    std::uint32_t next = 0;
    std::optional<std::uint32_t> released;  // the last one
};

struct ActionSet {
    std::string name;
    bool attached = false;
};
struct Action {
    std::uint64_t set = 0;
    std::string name;
    XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
    std::vector<XrPath> sides;
};
struct Binding {
    std::string profile, path;
    std::uint64_t action = 0;
};
struct HandTracker {
    std::uint64_t session = 0;
    std::size_t side = 0;
};

// XR_FB_passthrough: the feature and each of its layers are paused or run separately.
struct Passthrough {
    bool running = false;
};
struct PassthroughLayer {
    std::uint64_t passthrough = 0;
    bool running = false;
};

struct Session {
    std::uint64_t id = 0;
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
    bool running = false;
    bool headless = false;    // without pictures and frames
    bool exiting = false;     // STOPPING leads to EXITING
    bool begun_once = false;  // a frame since xrBeginSession
    bool attached = false;
    bool lost = false;
    bool waiting = false;          // a thread is inside xrWaitFrame
    std::optional<XrTime> waited;  // a frame that is waited for and not begun
    std::optional<XrTime> begun;   // a frame that is begun and not ended
    bool waited_render = false, begun_render = false;
    XrTime last_display = 0;
    std::array<Hand, 2> synced{}, synced_before{};
    std::vector<ViveTracker> synced_trackers;
    bool has_synced = false;
    std::map<XrReferenceSpaceType, std::vector<Origin>> origins;
    std::map<XrTime, std::vector<XrView>> located;
    Vulkan vulkan;
};

struct Instance {
    std::uint64_t id = 0;
    Config config;
    std::set<std::string> extensions;
    std::vector<std::string> paths;  // XrPath is the index plus one
    std::deque<XrEventDataBuffer> events;
    bool lost = false;
    bool requirements_queried = false;
    VulkanObjects created;  // by the runtime, for the client
    std::optional<Session> session;
    std::map<std::uint64_t, Space> spaces;
    std::map<std::uint64_t, Swapchain> swapchains;
    std::map<std::uint64_t, ActionSet> sets;
    std::map<std::uint64_t, Action> actions;
    std::map<std::uint64_t, HandTracker> trackers;
    std::map<std::uint64_t, Passthrough> passthroughs;
    std::map<std::uint64_t, PassthroughLayer> passthrough_layers;
    std::vector<Binding> bindings;
    std::deque<XrViveTrackerPathsHTCX> sent_paths;  // by events
};

struct InjectedResult {
    XrResult result = XR_SUCCESS;
    int count = 0;
    int skip = 0;  // calls before them
};

struct State {
    std::mutex mutex;
    std::condition_variable changed;
    Config config;
    Tracked head{{{0.0, 1.6, 0.0}}};
    std::array<Hand, 2> hands{};
    std::vector<ViveTracker> vive_trackers;
    std::string blocked_call;  // the function that does not return
    int delayed_periods = 0;   // of the next frame
    int reported_periods = 1;  // in a reported period
    bool sensed = true;        // by XR_EXT_user_presence
    bool worn = true, focus = true, should_render = true, blocked = false, capture = false;
    std::map<std::string, InjectedResult, std::less<>> injected;
    std::map<std::string, std::uint64_t, std::less<>> calls;
    std::vector<std::string> violations;
    std::vector<Frame> frames;
    std::vector<Vibration> vibrations;
    std::optional<Instance> instance;
    std::map<std::uint64_t, Kind> ended;         // objects that no longer exist
    std::set<std::thread::id> notified_of_loss;  // threads that know of the loss
    std::uint64_t last_id = 0;
    std::uint64_t generation = 0;  // of reset()
    Script script;
};

State& state();

template <class Handle>
std::uint64_t id_of(Handle handle) {
    return reinterpret_cast<std::uint64_t>(handle);
}
template <class Handle>
Handle handle_of(std::uint64_t id) {
    return reinterpret_cast<Handle>(id);
}

void violate(State& s, std::string_view function, std::string_view what);
// Records the violation and returns `result`.
XrResult refuse(State& s, std::string_view function, XrResult result, std::string_view what);

XrTime now(const State& s);

// Puts the session in this state and queues the event.
void enter_state(State& s, XrSessionState to);
void queue_event(State& s, const void* event, std::size_t size);
// Leads the session to where the user is: worn, focused.
void advance_session(State& s);
void stop_session(State& s);
void play(State& s, Event event);
void play_recentre(State& s, XrReferenceSpaceType space, XrDuration delay, const std::optional<Pose>& shift);
// Queues the event of XR_EXT_user_presence, if that extension is enabled and a session exists.
void report_presence(State& s);
// Runs the script's commands for the next frame.
void count_frame(State& s);
void write_report(const State& s);
// Drops the instance with all its objects.
void drop_instance(State& s);
// Forgets the session's children. `vulkan`: destroy the images too.
void drop_session(State& s, bool vulkan);

// The result of a call before its own work: an injected one, or that of a lost instance or session. None: the
// call proceeds.
enum class Level : std::uint8_t { global, instance, session };
std::optional<XrResult> enter(State& s, std::string_view function, Level level);

// The same for a function that destroys, also after a loss: what it returns if it succeeds.
XrResult enter_destroying(State& s, std::string_view function);

// Runs `body(State&, std::unique_lock<std::mutex>&)` for a call of the client.
template <class Body>
XrResult call(std::string_view function, Level level, const Body& body) {
    State& s = state();
    std::unique_lock lock(s.mutex);
    s.changed.wait(lock, [&] { return s.blocked_call.empty() || s.blocked_call != function; });
    if (const std::optional<XrResult> result = enter(s, function, level)) return *result;
    return body(s, lock);
}

// The object of this handle; null, after recording a violation, if there is none.
template <class Object, class Handle>
Object* find(State& s, std::string_view function, std::map<std::uint64_t, Object>& objects, Handle handle) {
    const auto found = objects.find(id_of(handle));
    if (found != objects.end()) return &found->second;
    const bool destroyed = s.ended.count(id_of(handle)) != 0;
    violate(s, function, destroyed ? "uses an object that was destroyed" : "uses a handle of no object");
    return nullptr;
}

// Removes the object; a violation if there is none.
template <class Object, class Handle>
bool remove(State& s, std::string_view function, std::map<std::uint64_t, Object>& objects, Handle handle,
            Kind kind) {
    if (objects.erase(id_of(handle)) != 0) {
        s.ended[id_of(handle)] = kind;
        return true;
    }
    const bool destroyed = s.ended.count(id_of(handle)) != 0;
    violate(s, function, destroyed ? "destroys an object twice" : "destroys a handle of no object");
    return false;
}

// Answers a query that is called for the count and again for the values.
template <class T, class Assign>
XrResult list(State& s, std::string_view function, const std::vector<T>& values, std::uint32_t capacity,
              std::uint32_t* count, const Assign& assign) {
    *count = static_cast<std::uint32_t>(values.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < values.size())
        return refuse(s, function, XR_ERROR_SIZE_INSUFFICIENT, "is given fewer elements than it returns");
    for (std::size_t i = 0; i < values.size(); ++i) assign(i, values[i]);
    return XR_SUCCESS;
}

// Pose of a space at a time, relative to the stage.
Tracked locate(const State& s, const Space& space, XrTime time);
XrPosef to_xr(const Pose& pose);
Pose from_xr(const XrPosef& pose);
bool is_unit(const XrQuaternionf& q);
XrSpaceLocationFlags flags_of(const Tracked& at);
// The same of a hand's space, at any time.
Tracked locate_action(const State& s, const Space& space);
// Views of the eyes relative to `base`.
std::vector<XrView> views_at(const State& s, const Pose& base);

// The functions of the client interface, by name; null: there is none, or its extension is not enabled.
using FunctionTable = std::map<std::string_view, PFN_xrVoidFunction>;
void add_instance_functions(FunctionTable& table);
void add_session_functions(FunctionTable& table);
void add_frame_functions(FunctionTable& table);
void add_swapchain_functions(FunctionTable& table);
void add_action_functions(FunctionTable& table);
void add_input_functions(FunctionTable& table);
void add_tracker_functions(FunctionTable& table);
void add_passthrough_functions(FunctionTable& table);
// Checks a layer that is submitted, and records it.
XrResult check_passthrough(State& s, const XrCompositionLayerPassthroughFB& layer, Frame& frame);

inline const std::string role_folder = "/user/vive_tracker_htcx/role/";
// The connected tracker with this path of a role; null: none.
const ViveTracker* tracker_with_role(const std::vector<ViveTracker>& trackers, const std::string& path);
void set_vive_tracker(State& s, const ViveTracker& tracker);

// Interaction profiles of the specification, and their inputs and outputs as "/user/hand/...".
bool is_known_profile(const std::string& profile);
bool has_input(const std::string& profile, const std::string& path);

template <class Function>
void add(FunctionTable& table, std::string_view name, Function function) {
    table[name] = reinterpret_cast<PFN_xrVoidFunction>(function);
}

}  // namespace bolt::mock
