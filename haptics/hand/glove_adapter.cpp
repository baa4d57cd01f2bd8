#include "haptics/hand/glove_adapter.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace bolt::hand {

Status check_port_access(const std::filesystem::path& port) {
    if (faccessat(AT_FDCWD, port.c_str(), R_OK | W_OK, AT_EACCESS) == 0) return {};
    const int why = errno;
    std::string expected = "a port that is there; is the glove's adapter plugged in?";
    struct stat node {};
    if (why != ENOENT && stat(port.c_str(), &node) == 0) {
        const group* owner = getgrgid(node.st_gid);
        expected = fmt::format("a user of the group {0}: sudo usermod -aG {0} NAME, then log in again",
                               owner != nullptr ? owner->gr_name : std::to_string(node.st_gid).c_str());
        if (owner != nullptr && owner->gr_gid == 0) expected = "a port that not only root may use";
    }
    return fail(ErrorCode::no_device, fmt::format("{} cannot be used: {}", port.string(), std::strerror(why)),
                std::move(expected));
}

std::optional<int> latency_timer_ms(const std::filesystem::path& port, const std::filesystem::path& devices) {
    std::error_code ignored;
    const auto real = std::filesystem::canonical(port, ignored);
    std::ifstream file(devices / real.filename() / "latency_timer");
    int ms = 0;
    if (!(file >> ms)) return std::nullopt;
    return ms;
}

}  // namespace bolt::hand
