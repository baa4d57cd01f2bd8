// A process of its own for what a process can only do once: die, lose its rights, run out of file size.
#pragma once

#include <cstdint>
#include <functional>

namespace bolt::session::test {

struct ChildEnd {
    bool killed = false;            // by SIGKILL
    int code = -1;                  // exit status, if it ended by itself
    std::uint64_t last_report = 0;  // what it reported last
    std::uint64_t reports = 0;
};

// Runs `work` in a forked process; its value is the exit status. `work` gets a function to report numbers
// with. Once `kill_at` reports have come, and `delay_us` later, the child is killed.
ChildEnd run_child(const std::function<int(const std::function<void(std::uint64_t)>&)>& work,
                   std::uint64_t kill_at = UINT64_MAX, unsigned delay_us = 0);

}  // namespace bolt::session::test
