// The guiding force: its law, the planning of its path around obstacles, and its step. The force points
// towards the target and is inversely proportional to the distance, as in the 2018 paper
// (haptics/joint/published.hpp), but bounded and with limited stiffness; a torque aligns the jaw with the
// hexagon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/base/function_ref.hpp"
#include "engine/base/math.hpp"
#include "haptics/force/output_stage.hpp"

namespace bolt::force {

struct GuidingParameters {
    double gain = 0.1;                 // k of F = k/d, N·m: 1 N at 10 cm
    double stiffness = 500.0;          // K_max, N/m, largest stiffness that the device renders stably
    double fade_distance = 1.0;        // m; from here to twice this distance the force fades to zero
    double max_force = 3.0;            // N
    double max_torque = 0.2;           // N·m, of each of the two parts of aligning_torque()
    double alignment_distance = 0.08;  // m to the target within which the torque acts
    double mode_share = 1.0;           // 0 … 1, share of the force that the lesson's mode allows
    double fade_rate = 4.0;            // 1/s, at which the force fades in and out
};

// The force k/d has the local stiffness k/d². Below d_min = √(k/K_max) the spring force K_max d replaces k/d,
// and `max_force` caps both. Force and potential are continuous; the largest force is √(k K_max) or the cap.
// `distance` in m.
double guiding_pull(const GuidingParameters& guiding, double distance);                      // N
Vec3 guiding_force(const GuidingParameters& guiding, const Vec3& tool, const Vec3& target);  // N

// Potential of guiding_pull, J, 0 at the target.
double guiding_potential(const GuidingParameters& guiding, double distance);

// Orientation of a nut's hexagon: orthogonal unit vectors. A jaw fits with its direction along `flat` or
// turned from it about `axis` by a multiple of 60°.
struct Hexagon {
    Vec3 axis{0.0, 1.0, 0.0};     // of the bolt, away from the members
    Vec3 flat{1.0, 0.0, 0.0};     // along a flat
    Vec3 across{0.0, 0.0, -1.0};  // axis × flat
};

// The torque, N·m, with two parts: one turns the jaw to the nearest of the six orientations, the other turns
// its normal parallel or antiparallel to the axis. It is the gradient of a smooth potential V, and therefore
// continuous where the nearest orientation changes:
//
//   V = max_torque/6 (1 − Re z⁶) + max_torque (1 − (n·a)²)
//
// n is the normal, a the axis, and z = jaw·flat + i jaw·across. Each part is at most `max_torque`.
Vec3 aligning_torque(double max_torque, const Hexagon& hexagon, const Vec3& jaw, const Vec3& normal);
// V, J.
double aligning_potential(double max_torque, const Hexagon& hexagon, const Vec3& jaw, const Vec3& normal);

// Plans a path for the guiding force around obstacles. The caller supplies the line-of-sight query (Embree,
// in the servo), so the force never pulls through a housing.

// Returns true if a point can move along the straight segment. The implementation may require a margin for
// the tool.
using IsSegmentFree = FunctionRef<bool(const Vec3& from, const Vec3& to)>;

struct GuideTarget {
    int id = -1;                    // identifies the target; negative: none
    Vec3 point{0.0};                // m, at which the tool is to arrive
    Vec3 axis{0.0, 1.0, 0.0};       // unit, towards the accessible side
    double approach_height = 0.08;  // m, height above `point` at which the last segment begins
    double bounding_radius = 0.03;  // m, of the ball that the target's nut and bolt fill; not an obstacle
    Hexagon hexagon;
};

struct GuidePath {
    std::array<Vec3, 5> points{};  // from the tool to the target
    std::size_t count = 0;         // 0: no path found
};

// Candidates:
// - the straight segment, if it ends along the axis or, at the height of the nut, from the side;
// - via the approach point;
// - over the target at several heights;
// - around one side.
// Returns the shortest free candidate. If none is free, returns the straight segment if it is free in spite
// of its direction, otherwise an empty path. Queries `free` less than 200 times.
GuidePath plan_path(const Vec3& from, const GuideTarget& target, IsSegmentFree free);

// The lowest height above the target, m, to which the tool may be led from its present position. A segment
// that is free for a point may be too narrow for the tool. Near the target only a motion along the axis is
// certain to have room for it. So the tool is led at constant height until it is inside a cone about the
// axis, and then down.
double lowest_permitted_height(const GuideTarget& target, const Vec3& tool);

// Moves the end of the path to the target's present position, and the approach point, if there is one, along
// with it.
void move_end(GuidePath& path, const GuideTarget& target);

double length(const GuidePath& path);                // m
Vec3 point_at(const GuidePath& path, double along);  // `along` in m from the start, clamped

// Returns true if the parts of the segment outside the ball of GuideTarget::bounding_radius are free.
bool free_to(const Vec3& from, const Vec3& to, const GuideTarget& target, IsSegmentFree free);

// The guiding force: plans a path to a nut, pulls the tool towards the farthest point of the path in the
// tool's line of sight and aligns the jaw at the end. The force is continuous: it fades in and out, and
// target or path change only while the force is zero.

// The tool's head in the assembly's frame.
struct GuidedTool {
    Vec3 position{0.0};                  // m
    Vec3 head_direction{1.0, 0.0, 0.0};  // unit; aligns with a flat of the hexagon
    Vec3 normal{0.0, 0.0, 1.0};          // unit, normal of the jaw's plane
};

struct GuideState {
    GuideTarget target;  // of the present force; replaced when this force has faded out
    GuidePath path;
    double along = 0.0;           // m along the path to the pull point, towards which the force points
    double max_along = 0.0;       // m, largest value of `along` on this path
    double force_share = 0.0;     // 0 … 1, share of the force that is requested now
    double torque_share = 0.0;    // 0 … 1, share of the aligning torque that is requested now
    double time_to_replan = 0.0;  // s until the next attempt to plan a path
    double blocked_time = 0.0;  // s that the tool has been at the pull point without sight of the path beyond

    // Values of the last tick, for the energy balance.
    Vec3 tool{0.0}, force{0.0};
    bool at_end = false;  // the pull point is the target
};

// One tick of dt. With a negative `target.id` the force fades out; pass a negative id while a nut is engaged.
// Returns the request to the output stage. Along the path the force feeds energy in on purpose. All
// of its work is reported as injected energy, so that the passivity observer does not take it for
// instability. At the target the force derives from a potential, which the observer treats like the energy of
// a spring.
ForceRequest guide(const GuidingParameters& guiding, GuideState& state, const GuidedTool& tool,
                   const GuideTarget& target, IsSegmentFree free, double dt);

}  // namespace bolt::force
