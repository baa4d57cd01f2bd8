// Where a program keeps what belongs to its user.
#pragma once

#include <filesystem>

#include "engine/base/result.hpp"

namespace bolt::content {

// By the XDG base directory specification; it need not be there yet. An error: the environment names none.
Result<std::filesystem::path> data_folder();

// A trainee's name as a file's: another for every name, of letters that every file system takes.
std::string file_name_of(std::string_view trainee);

}  // namespace bolt::content
