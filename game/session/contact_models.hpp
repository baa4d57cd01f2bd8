// Loads the contact models of an assembly and its wrench for the servo, and measures how well each named view
// shows a nut.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "game/session/session_file.hpp"
#include "haptics/collision/world.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::session {

// The pose of a nut's model on its joint.
struct HexagonPose {
    Quat straighten{1.0, 0.0, 0.0, 0.0};  // rotation about the bolt that puts a corner on e1
    double low = 0.0;                     // m, height of the bearing face above the seat
};

// Finds the six corners of the hexagon among the points of the mesh:
//   nut, hexagon head   the points furthest from the axis
//   socket head         the points above the bearing face, at the distance of the socket's corners from the
//                       axis. A head that is drawn without its socket is not rotated
// The bearing face of a nut is at its lowest points, that of a head at the seat. `points`: in the assembly's
// frame.
HexagonPose find_hexagon(const servo::NutGeometry& nut, std::span<const glm::dvec3> points);

// Transforms from the assembly's frame to the nut's own; servo::nut_pose transforms back.
inline Vec3 to_nut_frame(const servo::NutGeometry& nut, const HexagonPose& hexagon, const Vec3& p) {
    const Vec3 d = p - nut.seat;
    const Vec3 local(glm::dot(d, nut.e1), glm::dot(d, nut.e2), glm::dot(d, nut.axis));
    return hexagon.straighten * (local - Vec3(0, 0, hexagon.low));
}

// The contact models of a lesson's obstacles and tools, and their description in the session file.
struct ContactModels {
    servo::ToolContact tool_contact;
    std::vector<ObstacleName> names;  // node names, by obstacle id
    std::string files;                // files and generated tools, each with size and checksum (FNV-1a)
};

// Returns an error if the assembly file names no contact model. A tool without a model is no error: its model
// is generated (game/tool_models).
std::optional<Error> missing_contact_model(const content::Assembly& assembly);

// None if the contact model is missing (missing_contact_model). A joint's turned part is the node for which
// content::is_turned_node() is true; all other nodes are fixed. A tool is `NAME.contact.glb` beside its
// `NAME.glb` if that file exists, else `NAME.glb`; without a file it is generated. Fails, and names the file,
// if a model cannot be read, has no triangles, has more parts than a session can number, or has an open
// surface where a closed one is required.
Result<std::optional<ContactModels>> load_contact_models(const content::Assembly& assembly,
                                                         const servo::Setup& setup);

// Rotation from the frame of a wrench's model to the tool's frame. Fails, and names the file, if the model
// cannot be used (load_contact_models()).
Result<Quat> wrench_rotation(const content::WrenchDesign& design);

// ContactModels::tool_contact of load_contact_models().
Result<std::optional<servo::ToolContact>> load_tool_contact(const content::Assembly& assembly,
                                                            const servo::Setup& setup);

// The assembly's wrench alone, in the tool's frame. Fails, and names the file, if its model cannot be used
// (load_contact_models()).
Result<collision::ToolShape> load_wrench(const content::Assembly& assembly);

// Moves all nuts onto their seats.
void seat_nuts(const servo::Setup& setup, servo::ToolContact& contact);

// The visibility of a joint's nut in a named view of its assembly.
struct NutView {
    double share = 0.0;  // visible fraction of the nut, 0…1
    double size = 0.0;   // visible area, relative to a square of the picture's height
    bool framed = true;  // the nut's centre is inside a picture of 4:3 or wider
};

// One entry for each view of the assembly, in its order, for the present poses of all bodies. Empty if the
// joint's nut has no contact model.
std::vector<NutView> nut_views(const content::Assembly& assembly, const servo::ToolContact& contact,
                               std::size_t joint);

// Index of the view with the largest NutView::size of those that frame the nut; none if none shows it.
std::optional<std::size_t> best_view(std::span<const NutView> views);

}  // namespace bolt::session
