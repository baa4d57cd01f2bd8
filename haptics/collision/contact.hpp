// A contact between the tool and an obstacle, and the result of a contact query.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/base/pose.hpp"

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
    // Index of the feature of the tool or, with the bit `of_obstacle`, of the obstacle. Constant while both
    // move.
    std::uint32_t feature = 0;
    // Contacts with meshes: a triangle under the closest point, of the body that `feature` does not belong
    // to.
    std::uint32_t triangle = 0;
    // Unit: the normal of the smooth surface that the facets approximate (smooth_normals.hpp). Zero: none;
    // use `normal`.
    Vec3 smooth{0.0};
};

inline constexpr std::uint32_t of_obstacle = 0x80000000U;  // in `Contact::feature`

struct ContactQueryResult {
    std::size_t count = 0;   // contacts written
    double clearance = 0.0;  // m; lower bound of the distance of everything that was not written
    bool truncated = false;  // the output was too small; the nearest contacts were kept
    std::uint32_t work = 0;  // cost of the query in comparisons of a sample with a surface, approximate
};

}  // namespace bolt::collision
