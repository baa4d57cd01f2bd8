// The workshop as a glTF model: floor, back wall, a bench with a clamping plate, a tool board and two strip
// lights.
//
// Frame: metres, Y up, +Z towards the trainee. The origin, with the empty node `machine_mount`, is the middle
// of the clamping plate's upper face. A machine's foot is placed on y = 0 with its middle on the node and its
// length along x. The plate is 1.00 m by 0.62 m; the floor is at y = −0.85 m.
#pragma once

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::sculpt {

Result<assets::Model> make_workshop();

}  // namespace bolt::sculpt
