#include "engine/base/feed.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/base/spawn.hpp"

namespace bolt {

Result<Feed> Feed::start(const std::vector<std::string>& command) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorCode::failed, fmt::format("no pipe for {}: {}", command[0], std::strerror(errno)));
    const Redirect input{ends[0], STDIN_FILENO};
    const Result<int> child = spawn(command, {&input, 1});
    ::close(ends[0]);
    if (!child) {
        ::close(ends[1]);
        return fail(child.error());
    }
    return Feed(ends[1], *child, command[0]);
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
    return wait_for(std::exchange(child_, -1));
}

}  // namespace bolt
