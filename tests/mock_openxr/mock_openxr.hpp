// A mock OpenXR runtime: a library that OpenXR's loader loads like a real runtime. It shows nothing, but
// checks every call of the client, records what is submitted, and does what a test asks for: heads, hands,
// events and errors. A test in the same process loads the library again with dlopen() and gets the control
// from the function mock_openxr_control. Another program is driven by a script: the environment variable
// MOCK_OPENXR_SCRIPT names a file with lines
//
//   FRAME head X Y Z QX QY QZ QW        the pose of the head from this frame on, in the stage
//   FRAME hand left|right X Y Z QX QY QZ QW CLOSED     grip and aim, and trigger and squeeze, 0 … 1
//   FRAME no-hand left|right
//   FRAME event NAME                    an Event below: take-off, put-on, lose-focus, …
//   FRAME off SECONDS                   takes the headset off for this time
//   FRAME picture FILE                  saves the left and right eye of this frame side by side (PPM)
//   0 size WIDTH HEIGHT                 of an eye's picture
//   0 real-time                         frames last as long as those of a display
//
// and at the end of the session the violations are appended to the file that MOCK_OPENXR_REPORT names.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/xr/openxr.hpp"

namespace bolt::mock_openxr {

struct Config {
    bool headset = true;  // one is connected
    int eyes = 2;
    std::uint32_t width = 64, height = 48;  // recommended
    double period = 1.0 / 90.0;             // s
    bool real_time = false;                 // xrWaitFrame lasts for a period
    bool refuses_arrays = false;            // swapchains have one layer
    std::vector<std::int64_t> formats{VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R8G8B8A8_SRGB,
                                      VK_FORMAT_D32_SFLOAT};  // in the runtime's order
    std::vector<std::string> extensions{"XR_KHR_vulkan_enable2", "XR_KHR_composition_layer_depth",
                                        "XR_EXT_hand_tracking", "XR_EXT_local_floor",
                                        "XR_EXT_hand_interaction"};
    std::vector<XrEnvironmentBlendMode> blend_modes{XR_ENVIRONMENT_BLEND_MODE_OPAQUE};
    bool stage = true;                                                    // it knows the room
    std::string profile = "/interaction_profiles/khr/simple_controller";  // of both controllers
    bool needs_newer_vulkan = false;
};

struct Head {
    Pose pose{{0.0, 1.65, 0.0}, {1.0, 0.0, 0.0, 0.0}};  // in the stage
    bool valid = true, tracked = true;
};

struct Hand {
    bool active = false;
    Pose grip, aim;  // in the stage
    bool valid = true, tracked = true;
    float trigger = 0.0F, squeeze = 0.0F;
    float stick_x = 0.0F, stick_y = 0.0F;
    bool menu = false, secondary = false;
    bool joints = false;                 // hand tracking sees the hand
    std::array<bool, 26> joint_valid{};  // of the joints, which are at the grip
};

enum class Event : std::uint8_t {
    take_off,       // the user takes the headset off: STOPPING
    put_on,         // and puts it on again: READY
    lose_focus,     // the system's menu is in front: VISIBLE
    regain_focus,   // FOCUSED
    user_exit,      // the user ends the program in the system's menu
    lose_session,   // LOSS_PENDING
    lose_instance,  // the runtime ends: every call fails
    recentre,  // the origin of the stage moves by Config… 0.1 m to the right, and the client is told the pose
    recentre_local,  // that of the local space
    profile_changed,
    mask_changed,
    events_lost,
};

struct EyeRecord {
    Pose pose;
    XrFovf fov{};
    std::uint32_t width = 0, height = 0, layer = 0;
    std::vector<std::uint8_t> rgba;  // if pictures are recorded; the bytes of the image, 4 a pixel
    std::vector<float> depth;        // the same of a depth layer
    std::optional<std::array<float, 2>> depth_range;  // distances at depth 0 and 1
};
struct FrameRecord {
    XrTime time = 0;
    bool layers = false;
    std::vector<EyeRecord> eyes;
};
struct VibrationRecord {
    int side = 0;
    float amplitude = 0.0F, frequency = 0.0F;  // amplitude 0: stopped
    XrTime time = 0;                           // of the last frame
};

class Control {
  public:
    Control() = default;
    Control(const Control&) = delete;
    Control& operator=(const Control&) = delete;
    virtual ~Control() = default;

    // Before the client creates its instance; also clears all records, failures and violations.
    virtual void configure(const Config& config) = 0;
    virtual void set_head(const Head& head) = 0;
    virtual void set_hand(int side, const Hand& hand) = 0;
    virtual void send(Event event) = 0;
    virtual void should_render(bool renders) = 0;
    virtual void block_frames(bool blocks) = 0;  // xrWaitFrame does not return
    // The next `count` calls of the function return `result`.
    virtual void fail_next(const std::string& function, XrResult result, int count) = 0;
    virtual void record_pictures(bool records) = 0;

    virtual XrSessionState state() = 0;
    virtual std::uint64_t frame_count() = 0;
    virtual std::optional<FrameRecord> last_frame() = 0;
    virtual std::vector<VibrationRecord> vibrations() = 0;
    virtual std::vector<std::string> violations() = 0;  // since the last call
};

}  // namespace bolt::mock_openxr
