#include "tools/import/guard.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "engine/base/console.hpp"

namespace bolt::step_import {

namespace {

[[noreturn]] void child(const std::function<int()>& work) {
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) (void)std::signal(number, SIG_DFL);
    const rlimit none{0, 0};
    (void)setrlimit(RLIMIT_CORE, &none);
    int code = 1;
    try {
        code = work();
    } catch (const std::exception& error) {
        (void)std::fprintf(stderr, "error: %s\n", error.what());
    }
    (void)std::fflush(nullptr);
    _exit(code);  // destructors of static objects are the parent's business
}

}  // namespace

int run_guarded(const std::filesystem::path& step, const std::function<int()>& work) {
    (void)std::fflush(nullptr);
    const pid_t pid = fork();
    if (pid < 0) return work();
    if (pid == 0) child(work);
    int status = 0;
    while (waitpid(pid, &status, 0) < 0)
        if (errno != EINTR) return 1;
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = step.string();
    if (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM || WTERMSIG(status) == SIGINT) {
        error.code = ErrorCode::failed;
        error.what = "the import was stopped from outside";
        error.expected = "if nobody stopped it, the memory ran out: try a larger --deflection";
    } else {
        error.what = fmt::format("the CAD kernel crashed on this file (signal {})", WTERMSIG(status));
        error.expected = "expected a STEP file as a CAD program exports it: is it damaged?";
    }
    return complain(error);
}

}  // namespace bolt::step_import
