// The contact models of an assembly and its wrench, as the servo touches them.
#pragma once

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "haptics/servo/touch.hpp"

namespace bolt::play {

// None if the assembly names no contact model or no wrench. A joint's nut is the node `ID_nut` under the
// joint's node; all other nodes stand still. The wrench is `NAME.contact.glb` beside its `NAME.glb` where
// there is one. Errors name the file: it cannot be read, has no triangles, or has a surface that is not
// closed where it must be.
Result<std::optional<servo::Touch>> load_touch(const content::Assembly& assembly, const servo::Setup& setup);

}  // namespace bolt::play
