// One slip behind many wrong positions: wrong units, axes that are exchanged, another origin.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

// A joint as the file and as the model have it, metres.
struct Placement {
    Vec3 file, file_axis, model, model_axis;
};

inline constexpr double position_tolerance = 0.01e-3;      // m
inline constexpr double axis_tolerance = to_radians(0.1);  // rad

bool agrees(const Placement& placement);

struct Slip {
    std::string what;      // "the model is in millimetres"
    std::string expected;  // what to do
};

// The slip that explains all of them; none if they agree, or if no single slip does.
std::optional<Slip> common_slip(std::span<const Placement> placements);

// Whether a part's surface is closed.

struct OpenEdges {
    std::size_t count = 0;
    Vec3 first{0.0};  // the middle of one of them
};

// Edges that no triangle runs through the other way. Corners are the same where their coordinates are exactly
// equal.
OpenEdges open_edges(std::span<const Triangle> triangles);

// Each joint's node: there, alone, in its place.

// For every joint the scene's node that shows it; -1 where that is not so, which has been said then.
std::vector<int> check_nodes(const content::Assembly& assembly, const Scene& scene, const Messages& messages);

// The files themselves: budgets, the same names at every level, a contact model that is closed.

inline constexpr std::size_t near_budget = 250'000, far_budget = 60'000;  // triangles, counting instances
inline constexpr std::uintmax_t file_budget = 8'000'000;                  // bytes

void check_file_size(const std::string& path, std::string_view pointer, const Messages& messages);
void check_triangles(const Scene& scene, std::size_t budget, std::string_view pointer,
                     const Messages& messages);
void check_names(const Scene& near, const Scene& far, const Messages& messages);
void check_contact(const Scene& contact, const Scene& near, const Messages& messages);

}  // namespace bolt::geometry
