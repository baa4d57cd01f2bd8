// Pictures as PNG files.
#pragma once

#include <filesystem>

#include "engine/render/picture.hpp"

namespace bolt::view {

// Makes the folder if it is not there, and says the file's name on the standard output.
Status write_picture(const render::Picture& picture, const std::filesystem::path& file);

}  // namespace bolt::view
