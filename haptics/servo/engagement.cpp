#include "haptics/servo/engagement.hpp"

#include <algorithm>
#include <cmath>

#include "haptics/joint/nut.hpp"

namespace bolt::servo {

namespace {

constexpr double max_radial_offset = 1.5e-3;  // m, up to which a jaw slides onto the nut
constexpr double min_engage_cosine = 0.9976;  // cos 4°, of the angle between the jaw's normal and the axis
constexpr double finger_reach = 0.012;        // m from fingertips to nut centre
// cos 30°, of the angle between the jaw's normal and the axis; a jaw that is tilted more releases the nut.
constexpr double min_held_cosine = 0.866;
constexpr double max_handle_axis_cosine = 0.8;  // above it the azimuth of the handle is ill-conditioned
constexpr double max_turn_per_tick = 0.35;      // rad in a tick, faster than any hand
constexpr double offset_decay_time = 0.05;      // s, of Engagement::offset_at_engagement

struct NutOffset {
    double axial = 0.0;   // m, along the nut's axis
    double radial = 0.0;  // m
};

NutOffset offset_of(const Vec3& from_centre, const NutGeometry& nut) {
    const double axial = glm::dot(from_centre, nut.axis);
    return {axial, glm::length(from_centre - axial * nut.axis)};
}

bool tilted_away(const NutGeometry& nut, const ToolPose& tool, Grip grip) {
    if (std::abs(glm::dot(tool.handle, nut.axis)) > max_handle_axis_cosine) return true;
    return grip == Grip::wrench && std::abs(glm::dot(tool.normal, nut.axis)) < min_held_cosine;
}

bool pulled_away(const NutGeometry& nut, const NutOffset& o, Grip grip) {
    if (grip == Grip::fingers) return std::hypot(o.axial, o.radial) > 2.0 * finger_reach;
    return std::abs(o.axial) > 0.6 * nut.height || o.radial > 0.3 * nut.across_flats;
}

bool fits(const Setup& setup, const NutGeometry& nut, const NutOffset& o, const ToolPose& tool, Grip grip,
          double misalignment) {
    if (tilted_away(nut, tool, grip)) return false;
    if (grip == Grip::fingers) return std::hypot(o.axial, o.radial) < finger_reach;
    return std::abs(o.axial) < 0.35 * nut.height && o.radial < max_radial_offset &&
           std::abs(glm::dot(tool.normal, nut.axis)) > min_engage_cosine &&
           std::abs(misalignment) <= setup.wrench.half_play &&
           collision::grips(setup.wrench.head, shape_of(nut));
}

// `azimuth`: rad, of the tool to the nut's hexagon. A ratchet lets its head turn until it fits.
double misalignment_of(const Wrench& wrench, double azimuth) {
    return wrench.ratchet.tooth_angle > 0.0 ? 0.0 : wrap(azimuth, collision::fitting_angle(wrench.head));
}

}  // namespace

void turn_tool(const Wrench& wrench, double turned, Engagement& e) {
    if (wrench.ratchet.tooth_angle > 0.0) {
        const double sense = wrench.ratchet.loosens ? -1.0 : 1.0;
        const double taken_up = std::clamp(sense * turned, 0.0, e.ratchet_slack);
        e.ratchet_slack -= taken_up;
        turned -= sense * taken_up;
    }
    e.hand_angle += turned;
}

double pawl_drag(const Ratchet& ratchet, double slack) {
    const double climbed = slack / ratchet.tooth_angle;
    return ratchet.drag * (ratchet.least_drag_share + (1.0 - ratchet.least_drag_share) * climbed);
}

void limit_to_pawl(const Wrench& wrench, double rotation, const Engagement& e, joint::NutDrive& drive) {
    if (wrench.ratchet.tooth_angle <= 0.0) return;
    const double ahead = (wrench.ratchet.loosens ? -1.0 : 1.0) * (e.hand_angle - rotation);
    if (ahead < -drive.half_play) drive.torque_limit = pawl_drag(wrench.ratchet, e.ratchet_slack);
}

void settle_ratchet(const Wrench& wrench, double rotation, double play, Engagement& e) {
    const Ratchet& ratchet = wrench.ratchet;
    if (ratchet.tooth_angle <= 0.0) return;
    // Positive in the direction in which the head turns with the handle.
    const double sense = ratchet.loosens ? -1.0 : 1.0;
    const auto slip = [&] {
        const double rearmost =
            sense * rotation - play - pawl_drag(ratchet, e.ratchet_slack) / wrench.stiffness;
        const double slipped = std::max(0.0, rearmost - sense * e.hand_angle);
        e.ratchet_slack += slipped;
        e.hand_angle += sense * slipped;
    };
    slip();
    if (e.ratchet_slack < ratchet.tooth_angle) return;
    e.ratchet_slack = std::fmod(e.ratchet_slack, ratchet.tooth_angle);
    slip();  // the pawl has dropped into a tooth, and the head springs forward
}

std::optional<Pose> commanded_pose(const CommandedTool& commanded) {
    Pose pose;
    bool valid = true;
    for (int i = 0; i < 3; ++i) {
        pose.position[i] = static_cast<double>(commanded.position[i]);
        valid = valid && std::abs(pose.position[i]) < 1e3;  // false for NaN too
    }
    const Quat q(static_cast<double>(commanded.orientation[0]), static_cast<double>(commanded.orientation[1]),
                 static_cast<double>(commanded.orientation[2]),
                 static_cast<double>(commanded.orientation[3]));
    const double norm = std::sqrt(glm::dot(q, q));
    if (!(valid && norm > 0.5 && norm < 2.0)) return std::nullopt;
    pose.orientation = q / norm;
    return pose;
}

ToolPose tool_pose(const CommandedTool& commanded) {
    const std::optional<Pose> pose = commanded_pose(commanded);
    if (!pose) return {Vec3(0.0), Quat(1, 0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), false};
    return tool_pose(*pose);
}

ToolPose tool_pose(const Pose& pose) {
    return {pose.position, pose.orientation, pose.orientation * Vec3(1, 0, 0),
            pose.orientation * Vec3(0, 0, 1), true};
}

Vec3 nut_centre(const NutGeometry& nut, double nut_angle) {
    const double gap = std::max(0.0, nut.start_gap - nut.lead * nut_angle);
    return nut.seat + nut.axis * (gap + nut.grip_height);
}

double tool_azimuth(const Setup& setup, const NutGeometry& nut, const ToolPose& tool, Grip grip) {
    const double handle = angle_of(nut, tool.handle);
    if (grip != Grip::wrench) return handle;
    const bool turned_over = glm::dot(tool.normal, nut.axis) < 0.0;
    return handle + nut.sense * (turned_over ? setup.wrench.head_angle : -setup.wrench.head_angle);
}

void update_pose_engagement(const Setup& setup, std::span<const joint::JointState> joints,
                            const ToolPose& tool, Grip grip, Engagement& e) {
    if (!tool.valid) {
        e = {};
        return;
    }
    if (e.joint >= 0) {
        const NutGeometry& nut = setup.nuts[static_cast<std::size_t>(e.joint)];
        const double nut_angle = joints[static_cast<std::size_t>(e.joint)].nut.angle;
        const NutOffset o = offset_of(tool.position - nut_centre(nut, nut_angle), nut);
        const double azimuth = tool_azimuth(setup, nut, tool, grip);
        const double turned = wrap(azimuth - e.azimuth, 2.0 * pi);
        if (grip == e.grip && !pulled_away(nut, o, grip) && !tilted_away(nut, tool, grip) &&
            std::abs(turned) < max_turn_per_tick) {
            if (grip == Grip::wrench)
                turn_tool(setup.wrench, turned, e);
            else
                e.hand_angle += turned;
            e.azimuth = azimuth;
            e.offset_at_engagement *= 1.0 - setup.dt / offset_decay_time;
            return;
        }
        e = {};
        return;  // a nut released in this tick can be engaged in the next tick at the earliest
    }
    if (grip == Grip::none) return;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const NutGeometry& nut = setup.nuts[i];
        const double nut_angle = joints[i].nut.angle;
        const Vec3 from_centre = tool.position - nut_centre(nut, nut_angle);
        if (std::abs(from_centre.x) + std::abs(from_centre.y) + std::abs(from_centre.z) > 0.1) continue;
        const double azimuth = tool_azimuth(setup, nut, tool, grip);
        const double misalignment = misalignment_of(setup.wrench, azimuth - joints[i].rotation());
        if (!fits(setup, nut, offset_of(from_centre, nut), tool, grip, misalignment)) continue;
        e.joint = static_cast<int>(i);
        e.grip = grip;
        e.azimuth = azimuth;
        e.hand_angle = joints[i].rotation() + (grip == Grip::wrench ? misalignment : 0.0);
        e.offset_at_engagement = from_centre;
        return;
    }
}

