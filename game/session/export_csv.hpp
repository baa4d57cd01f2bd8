// Exports a session's ticks as comma-separated values (RFC 4180): a header row with units in the names, then
// one row for each tick.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "engine/base/result.hpp"
#include "game/session/session_file.hpp"

namespace bolt::session {

struct CsvOptions {
    std::uint64_t every_n = 1;                     // one row every n ticks, starting with the first
    std::string out_name = "the standard output";  // name of `out` in errors
};

// Writes everything to `out` and flushes it; the caller closes it. Numbers are the shortest that read back as
// the same single-precision value. A caller whose `out` may be a pipe ignores SIGPIPE to get the error
// instead of the signal.
Status export_csv(const Reader& session, std::FILE* out, const CsvOptions& options = {});

}  // namespace bolt::session
