// Writes the generated files into the content folder.
#pragma once

#include <filesystem>

#include "engine/base/result.hpp"

namespace bolt::sculpt {

Status write_hands(const std::filesystem::path& content);        // hands/hand_{left,right}.glb
Status write_workshop(const std::filesystem::path& content);     // environments/workshop.glb
Status write_environment(const std::filesystem::path& content);  // environments/workshop.hdr

}  // namespace bolt::sculpt
