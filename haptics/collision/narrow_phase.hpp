// The narrow phase: contacts between the tool and all bodies of a world. Three kinds of pairs are compared:
// samples of the tool against surfaces of bodies, samples of bodies against the tool's surface, edges of the
// tool against edges of bodies.
//
// Every sample and every cluster of samples stores the lower bound of its distance that its last query found.
// The relative motion since that query is subtracted; the surface is queried again only where the remaining
// bound is within the band. The bounds save work and never change the result: with an empty cache every bit
// is the same.
#pragma once

#include <vector>

#include "haptics/collision/contact.hpp"
#include "haptics/collision/edges.hpp"
#include "haptics/collision/world.hpp"

namespace bolt::collision {

// Bounds are stored so that a motion need not be subtracted from each of them. `lower` stores the bound plus
// the accumulated displacement of the sample or cluster when the bound was computed (PairCache::moved +
// PairCache::turned × distance from the tool's origin), and `turn` the bound plus PairCache::turned. What is
// stored less the present accumulated motion is the bound that holds now. All bounds are conservative.
struct DistanceBound {
    // m. The bound of a point is its signed distance. The bound of a piece of an edge is how far it may move
    // before another edge can come near (EdgeQueryResult::clear_distance).
    double lower;
    double turn;  // rad, accumulated turn up to which `lower` holds; infinite for points
};

// The last query of a sample or cluster. When its DistanceBound has run out, a tighter test follows: no point
// of the cluster has moved more than the motion of its middle, plus its radius times the turn since the
// query.
struct CachedQuery {
    glm::vec3 at;   // m, of the middle
    float lower;    // m
    double turned;  // rad
    // True for a piece of an edge if another edge was within 2 mm (short_lookahead); the next search then
    // looks less far ahead.
    bool edge_near;
};

// The cache of one solid's samples against the other's surface.
struct SurfaceQueryCache {
    std::vector<std::vector<DistanceBound>> levels;       // by level and cluster; valid for all samples in it
    std::vector<std::vector<CachedQuery>> level_queries;  // by level and cluster
    std::vector<DistanceBound> samples;                   // by sample
    std::vector<CachedQuery> sample_queries;              // by sample
    std::vector<EdgeCache> edges;                         // by piece
};

// The cache of the tool and one body.
struct PairCache {
    bool empty = true;                 // no query yet
    Pose last;                         // tool to body, at the last query
    double moved = 0.0, turned = 0.0;  // m and rad, accumulated relative motion
    SurfaceQueryCache of_tool, of_body;
};

struct NarrowPhaseState {
    std::vector<PairCache> pairs;  // in the order of the world's bodies
    // Scratch memory of a query.
    std::vector<Contact> near;
    std::vector<RankedContact> order;
    std::vector<KeptContact> kept;
    std::vector<std::uint8_t> kept_in;
    std::vector<DeferredContact> deferred;
    std::vector<RankedContact> deferred_order;
};

// Allocates everything that `find_contacts` needs for this world and tool.
NarrowPhaseState make_narrow_phase(const CollisionWorld& world, const ToolShape& tool);

// Discards all cached bounds. The next result is the same, at a higher cost.
void clear_cache(NarrowPhaseState& state, const CollisionWorld& world, const ToolShape& tool);

// Writes the contacts up to `band` (m) between the tool at `pose` and the enabled bodies of the world.
// Penetration of any depth is found. Contacts of two edges are reported up to a depth of 2 mm; beyond that,
// samples of the surfaces lie inside and report it (edges.hpp). Distances are those of the meshes,
// computed in double, with an error below 1e-9 m. `complete_within` is the band if all contacts were written
// or merged (contact.hpp), otherwise the distance up to which they are complete. `query_cost` depends on the
// cache. Does not allocate.
ContactQueryResult find_contacts(const CollisionWorld& world, const ToolShape& tool, const Pose& pose,
                                 double band, NarrowPhaseState& state, std::span<Contact> out);

// Smooth contact normals on facetted meshes (smooth_normals.cpp). A bar or rounded edge is modelled by
// facets, and a hand that slides along it must not feel them. Near the surface the normal is interpolated
// between facets as shading does (force shading: Morgenbesser and Srinivasan, ASME DSC-58, 1996; Ruspini,
// Kolarov and Khatib, SIGGRAPH 1997). Distances stay those of the facets, so smoothing permits no additional
// penetration.

// m. The full correction applies up to `smooth_near`, which exceeds GodObjectParameters::skin, and fades to
// none at `smooth_far`, because contacts further away bear no force.
inline constexpr double smooth_near = 0.16e-3, smooth_far = 0.36e-3;
// rad, greatest angle between the smooth normal and the facets' normal.
inline constexpr double max_smoothing_angle = 20.0 * pi / 180.0;

// Sets `Contact::smooth` of contacts that `find_contacts` wrote for this world, tool and pose. A crease is an
// edge too sharp to lie between two facets of one round surface; a blunter edge counts as part of its face.
// In a contact of a face with a crease, the normal of the face without its component along the crease is
// used. In a contact of two smooth surfaces both normals are averaged, and the flatter surface has the
// greater weight. In a contact of two creases `smooth` stays zero.
void smooth_normals(const CollisionWorld& world, const ToolShape& tool, const Pose& pose,
                    std::span<Contact> contacts);

}  // namespace bolt::collision
