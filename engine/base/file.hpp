// Whole small files in and out, with errors that say which file and why.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace bolt {

// Reads a whole file; fails if it is missing, not a regular file, or larger than `limit` bytes.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, ErrorCode code);

// Writes beside the target and renames, so that a full disk never leaves half a file under the name. What is
// no regular file (a device, a pipe) is written to and stays what it is.
Status write_file(const std::filesystem::path& path, std::string_view text);

// Fails if both name the same file: writing over what is being read would destroy it.
Status keep_apart(const std::filesystem::path& input, const std::filesystem::path& output);

}  // namespace bolt
