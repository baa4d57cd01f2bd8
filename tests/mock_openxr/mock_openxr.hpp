// A mock OpenXR runtime with a headset of settable properties, for tests. OpenXR's loader uses it if
// XR_RUNTIME_JSON names its manifest. It draws nothing: it checks the client, records what the client
// submits, and plays what a user and a runtime can do.
//
// A test obtains the control interface by dlopen of the same library and dlsym of "mock_openxr_control", a
// function of type `const Control*()`. All its functions lock the mock, so any thread may call them. Poses
// are relative to the stage: metres, y up.
//
// A program in another process is driven by a script (script.hpp).
#pragma once

#include <openxr/openxr.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::mock {

// Newer than the headers of Debian 12.
inline constexpr auto local_floor_space = static_cast<XrReferenceSpaceType>(1000426000);
inline constexpr const char* user_presence = "XR_EXT_user_presence";
struct UserPresenceEvent {
    XrStructureType type = static_cast<XrStructureType>(1000470000);
    const void* next = nullptr;
    XrSession session = XR_NULL_HANDLE;
    XrBool32 present = XR_FALSE;
};
struct UserPresenceProperties {
    XrStructureType type = static_cast<XrStructureType>(1000470001);
    void* next = nullptr;
    XrBool32 supported = XR_FALSE;
};

struct ViewAngles {
    float left = -0.8F, right = 0.7F, up = 0.75F, down = -0.85F;  // rad
};

// Properties of the runtime and the headset. An instance keeps those that it was created with.
struct Config {
    bool connected = true;  // may change while an instance exists: xrGetSystem then reports it
    std::uint32_t eyes = 2;
    std::uint32_t width = 64, height = 48;  // recommended size of an eye's picture
    std::uint32_t max_width = 256, max_height = 256;
    // In the runtime's order: R16G16B16A16_UNORM, R8G8B8A8_SRGB, D32_SFLOAT.
    std::vector<std::int64_t> formats{91, 43, 126};
    std::vector<std::string> extensions{"XR_KHR_vulkan_enable2",  "XR_KHR_composition_layer_depth",
                                        "XR_KHR_visibility_mask", "XR_EXT_hand_tracking",
                                        "XR_MND_headless",        "XR_KHR_convert_timespec_time"};
    std::vector<XrEnvironmentBlendMode> blend_modes{XR_ENVIRONMENT_BLEND_MODE_OPAQUE};
    std::vector<XrReferenceSpaceType> spaces{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL,
                                             XR_REFERENCE_SPACE_TYPE_STAGE};
    bool foreign_gpu = false;                   // the headset is on a GPU that Vulkan does not list
    bool refuse_arrays = false;                 // xrCreateSwapchain fails for more than one layer
    bool has_cameras = true;                    // the system property, if XR_FB_passthrough is enabled
    bool tracks_hands = true;                   // the system property, if XR_EXT_hand_tracking is enabled
    std::vector<std::string> unknown_profiles;  // interaction profiles that the runtime does not know
    std::vector<std::string> unknown_roles;     // of Vive trackers: the runtime accepts no binding of them
    bool refuses_unknown_roles = false;         // and no action
    std::array<ViewAngles, 2> fov{ViewAngles{}, ViewAngles{-0.7F, 0.8F, 0.75F, -0.85F}};
    double ipd = 0.064;                   // m between the eyes
    double cant = 0.0;                    // rad by which each eye is turned outwards
    Pose seated_origin{{0.0, 1.2, 0.0}};  // of LOCAL, relative to the stage
    Pose floor_origin{};                  // of LOCAL_FLOOR
    std::int64_t period = 11'111'111;     // ns between frames
    bool real_time = false;               // false: xrWaitFrame returns at once, and time is counted in frames
    std::uint32_t images = 3;             // in a swapchain
    XrVersion min_vulkan = XR_MAKE_VERSION(1, 1, 0);
    std::vector<XrVector2f> hidden_triangles{{-1.0F, 1.0F}, {-0.6F, 1.0F}, {-1.0F, 0.6F}};  // visibility mask
};

struct Tracked {
    Pose pose;
    bool valid = true, tracked = true;
};

inline constexpr std::size_t joint_count = 26;
struct Joint {
    Tracked at;
    float radius = 0.01F;
};

struct Hand {
    bool active = true;  // a controller is in this hand
    std::string profile = "/interaction_profiles/oculus/touch_controller";
    Tracked grip, aim;
    float trigger = 0.0F, squeeze = 0.0F;
    XrVector2f stick{0.0F, 0.0F};
    bool menu = false;       // the buttons menu, b and y
    bool secondary = false;  // the buttons a and x, and the presses of stick and trackpad
    bool has_joints = false;
    bool pinches = false;  // of a script's joints
    std::array<Joint, joint_count> joints{};
};
enum class Side : std::uint8_t { left, right };

