// Which features of a tool and of the obstacles are near each other: the tool's samples against the
// obstacles' surfaces, the obstacles' samples against the tool's, edges against edges.
//
// Most of it is known from before: every cluster of samples and every sample keeps a lower bound of its
// distance that was proven once and is spent by the motion since, of the tool and of the obstacle; only where
// the bound is spent is asked again. The bounds save work and never change the answer, not by a bit.
#pragma once

#include <vector>

#include "haptics/contact/edge_sighting.hpp"
#include "haptics/contact/reduce.hpp"
#include "haptics/contact/tool.hpp"
#include "haptics/contact/world.hpp"

namespace bolt::contact {

// What is proven of one sample or cluster. Bounds held when they were proven, and stand here plus the
// way and the turn that were made by then: less those made by now, they hold now.
struct Proven {
    // Of points the signed distance; of edge pieces `Crossings::clear`.
    double lower;
    double turn;  // rad, `Crossings::turn`; infinite for points
};

// What was proven when something was looked at last: where its middle was in the surface's frame, the bound
// that held there, and the turn made by then. It has not moved further than its middle has and than its size
// times the turn since.
struct Sighting {
    glm::vec3 at;
    float lower;
    double turned;
    bool met;  // of an edge piece: something of the other's was near
};

struct Bounds {
    // Of all that is in the clusters of each level.
    std::vector<std::vector<Proven>> levels;
    std::vector<std::vector<Sighting>> levels_seen;
    std::vector<Proven> samples;
    std::vector<Sighting> seen;
    std::vector<EdgeSighting> edges;  // by piece
};

// Of the tool and one body.
struct PairBounds {
    bool fresh = true;                 // nothing proven yet
    Pose last;                         // tool to body, when it was looked at last
    double moved = 0.0, turned = 0.0;  // m and rad, the way made
    Bounds of_tool, of_body;
};

struct ProximityState {
    std::vector<PairBounds> pairs;  // in the order of the world's bodies
    // Working space.
    std::vector<Contact> near;
    std::vector<Ranked> order;
    std::vector<Core> kept;
    std::vector<std::uint8_t> kept_in;
    std::vector<Waiting> waiting;
    std::vector<Ranked> waiting_order;
};

// All memory that `find_contacts` needs for this world and tool.
ProximityState make_proximity(const World& world, const ToolShape& tool);

// Everything proven is forgotten: the next answer is the same, and takes longer.
void forget(ProximityState& state, const World& world, const ToolShape& tool);

// Contacts up to `band` (m) between the tool at `pose` and what is on in the world; deeper than the surface
// there is no limit, but for edges against edges (edges.hpp). Their distances are those of the meshes, in
// double (`Contact` holds to 1e-9 m). `Found::clearance` is the band if all were written or merged
// (reduce.hpp), else how far the written ones are all. `Found::work` is less the more was proven before.
Found find_contacts(const World& world, const ToolShape& tool, const Pose& pose, double band,
                    ProximityState& state, std::span<Contact> out);

}  // namespace bolt::contact
