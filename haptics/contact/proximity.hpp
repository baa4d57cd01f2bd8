// Which features of a tool and of the obstacles are near each other: the tool's samples against the
// obstacles' surfaces, the obstacles' samples against the tool's, edges against edges.
//
// Most of it is known from before: every cluster of samples and every sample keeps a lower bound of its
// distance that was proven once and is spent by the motion since, of the tool and of the obstacle; only where
// the bound is spent is asked again. The bounds save work and never change the answer, not by a bit.
#pragma once

#include <vector>

#include "haptics/contact/contact.hpp"
#include "haptics/contact/tool.hpp"
#include "haptics/contact/world.hpp"

namespace bolt::contact {

// What is proven of one sample. Lower bounds held when they were proven, and stand here plus the way that the
// sample had made by then: less the way made by now, they hold now. The upper bound stands less the way made
// by then.
struct SampleBounds {
    double point, edge;  // signed distance of its point to the surface; distance of its edge to convex edges
    double upper;        // of the point's unsigned distance
};

struct Bounds {
    std::vector<double> groups, clusters;  // lower bounds of all that is in them
    std::vector<SampleBounds> samples;
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
    std::vector<Contact> near;      // working space
};

// All memory that `find_contacts` needs for this world and tool.
ProximityState make_proximity(const World& world, const ToolShape& tool);

// Everything proven is forgotten: the next answer is the same, and takes longer.
void forget(ProximityState& state, const World& world, const ToolShape& tool);

// Contacts up to `band` (m) between the tool at `pose` and what is on in the world; deeper than the surface
// there is no limit. Their distances are those of the meshes, in double (`Contact` holds to 1e-9 m).
// `Found::clearance` is the band if all were written or merged (reduce.hpp), else how far the written ones
// are all.
Found find_contacts(const World& world, const ToolShape& tool, const Pose& pose, double band,
                    ProximityState& state, std::span<Contact> out);

}  // namespace bolt::contact
