#include "engine/base/spawn.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>

extern char** environ;

namespace bolt {

Result<int> spawn(const std::vector<std::string>& command, std::span<const Redirect> redirects) {
    std::vector<char*> arguments;
    for (const std::string& word : command)
        arguments.push_back(const_cast<char*>(word.c_str()));  // NOLINT: posix_spawn changes none of them
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (const Redirect& redirect : redirects)
        ::posix_spawn_file_actions_adddup2(&actions, redirect.ours, redirect.as);
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (problem != 0)
        return fail(ErrorCode::failed,
                    fmt::format("{} cannot be started: {}", command[0], std::strerror(problem)));
    return child;
}

int wait_for(int child) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace bolt
