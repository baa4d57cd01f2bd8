// Reduces all nearby contacts to the few that constrain the tool.
#pragma once

#include <span>

#include "engine/base/function_ref.hpp"
#include "haptics/collision/contact.hpp"

namespace bolt::collision {

// Two contacts with the same obstacle are merged if their points on the tool are within the merge distance
// and their normals are nearly parallel; the nearer one is kept. The merge distance starts at
// `first_merge_distance` and doubles up to `last_merge_distance` until the kept contacts fit the output. The
// permitted angle grows with the difference of the two distances.
//
// Error bound: in a motion that the kept contacts permit and that moves no point by more than `merge_stride`,
// a merged contact penetrates its obstacle more than the kept one by at most merge_angle × merge_stride plus
// the merge distance times the turn.
inline constexpr double merge_angle = 4.0 * pi / 180.0;  // rad
inline constexpr double merge_stride = 0.5e-3;           // m
inline constexpr double first_merge_distance = 2e-3;     // m
inline constexpr double last_merge_distance = 32e-3;     // m

// Strict total order of contacts: by distance, then by feature, obstacle and normal.
bool nearer(const Contact& a, const Contact& b);

// Bounds of a contact that has not been computed. Most deferred contacts merge with a nearer one, which saves
// their exact query.
struct DeferredContact {
    double lower = 0.0;   // m; lower bound of the distance
    Vec3 on_tool{0.0};    // m; the point on the tool is within `blur` of it
    Vec3 normal{0.0};     // unit; the normal is within `spread` of it
    float blur = 0.0F;    // m
    float spread = 0.0F;  // rad
    ObstacleId obstacle;
    // Set and read by the narrow phase.
    std::uint32_t sample = 0;
    double spent = 0.0;
    std::uint32_t pair = 0;
    bool of_tool = false;
    bool found = false;  // resolved: it has become a contact or is none
};

// Computes a deferred contact. Returns false if there is no contact within the band.
using ResolveDeferred = FunctionRef<bool(const DeferredContact&, Contact&)>;

// Scratch memory of the reduction.
struct RankedContact {
    double distance = 0.0;
    std::uint32_t index = 0;  // of the contact or deferred contact
    std::uint32_t by = 0;     // index of the kept contact that it last merged with; 0xffffffff: none
};
struct KeptContact {
    Vec3 on_tool{0.0}, normal{0.0};
    double distance = 0.0;
    ObstacleId obstacle;
    std::uint32_t index = 0;  // of the contact
};

struct ReductionInput {
    std::span<Contact> near;  // `count` contacts, then free room for resolved ones
    std::size_t count = 0;
    std::span<RankedContact> order;  // these three are as large as `near`
    std::span<KeptContact> kept;
    std::span<std::uint8_t> kept_in;
    std::span<DeferredContact> deferred;
    std::span<RankedContact> deferred_order;  // as large as `deferred`
    double clearance = 0.0;                   // m; no contact nearer than this is missing from the input
};

// Writes the kept contacts, nearest first. The result is the same as if all deferred contacts had been
// resolved beforehand.
ContactQueryResult reduce_contacts(ReductionInput all, ResolveDeferred find, std::span<Contact> out);

}  // namespace bolt::collision
