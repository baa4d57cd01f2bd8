// A new session file in the place of whatever was there.
#pragma once

#include <filesystem>
#include <string>

#include "engine/base/result.hpp"
#include "game/record/session.hpp"
#include "game/record/tables.hpp"

namespace bolt::record {

// Makes a session without ticks at `path`, closed, in write-ahead mode, and the folder for it; `seals` gets
// its seals. It is made under another name first: if that fails, an old file at `path` is still there.
Status make_new_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                     Seals& seals);

}  // namespace bolt::record
