// Motion of a simulated hand: reaching movements along an arc, physiological tremor, and path planning around
// the obstacles of the contact simulation.
#pragma once

#include <cmath>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/servo/engagement.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::motion {

using bolt::minimum_jerk;

// The pose at fraction s (0 … 1) of a reaching movement along an arc, whose middle is `bulge` (m) off the
// straight line.
inline Pose arc_pose(const Pose& from, const Pose& to, double s, const Vec3& bulge) {
    return {glm::mix(from.position, to.position, s) + bulge * (4.0 * s * (1.0 - s)),
            glm::slerp(from.orientation, to.orientation, s)};
}

// Tremor as two incommensurate sines per axis in the 8–12 Hz band, with unit amplitude and random phases.
class Tremor {
  public:
    explicit Tremor(Random& random) {
        for (int i = 0; i < count; ++i) {
            rate_[i] = 2.0 * pi * random.uniform(8.0, 12.0);
            phase_[i] = random.uniform(0.0, 2.0 * pi);
        }
    }
    [[nodiscard]] Vec3 at(double time) const { return {pair(time, 0), pair(time, 2), pair(time, 4)}; }
    [[nodiscard]] double torsion(double time) const { return pair(time, 6); }

  private:
    static constexpr int count = 8;
    [[nodiscard]] double pair(double time, int i) const {
        return 0.5 * (std::sin(rate_[i] * time + phase_[i]) + std::sin(rate_[i + 1] * time + phase_[i + 1]));
    }
    double rate_[count];
    double phase_[count];
};

// Orientation of a tool whose handle is at the given angle about the bolt, rad (tightening positive).
// `flipped`: the tool is turned over, so that its +Z points against the nut's axis.
Quat tool_orientation(const servo::NutGeometry& nut, double handle_angle, bool flipped);

struct ReachPath {
    Vec3 bulge{0.0};              // m, as for arc_pose()
    std::vector<Pose> waypoints;  // poses to reach first, on straight lines; empty if one reach suffices
};

// Plans a reach in which the wrench touches no obstacle. Tries in this order: an arc with a bulge of at least
// `min_bulge` m along `up`; an arc with a bulge to a side too; straight up, across and down; a detour through
// open space where the wrench is turned; a straight approach from beside; a path around the whole assembly,
// such as from its front to its back. If all fail, returns the highest path over the top.
ReachPath plan_reach(const servo::Setup& setup, const servo::ToolContact& contact, const Pose& from,
                     const Pose& to, const Vec3& up, double min_bulge);

// The angle at which a wrench sits on a nut.
struct HandleAngle {
    double angle = 0.0;    // rad about the bolt, tightening positive
    bool flipped = false;  // the wrench is turned over, as in tool_orientation()
    // rad by which the handle can swing from there. Never below 15°, even where there is less room, so that a
    // pull is tried all the same.
    double free_swing = 0.0;
};

// Chooses one of the angles at which the head fits, also with the wrench turned over. Room for a pull of
// `stroke` rad in the direction of `sign` (tightening positive) and for the approach has the most weight,
// then a small distance to `preferred` (rad). If no angle has enough room, returns the best of them.
// `contact` null: there are no obstacles, and every angle has room. `state`: of the joint.
HandleAngle choose_handle_angle(const servo::Setup& setup, const servo::ToolContact* contact,
                                std::size_t joint, const joint::JointState& state, double preferred,
                                double sign, double stroke);

// Height above the nut, m, at which a wrench waits before it is lowered: `max_height`, or down to 15 mm if an
// obstacle is above the nut. If no height is free, also `max_height`.
double hover_height(const servo::Setup& setup, const servo::ToolContact& contact, std::size_t joint,
                    double nut_angle, const HandleAngle& handle, double max_height);

// Returns the commanded pose, moved towards `wrench`, the pose that obstacles permit, so that it is ahead by
// at most 4 mm and 4°: the force of a hand on a blocked wrench is limited.
Pose give_way_to_wrench(const Pose& commanded, const Pose& wrench);

}  // namespace bolt::motion
