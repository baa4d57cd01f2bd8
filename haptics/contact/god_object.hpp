// The tool as contacts hold it: its pose follows the device's as far as obstacles allow and never goes into
// them. What is felt is the coupling between the two poses (haptics/force/coupling.hpp), so no contact has a
// spring of its own and nothing jumps when one comes or goes.
//
// Ruspini, Kolarov and Khatib, SIGGRAPH 1997 (the proxy); Ortega, Redon and Coquillart, IEEE TVCG 13(3), 2007
// (six degrees of freedom, least constraint). The metric of the constraint is the coupling's stiffness: the
// god-object rests where spring and contacts balance, and the spring's force is the contacts' force.
#pragma once

#include <limits>
#include <optional>

#include "engine/base/function_ref.hpp"
#include "haptics/contact/contact.hpp"
#include "haptics/contact/twist.hpp"
#include "haptics/force/coupling.hpp"

namespace bolt::contact {

// Contacts of the tool at a pose, up to `band` away; see contact.hpp for what an answer promises.
using Finder = FunctionRef<Found(const Pose&, double band, std::span<Contact>)>;

inline constexpr std::size_t most_contacts = 32;  // asked of the finder

// How fast the felt force may change because of what the god-object does (falls off an edge, slips), in a
// millisecond, beyond what the hand's own motion would change with the tool held, or any part of that. A step
// of 7 % is noticed. Pushed out of what moved into it, it is held to `at_most` alone.
struct Quiet {
    double of_present = 0.05;    // of the force that is felt
    double of_greatest = 0.005;  // of the greatest force, when little is felt
    double at_most = 0.08;       // of the greatest force, the hand's own motion included
    // So much of that at once; the rest only on the way that the force has been going: what goes to and fro
    // from tick to tick would be felt as trembling.
    double at_once = 0.3;
};

struct GodObjectParameters {
    force::Coupling coupling;
    Quiet quiet;
    double radius = 0.3;        // m: no point of the tool is farther from its origin
    std::optional<Extent> box;  // in the tool's frame, and none is outside of it either
    double friction = 0.15;     // coefficient
    // m kept between tool and obstacles. What the finder sees too late, for it lies between its points, is up
    // to 0.19 mm nearer (bolt-truth, on the ZQ350): so the tool is never deeper in anything than 0.1 mm.
    double skin = 110e-6;
    double stride = 0.4e-3;  // m that a point may move between two queries where nothing certifies more
    double reach = 5e-3;     // m, the widest band asked for
    double recovery = 0.25;  // m/s, at which it is pushed out when an obstacle moves into it
    // Of the finder, a tick, and what they may have cost (Found::work, without the first where the tick
    // before ended) for there to be another one once the god-object has moved. When they are spent it stays
    // behind, and goes on in the next tick.
    int queries = 5;
    std::uint32_t work = 800;
};

struct GodObjectState {
    Pose tool;
    // Of the last tick.
    Pose device;
    force::Offset offset;
    force::OutputCommand felt;
    force::OutputCommand event;  // what of its change was not the hand's own
    // m: the nearest of what was found about it; infinite where that was nothing.
    double free = std::numeric_limits<double>::infinity();
    // Where contacts, if any, let it go, first of all; the next tick's will not differ much.
    Twist let_go;
};

// What a step did.
struct GodObjectStep {
    double nearest = 0.0;      // m, least distance found at the pose that was last looked at; a lower bound
    std::size_t contacts = 0;  // within the band, there
    int queries = 0;
    std::uint32_t work = 0;  // of the finder
    int solves = 0;
    bool spent = false;    // the queries were not enough to get where the contacts allow
    bool settled = false;  // held back so that the force does not leap
};

// The tool must be free where it starts.
GodObjectState start_god_object(const Pose& pose);

// One tick of dt. A motion is only carried out if the finder certified it beforehand (no point of the tool
// travels farther than the nearest obstacle) or, at strides of at most `stride`, finds after it nothing too
// near that the motion came nearer to: what a finder sees late, up to 0.25 mm, was as near before. A pose
// that is not finite is ignored: the god-object keeps everything as it is. No allocation.
GodObjectStep step_god_object(const GodObjectParameters& parameters, GodObjectState& state,
                              const Pose& device, Finder finder, double dt);

}  // namespace bolt::contact
