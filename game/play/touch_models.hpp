// The contact models of an assembly and its wrench, as the servo touches them.
#pragma once

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "game/record/session.hpp"
#include "haptics/servo/touch.hpp"

namespace bolt::play {

// What a lesson's wrench meets, and what its session says of it.
struct TouchModels {
    servo::Touch touch;
    std::vector<record::ObstacleName> names;  // node names, as Touch::touched numbers them
    std::string files;                        // each with its size and the sum of its bytes (FNV-1a, 64 bits)
};

// None if the assembly names no contact model or its tool no model. A joint's nut is the node `ID_nut` under
// the joint's node; all other nodes stand still. The wrench is `NAME.contact.glb` beside its `NAME.glb` where
// there is one. Errors name the file: it cannot be read, has no triangles, or has a surface that is not
// closed where it must be.
Result<std::optional<TouchModels>> load_touch_models(const content::Assembly& assembly,
                                                     const servo::Setup& setup);

// From the frame of a wrench's model to the tool's. Errors as above.
Result<Quat> wrench_turn(const content::WrenchDesign& design);

Result<std::optional<servo::Touch>> load_touch(const content::Assembly& assembly, const servo::Setup& setup);

// The assembly's wrench alone, in the tool's frame. An error: it names none, or as above.
Result<contact::ToolShape> load_wrench(const content::Assembly& assembly);

}  // namespace bolt::play
