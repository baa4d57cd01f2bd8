// A contact between the tool and an obstacle, the result of a contact query, and the reduction of all nearby
// contacts to the few that constrain the tool.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/base/function_ref.hpp"
#include "engine/base/math.hpp"

namespace bolt::collision {

enum class ObstacleKind : std::uint8_t { none, fixed, nut };

// Names one obstacle of a world: a kind in the two upper bits of a word and an index below 2^30 in the rest.
// Ordered by kind, then by index. A default-constructed id is `none`.
class ObstacleId {
  public:
    constexpr ObstacleId() = default;

    // The part with this index among the parts that never move.
    static constexpr ObstacleId fixed(std::size_t index) { return {ObstacleKind::fixed, index}; }
    // The nut of the joint with this index.
    static constexpr ObstacleId nut(std::size_t joint) { return {ObstacleKind::nut, joint}; }

    [[nodiscard]] constexpr ObstacleKind kind() const {
        return static_cast<ObstacleKind>(word_ >> index_bits);
    }
    [[nodiscard]] constexpr std::uint32_t index() const { return word_ & index_mask; }
    [[nodiscard]] constexpr bool is_none() const { return word_ == 0; }
    [[nodiscard]] constexpr bool is_fixed() const { return kind() == ObstacleKind::fixed; }
    [[nodiscard]] constexpr bool is_nut() const { return kind() == ObstacleKind::nut; }

    friend constexpr auto operator<=>(const ObstacleId&, const ObstacleId&) = default;

  private:
    static constexpr unsigned index_bits = 30;
    static constexpr std::uint32_t index_mask = (1U << index_bits) - 1U;

    constexpr ObstacleId(ObstacleKind kind, std::size_t index)
        : word_(static_cast<std::uint32_t>(kind) << index_bits |
                (static_cast<std::uint32_t>(index) & index_mask)) {}

    std::uint32_t word_ = 0;
};

// The closest features of tool and obstacle, in the assembly's frame:
// on_obstacle + distance × normal = on_tool, to the tolerance that the query states.
struct Contact {
    Vec3 on_tool{0.0};      // m
    Vec3 on_obstacle{0.0};  // m
    Vec3 normal{0.0};       // unit, from the obstacle to the free side
    double distance = 0.0;  // m, signed; negative: penetration
    ObstacleId obstacle;
    // Index of a feature of the tool or, if the bit `of_obstacle` is set, of a feature of the obstacle. A
    // feature keeps its index while tool and obstacle move.
    std::uint32_t feature = 0;
    // Contacts with meshes only: a triangle that contains the closest point. If `feature` is of the tool, the
    // triangle is of the obstacle, and vice versa.
    std::uint32_t triangle = 0;
    // Unit: the normal of the smooth surface that the facets approximate (narrow_phase.hpp). Zero: none;
    // use `normal`.
    Vec3 smooth{0.0};
};

inline constexpr std::uint32_t of_obstacle = 0x80000000U;  // in `Contact::feature`

struct ContactQueryResult {
    std::size_t count = 0;         // contacts written
    double complete_within = 0.0;  // m; every nearer contact was written, or merged with a written one
    bool truncated = false;        // the output was too small; the nearest contacts were kept
    std::uint32_t query_cost = 0;  // in comparisons of a sample with a surface, approximate
};

// Two contacts with the same obstacle are merged if their points on the tool are within the merge distance
// and their normals are nearly parallel; the nearer one is kept. The merge distance starts at
// `first_merge_distance` and doubles up to `last_merge_distance` until the kept contacts fit the output. The
// normals of equally distant contacts may differ by `merge_angle`. A contact that is further away than the
// kept one by d may differ by more, because the motion must first close d: by d / merge_stride (rad) more.
//
// The error is bounded. In a motion that the kept contacts permit, and that moves no point by more than
// `merge_stride`, a merged contact penetrates at most this much deeper than the kept one: merge_angle ×
// merge_stride, plus the merge distance times the rotation (rad) of the motion.
inline constexpr double merge_angle = 4.0 * pi / 180.0;  // rad
inline constexpr double merge_stride = 0.5e-3;           // m
inline constexpr double first_merge_distance = 2e-3;     // m
inline constexpr double last_merge_distance = 32e-3;     // m

// Strict total order of contacts: by distance, then by feature, obstacle and normal.
bool nearer(const Contact& a, const Contact& b);

// Bounds of a contact that has not been computed. Most deferred contacts merge with a nearer one, which saves
// their exact query.
struct DeferredContact {
    double lower = 0.0;           // m; lower bound of the distance
    Vec3 on_tool{0.0};            // m; the exact point on the tool is within `position_error` of this one
    Vec3 normal{0.0};             // unit; the exact normal is within `spread` of this one
    float position_error = 0.0F;  // m
    float spread = 0.0F;          // rad
    ObstacleId obstacle;
    // Set and read by the narrow phase.
    std::uint32_t sample = 0;  // index of the sample
    double accumulated = 0.0;  // m, accumulated motion of the sample by then, for its DistanceBound
    std::uint32_t body = 0;    // index in `CollisionWorld::bodies`
    bool of_tool = false;      // the sample is the tool's
    bool resolved = false;     // the exact query has been done, with or without a contact as its result
};

// Collects contacts in a buffer of fixed size; when it is full, a nearer contact replaces the furthest.
struct ContactCollector {
    std::span<Contact> buffer;
    std::size_t count = 0;
    double complete_within;  // m; all contacts nearer than this are in the buffer or deferred
    std::span<DeferredContact> deferred;
    std::size_t deferred_count = 0;
    std::uint32_t query_cost = 0;

