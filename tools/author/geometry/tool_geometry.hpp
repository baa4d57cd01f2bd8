// A tool of an assembly as triangles: the author's model or a generated one. Tool frame: as in
// haptics/collision/tool_head.hpp, so the origin is on the bolt's axis in the middle of the part that grips,
// +X along the handle, +Z along the bolt. The mouth of an open end points along -X, rotated by the head angle
// about Z.
#pragma once

#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "haptics/collision/tool_head.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

struct ToolGeometry {
    std::string name = "the wrench";  // used in messages
    std::vector<Triangle> triangles;  // in the tool frame, metres
    collision::ToolHead head;         // the part that grips
    // rad about +Z, from the handle to that direction of the head in which a corner of the gripped hexagon
    // points. For an open end it points to the throat.
    double head_angle = 0.0;
    double head_size = 0.0;       // m, of an open end: middle of the jaw to the outside of the head
    double half_thickness = 0.0;  // m, of an open end's head
    double reach = 0.0;           // m, largest distance from the axis
    double handle_height = 0.0;   // m above the origin, of the middle of the handle
    double top = 0.0;             // m above the origin, of the upper side of head or handle

    [[nodiscard]] bool is_open_end() const { return std::holds_alternative<collision::Jaw>(head); }
};

// The frame of a tool's model. `found`: determined from the model's flat side, which is normal to Y (as
// import-step writes it) or to Z. `tool`: the tool frame.
enum class ModelFrame : std::uint8_t { found, tool };

// The tool that a model shows. Fails if the measured width of the jaw, hole or key does not agree with the
// design.
Result<ToolGeometry> tool_from_model(const FlattenedModel& scene, const content::WrenchDesign& design,
                                     ModelFrame frame = ModelFrame::found);

// The tool that the trainer generates for a design. If the design names a model, this model is ignored.
Result<ToolGeometry> generated_tool(const content::WrenchDesign& design);

// The tool on a joint with the axis +Y, its handle along +X. `turned_over`: rotated by 180° about the handle.
Bvh place_on_joint(const ToolGeometry& tool, bool turned_over);

}  // namespace bolt::geometry
