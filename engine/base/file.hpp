// Reads and writes whole small files; errors name the file and the reason.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace bolt {

// Reads a whole file; fails if it is missing, not a regular file, or larger than `limit` bytes.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, ErrorCode code);

// Writes to a temporary file beside the target and renames it, so that a full disk never leaves a truncated
// file under that name. If `path` is a device or a pipe, the text is written to it directly.
Status write_file(const std::filesystem::path& path, std::string_view text);

// Fails if both paths name the same file, because writing the output would destroy the input.
Status require_different_files(const std::filesystem::path& input, const std::filesystem::path& output);

}  // namespace bolt
