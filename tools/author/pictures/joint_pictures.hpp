// Pictures of the joints of an assembly with the room for its tool.
#pragma once

#include <filesystem>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "engine/gpu/vk.hpp"
#include "tools/author/geometry/drawn_tool_room.hpp"

namespace bolt::author {

inline constexpr VkExtent2D joint_picture_size{800, 600};

// Draws FOLDER/JOINT.png for each joint in `rooms` (of check_geometry): the part that is turned, its tool on
// it in the middle of its widest free swing, the free directions in green and the blocked ones in red. Prints
// a line for each picture, with the parts that block the wrench.
Status draw_joint_pictures(const content::Assembly& assembly, const geometry::DrawnToolRooms& rooms,
                           const std::filesystem::path& folder);

}  // namespace bolt::author
