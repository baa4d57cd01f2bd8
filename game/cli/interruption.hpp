// SIGINT (Ctrl+C) and SIGTERM as requests to end, so that a recording command can complete its session file.
#pragma once

namespace bolt::cli {

// From now on SIGINT and SIGTERM only set the flag that `interrupted()` returns.
void catch_interruption();

// Returns true if the program was requested to end.
[[nodiscard]] bool interrupted();

}  // namespace bolt::cli