inline constexpr const char* vive_tracker_extension = XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME;
struct ViveTracker {
    std::string serial;  // part of its persistent path
    std::string role;    // the end of its role path; empty: none
    bool connected = true;
    Tracked at;
};

// An action of the user or the runtime.
enum class Event : std::uint8_t {
    put_on,           // session: READY
    taken_off,        // to STOPPING, then IDLE
    focus_lost,       // to VISIBLE
    focus_gained,     // to FOCUSED
    exit_by_user,     // to STOPPING, then EXITING
    session_loss,     // LOSS_PENDING; the session is then lost
    instance_loss,    // the event INSTANCE_LOSS_PENDING; the instance is then lost
    profile_changed,  // INTERACTION_PROFILE_CHANGED
    mask_changed,     // VISIBILITY_MASK_CHANGED
    events_lost,      // EVENTS_LOST
    user_present,     // with XR_EXT_user_presence: the user is sensed; the session's state stays
    user_absent,
    room_reinit,       // PASSTHROUGH_STATE_CHANGED of XR_FB_passthrough: create it again
    room_failed,       // not recoverable
    room_interrupted,  // recoverable
    room_restored,
};

// A picture of one eye, read back. Row 0 is at the top.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // with sRGB's encoding
    std::vector<float> depth;        // empty without a depth layer
};

struct SubmittedView {
    XrPosef pose{};
    XrFovf fov{};
    XrRect2Di rect{};
    std::uint32_t layer = 0;  // of the swapchain's image
    bool has_depth = false;
    float min_depth = 0.0F, max_depth = 0.0F, near_z = 0.0F, far_z = 0.0F;
    Picture picture;  // if pictures are captured
};
struct Frame {
    XrTime time = 0;
    bool should_render = false;
    bool has_layer = false;                                    // of pictures
    std::vector<XrStructureType> layers;                       // from the bottom to the top
    std::optional<XrCompositionLayerFlags> passthrough_flags;  // of its layer; none: there is none
    XrEnvironmentBlendMode blend_mode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    XrCompositionLayerFlags flags = 0;
    std::vector<SubmittedView> views;
    std::vector<XrView> located;  // by the last xrLocateViews for this time
};

struct Vibration {
    XrTime time = 0;  // at which it was requested
    Side side = Side::left;
    bool stop = false;
    float amplitude = 0.0F, frequency = 0.0F;
    XrDuration duration = 0;
};

struct Control {
    // Drops all that the client left, and restores the defaults: a connected headset that is put on, virtual
    // time. Every session ends as if lost.
    void (*reset)();
    // For the next instance.
    void (*configure)(const Config& config);
    // Changes Config::connected alone, also for an existing instance.
    void (*connect)(bool connected);
    void (*set_head)(const Tracked& head);
    void (*set_hand)(Side side, const Hand& hand);
    // Adds the tracker with this serial number, or changes it. The runtime reports one that was connected or
    // got another role, but not one that was switched off.
    void (*set_vive_tracker)(const ViveTracker& tracker);
    void (*send)(Event event);
    // The origin of the space moves to `shift`, in the old space, `delay` ns after the last display time.
    // Without `shift` the runtime does not know where to.
    void (*recentre)(XrReferenceSpaceType space, XrDuration delay, const std::optional<Pose>& shift);
    // The next `count` calls of the function return `result` and do nothing else; destroying functions still
    // destroy. XR_ERROR_SESSION_LOST and XR_ERROR_INSTANCE_LOST really lose the session or the instance.
    void (*fail_next)(const std::string& function, XrResult result, int count);
    // The same after `skip` further calls.
    void (*fail_after)(const std::string& function, int skip, XrResult result, int count);
    void (*block_wait)(bool blocked);  // xrWaitFrame does not return until released or lost
    // Calls of the function do not return until it is released: block_call("").
    void (*block_call)(const std::string& function);
    // The next frame is displayed `count` periods later than it would be, as after a slow frame.
    void (*delay_frame)(int count);
    // The following frames report this multiple of the period, as Monado does while the client misses frames.
    void (*report_period)(int multiple);
    void (*set_should_render)(bool should_render);
    void (*set_capture)(bool capture);  // read the pictures of all following frames

    // Rules of OpenXR that the client broke, as sentences that begin with the function. Taking clears them.
    std::vector<std::string> (*take_violations)();
    std::vector<Frame> (*take_frames)();
    std::vector<Vibration> (*take_vibrations)();
    std::uint64_t (*calls)(const std::string& function);  // calls since reset()
    XrInstance (*instance)();                             // null: none
    XrSessionState (*session_state)();                    // UNKNOWN without a session
    bool (*session_running)();
    bool (*waiting)();  // a thread is inside xrWaitFrame
    // Suggested bindings that the runtime accepted: "/interaction_profiles/... action /user/hand/...".
    std::vector<std::string> (*accepted_bindings)();
};
using ControlFunction = const Control* (*)();

}  // namespace bolt::mock
