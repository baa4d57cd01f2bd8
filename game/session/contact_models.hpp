// The pose of a nut's model on its joint: the direction of its hexagon and the height of its bearing face.
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

struct HexagonLie {
    Quat straighten{1.0, 0.0, 0.0, 0.0};  // about the bolt; puts a corner on e1
    double low = 0.0;                     // m, bearing face along the bolt, from the seat
};

// Finds the six corners as the outermost points of the mesh. `points`: in the assembly's frame.
HexagonLie lie_of(const servo::NutGeometry& nut, std::span<const glm::dvec3> points);

// From the assembly's frame to the nut's own; servo::nut_pose maps back to where the nut is.
inline Vec3 to_own_frame(const servo::NutGeometry& nut, const HexagonLie& lie, const Vec3& p) {
    const Vec3 d = p - nut.seat;
    const Vec3 local(glm::dot(d, nut.e1), glm::dot(d, nut.e2), glm::dot(d, nut.axis));
    return lie.straighten * (local - Vec3(0, 0, lie.low));
}

// Loads the contact models of an assembly and its wrench for the servo.

// What the wrench of a lesson collides with, and how the session file describes it.
struct TouchModels {
    servo::ToolContact tool_contact;
    std::vector<session::ObstacleName> names;  // node names, as ToolContact::touched numbers them
    std::string files;                         // each with its size and checksum (FNV-1a, 64 bits)
};

// The contact model that the assembly file does not name, with its place there; none if it names both.
std::optional<Error> missing_contact_model(const content::Assembly& assembly);

// None if a model is missing (missing_contact_model). A joint's nut is the node `ID_nut` under
// the joint's node; all other nodes stand still. The wrench is `NAME.contact.glb` beside its `NAME.glb` where
// there is one. Errors name the file: it cannot be read, has no triangles, or has a surface that is not
// closed where it must be.
Result<std::optional<TouchModels>> load_touch_models(const content::Assembly& assembly,
                                                     const servo::Setup& setup);

// From the frame of a wrench's model to the tool's. Errors as above.
Result<Quat> wrench_turn(const content::WrenchDesign& design);

Result<std::optional<servo::ToolContact>> load_tool_contact(const content::Assembly& assembly,
                                                            const servo::Setup& setup);

// The assembly's wrench alone, in the tool's frame. An error: it names none, or as above.
Result<collision::ToolShape> load_wrench(const content::Assembly& assembly);

// How much of a joint's nut each named view of an assembly shows, for choosing a view and for authors who
// define them.

struct NutView {
    double share = 0.0;  // visible fraction of the nut, 0…1
    double size = 0.0;   // visible area, relative to a square of the picture's height
    bool framed = true;  // the nut's centre is inside a picture of 4:3 or wider
};

// Moves all nuts down to their seats, as the models show them.
void seat_nuts(const servo::Setup& setup, servo::ToolContact& touch);

// One entry for each view of the assembly, in its order, with all bodies where they are now. Empty if the
// joint's nut has no contact model.
std::vector<NutView> views_of_nut(const content::Assembly& assembly, const servo::ToolContact& touch,
                                  std::size_t joint);

// Index of the view that shows most of the nut; none if no view shows it.
std::optional<std::size_t> best_view(std::span<const NutView> views);

}  // namespace bolt::session
