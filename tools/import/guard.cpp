#include "tools/import/guard.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>

#include "engine/base/console.hpp"

namespace bolt::step_import {

namespace {

[[noreturn]] void child(const std::function<int()>& work, rlim_t patience) {
    rlimit processor{};
    if (getrlimit(RLIMIT_CPU, &processor) == 0) {
        processor.rlim_cur = std::min(processor.rlim_cur, patience);
        (void)setrlimit(RLIMIT_CPU, &processor);
    }
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
        (void)std::signal(number, SIG_DFL);
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

unsigned patience_for(const std::filesystem::path& step) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(step, none);
    return 120 + (none ? 0U : static_cast<unsigned>(std::min<std::uintmax_t>(bytes / 16384, 100000)));
}

int run_guarded(const std::filesystem::path& step, const std::function<int()>& work, unsigned patience) {
    (void)std::fflush(nullptr);
    const pid_t pid = fork();
    if (pid < 0) return work();
    if (pid == 0) child(work, patience);
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
    } else if (WTERMSIG(status) == SIGXCPU) {
        error.what = "the CAD kernel does not come to an end with this file";
        error.expected = "expected a STEP file as a CAD program exports it: is it damaged?";
    } else {
        error.what = fmt::format("the CAD kernel crashed on this file (signal {})", WTERMSIG(status));
        error.expected = "expected a STEP file as a CAD program exports it: is it damaged?";
    }
    return complain(error);
}

}  // namespace bolt::step_import
