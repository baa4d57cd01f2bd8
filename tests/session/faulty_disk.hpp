// Fault injection for disk access: while an object exists, SQLite accesses files through it.
//
// Counts the operations that change a file (write, truncate, sync, delete). At a chosen one either the
// process is killed, halfway through a write, or the disk is full from then on.
#pragma once

namespace bolt::session::test {

enum class DiskFault { none, full, kill };

class FaultyDisk {
  public:
    FaultyDisk(DiskFault fault, int at_operation);
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;
    ~FaultyDisk();

    [[nodiscard]] static int operations();  // since the object was created
};

}  // namespace bolt::session::test
