#include "haptics/station/pivot.hpp"

#include <algorithm>
#include <limits>

namespace bolt::station {

namespace {

using force::Pivot;

// m from a bolt's axis, and above and below its nut's way, within which the wrench pivots about the bolt;
// half more to leave it. Lower, the wrench is beside the work, and a turn would drive the jaw under its edge.
// The guiding force aligns the jaw from the same distance (GuidingParameters::alignment_distance).
constexpr double pivot_radius = 0.08, pivot_above = 0.06, pivot_below = 0.002;
constexpr double pivot_alignment = 0.7;  // cosine of the largest angle between the tool's normal and the bolt
constexpr double pivot_rate = 1.0;  // rad/s, at most, at which the wrench turns to a bolt that it comes near
// m and rad by which obstacles hold a wrench back that no longer turns to a bolt: it would push the hand
// away, with energy that the hand did not put in.
constexpr double held_back = 0.3e-3, held_back_angle = 5e-3;

// The distance of a jaw at `tool` from the axis of this nut's bolt, m, if it is near the nut at any position
// of the nut on its thread; otherwise infinity. `slack`: factor on the distances.
double distance_if_near(const servo::NutGeometry& nut, const Pose& tool, double slack) {
    const Vec3 from_seat = tool.position - nut.seat;
    const double height = glm::dot(from_seat, nut.axis);
    const double aside = glm::length(from_seat - height * nut.axis);
    const double alignment = std::abs(glm::dot(tool.orientation * Vec3(0.0, 0.0, 1.0), nut.axis));
    const bool near = height > -slack * pivot_below &&
                      height < nut.start_gap + nut.height + slack * pivot_above &&
                      aside < slack * pivot_radius && alignment > pivot_alignment / slack;
    return near ? aside : std::numeric_limits<double>::infinity();
}

// The nut that the wrench pivots about: the engaged one, else the nearest that is near; −1: none. The one
// that it pivoted about before counts as nearer than it is.
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

// On a nut the wrench must continue to turn until its jaw fits.
bool is_held_back(const Pose& commanded, const servo::Output& output) {
    return !output.touched.is_nut() &&
           (glm::length(output.constrained_tool.position - commanded.position) > held_back ||
            glm::length(turn_between(output.constrained_tool.orientation, commanded.orientation)) >
                held_back_angle);
}

// The pose `last`, square to the bolt, except that it turns by `max_turn` rad at most.
Pose squared(const Pose& last, const Pivot& pivot, double lever_arm, const Vec3& lever_end, double max_turn) {
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

void pivot_about_bolt(const Layout& layout, const servo::Setup& setup, StationState& s, const Pose& last,
                      double dt) {
    const bool wrench = s.input.grip == servo::Grip::wrench && s.workspace.lever_arm > 0.0;
    s.pivot_joint = wrench ? nut_to_pivot_about(setup, s) : -1;
    if (s.pivot_joint < 0) return;
    const servo::NutGeometry& nut = setup.nuts[static_cast<std::size_t>(s.pivot_joint)];
    const Pivot pivot{nut.seat, nut.axis};
    const Vec3 lever_end = force::lever_end(s.workspace, s.workspace.commanded_tool);
    const double lever_arm = s.workspace.lever_arm;
    // Without output nothing holds the jaw: a tilted wrench that was turned square would sink into the work.
    const bool turns = s.input.enabled && !is_held_back(last, s.output);
    const double max_turn = turns ? pivot_rate * dt : 0.0;
    force::realign(layout.workspace, s.workspace, s.mover_pose,
                   s.output.joint >= 0
                       ? force::pivoted(pivot, s.output.constrained_tool, lever_arm, lever_end)
                       : squared(last, pivot, lever_arm, lever_end, max_turn));
}

}  // namespace bolt::station
