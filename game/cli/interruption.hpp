// Ctrl+C and a polite kill: a command that records ends its session in order.
#pragma once

namespace bolt::cli {

/// From now on SIGINT and SIGTERM only set what `interrupted()` tells.
void catch_interruption();

/// Whether somebody wants the program to end.
[[nodiscard]] bool interrupted();

}  // namespace bolt::cli
