#include "engine/base/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

extern char** environ;

namespace bolt {

Result<Finished> run_program(const std::vector<std::string>& command, Hear hear) {
    std::vector<char*> arguments;
    for (const std::string& word : command)
        arguments.push_back(const_cast<char*>(word.c_str()));  // NOLINT: posix_spawn changes none of them
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorCode::failed, fmt::format("no pipe for {}: {}", command[0], std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    if (hear == Hear::output_and_errors) ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    Finished finished;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 1; problem == 0 && got != 0;) {
        got = ::read(ends[0], buffer.data(), buffer.size());
        if (got < 0 && errno != EINTR) break;
        if (got > 0) finished.said.append(buffer.data(), static_cast<std::size_t>(got));
    }
    ::close(ends[0]);
    if (problem != 0)
        return fail(ErrorCode::failed,
                    fmt::format("{} cannot be started: {}", command[0], std::strerror(problem)));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return finished;
}

}  // namespace bolt
