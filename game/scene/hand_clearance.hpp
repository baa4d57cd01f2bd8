// Keeps the displayed hand out of solids: rotates it about the held object, slides it along the handle and
// bends the wrist. It affects the pictures only; the servo does not read the result.
//
// The search is damped least squares (Levenberg 1944, Marquardt 1963) over six parameters. A skin point that
// is nearer to a solid than a margin adds the square of the missing distance to the cost, and a departure
// from the natural posture adds its own square. Each frame starts from the solution of the frame before.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "haptics/collision/world.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::scene {

// A vertex of the hand's mesh with its skinning joints and weights.
struct SkinPoint {
    glm::vec3 position{0.0F};  // m, in the bind pose
    glm::u16vec4 joints{0};
    glm::vec4 weights{0.0F};
};

// Samples at most `count` vertices evenly over the skin (farthest-point sampling). Deterministic.
std::vector<SkinPoint> sample_skin(const assets::Model& hand, std::size_t count);

// The task of the hand; selects the limits of its departure from the posture.
enum class HandTask : std::uint8_t { on_handle, at_nut };

// The departure from a posture: rotation vector about the pivot (3, rad), slide (m; along the handle, or away
// from the nut), flexion and deviation of the wrist (rad).
using HandDeparture = std::array<double, 6>;

struct HandClearance {
    HandDeparture goal{}, shown{};  // `shown` follows `goal` with a time constant
    // m, penetration of the deepest skin point at `shown`, without the cuff; negative: outside
    double depth = 0.0;
    double cuff = 1.0;  // 0 … 1, displayed fraction of the cuff's length

    // State of the search. While the goal penetrates solids, other starting points are refined in turn.
    bool started = false, settled = false;  // settled: the search rests until an input changes
    HandTask task = HandTask::at_nut;       // in the last frame, as `at` and `posture`
    std::size_t start = 0;                  // number of the starting point that is refined now
    int start_steps = 0;                    // steps of that refinement so far
    HandDeparture candidate{};              // result of that refinement so far
    Pose at;
    hand::Skeleton posture;
};

// The inputs of the search in a frame.
struct HandSurroundings {
    const collision::CollisionWorld* solids = nullptr;
    Pose at;  // from the frame of the posture to the assembly's
    HandTask task = HandTask::at_nut;
    Vec3 pivot{0.0};  // m, in the frame of the posture
    std::span<const SkinPoint> skin;
    std::span<const glm::mat4> inverse_bind;
};

// Advances the search by a frame of `seconds`. The first frame searches from all starting points and shows
// the best result immediately; later frames do a bounded amount of work and move `shown` continuously.
// Returns early if the search has settled and task, place and posture are unchanged; it does not notice a
// moved obstacle.
void advance(HandClearance& clearance, const HandSurroundings& around, const hand::Skeleton& posture,
             double seconds);

// Applies the departure to the posture.
hand::Skeleton apply_departure(const hand::Skeleton& posture, const HandDeparture& by, HandTask task,
                               const Vec3& pivot);

// Penetration depth of a point in the solids, m; negative outside, at least −margin. `out`: outward unit
// normal at the nearest surface, written only if the point is inside or within the margin.
double penetration_depth(const collision::CollisionWorld& solids, const Vec3& point, double margin,
                         Vec3& out);

}  // namespace bolt::scene
