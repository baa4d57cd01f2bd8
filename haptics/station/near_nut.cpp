// A station moves the tool near a nut: a wrench pivots about the bolt, and a tool whose device renders no
// force approaches the nut by itself.
#include <algorithm>
#include <limits>

#include "haptics/servo/tick.hpp"
#include "haptics/station/station_tick.hpp"

namespace bolt::station {

namespace {

using force::Pivot;

// m. The wrench pivots about a bolt while its jaw is within pivot_radius of the axis, at most pivot_below
// below the nut's range of travel and at most pivot_above above it. Pivoting ends at 1.5 times these
// distances. Further down the jaw is beside the workpiece, and a rotation would push it under the workpiece's
// edge. The guiding force aligns the jaw from the same distance (GuidingParameters::alignment_distance).
constexpr double pivot_radius = 0.08, pivot_above = 0.06, pivot_below = 0.002;
constexpr double pivot_alignment = 0.7;  // cosine of the largest angle between the tool's normal and the bolt
constexpr double pivot_rate = 1.0;  // rad/s, largest rate at which the wrench turns square to a near bolt
// m and rad. If contacts hold the wrench back from its commanded pose by more than this, the wrench stops
// turning to the bolt; otherwise it would push the hand with energy that the hand did not supply.
constexpr double max_lag = 0.3e-3, max_lag_angle = 5e-3;

// The distance of a jaw at `tool` from the axis of this nut's bolt, m, if it is near the nut at any position
// of the nut on its thread; otherwise infinity. `range_factor`: factor on the distances.
double distance_if_near(const servo::NutGeometry& nut, const Pose& tool, double range_factor) {
    const Vec3 from_seat = tool.position - nut.seat;
    const double height = glm::dot(from_seat, nut.axis);
    const double aside = glm::length(from_seat - height * nut.axis);
    const double alignment = std::abs(glm::dot(tool.orientation * Vec3(0.0, 0.0, 1.0), nut.axis));
    const bool near = height > -range_factor * pivot_below &&
                      height < nut.start_gap + nut.height + range_factor * pivot_above &&
                      aside < range_factor * pivot_radius && alignment > pivot_alignment / range_factor;
    return near ? aside : std::numeric_limits<double>::infinity();
}

// The joint whose nut the wrench pivots about: the engaged one, else the nearest in range; −1: none. The
// previous joint has 1.5 times the range and counts as nearer, so that the choice does not alternate.
int nut_to_pivot_about(const servo::Setup& setup, const StationState& s) {
    if (s.output.joint >= 0) return s.output.joint;
    int found = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const double preference = static_cast<int>(i) == s.pivot_joint ? 1.5 : 1.0;
        const double distance =
            distance_if_near(setup.nuts[i], s.output.constrained_tool, preference) / preference;
        if (distance >= least) continue;
        least = distance;
        found = static_cast<int>(i);
    }
    return found;
}

// Contact with a nut does not count: there the wrench must continue to turn until its jaw fits.
bool is_held_back(const Pose& commanded, const servo::Output& output) {
    return !output.touched.is_nut() &&
           (glm::length(output.constrained_tool.position - commanded.position) > max_lag ||
            glm::length(turn_between(output.constrained_tool.orientation, commanded.orientation)) >
                max_lag_angle);
}

// Turns the pose `last` square to the bolt, by `max_turn` rad at most.
Pose turned_square_to_bolt(const Pose& last, const Pivot& pivot, double lever_arm, const Vec3& lever_end,
                           double max_turn) {
    const Vec3 normal = last.orientation * Vec3(0.0, 0.0, 1.0);
    const Vec3 axis = glm::dot(normal, pivot.axis) < 0.0 ? -pivot.axis : pivot.axis;
    const Quat to_axis =
        glm::normalize(Quat(1.0 + glm::dot(normal, axis), glm::cross(normal, axis)));  // the shortest turn
    const Pose upright{last.position, glm::normalize(to_axis * last.orientation)};
    const Pose there = force::pivoted(pivot, upright, lever_arm, lever_end);
    const Vec3 turn = force::clamp_length(turn_between(last.orientation, there.orientation), max_turn);
    Pose tool{lever_end, glm::normalize(rotation(turn) * last.orientation)};
    tool.position -= tool.orientation * Vec3(lever_arm, 0.0, 0.0);
    return tool;
}

}  // namespace

void pivot_about_bolt(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                      const Pose& last, double dt) {
    const bool wrench = s.input.grip == servo::Grip::wrench && s.workspace.lever_arm > 0.0;
    s.pivot_joint = wrench ? nut_to_pivot_about(setup, s) : -1;
    if (s.pivot_joint < 0) return;
    const servo::NutGeometry& nut = setup.nuts[static_cast<std::size_t>(s.pivot_joint)];
    const Pivot pivot{nut.seat, nut.axis};
    const Vec3 lever_end = force::lever_end(s.workspace, s.workspace.commanded_tool);
    const double lever_arm = s.workspace.lever_arm;
    // While the dead-man switch is released no force is rendered, so turning a tilted wrench square would
    // push it into the workpiece.
    const bool turns = s.input.dead_man && !is_held_back(last, s.output);
    const double max_turn = turns ? pivot_rate * dt : 0.0;
    force::realign(layout.workspace, s.workspace, s.mover_pose,
                   s.output.joint >= 0
                       ? force::pivoted(pivot, s.output.constrained_tool, lever_arm, lever_end)
                       : turned_square_to_bolt(last, pivot, lever_arm, lever_end, max_turn));
}

namespace {

// Chosen for a tool that approaches a nut by itself: 12 cm/s within 8 cm of the nut, slower than a user who
// pushes the tool away.
constexpr force::GuidingParameters approach_guiding{.gain = 0.25, .max_force = 3.0, .max_torque = 0.2};
constexpr double approach_speed = 0.04;         // m/s per N of the guiding law
constexpr double approach_angular_speed = 3.0;  // rad/s per N·m; slower than a user who turns the tool

}  // namespace

void move_to_nut(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                 const servo::State& servo, const StationInputs& inputs, servo::TickInput& input) {
    if (!layout.mover || layout.mover->sensing != device::Sensing::velocity || renders_force(*layout.mover))
        return;
    Pose& tool = s.workspace.commanded_tool;
    const int held = s.output.joint;
    const int joint = held < 0 && s.mover.usable && input.dead_man ? inputs.controls.approach_joint : -1;
    // A held nut carries the tool along as it descends.
    if (held >= 0) {
        const auto i = static_cast<std::size_t>(held);
        const Vec3 at = servo::nut_centre(setup.nuts[i], servo.joints[i].nut.angle);
        if (s.followed_nut == held) tool.position += at - s.followed_point;
        s.followed_point = at;
    }
    s.followed_nut = held;
    const servo::ToolPose now = servo::tool_pose(s.workspace.commanded_tool);
    const auto free = [&](const Vec3& from, const Vec3& to) {
        return !servo.tool_contact || !servo::occluded(*servo.tool_contact, from, to, joint);
    };
    const force::OutputCommand guiding =
        force::guide(approach_guiding, s.approach_guide, servo::guided_tool(setup, now),
                     servo::guide_target(setup, servo.joints, joint), free, setup.dt)
            .command;
    tool.position += approach_speed * setup.dt * guiding.force;
    tool.orientation =
        glm::normalize(rotation(approach_angular_speed * setup.dt * guiding.torque) * tool.orientation);
    input.commanded_tool = servo::to_commanded_tool(tool);
    s.input = input;
}

}  // namespace bolt::station
