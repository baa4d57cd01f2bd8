#include "engine/base/process.hpp"

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

namespace {

// Makes our file descriptor `ours` available to the child as its descriptor `theirs`.
struct Redirect {
    int ours = -1, theirs = -1;
};

struct Pipe {
    int read_end = -1, write_end = -1;
};

Result<Pipe> make_pipe(const std::string& program) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorCode::failed,
                    fmt::format("a pipe to {} cannot be created: {}", program, std::strerror(errno)));
    return Pipe{ends[0], ends[1]};
}

// Returns the process id of the started program.
Result<int> spawn(const std::vector<std::string>& command, std::span<const Redirect> redirects) {
    std::vector<char*> arguments;
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));  // NOLINT: posix_spawn changes none of them
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (const Redirect& redirect : redirects)
        ::posix_spawn_file_actions_adddup2(&actions, redirect.ours, redirect.theirs);
    pid_t child = 0;
    const int error_number =
        ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error_number != 0)
        return fail(ErrorCode::failed,
                    fmt::format("{} cannot be started: {}", command[0], std::strerror(error_number)));
    return child;
}

// Waits for the child to exit. Returns its exit code; -1 if a signal ended it.
int wait_for(int child) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

Result<ProgramResult> run_program(const std::vector<std::string>& command, Capture capture) {
    BOLT_TRY_ASSIGN(const Pipe pipe, make_pipe(command[0]));
    std::vector<Redirect> redirects{{pipe.write_end, STDOUT_FILENO}};
    if (capture == Capture::output_and_errors) redirects.push_back({pipe.write_end, STDERR_FILENO});
    const Result<int> child = spawn(command, redirects);
    ::close(pipe.write_end);
    ProgramResult result;
    std::array<char, 4096> buffer{};
    for (ssize_t count = 1; child && count != 0;) {
        count = ::read(pipe.read_end, buffer.data(), buffer.size());
        if (count < 0 && errno != EINTR) break;
        if (count > 0) result.output.append(buffer.data(), static_cast<std::size_t>(count));
    }
    ::close(pipe.read_end);
    if (!child) return fail(child.error());
    result.exit_code = wait_for(*child);
    return result;
}

Result<ChildStdin> ChildStdin::start(const std::vector<std::string>& command) {
    BOLT_TRY_ASSIGN(const Pipe pipe, make_pipe(command[0]));
    const Redirect input{pipe.read_end, STDIN_FILENO};
    const Result<int> child = spawn(command, {&input, 1});
    ::close(pipe.read_end);
    if (!child) {
        ::close(pipe.write_end);
        return fail(child.error());
    }
    return ChildStdin(pipe.write_end, *child, command[0]);
}

ChildStdin::ChildStdin(ChildStdin&& other) noexcept
    : pipe_(std::exchange(other.pipe_, -1)),
      child_(std::exchange(other.child_, -1)),
      name_(std::move(other.name_)) {}

ChildStdin& ChildStdin::operator=(ChildStdin&& other) noexcept {
    std::swap(pipe_, other.pipe_);
    std::swap(child_, other.child_);
    std::swap(name_, other.name_);
    return *this;
}

ChildStdin::~ChildStdin() { (void)finish(); }

Status ChildStdin::write(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(pipe_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0)
            return fail(ErrorCode::failed,
                        fmt::format("{} no longer reads its input: {}", name_, std::strerror(errno)));
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

int ChildStdin::finish() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    if (child_ < 0) return -1;
    return wait_for(std::exchange(child_, -1));
}

}  // namespace bolt
