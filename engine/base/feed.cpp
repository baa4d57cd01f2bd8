#include "engine/base/feed.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

extern char** environ;

namespace bolt {

Result<Feed> Feed::start(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    for (const std::string& word : command)
        arguments.push_back(const_cast<char*>(word.c_str()));  // NOLINT: posix_spawn changes none of them
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorCode::failed, fmt::format("no pipe for {}: {}", command[0], std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    if (problem != 0) {
        ::close(ends[1]);
        return fail(ErrorCode::failed,
                    fmt::format("{} cannot be started: {}", command[0], std::strerror(problem)));
    }
    return Feed(ends[1], child, command[0]);
}

Feed::Feed(Feed&& other) noexcept
    : pipe_(std::exchange(other.pipe_, -1)),
      child_(std::exchange(other.child_, -1)),
      name_(std::move(other.name_)) {}

Feed& Feed::operator=(Feed&& other) noexcept {
    std::swap(pipe_, other.pipe_);
    std::swap(child_, other.child_);
    std::swap(name_, other.name_);
    return *this;
}

Feed::~Feed() { (void)finish(); }

Status Feed::write(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(pipe_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0)
            return fail(ErrorCode::failed, fmt::format("{} takes no more: {}", name_, std::strerror(errno)));
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

int Feed::finish() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    if (child_ < 0) return -1;
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace bolt
