// The room for a tool on each joint of an assembly: check_geometry() measures it, pictures and preview draw
// it.
#pragma once

#include <set>
#include <vector>

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/free_swing.hpp"
#include "tools/author/geometry/scene.hpp"
#include "tools/author/geometry/tool_geometry.hpp"

namespace bolt::geometry {

// One joint, tightened, with its own tool or the default one. Heights and angles are in the joint's frame; an
// angle about +Y runs from +X.
struct DrawnToolRoom {
    std::size_t joint = 0;  // index into Assembly::joints
    glm::dmat4 to_assembly{1.0};
    Aabb turned;                    // the nut or head that is turned; empty if the model has none
    std::set<std::uint32_t> parts;  // the joint's fasteners, as indices into FlattenedModel::parts
    std::size_t tool = 0;           // index into Assembly::tools and DrawnToolRooms::tools
    bool gripped = false;      // the joint has a part that the tool grips; the following are set only then
    FreeSwing swing;           // of the tool; of an open end: of the orientation with more room
    bool turned_over = false;  // in that orientation the open end is turned over
    double handle = 0.0;       // rad, the middle of the widest free arc; 0 without an arc
    double height = 0.0;       // m, of the tool's origin
    double turn = 0.0;         // rad by which the hexagon has to turn to fit the head at `handle`
    std::uint32_t obstruction = no_part;  // a part in the path of the tool onto the joint
};

struct DrawnToolRooms {
    FlattenedModel scene;
    Bvh everything;                     // all parts, in the assembly's frame
    std::vector<ToolGeometry> tools;    // in the order of the assembly
    std::vector<DrawnToolRoom> joints;  // those whose node the model has
    // The room for each tool that cannot do its work on a joint: too little swing, or no path onto it.
    std::vector<DrawnToolRoom> failing;
};

}  // namespace bolt::geometry
