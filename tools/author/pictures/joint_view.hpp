// The camera of a picture of one joint.
#pragma once

#include <vector>

#include "game/view/camera.hpp"
#include "tools/author/geometry/wrench_room.hpp"

namespace bolt::author {

// Points that a picture should show, m, in the assembly's frame.
struct PictureContents {
    std::vector<Vec3> visible;  // parts in front of these make a view worse
    std::vector<Vec3> framed;   // all are in the picture
};

// The nearest view from which all of `framed` is in the picture, from the side of the turned part from which
// the most of `visible` can be seen.
view::Orbit joint_view(const geometry::WrenchRooms& rooms, const geometry::WrenchRoom& room,
                       const PictureContents& contents, double aspect);

}  // namespace bolt::author