namespace {

// rad; angle that corresponds to a few micrometres (the god-object's tolerance) at half a flat's length.
constexpr double angle_tolerance = 1e-3;
constexpr double max_engage_distance = 0.1;  // m from head to nut beyond which a nut is skipped
constexpr double min_overlap = 0.5e-3;       // m of rings, sockets and keys on the flats, to engage
constexpr double min_torque_limit = 1e-9;    // N·m; NutDrive::torque_limit 0 means unlimited

// Modelling assumptions: a jaw slips off a corner when it has turned by its whole backlash since it reached
// the corner torque, but not faster than an elastic wrench swings back.
constexpr double slip_off_half_plays = 2.0;  // half plays
constexpr double min_slip_time = 0.02;       // s
constexpr double min_height = 0.2e-3;        // m, lower bound of the rounded height

double corner_torque(const Setup& setup, const NutGeometry& nut, double rounded, const Engagement& e) {
    const collision::ToolHead& head = setup.wrench.head;
    const collision::HeadFit& fit = e.fit;
    const double width = collision::width_across_flats(head);
    if (std::holds_alternative<collision::HexKey>(head)) {
        const double clearance = 0.5 * (collision::width_across_flats(shape_of(nut)) - width);
        return joint::ring_torque(nut.corner_pressure, {fit.overlap, width, 6, fit.tilt, clearance, rounded});
    }
    const double clearance = 0.5 * (width - nut.across_flats);
    if (const auto* ring = std::get_if<collision::Ring>(&head))
        return joint::ring_torque(
            nut.corner_pressure, {fit.overlap, nut.across_flats, ring->points, fit.tilt, clearance, rounded});
    return joint::corner_torque(nut.corner_pressure, {fit.overlap, fit.toward_throat, fit.toward_mouth,
                                                      fit.tilt, clearance, rounded});
}

double play_of(const Setup& setup, const NutGeometry& nut, double rounded) {
    return half_play(setup.wrench, nut.across_flats, rounded);
}

// Direction of the throat, or of a corner of a key or a ring, about the bolt, rad, tightening positive.
double azimuth_of(const Setup& setup, const NutGeometry& nut, const ToolPose& tool) {
    const double head = setup.wrench.head_angle;
    const Vec3 to_throat = tool.orientation * Vec3(std::cos(head), std::sin(head), 0.0);
    return angle_of(nut, to_throat);
}

}  // namespace

