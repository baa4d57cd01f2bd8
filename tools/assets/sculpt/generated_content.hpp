// The generated content: the workshop model, and the files of the hands, the workshop and its environment.
#pragma once

#include <filesystem>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::sculpt {

// Returns the workshop as a glTF model: floor, back wall, a bench with a clamping plate, a tool board and two
// strip lights. Implemented in workshop.cpp.
//
// Frame: metres, Y up, +Z towards the trainee. The origin, with the empty node `machine_mount`, is the middle
// of the clamping plate's upper face. A machine's foot is placed on y = 0 with its middle on the node and its
// length along x. The plate is 1.00 m by 0.62 m; the floor is at y = −0.85 m.
Result<assets::Model> make_workshop();

// Write into the content folder.
Status write_hands(const std::filesystem::path& content);        // hands/hand_{left,right}.glb
Status write_workshop(const std::filesystem::path& content);     // environments/workshop.glb
Status write_environment(const std::filesystem::path& content);  // environments/workshop.hdr

}  // namespace bolt::sculpt
