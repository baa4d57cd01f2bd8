#include "tests/session/child.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace bolt::session::test {

ChildEnd run_child(const std::function<int(const std::function<void(std::uint64_t)>&)>& work,
                   std::uint64_t kill_at, unsigned delay_us) {
    int ends[2];
    if (::pipe(ends) != 0) std::abort();
    (void)std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0) std::abort();
    if (child == 0) {
        (void)::close(ends[0]);
        const int code = work([&](std::uint64_t number) {
            if (::write(ends[1], &number, sizeof number) != sizeof number) ::_exit(99);
        });
        ::_exit(code);  // skips the destructors and reports of the test program
    }
    (void)::close(ends[1]);
    ChildEnd end;
    std::uint64_t number = 0;
    // A pipe transfers eight bytes atomically. Reports from before the kill are still read.
    while (::read(ends[0], &number, sizeof number) == sizeof number) {
        end.last_report = number;
        if (++end.reports != kill_at) continue;
        ::usleep(delay_us);
        ::kill(child, SIGKILL);
    }
    (void)::close(ends[0]);
    int status = 0;
    if (::waitpid(child, &status, 0) != child) std::abort();
    end.killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
    return end;
}

}  // namespace bolt::session::test
