// Creates a session file, replacing and keeping an older one.
#pragma once

#include <filesystem>
#include <string>

#include "engine/base/result.hpp"
#include "game/session/file_lock.hpp"
#include "game/session/session_file.hpp"
#include "game/session/tables.hpp"

namespace bolt::session {

// Creates the folder of `path` and locks `path` against other programs that record.
Result<FileLock> claim_place(const std::filesystem::path& path, const std::string& file);

// Creates a closed session without ticks at `path`, in write-ahead mode, and sets `checksums`. `path` must be
// claimed. The file is created under another name first, so a failure leaves an old file at `path` untouched.
// The old file is kept as session_file.hpp describes. On file systems with hard links `path` always names a
// whole session, old or new.
Status make_new_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                     TableChecksums& checksums);

}  // namespace bolt::session
