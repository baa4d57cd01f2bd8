// The god-object algorithm, which moves the constrained tool: the pose of the tool under contact constraints.
// It follows the commanded tool as far as obstacles permit. It does not penetrate them, apart from the error
// of their sampled surfaces (GodObjectParameters::skin). The hand feels the coupling between the two poses
// (haptics/proxy/coupling.hpp); contacts have no springs of their own, so a contact that appears or
// disappears causes no step in the force.
//
// Ruspini, Kolarov and Khatib, SIGGRAPH 1997 (the proxy); Ortega, Redon and Coquillart, IEEE TVCG 13(3), 2007
// (six degrees of freedom, least constraint). The constrained tool takes the pose with the
// least energy of the coupling's spring among those that contacts permit. There spring and contacts balance,
// so the force of the spring equals that of the contacts.
#pragma once

#include <limits>
#include <optional>

#include "engine/base/function_ref.hpp"
#include "haptics/collision/contact.hpp"
#include "haptics/proxy/constraint_solver.hpp"
#include "haptics/proxy/coupling.hpp"

namespace bolt::proxy {

// Writes the contacts of the tool at a pose, up to a distance of `band` (m), as contact.hpp describes them.
using ContactFinder =
    FunctionRef<collision::ContactQueryResult(const Pose&, double band, std::span<collision::Contact>)>;

inline constexpr std::size_t max_contacts = 32;  // capacity of the finder's output

// Limits on the change of the rendered force per millisecond. The change has two parts:
//
//   the hand's part   the change that the hand's motion causes while the constrained tool stands still
//   the tool's part   the rest: the constrained tool itself moves, because it slips or falls off an edge
//
// The tool's part is limited to the greater of two values, `tool_share_of_rendered` of the rendered force and
// `tool_share_of_maximum` of the greatest force that the coupling renders (Coupling::max_force); people
// notice a step of 7 % of the force that they feel. Both parts together are limited to
// `total_share_of_maximum`. While the tool is pushed out of an obstacle that moved into it, only the total
// limit applies. The same limits hold for the torque, with the rendered and the greatest torque.
struct ForceRateLimits {
    double tool_share_of_rendered = 0.05;  // of the rendered force
    double tool_share_of_maximum = 0.005;  // of the greatest force; applies if little is rendered
    double total_share_of_maximum = 0.08;  // of the greatest force
    // The tool's part may change by this share of its limit in any direction. It may change by more, up to
    // the whole limit, only in the direction in which it changed in the last tick, because a change that
    // alternates from tick to tick is felt as trembling.
    double any_direction_share = 0.3;
};

struct GodObjectParameters {
    proxy::Coupling coupling;
    ForceRateLimits rate_limits;
    double radius = 0.3;                        // m; bounds the distance of the tool's points from its origin
    std::optional<collision::BoundingBox> box;  // bounds the tool as well, in its own frame
    double friction_coefficient = 0.15;
    // m, kept between tool and obstacles. The finder samples the surfaces. Between two samples the tool can
    // be up to 0.19 mm nearer than the finder reports (measured by bolt-contact-validation, on the ZQ350).
    // The real surfaces can therefore overlap by at most 0.08 mm (0.19 − 0.11).
    double skin = 110e-6;
    // m, how far a point of the tool may move until the next query. It may move further only if the last
    // query found no obstacle on that longer way.
    double stride = 0.4e-3;
    double max_band = 5e-3;        // m, widest band of a query
    double recovery_speed = 0.25;  // m/s, at which the tool is pushed out of an obstacle that moved into it
    // A tool nearer to an obstacle than the skin must retreat. Between two obstacles a retreat from both can
    // be impossible. True: the tool then goes to the middle of the gap, and no greater retreat is demanded.
    // False (sessions before format 11): the demand remains, the contact forces grow, and their friction
    // holds the tool.
    bool allows_narrow_gaps = true;
    // Budget per tick: the number of queries, and their cost (ContactQueryResult::query_cost). There
    // are two exceptions. The first query of a tick, at the pose where the last tick ended, costs nothing if
    // it searches no further than one stride. And the limit of the cost applies only after the first motion
    // of a tick, so that each tick makes progress. Once the budget is spent, the tool moves only as far as
    // earlier queries found no obstacle, and continues in the next tick.
    int max_queries = 5;
    std::uint32_t max_query_cost = 800;
};

struct GodObjectState {
    Pose constrained_tool;  // in the assembly's frame
    // Values of the last tick.
    Pose commanded_tool;
    proxy::Offset offset;
    force::OutputCommand rendered;     // N and N·m, by the coupling
    force::OutputCommand tool_change;  // the tool's part (ForceRateLimits) of the change of `rendered`
    // m, nearest contact; infinite without contacts.
    double nearest_contact = std::numeric_limits<double>::infinity();
    Twist first_motion;  // first constrained motion of the tick; warm-starts the next solve
};

// Result of a step.
struct GodObjectStep {
    double nearest = 0.0;      // m; lower bound of the distance at the end of the step
    std::size_t contacts = 0;  // within the band, at the last of the tool's poses that was queried
    int queries = 0;
    std::uint32_t query_cost = 0;
    int solves = 0;
    // The budget of queries ended, or four motions from one pose were rejected (step_god_object()), before
    // the tool reached the pose with the least energy.
    bool cut_short = false;
    bool rate_limited = false;  // the motion was shortened to limit the change of force
};

// The state with commanded and constrained tool at `pose`, where the tool must not penetrate anything.
GodObjectState start_god_object(const Pose& pose);

// Advances by one tick of `dt` (s). A motion is accepted in one of two cases:
//
//   free    no point of the tool travels further than the distance to the nearest obstacle, less the skin
//   short   no point travels further than `stride`, and each contact that the motion approached ends at least
//           skin/5 away, or no nearer than the nearest contact was before
//
// At the end of a short motion the finder can report a contact that it missed at the start. The motion is
// accepted in spite of such a contact if it did not approach it, and if the surfaces overlapped by at most
// 0.25 mm at the start. Ignores a pose that is not finite. Does not allocate.
GodObjectStep step_god_object(const GodObjectParameters& parameters, GodObjectState& state,
                              const Pose& commanded_tool, ContactFinder finder, double dt);

}  // namespace bolt::proxy
