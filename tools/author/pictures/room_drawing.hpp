// Draws the room for the tool of a joint into a scene: free and blocked directions, the tool, and the names
// of the parts that block it.
#pragma once

#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "engine/render/scene.hpp"
#include "game/view/camera.hpp"
#include "tools/author/geometry/drawn_tool_room.hpp"
#include "tools/author/pictures/swing_fan.hpp"

namespace bolt::author {

inline constexpr glm::vec4 free_color{0.1F, 0.8F, 0.25F, 1.0F}, blocked_color{0.95F, 0.1F, 0.1F, 1.0F};

// The ring in which the directions of a tool are drawn.
FanRing ring_of(const geometry::DrawnToolRooms& rooms, const geometry::DrawnToolRoom& room);

// Adds the directions: the free ones in green and the blocked ones in red. `fan`: of make_swing_fan().
void add_fan(render::Scene& scene, const assets::Model& fan, const render::GpuModel& gpu_fan,
             const geometry::DrawnToolRoom& room);

// The pose of the tool's frame in the assembly's frame: on the turned part. `handle`: angle of the handle,
// rad.
glm::dmat4 tool_pose(const geometry::DrawnToolRoom& room, double handle);

struct DrawnTool {
    assets::Model model;
    glm::dmat4 from_model{1.0};  // to the tool's frame
};

Result<DrawnTool> load_drawn_tool(const content::WrenchDesign& design);

// A part that blocks the wrench: how much of the revolution, and where its widest range is.
struct Blocker {
    std::string name;
    double total = 0.0, widest = 0.0, middle = 0.0;  // rad
};

// Sorted by `total`, the largest first.
std::vector<Blocker> blockers_of(const geometry::DrawnToolRooms& rooms, const geometry::DrawnToolRoom& room);

// "40.0 degrees of free swing; blocked by "casing" (320 degrees)". `tool`: name of the tool, if the joint has
// another one than the default.
std::string describe_room(const geometry::DrawnToolRoom& room, const std::vector<Blocker>& blockers,
                          const std::string& tool);

// Adds the width of the widest free arc, and the names of the parts that block the most.
void add_room_labels(render::Scene& scene, const geometry::DrawnToolRooms& rooms,
                     const geometry::DrawnToolRoom& room, const std::vector<Blocker>& blockers);

// The nearest view that shows the tool and its directions, from the side of the turned part from which the
// most of them can be seen.
view::Orbit joint_view(const geometry::DrawnToolRooms& rooms, const geometry::DrawnToolRoom& room,
                       double aspect);

}  // namespace bolt::author
