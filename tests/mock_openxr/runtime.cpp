// The two functions that the library exports: the loader's entry and the control interface.
#include <fmt/format.h>

#include <utility>

#include "tests/mock_openxr/negotiation.hpp"
#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

// Functions of extensions, which a client gets only if it enabled them.
const char* extension_of(std::string_view function) {
    const auto contains = [&](const char* part) { return function.find(part) != std::string_view::npos; };
    if (contains("Vulkan")) return XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME;
    if (contains("VisibilityMask")) return XR_KHR_VISIBILITY_MASK_EXTENSION_NAME;
    if (contains("HandTracker") || contains("HandJoints")) return XR_EXT_HAND_TRACKING_EXTENSION_NAME;
    if (contains("Passthrough")) return XR_FB_PASSTHROUGH_EXTENSION_NAME;
    if (contains("ViveTracker")) return vive_tracker_extension;
    if (contains("ConvertTimespec")) return XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME;
    return nullptr;
}

XrResult XRAPI_CALL get_proc(XrInstance instance, const char* name, PFN_xrVoidFunction* function) {
    static const FunctionTable table = [] {
        FunctionTable made;
        add_instance_functions(made);
        add_session_functions(made);
        add_frame_functions(made);
        add_swapchain_functions(made);
        add_action_functions(made);
        add_input_functions(made);
        add_tracker_functions(made);
        add_passthrough_functions(made);
        add(made, "xrGetInstanceProcAddr", &get_proc);
        return made;
    }();
    *function = nullptr;
    const auto found = table.find(name);
    if (found == table.end()) return XR_ERROR_FUNCTION_UNSUPPORTED;
    if (const char* extension = extension_of(name); extension != nullptr) {
        State& s = state();
        const std::lock_guard lock(s.mutex);
        const bool enabled =
            instance != XR_NULL_HANDLE && s.instance && s.instance->extensions.count(extension) != 0;
        if (!enabled) return XR_ERROR_FUNCTION_UNSUPPORTED;
    }
    *function = found->second;
    return XR_SUCCESS;
}

// Functions of the control interface lock the mock.
template <class Body>
auto locked(const Body& body) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    return body(s);
}

void reset() {
    locked([](State& s) {
        if (s.instance) drop_instance(s);
        s.config = {};
        s.head = State().head;
        s.hands = {};
        s.vive_trackers.clear();
        s.sensed = s.worn = s.focus = s.should_render = true;
        s.blocked = s.capture = false;
        s.blocked_call.clear();
        s.delayed_periods = 0;
        s.reported_periods = 1;
        s.injected.clear();
        s.calls.clear();
        s.violations.clear();
        s.frames.clear();
        s.vibrations.clear();
        s.ended.clear();
        s.notified_of_loss.clear();
        ++s.generation;
        s.changed.notify_all();
    });
}

const Control control{
    &reset,
    [](const Config& config) { locked([&](State& s) { s.config = config; }); },
    [](bool connected) { locked([&](State& s) { s.config.connected = connected; }); },
    [](const Tracked& head) { locked([&](State& s) { s.head = head; }); },
    [](Side side, const Hand& hand) {
        locked([&](State& s) { s.hands[static_cast<std::size_t>(side)] = hand; });
    },
    [](const ViveTracker& tracker) { locked([&](State& s) { set_vive_tracker(s, tracker); }); },
    [](Event event) { locked([&](State& s) { play(s, event); }); },
    [](XrReferenceSpaceType space, XrDuration delay, const std::optional<Pose>& shift) {
        locked([&](State& s) { play_recentre(s, space, delay, shift); });
    },
    [](const std::string& function, XrResult result, int count) {
        locked([&](State& s) { s.injected[function] = {result, count, 0}; });
    },
    [](const std::string& function, int skip, XrResult result, int count) {
        locked([&](State& s) { s.injected[function] = {result, count, skip}; });
    },
    [](bool blocked) {
        locked([&](State& s) {
            s.blocked = blocked;
            s.changed.notify_all();
        });
    },
    [](const std::string& function) {
        locked([&](State& s) {
            s.blocked_call = function;
            s.changed.notify_all();
        });
    },
    [](int count) { locked([&](State& s) { s.delayed_periods = count; }); },
    [](int multiple) { locked([&](State& s) { s.reported_periods = multiple; }); },
    [](bool should_render) { locked([&](State& s) { s.should_render = should_render; }); },
    [](bool capture) { locked([&](State& s) { s.capture = capture; }); },
    [] { return locked([](State& s) { return std::exchange(s.violations, {}); }); },
    [] { return locked([](State& s) { return std::exchange(s.frames, {}); }); },
    [] { return locked([](State& s) { return std::exchange(s.vibrations, {}); }); },
    [](const std::string& function) {
        return locked([&](State& s) {
            const auto found = s.calls.find(function);
            return found == s.calls.end() ? std::uint64_t{0} : found->second;
        });
    },
    [] {
        return locked([](State& s) {
            return s.instance ? handle_of<XrInstance>(s.instance->id) : XrInstance{XR_NULL_HANDLE};
        });
    },
    [] {
        return locked([](State& s) {
            return s.instance && s.instance->session ? s.instance->session->state : XR_SESSION_STATE_UNKNOWN;
        });
    },
    [] {
        return locked(
            [](State& s) { return s.instance && s.instance->session && s.instance->session->running; });
    },
    [] {
        return locked(
            [](State& s) { return s.instance && s.instance->session && s.instance->session->waiting; });
    },
    [] {
        return locked([](State& s) {
            std::vector<std::string> lines;
            if (!s.instance) return lines;
            for (const Binding& b : s.instance->bindings)
                lines.push_back(
                    fmt::format("{} {} {}", b.profile, s.instance->actions[b.action].name, b.path));
            return lines;
        });
    },
};

}  // namespace

}  // namespace bolt::mock

#define BOLT_MOCK_EXPORT extern "C" __attribute__((visibility("default")))

BOLT_MOCK_EXPORT XrResult XRAPI_CALL xrNegotiateLoaderRuntimeInterface(
    const bolt::mock::NegotiateLoaderInfo* loader, bolt::mock::NegotiateRuntimeRequest* request);
BOLT_MOCK_EXPORT XrResult XRAPI_CALL xrNegotiateLoaderRuntimeInterface(
    const bolt::mock::NegotiateLoaderInfo* loader, bolt::mock::NegotiateRuntimeRequest* request) {
    using namespace bolt::mock;
    if (loader == nullptr || request == nullptr || loader->type != LoaderStruct::loader_info ||
        request->type != LoaderStruct::runtime_request || loader->min_interface > 1 ||
        loader->max_interface < 1)
        return XR_ERROR_INITIALIZATION_FAILED;
    request->interface = 1;
    request->api = XR_MAKE_VERSION(1, 0, 20);
    request->get_instance_proc_addr = &get_proc;
    return XR_SUCCESS;
}

BOLT_MOCK_EXPORT const bolt::mock::Control* mock_openxr_control();
BOLT_MOCK_EXPORT const bolt::mock::Control* mock_openxr_control() { return &bolt::mock::control; }
