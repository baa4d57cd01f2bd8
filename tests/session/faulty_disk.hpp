// A disk that fails on purpose: while an object lives, SQLite does its file work through it.
//
// Work is counted in operations that change a file (write, truncate, sync, delete). At a chosen one either
// the process is killed, with half of a write done, or the disk is full from there on.
#pragma once

namespace bolt::session::test {

enum class Fault { none, full, kill };

class FaultyDisk {
  public:
    FaultyDisk(Fault fault, int at_operation);
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;
    ~FaultyDisk();

    [[nodiscard]] static int operations();  // since the object was made
};

}  // namespace bolt::session::test
