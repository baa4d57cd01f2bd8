// The state of the mock runtime, which all its functions share.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "tests/mock_openxr/mock_openxr.hpp"

namespace bolt::mock_openxr {

// Vulkan's functions, which the mock gets through the application. volk's are the application's own.
struct Vulkan {
    PFN_vkGetInstanceProcAddr get_instance = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice gpu = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t family = 0;
    PFN_vkGetDeviceProcAddr get_device = nullptr;

    template <class Function>
    Function of_instance(const char* name) const {
        return reinterpret_cast<Function>(get_instance(instance, name));
    }
    template <class Function>
    Function of_device(const char* name) const {
        return reinterpret_cast<Function>(get_device(device, name));
    }
};

enum class SpaceKind : std::uint8_t { stage, local, local_floor, view, grip, aim };
struct Space {
    SpaceKind kind = SpaceKind::stage;
    int side = 0;
    Pose offset;
};
struct Swapchain {
    std::uint32_t width = 0, height = 0, layers = 1;
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::vector<VkImage> images;
    std::vector<VkDeviceMemory> memory;
    std::deque<std::uint32_t> acquired;  // in order
    bool waited = false;                 // for the first of them
    std::uint32_t next = 0;
    std::optional<std::uint32_t> released;
};
struct Action {
    std::string name;
    XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
    std::set<std::string> inputs;  // bound inputs of the present profile: "input/trigger/value"
};

struct ScriptLine {
    std::uint64_t frame = 0;
    std::vector<std::string> words;
};

struct State {
    std::mutex mutex;
    std::condition_variable changed;
    Config config;
    Head head;
    std::array<Hand, 2> hands;
    Pose stage_origin, local_origin;

    bool instance = false, instance_lost = false, session_lost = false;
    std::set<std::string> enabled;
    bool requirements_queried = false;
    Vulkan vulkan;

    bool session = false, running = false, exit_requested = false, attached = false;
    bool gains_focus = true;  // by itself, after some frames
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
    std::deque<XrEventDataBuffer> events;
    bool should_render = true, blocked = false;

    // Frames: each is waited for, begun and ended.
    std::uint64_t waited = 0, begun = 0, ended = 0;
    XrTime now = 1'000'000'000, waited_time = 0, begun_time = 0;
    int waiting_threads = 0;

    std::set<std::unique_ptr<Space>> spaces;
    std::set<std::unique_ptr<Swapchain>> swapchains;
    std::set<std::unique_ptr<Action>> actions;
    std::vector<std::string> paths{""};  // XrPath is the index
    int action_sets = 0, hand_trackers = 0;
    std::array<int, 2> tracker_sides{0, 1};

    bool record_pictures = false;
    FrameRecord last_frame;
    std::vector<VibrationRecord> vibrations;
    std::vector<std::string> violations;
    std::map<std::string, std::pair<XrResult, int>> failures;
    std::vector<ScriptLine> script;
    std::optional<std::chrono::steady_clock::time_point> put_on_at;  // by the script

    void violation(std::string what) { violations.push_back(std::move(what)); }
    // Must be held by the caller: the mutex.
    void enter(XrSessionState next);
};

State& state();

// The result that a test has asked for, or of a lost instance; none: go on.
std::optional<XrResult> injected(State& s, const char* function);

#define MOCK_ENTER(function)                                         \
    State& s = state();                                              \
    std::unique_lock lock(s.mutex);                                  \
    if (const auto failure = injected(s, function)) return *failure; \
    static_cast<void>(lock)

template <class T>
T* find(std::set<std::unique_ptr<T>>& set, void* handle) {
    for (const auto& one : set)
        if (one.get() == handle) return one.get();
    return nullptr;
}
template <class T>
bool erase(std::set<std::unique_ptr<T>>& set, void* handle) {
    for (auto it = set.begin(); it != set.end(); ++it)
        if (it->get() == handle) {
            set.erase(it);
            return true;
        }
    return false;
}

Pose pose_of(const State& s, const Space& space);
bool space_valid(const State& s, const Space& space);
bool space_tracked(const State& s, const Space& space);

using Functions = std::map<std::string, PFN_xrVoidFunction>;
void add_session_functions(Functions& functions);
void add_image_functions(Functions& functions);
void add_action_functions(Functions& functions);

// Reads the image that a layer shows back from the GPU.
std::vector<std::uint8_t> read_image(const Vulkan& vulkan, const Swapchain& swapchain, std::uint32_t layer,
                                     std::uint32_t width, std::uint32_t height);
void destroy_images(const Vulkan& vulkan, Swapchain& swapchain);

void load_script(State& s);
void run_script(State& s);  // what is due in this frame; the mutex is held
void save_script_pictures(State& s);
void apply_event(State& s, Event event);  // the mutex is held

template <class Function>
PFN_xrVoidFunction as_void(Function function) {
    return reinterpret_cast<PFN_xrVoidFunction>(function);
}

}  // namespace bolt::mock_openxr
