// What the obstacles of an assembly sound like, by the number that the servo's output has for them.
#pragma once

#include <span>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/session/session_file.hpp"
#include "game/sound/sound_cues.hpp"

namespace bolt::sound {

// Bolts and washers sound as nuts do: parts whose names begin with a joint's id, as `B1_washer` does. All
// others are taken for castings.
std::vector<Met> materials(const content::Assembly& assembly, std::span<const session::ObstacleName> names);

}  // namespace bolt::sound
