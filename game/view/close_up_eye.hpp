// An eye on the head of the wrench, or beside the fingers: near enough to see how the jaw lies on the nut.
#pragma once

#include "game/view/view_search.hpp"

namespace bolt::view {

// m, in the frame of the tool at work (`of.wrench`, or `fingers` where there is none): from over the handle
// if nut and jaw are well seen from there, through `swing` (rad about the bolt, signed) of the wrench; else
// from where they are, as near to the handle as may be; else from where most is seen. Fingers come along x,
// so their eye looks from the other side.
struct CloseUpEye {
    Vec3 at{0.0};
    double seen = 0.0;  // 0 … 1, the least in the swing
};
CloseUpEye close_up_eye(const ViewOf& of, const Pose& tool, double swing, motion::Sight& sight);

// How far off it is, of the nut's width, and its field of view, rad.
inline constexpr double close_up_distance = 4.5, close_up_fov = to_radians(42.0);

}  // namespace bolt::view
