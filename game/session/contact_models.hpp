// Loads the contact models of an assembly and its wrench for the servo.
#pragma once

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "game/session/session_file.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::session {

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

}  // namespace bolt::session
