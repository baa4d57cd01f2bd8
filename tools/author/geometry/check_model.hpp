// Checks of the model files as a whole (the nodes that joints name, systematic errors of units, axes or
// origin, closed surfaces, node names at every level, triangle and byte budgets) and of each joint against
// its model (sizes, contact and overlap of the fasteners and members, room for its tools).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/drawn_tool_room.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/other_tools.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

// Position (m) and unit axis of a joint, in the assembly file and in the model.
struct JointPlacement {
    Vec3 file, file_axis, model, model_axis;
};

inline constexpr double position_tolerance = 0.01e-3;      // m
inline constexpr double axis_tolerance = to_radians(0.1);  // rad

// Returns true if file and model agree within the tolerances.
bool agrees(const JointPlacement& placement);

// One mistake that explains the wrong positions of all joints.
struct SystematicError {
    std::string what;      // "the model is in millimetres"
    std::string expected;  // "metres, as in glTF: scale the model by 0.001"
};

// Returns nullopt if all placements agree, or if no single mistake explains all of them.
std::optional<SystematicError> find_systematic_error(std::span<const JointPlacement> placements);

struct OpenEdges {
    std::size_t count = 0;
    Vec3 first{0.0};  // m, middle of one of them
};

// Counts the triangle edges without a partner in the opposite direction; a closed surface has none. Corners
// with exactly equal coordinates are the same point.
OpenEdges open_edges(std::span<const Triangle> triangles);

// Checks that each joint's node exists once, is rigid and is at the joint's position. Returns the node index
// for every joint; -1 where an error was reported.
std::vector<int> check_nodes(const content::Assembly& assembly, const FlattenedModel& scene,
                             const Messages& messages);

inline constexpr std::size_t near_budget = 250'000, far_budget = 60'000;  // triangles, counting instances
inline constexpr std::uintmax_t file_budget = 8'000'000;                  // bytes

// Report a model file above `file_budget`, and a model with more than `budget` triangles. `pointer`: JSON
// pointer of the model in the assembly file.
void check_file_size(const std::string& path, std::string_view pointer, const Messages& messages);
void check_triangles(const FlattenedModel& scene, std::size_t budget, std::string_view pointer,
                     const Messages& messages);
// Reports node names that only one of the two levels has.
void check_names(const FlattenedModel& near, const FlattenedModel& far, const Messages& messages);
// Reports parts of the contact model that are not closed, or whose names the near model lacks.
void check_contact(const FlattenedModel& contact, const FlattenedModel& near, const Messages& messages);

// An open end: its name for messages, and its opening, m.
struct JawOpening {
    std::string owner;  // empty, or " (the tool "torque_wrench")"
    double opening = 0.0;
};

// The checks of one joint are implemented in check_joint.cpp.
//
// Returns false if the joint has no part that a tool can grip. `index`: of the joint in the file.
// `everything`: all parts, in the assembly's frame. `jaws`: the tools of the joint that are open ends; the
// jaw of each must fit the nut.
bool check_fasteners_and_members(const content::AssemblyJoint& joint, std::size_t index,
                                 const JointParts& parts, const FlattenedModel& scene, const Bvh& everything,
                                 std::span<const JawOpening> jaws, const Messages& messages);

// Checks that each tool can be brought onto the turned part and swings far enough on it. `tools`: of
// tools_of_joint(). `room`: receives what was measured for the first one. `failing`: receives the rooms of
// those that do not fit. Implemented in check_reach.cpp.
void check_tool_room(const JointSurroundings& surroundings, std::size_t joint,
                     const std::vector<std::size_t>& tools, ToolSet& set, const Messages& messages,
                     DrawnToolRoom& room, std::vector<DrawnToolRoom>& failing);

}  // namespace bolt::geometry
