// Keeps the drawn hand out of solids: turns it about what it holds, slides it along the handle and bends its
// wrist. Affects pictures only; the servo never reads any of this.
//
// The search is damped least squares (Levenberg 1944, Marquardt 1963) over six parameters. A point of the
// hand's skin that is nearer to a solid than a margin adds the square of what is missing, and a departure
// from the natural posture adds its own square. A frame continues from the solution of the frame before.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "haptics/collision/world.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::scene {

// A vertex of the hand's mesh with the joints that move it.
struct SkinPoint {
    glm::vec3 at{0.0F};  // m, in the bind pose
    glm::u16vec4 joints{0};
    glm::vec4 weights{0.0F};
};

// At most `count` vertices, spread evenly over the skin. The same for the same model.
std::vector<SkinPoint> spread_skin_points(const assets::Model& hand, std::size_t count);

// What the hand does; decides how it may depart from its posture.
enum class HandTask : std::uint8_t { on_handle, at_nut };

// The departure from a posture: rotation vector about the pivot (rad), slide (m; along the handle, or away
// from the nut), flexion and deviation of the wrist (rad).
using HandDeparture = std::array<double, 6>;

struct HandClearance {
    HandDeparture goal{}, shown{};  // `shown` follows `goal`
    double depth = 0.0;  // m, of the deepest point of the hand proper at `shown`; negative: outside
    double cuff = 1.0;   // the share of the cuff's length that is drawn

    // Of the search. While the goal is not clear, other starts are refined in turn.
    bool started = false, settled = false;
    HandTask task = HandTask::at_nut;
    std::size_t start = 0;
    int start_steps = 0;
    HandDeparture candidate{};
    Pose at;
    hand::Skeleton posture;
};

// What a frame's search reads.
struct HandSurroundings {
    const collision::World* solids = nullptr;
    Pose at;  // from the frame of the posture to the assembly's
    HandTask task = HandTask::at_nut;
    Vec3 pivot{0.0};  // m, in the frame of the posture
    std::span<const SkinPoint> skin;
    std::span<const glm::mat4> inverse_bind;
};

// A frame of `seconds`. The first frame searches from all starts and shows the best at once; later frames do
// a bounded amount of work, and `shown` moves continuously. A frame in which nothing has moved costs nothing
// once the search has settled.
void advance(HandClearance& clearance, const HandSurroundings& around, const hand::Skeleton& posture,
             double seconds);

// The posture with the departure applied.
hand::Skeleton departed(const hand::Skeleton& posture, const HandDeparture& by, HandTask task,
                        const Vec3& pivot);

// m: how deep a point is inside the solids, negative outside; exact only within `margin` outside. `out`:
// unit, the way to the nearest surface's outside; written where the point is inside or within the margin.
double depth_in(const collision::World& solids, const Vec3& point, double margin, Vec3& out);

}  // namespace bolt::scene
