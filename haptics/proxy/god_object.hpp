// The god-object algorithm, which moves the constrained tool: the pose of the tool under contact constraints.
// It follows the commanded tool as far as obstacles permit and does not penetrate them. The hand feels the
// coupling between the two poses (haptics/proxy/coupling.hpp); contacts have no springs of their own, so a
// contact that appears or disappears causes no step in the force.
//
// Ruspini, Kolarov and Khatib, SIGGRAPH 1997 (the proxy); Ortega, Redon and Coquillart, IEEE TVCG 13(3), 2007
// (six degrees of freedom, least constraint). The metric of the constraint is the coupling's stiffness: the
// constrained tool rests where spring and contacts balance, and the spring's force is the contacts' force.
#pragma once

#include <limits>
#include <optional>

#include "engine/base/function_ref.hpp"
#include "haptics/collision/contact.hpp"
#include "haptics/proxy/constraint_solver.hpp"
#include "haptics/proxy/coupling.hpp"

namespace bolt::proxy {

// Writes the contacts of the tool at a pose up to `band` (m); the result is as contact.hpp states.
using ContactFinder =
    FunctionRef<collision::ContactQueryResult(const Pose&, double band, std::span<collision::Contact>)>;

inline constexpr std::size_t max_contacts = 32;  // capacity of the finder's output

// Limits on the change of the rendered force in a millisecond. The change has two parts:
//
//   by the hand   the change that the hand's motion causes if the constrained tool stands still
//   by the tool   the rest: the constrained tool itself moves, because it slips or falls off an edge
//
// The part by the tool is limited to the greater of `of_rendered` and `of_maximum`. Both parts together are
// limited to `maximum`. People notice a step of 7 %. While the tool is pushed out of an obstacle that moved
// into it, only `maximum` applies. The same limits hold for the torque, with the rendered and the greatest
// torque.
struct ForceRateLimits {
    double of_rendered = 0.05;  // share of the rendered force
    double of_maximum = 0.005;  // share of the greatest force; the greater of the two if little is rendered
    double maximum = 0.08;      // share of the greatest force
    // Share of the limit by the tool that is permitted in any direction. The rest is permitted only along the
    // tool's part of the last tick: a change that alternates from tick to tick would be felt as trembling.
    double any_direction_share = 0.3;
};

struct GodObjectParameters {
    proxy::Coupling coupling;
    ForceRateLimits rate_limits;
    double radius = 0.3;                // m; bounds the distance of the tool's points from its origin
    std::optional<collision::Box> box;  // bounds the tool as well, in its own frame
    double friction_coefficient = 0.15;
    // m, kept between tool and obstacles. Features between the finder's samples are detected up to 0.19 mm
    // late as measured (bolt-contact-validation, on the ZQ350), so the penetration stays below 0.1 mm.
    double skin = 110e-6;
    // m, how far a point of the tool may move until the next query. It may move further only if the last
    // query found no obstacle within that distance.
    double stride = 0.4e-3;
    double reach = 5e-3;     // m, widest band of a query
    double recovery = 0.25;  // m/s, at which the tool is pushed out of an obstacle that moved into it
    // Budget per tick: the number of queries, and their work (ContactQueryResult::work). The work of the
    // first query, at the pose of the last tick, is charged only if its band is wider than a stride, and
    // `work` limits only queries after the tick's first motion. Once the budget is spent, the tool moves only
    // as far as earlier queries proved free, and continues in the next tick.
    int queries = 5;
    std::uint32_t work = 800;
};

struct GodObjectState {
    Pose constrained_tool;  // in the assembly's frame
    // Values of the last tick.
    Pose commanded_tool;
    proxy::Offset offset;
    force::OutputCommand felt;        // N and N·m, rendered by the coupling
    force::OutputCommand own_change;  // part of its change that the hand's motion did not cause
    // m, nearest contact; infinite without contacts.
    double nearest_contact = std::numeric_limits<double>::infinity();
    Twist first_motion;  // first constrained motion of the tick; warm-starts the next solve
};

// Result of a step.
struct GodObjectStep {
    double nearest = 0.0;      // m; lower bound of the distance at the pose of the last query
    std::size_t contacts = 0;  // within the band at that pose
    int queries = 0;
    std::uint32_t work = 0;  // cost of the queries
    int solves = 0;
    bool budget_exhausted = false;  // the query budget ended before the tool reached its constrained pose
    bool rate_limited = false;      // the motion was shortened to limit the change of force
};

// The tool must not penetrate anything at `pose`.
GodObjectState start_god_object(const Pose& pose);

// Advances by one tick of `dt` (s). A motion is accepted in one of two cases. Either no point of the tool
// travels further than the distance to the nearest obstacle, less the skin. Or no point travels further than
// `stride`, and a query at the end of the motion finds no contact below a fifth of the skin to which the
// motion brought the tool closer. A finder may detect features up to 0.25 mm late. Ignores a pose that is not
// finite. Does not allocate.
GodObjectStep step_god_object(const GodObjectParameters& parameters, GodObjectState& state,
                              const Pose& commanded_tool, ContactFinder finder, double dt);

}  // namespace bolt::proxy
