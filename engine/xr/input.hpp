// The trainee's hands in a headset's session: controllers as OpenXR actions, tracked hands, Vive trackers,
// and the vibration of controllers.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/side.hpp"
#include "engine/xr/session.hpp"
#include "engine/xr/vive_trackers.hpp"

namespace bolt::xr {

using bolt::Side;

inline constexpr std::size_t hand_joint_count = 26;
struct HandJoint {
    Pose pose;            // −Z points to the fingertip, +Y out of the back of the hand
    double radius = 0.0;  // m, from the joint to the skin
    bool valid = false;   // false: pose and radius have no meaning
};
using HandJoints = std::array<HandJoint, hand_joint_count>;  // in the order of XR_EXT_hand_tracking

struct ControllerProfile;  // controller_profiles.hpp

// One hand in one frame. Without focus, or without a controller or tracked hand, `active` is false.
struct HandInput {
    bool active = false;
    // Origin in the palm; −Z to the thumb's side of a closed fist, X out of the palm of the left hand and
    // into that of the right one.
    std::optional<ReportedPose> grip;
    std::optional<ReportedPose> aim;  // −Z is the direction in which the hand points
    float select = 0.0F;              // 0 … 1: trigger, pinch
    float grasp = 0.0F;               // 0 … 1: squeeze; of a controller with one button: that button
    glm::vec2 stick{0.0F};            // −1 … 1, y away from the user
    bool menu = false;
    bool secondary = false;  // a second button of the hand: lays the wrench down
    std::optional<HandJoints> joints;
    const ControllerProfile* controller = nullptr;  // null: none, or one that the program does not know
};
struct Hands {
    std::array<HandInput, 2> sides;  // by Side
    ViveTrackers trackers;           // one of them may be fixed to a gloved hand
    [[nodiscard]] const HandInput& operator[](Side side) const {
        return sides[static_cast<std::size_t>(side)];
    }
    [[nodiscard]] HandInput& operator[](Side side) { return sides[static_cast<std::size_t>(side)]; }
};

// A vibration of a controller. Frequency 0: the runtime chooses.
struct Vibration {
    float amplitude = 0.0F;  // 0 … 1; 0 stops
    float frequency = 0.0F;  // Hz
    double duration = 0.0;   // s; 0: the shortest that the controller can do
};

// The names of actions that the runtime shows to the user, in the user's language.
struct ActionNames {
    std::string set = "Assembly", grip = "Hand", aim = "Pointer", select = "Select", grasp = "Close the hand",
                stick = "Turn the workpiece", menu = "Menu", secondary = "Lay the wrench down",
                vibrate = "Vibration";
};

class XrInput {
  public:
    // Suggests bindings for the common controllers and attaches the actions to the session. Only one XrInput
    // can be created for a session.
    static Result<std::unique_ptr<XrInput>> create(Session& session, const ActionNames& names);
    XrInput(const XrInput&) = delete;
    XrInput& operator=(const XrInput&) = delete;
    ~XrInput();

    // The hands at the time of a frame.
    Result<Hands> read(const FrameTiming& frame);
    Status vibrate(Side side, const Vibration& vibration);
    // Queries the roles of the Vive trackers again in the next frame. Call it after TrackersChanged.
    void trackers_changed() { roles_outdated_ = true; }

    // Controllers whose bindings the runtime accepted, as paths; for the report of `doctor`.
    [[nodiscard]] const std::vector<std::string>& profiles() const { return profiles_; }
    // The controller in this hand, as its path; empty: none.
    [[nodiscard]] Result<std::string> profile(Side side) const;

  private:
    XrInput() = default;
    Status create_actions(const ActionNames& names);
    Status suggest_bindings();
    Status attach();
    Status read_hand(const FrameTiming& frame, Side side, HandInput& hand);
    Status read_controllers();
    Status read_vive_trackers(const FrameTiming& frame, ViveTrackers& trackers);
    Status read_joints(const FrameTiming& frame, Side side, HandInput& hand);
    Result<std::optional<ReportedPose>> locate(XrSpace space, XrTime time) const;
    Result<float> value(XrAction action, Side side) const;
    Result<bool> pressed(XrAction action, Side side) const;

    Session* session_ = nullptr;
    ActionSetHandle set_;
    XrAction grip_ = XR_NULL_HANDLE, aim_ = XR_NULL_HANDLE, select_ = XR_NULL_HANDLE, grasp_ = XR_NULL_HANDLE,
             stick_ = XR_NULL_HANDLE, menu_ = XR_NULL_HANDLE, secondary_ = XR_NULL_HANDLE,
             vibrate_ = XR_NULL_HANDLE;  // owned by the set
    std::array<XrPath, 2> hands_{};
    std::array<SpaceHandle, 2> grip_spaces_, aim_spaces_;
    std::array<XrHandTrackerEXT, 2> hand_trackers_{};  // null without hand tracking
    std::vector<TrackerAction> vive_actions_;          // the roles that the runtime knows
    std::vector<SpaceHandle> vive_spaces_;             // one for each of vive_actions_
    TrackerRoles connected_roles_;                     // at the last query
    bool roles_outdated_ = true;
    std::vector<std::string> profiles_;
    std::array<const ControllerProfile*, 2> controllers_{};  // by Side; null: none, or an unknown one
    std::uint32_t reads_ = 0;                                // number of calls of read() with focus
};

}  // namespace bolt::xr