Pose pose_in_nut_frame(const NutGeometry& nut, const joint::JointState& joint, const ToolPose& tool) {
    return inverse(nut_pose(nut, joint.nut.angle, joint.common_turn)) * Pose{tool.position, tool.orientation};
}

void update_contact_engagement(const Setup& setup, std::span<const joint::JointState> joints,
                               std::span<const double> rounded, const ToolPose& tool, Engagement& e) {
    const collision::ToolHead& head = setup.wrench.head;
    const double width = collision::width_across_flats(head);
    const auto* jaw = std::get_if<collision::Jaw>(&head);
    const auto fit_on = [&](std::size_t i) {
        const NutGeometry& nut = setup.nuts[i];
        return collision::head_fit(head, shape_of(nut), pose_in_nut_frame(nut, joints[i], tool));
    };
    if (!tool.valid) {
        e = {};
        return;
    }
    if (e.joint >= 0) {
        const auto i = static_cast<std::size_t>(e.joint);
        const double azimuth = azimuth_of(setup, setup.nuts[i], tool);
        const double turned = wrap(azimuth - e.azimuth, 2.0 * pi);
        e.fit = fit_on(i);
        if (e.grip == Grip::wrench && e.fit.surrounds(width) && std::abs(turned) < max_turn_per_tick) {
            turn_tool(setup.wrench, turned, e);
            e.azimuth = azimuth;
            return;
        }
        e = {};
        return;  // a nut released in this tick can be engaged in the next tick at the earliest
    }
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const NutGeometry& nut = setup.nuts[i];
        const double nut_angle = joints[i].nut.angle;
        if (glm::length(tool.position - nut_centre(nut, nut_angle)) > max_engage_distance) continue;
        if (!collision::grips(head, shape_of(nut))) continue;
        const collision::HeadFit fit = fit_on(i);
        // The bevel is the hysteresis: a hand that trembles at the edge does not engage and release in turn.
        if (!fit.surrounds(width) || fit.overlap < (jaw != nullptr ? jaw->bevel : min_overlap)) continue;
        if (std::abs(fit.misalignment) > play_of(setup, nut, rounded[i]) + angle_tolerance) continue;
        e.joint = static_cast<int>(i);
        e.grip = Grip::wrench;
        e.azimuth = azimuth_of(setup, nut, tool);
        e.hand_angle = joints[i].rotation() + nut.sense * fit.misalignment;
        e.fit = fit;
        return;
    }
}