    // Returns false if there is no room; the caller must then compute the contact and call add().
    bool defer(const DeferredContact& one) {
        if (deferred_count == deferred.size()) return false;
        deferred[deferred_count++] = one;
        return true;
    }

    void add(const Contact& contact) {
        if (count < buffer.size()) {
            buffer[count++] = contact;
            if (count == buffer.size()) std::make_heap(buffer.begin(), buffer.end(), nearer);
            return;
        }
        if (nearer(contact, buffer.front())) {
            complete_within = std::min(complete_within, buffer.front().distance);
            std::pop_heap(buffer.begin(), buffer.end(), nearer);
            buffer.back() = contact;
            std::push_heap(buffer.begin(), buffer.end(), nearer);
        } else {
            complete_within = std::min(complete_within, contact.distance);
        }
    }
};

// Computes a deferred contact. Returns false if it is further away than the band of the query.
using ResolveDeferred = FunctionRef<bool(const DeferredContact&, Contact&)>;

// Scratch memory of the reduction.
struct RankedContact {
    double distance = 0.0;
    std::uint32_t index = 0;        // of the contact or deferred contact
    std::uint32_t merged_with = 0;  // index of the kept contact that it last merged with; 0xffffffff: none
};
struct KeptContact {
    Vec3 on_tool{0.0}, normal{0.0};
    double distance = 0.0;
    ObstacleId obstacle;
    std::uint32_t index = 0;  // of the contact
};

// reduce_contacts() selects contacts in iterations, each with a larger merge distance than the last.
struct ReductionInput {
    std::span<Contact> found;  // `count` contacts, then space for resolved ones
    std::size_t count = 0;
    // These three are as large as `found`.
    std::span<RankedContact> order;
    std::span<KeptContact> kept;
    std::span<std::uint8_t> kept_in;  // for each contact: the last iteration that kept it, from 1; 0: none
    std::span<DeferredContact> deferred;
    std::span<RankedContact> deferred_order;  // as large as `deferred`
    double complete_within = 0.0;             // m; no contact nearer than this is missing from the input
};

// Writes the kept contacts, nearest first. The result is the same as if all deferred contacts had been
// resolved beforehand.
ContactQueryResult reduce_contacts(ReductionInput all, ResolveDeferred resolve, std::span<Contact> out);

}  // namespace bolt::collision
