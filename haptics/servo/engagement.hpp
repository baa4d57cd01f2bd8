// Determines which nut the hand holds. Fingers, and a wrench without contact simulation, engage if their pose
// fits: level with the nut, centred, square to the axis and aligned within the play (update_pose_engagement).
// With contact simulation the geometry of the tool's head decides (update_contact_engagement).
#pragma once

#include <optional>
#include <span>

#include "haptics/servo/io.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::servo {

// The pose of a tool and its axes, in the assembly's frame.
struct ToolPose {
    Vec3 position{0.0};                    // m
    Quat orientation{1.0, 0.0, 0.0, 0.0};  // unit
    Vec3 handle{1.0, 0.0, 0.0};            // x axis of the tool
    Vec3 normal{0.0, 0.0, 1.0};            // z axis of the tool
    bool valid = true;                     // false: the command is not a pose; such a tool engages nothing
};

// The pose with its quaternion normalised; none if the command is not finite, is beyond 1 km or has a
// quaternion whose length is outside 0.5 … 2.
std::optional<Pose> commanded_pose(const CommandedTool& commanded);
// `valid` is false if the command is not a pose.
ToolPose tool_pose(const CommandedTool& commanded);
ToolPose tool_pose(const Pose& pose);

struct Engagement {
    int joint = -1;  // −1: no nut is held
    Grip grip = Grip::none;
    // rad, angle of the tool about the bolt at the last tick, in −π … π; a rotation that tightens increases
    // it.
    double azimuth = 0.0;
    // rad, where the hand wants the nut to be: at this rotation of the nut the spring between tool and nut is
    // relaxed.
    //
    //   hand_angle = nut's rotation at engagement + misalignment of head and hexagon at engagement
    //                + rotation of the tool about the bolt since then
    //
    // It is not wrapped to ±π. With a ratchet the rotation of the ratchet's head counts, not the handle's.
    double hand_angle = 0.0;
    double ratchet_slack = 0.0;  // rad, 0 … one tooth, by which the handle is behind the ratchet's head
    // m, tool minus nut centre at engagement; decays with a time constant of 0.05 s.
    Vec3 offset_at_engagement{0.0};

    // Click-type torque wrench; armed anew at each engagement.
    double set_torque = 0.0;  // N·m on the scale
    double swung = 0.0;       // rad that the handle has swung since the click

    // Wrench with contact simulation.
    collision::HeadFit fit;
    // 0 … 1, share of the corner torque (joint/nut.hpp) that the corners still bear while the head slips.
    double corner_torque_share = 1.0;
    // rad that the tool has turned beyond the angle at which it reaches the corner torque.
    double turned_beyond_corner_torque = 0.0;
};

// Centre of the nut in the assembly's frame, m, at `nut_angle` rad.
Vec3 nut_centre(const NutGeometry& nut, double nut_angle);

// Angle of the head or of the fingers about the bolt, from NutGeometry::e1: rad, tightening positive,
// in −π … π.
double tool_azimuth(const Setup& setup, const NutGeometry& nut, const ToolPose& tool, Grip grip);

// One tick. Releases the nut if the grip changes, the tool moves or tilts away, its angle changes by more
// than a hand can turn in a tick, or the command is not a pose. Engages a nut if none was held and the pose
// fits.
void update_pose_engagement(const Setup& setup, std::span<const joint::JointState> joints,
                            const ToolPose& tool, Grip grip, Engagement& engagement);

// With a ratchet (Ratchet in setup.hpp), a tick does four things in this order: turn_tool(); limit_to_pawl(),
// which limits the drive of the joint; the step of the joint; settle_ratchet(). Without a ratchet
// limit_to_pawl() and settle_ratchet() do nothing.

// Turns the engaged tool by `turned`, rad since the last tick, tightening positive. The handle of a ratchet
// first takes up Engagement::ratchet_slack.
void turn_tool(const Wrench& wrench, double turned, Engagement& engagement);

// N·m, drag of the pawl when the handle is `slack` rad behind the ratchet's head
// (Engagement::ratchet_slack).
double pawl_drag(const Ratchet& ratchet, double slack);

// While the handle turns back, the torque on the nut is at most the drag of the pawl: sets the torque limit
// of `drive`. `rotation`: rad, of the nut (joint::JointState::rotation).
void limit_to_pawl(const Wrench& wrench, double rotation, const Engagement& engagement,
                   joint::NutDrive& drive);

// Call after the joint's step. While the handle turns back, the head stops where its torque on the nut equals
// the drag of the pawl; the pawl climbs over the teeth while the handle moves on. `rotation`
// (joint::JointState::rotation) and `play` in rad.
void settle_ratchet(const Wrench& wrench, double rotation, double play, Engagement& engagement);

// Grip of a tool on a nut with contact simulation. Geometry alone determines whether the head holds the nut
// (haptics/collision/tool_head.hpp); the corners limit the torque that it can transmit
// (haptics/joint/nut.hpp).
//
// The joint law alone, with its implicit step, acts about the bolt's axis; contacts act in the other five
// directions. So contacts must not turn the nut; two measures ensure this. First, once the play is used
// up, contact queries place the hexagon not at the nut's angle but at that of the tool's head, so that the
// two cannot press on each other about the bolt. Second, the moment of the contacts about the bolt is not
// rendered. If contacts drove the nut instead, its torque would depend on the position error of the
// god-object: 0.01 mm at a corner changes a torque of 100 N·m by 3 N·m. The change from contacts to the law
// causes no jump of the force: a nut engages within the play, where the law's torque and the moment of the
// contacts about the bolt are both zero.

// Pose of the wrench in the nut's frame.
Pose pose_in_nut_frame(const NutGeometry& nut, const joint::JointState& joint, const ToolPose& tool);

// One tick. The head engages a nut of its size if it surrounds the hexagon (a key: if it is inside the
// socket) and is aligned with it within the play. To engage, the flats of head and hexagon must overlap along
// the bolt by at least Jaw::bevel, or by 0.5 mm for other heads. Releases the nut if the head no longer
// surrounds the hexagon or turns by more than a hand can turn in a tick, or if the command is not a pose.
// `rounded`, by joint: m (joint::CornerGrip::rounded).
void update_contact_engagement(const Setup& setup, std::span<const joint::JointState> joints,
                               std::span<const double> rounded, const ToolPose& tool, Engagement& engagement);

// The engaged wrench as the joint law's drive. `rounded`: m that the nut's corners have lost along each flat
// (joint::CornerGrip::rounded).
joint::NutDrive contact_drive(const Setup& setup, const NutGeometry& nut, double rounded,
                              const Engagement& engagement);

// Call before the joint's step. A tool transmits at most Wrench::yield_torque; any further rotation of the
// hand bends it permanently. `nut_rotation` in rad. Returns by how much (rad, ≥ 0) the hand has bent the
// tool in this tick. If the corners of the nut yield at a smaller torque, the tool does not bend
// (round_corners).
double bend_tool(const Wrench& wrench, double nut_rotation, joint::NutDrive& drive, Engagement& engagement);

// Call after the joint's step. Beyond the corner torque the head begins to slip: it removes material in
// proportion to its work, and transmits less torque the further it turns. Returns true in the tick in which
// it has passed over the corners.
bool round_corners(const Setup& setup, const NutGeometry& nut, const joint::JointState& joint,
                   double& rounded, Engagement& engagement);

}  // namespace bolt::servo
