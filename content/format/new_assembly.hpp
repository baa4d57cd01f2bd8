// Starts a new assembly: a folder whose assembly.json loads without a mistake and is there to be changed.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/base/result.hpp"

namespace bolt::content {

// Makes `folder` (refused if it is there and not empty) and writes assembly.json into it, titled `name`, with
// the models that it names.
// Outside of content/assemblies the schema is written beside it, so that an editor finds it. What fails
// leaves nothing behind.
Status create_assembly(const std::filesystem::path& folder, std::string_view name);

}  // namespace bolt::content
