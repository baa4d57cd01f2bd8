// A pseudo-terminal: the driver under test opens port() as its serial port, the test holds the other end.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace bolt::test {

class PseudoTerminal {
  public:
    PseudoTerminal() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        std::array<char, 128> name{};
        if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
            ptsname_r(master_, name.data(), name.size()) != 0)
            throw std::runtime_error("no pseudo-terminal");
        port_ = name.data();
        keep_ = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        termios raw{};
        tcgetattr(keep_, &raw);
        cfmakeraw(&raw);
        tcsetattr(keep_, TCSANOW, &raw);
    }
    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;
    ~PseudoTerminal() { unplug(); }

    [[nodiscard]] const std::filesystem::path& port() const { return port_; }

    void send(std::string_view text) const {
        [[maybe_unused]] const ssize_t n = write(master_, text.data(), text.size());
    }
    // Reads until the driver has written `text`. The kernel passes bytes on later and in pieces. Returns
    // false after 10 s without a byte, which only ends a test that hangs.
    [[nodiscard]] bool receives(std::string_view text) const {
        std::string received;
        pollfd wait{master_, POLLIN, 0};
        while (received.find(text) == std::string::npos) {
            std::array<char, 4096> bytes{};
            if (poll(&wait, 1, 10'000) <= 0) return false;
            const ssize_t n = read(master_, bytes.data(), bytes.size());
            if (n <= 0) return false;
            received.append(bytes.data(), static_cast<std::size_t>(n));
        }
        return true;
    }
    void unplug() {
        for (int* file : {&keep_, &master_}) {
            if (*file >= 0) close(*file);
            *file = -1;
        }
    }

  private:
    int master_ = -1, keep_ = -1;
    std::filesystem::path port_;
};

}  // namespace bolt::test
