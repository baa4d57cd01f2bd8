// Runs code in a child process that may be killed, drop its privileges or exceed its file size limit.
#pragma once

#include <cstdint>
#include <functional>

namespace bolt::session::test {

struct ChildEnd {
    bool killed = false;            // by SIGKILL
    int code = -1;                  // exit status, if it ended by itself
    std::uint64_t last_report = 0;  // the last number that it reported
    std::uint64_t reports = 0;
};

// Runs `work` in a forked process and uses its return value as the exit status. `work` receives a function
// that reports numbers. Kills the child `delay_us` after `kill_at` reports.
ChildEnd run_child(const std::function<int(const std::function<void(std::uint64_t)>&)>& work,
                   std::uint64_t kill_at = UINT64_MAX, unsigned delay_us = 0);

}  // namespace bolt::session::test
