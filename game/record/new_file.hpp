// A new session file in the place of whatever was there.
#pragma once

#include <filesystem>
#include <string>

#include "engine/base/result.hpp"
#include "game/record/file_lock.hpp"
#include "game/record/session.hpp"
#include "game/record/tables.hpp"

namespace bolt::record {

// Makes the folder for a session at `path` and keeps other programs from recording there.
Result<FileLock> claim_place(const std::filesystem::path& path, const std::string& file);

// Makes a session without ticks at `path`, closed, in write-ahead mode; `seals` gets its seals. The place has
// to be claimed. It is made under another name first: if that fails, an old file at `path` is still there.
// The old one is kept as session.hpp says; where a file can have two names there is a whole session at
// `path`, the old or the new one, at every moment.
Status make_new_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                     Seals& seals);

}  // namespace bolt::record
