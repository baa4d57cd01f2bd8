#include "engine/base/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <utility>

#include "engine/base/steady_seconds.hpp"

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
                    fmt::format("a pipe to {} cannot be created: {}", program, std::strerror(errno)),
                    "fewer open files");
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
                    fmt::format("{} cannot be started: {}", command[0], std::strerror(error_number)),
                    "an installed program");
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
                        fmt::format("{} no longer reads its input: {}", name_, std::strerror(errno)),
                        "a program that reads to the end");
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

int ChildStdin::finish() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    if (child_ < 0) return -1;
    return wait_for(std::exchange(child_, -1));
}

namespace {

// Waits at most `timeout` s until the socket has a packet or its other end is closed.
bool wait_for_packet(int socket, double timeout) {
    const double until = steady_seconds() + timeout;
    for (;;) {
        const double left = std::max(until - steady_seconds(), 0.0);
        const timespec time{static_cast<time_t>(left), static_cast<long>(1e9 * (left - std::floor(left)))};
        pollfd events{socket, POLLIN, 0};
        const int ready = ::ppoll(&events, 1, &time, nullptr);
        if (ready >= 0 || errno != EINTR) return ready > 0;
    }
}

// Returns how the child ended, if it does within `patience` s.
std::optional<ProgramEnd> reap(int child, double patience) {
    const double until = steady_seconds() + patience;
    for (;;) {
        int status = 0;
        if (::waitpid(child, &status, WNOHANG) == child) {
            if (WIFSIGNALED(status)) return ProgramEnd{0, WTERMSIG(status), false};
            return ProgramEnd{WEXITSTATUS(status), 0, false};
        }
        if (steady_seconds() >= until) return {};
        const timespec millisecond{0, 1'000'000};
        ::nanosleep(&millisecond, nullptr);
    }
}

}  // namespace

Result<ChildSocket> ChildSocket::start(const std::vector<std::string>& command) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return fail(ErrorCode::failed,
                    fmt::format("a socket to {} cannot be created: {}", command[0], std::strerror(errno)),
                    "fewer open files");
    const Redirect input{ends[1], STDIN_FILENO};
    const Result<int> child = spawn(command, {&input, 1});
    ::close(ends[1]);
    if (!child) {
        ::close(ends[0]);
        return fail(child.error());
    }
    return ChildSocket(ends[0], *child, command[0]);
}

ChildSocket::ChildSocket(ChildSocket&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)),
      child_(std::exchange(other.child_, -1)),
      name_(std::move(other.name_)),
      end_(other.end_) {}

ChildSocket& ChildSocket::operator=(ChildSocket&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(child_, other.child_);
    std::swap(name_, other.name_);
    std::swap(end_, other.end_);
    return *this;
}

ChildSocket::~ChildSocket() { end(0.0); }

Status ChildSocket::send(std::span<const std::byte> packet) {
    const ssize_t sent = ::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent == static_cast<ssize_t>(packet.size())) return {};
    return fail(ErrorCode::failed,
                fmt::format("{} no longer receives packets: {}", name_, std::strerror(errno)),
                "a running program");
}

Result<std::optional<std::size_t>> ChildSocket::receive(std::span<std::byte> packet, double timeout) {
    if (!wait_for_packet(socket_, timeout)) return std::optional<std::size_t>{};
    // MSG_TRUNC: the length of the packet, even if it did not fit.
    const ssize_t length = ::recv(socket_, packet.data(), packet.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (length > 0) return static_cast<std::size_t>(length);
    return fail(ErrorCode::failed, fmt::format("{} has ended", name_), "a running program");
}

ProgramEnd ChildSocket::end(double patience) {
    if (child_ >= 0) {
        ::shutdown(socket_, SHUT_WR);
        std::optional<ProgramEnd> ended = reap(child_, patience);
        if (!ended) {
            ::kill(child_, SIGKILL);
            wait_for(child_);
            ended = ProgramEnd{0, SIGKILL, true};
        }
        end_ = *ended;
        child_ = -1;
    }
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    return end_;
}

}  // namespace bolt
