#include "engine/base/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "engine/base/spawn.hpp"

namespace bolt {

Result<Finished> run_program(const std::vector<std::string>& command, Hear hear) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorCode::failed, fmt::format("no pipe for {}: {}", command[0], std::strerror(errno)));
    std::vector<Redirect> redirects{{ends[1], STDOUT_FILENO}};
    if (hear == Hear::output_and_errors) redirects.push_back({ends[1], STDERR_FILENO});
    const Result<int> child = spawn(command, redirects);
    ::close(ends[1]);
    Finished finished;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 1; child && got != 0;) {
        got = ::read(ends[0], buffer.data(), buffer.size());
        if (got < 0 && errno != EINTR) break;
        if (got > 0) finished.said.append(buffer.data(), static_cast<std::size_t>(got));
    }
    ::close(ends[0]);
    if (!child) return fail(child.error());
    finished.exit_code = wait_for(*child);
    return finished;
}

}  // namespace bolt