joint::NutDrive contact_drive(const Setup& setup, const NutGeometry& nut, double rounded,
                              const Engagement& e) {
    joint::NutDrive drive;
    drive.engaged = true;
    drive.angle = e.hand_angle;
    drive.half_play = play_of(setup, nut, rounded);
    drive.stiffness = setup.wrench.stiffness;
    drive.torque_limit =
        std::max(min_torque_limit, e.corner_torque_share * corner_torque(setup, nut, rounded, e));
    return drive;
}

double bend_tool(const Wrench& wrench, double nut_rotation, joint::NutDrive& drive, Engagement& e) {
    if (wrench.yield_torque <= 0.0 || e.joint < 0 || e.grip != Grip::wrench) return 0.0;
    if (drive.torque_limit > 0.0 && drive.torque_limit <= wrench.yield_torque) return 0.0;
    const double most = drive.half_play + wrench.yield_torque / wrench.stiffness;
    const double wound = e.hand_angle - e.swung - nut_rotation;
    const double bent = wound - std::clamp(wound, -most, most);
    e.hand_angle -= bent;
    drive.angle -= bent;
    return std::abs(bent);
}

bool round_corners(const Setup& setup, const NutGeometry& nut, const joint::JointState& joint,
                   double& rounded, Engagement& e) {
    const double full_corner_torque = corner_torque(setup, nut, rounded, e),
                 play = play_of(setup, nut, rounded);
    const double limit = std::max(min_torque_limit, e.corner_torque_share * full_corner_torque);
    if (std::abs(joint.torque) < 0.999 * limit) return false;
    const double wound = e.hand_angle - e.swung - joint.rotation();
    const double beyond = std::abs(wound) - play - full_corner_torque / setup.wrench.stiffness;
    const double turned = std::max(0.0, beyond - e.turned_beyond_corner_torque);
    e.turned_beyond_corner_torque = std::max(e.turned_beyond_corner_torque, beyond);
    // The work removes corner material: at each corner that bears, a triangle with two sides of `rounded`
    // that enclose 120°.
    const bool two =
        std::holds_alternative<collision::Jaw>(setup.wrench.head) || !setup.rounds_all_loaded_corners;
    const double corners = two ? 2.0 : 6.0;
    const double area = std::sqrt(3.0) / 4.0, height = std::max(e.fit.overlap, min_height);
    rounded = std::sqrt(square(rounded) + limit * turned / (corners * area * height * nut.corner_pressure));
    rounded = std::min(rounded, 0.5 * nut.across_flats / std::sqrt(3.0));
    const double remaining =
        1.0 - e.turned_beyond_corner_torque / (slip_off_half_plays * std::max(play, angle_tolerance));
    e.corner_torque_share =
        std::clamp(remaining, e.corner_torque_share - setup.dt / min_slip_time, e.corner_torque_share);
    if (e.corner_torque_share > 0.0) return false;
    e = {};
    return true;
}

}  // namespace bolt::servo
