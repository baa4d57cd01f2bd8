#include "engine/base/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace bolt {

namespace {

tl::unexpected<Error> port_lost(const char* what) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("the serial port is lost: {} ({})", what, std::strerror(errno));
    error.expected = "an adapter that stays plugged in";
    error.lost = true;
    return fail(std::move(error));
}

tl::unexpected<Error> cannot_open(const std::filesystem::path& path) {
    const int why = errno;
    std::string expected = "a serial port that can be opened";
    if (why == EACCES || why == EPERM)
        expected = "a user in the port's group (usually dialout), or the udev rule in tools/udev";
    else if (why == ENOENT || why == ENXIO || why == ENODEV)
        expected = "an existing port; is the device's adapter plugged in?";
    else if (why == EBUSY)
        expected = "a port that no other program has open";
    return fail(ErrorCode::no_device, fmt::format("cannot open {}: {}", path.string(), std::strerror(why)),
                std::move(expected));
}

// FTDI adapters buffer bytes for 16 ms by default.
void request_low_latency(int file) {
    serial_struct serial{};
    if (ioctl(file, TIOCGSERIAL, &serial) != 0) return;
    serial.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
    ioctl(file, TIOCSSERIAL, &serial);
}

}  // namespace

Result<SerialPort> SerialPort::open(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return cannot_open(path);
    SerialPort serial(file);
    termios settings{};
    if (tcgetattr(file, &settings) != 0)
        return fail(ErrorCode::no_device, fmt::format("{} is not a serial port", path.string()),
                    "a port such as /dev/ttyUSB0");
    if (ioctl(file, TIOCEXCL) != 0) return cannot_open(path);
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS);
    settings.c_cc[VMIN] = 0;
    settings.c_cc[VTIME] = 0;
    cfsetspeed(&settings, B115200);
    if (tcsetattr(file, TCSANOW, &settings) != 0)
        return fail(ErrorCode::no_device,
                    fmt::format("{} cannot be set to 115200 baud: {}", path.string(), std::strerror(errno)),
                    "a port that supports 115200 baud");
    request_low_latency(file);
    tcflush(file, TCIOFLUSH);
    return serial;
}

SerialPort::SerialPort(SerialPort&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
SerialPort& SerialPort::operator=(SerialPort&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
}
SerialPort::~SerialPort() {
    if (file_ < 0) return;
    // Otherwise a pseudo-terminal would stay exclusive as long as its other end is open.
    ioctl(file_, TIOCNXCL);
    close(file_);
}

Result<std::vector<std::uint8_t>> SerialPort::read(double timeout) {
    pollfd wait{file_, POLLIN, 0};
    const int ready = poll(&wait, 1, static_cast<int>(timeout * 1e3));
    if (ready < 0 && errno != EINTR) return port_lost("poll");
    std::vector<std::uint8_t> bytes;
    if (ready <= 0) return bytes;
    bytes.resize(4096);
    const ssize_t n = ::read(file_, bytes.data(), bytes.size());
    if (n < 0 && errno != EAGAIN && errno != EINTR) return port_lost("read");
    if (n <= 0 && (wait.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
        errno = EIO;
        return port_lost("hung up");
    }
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    return bytes;
}

Status SerialPort::write(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t n = ::write(file_, bytes.data() + at, bytes.size() - at);
        if (n > 0) {
            at += static_cast<std::size_t>(n);
            continue;
        }
        if (n < 0 && errno != EAGAIN && errno != EINTR) return port_lost("write");
        pollfd wait{file_, POLLOUT, 0};
        if (poll(&wait, 1, 1000) == 0) {
            errno = ETIMEDOUT;
            return port_lost("write");
        }
    }
    return {};
}

std::vector<std::filesystem::path> serial_ports() {
    std::vector<std::filesystem::path> ports;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/serial/by-id", ignored))
        ports.push_back(entry.path());
    if (ports.empty())
        for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
            const std::string name = entry.path().filename().string();
            if (name.starts_with("ttyUSB") || name.starts_with("ttyACM")) ports.push_back(entry.path());
        }
    std::sort(ports.begin(), ports.end());
    return ports;
}

Status check_port_access(const std::filesystem::path& port) {
    if (faccessat(AT_FDCWD, port.c_str(), R_OK | W_OK, AT_EACCESS) == 0) return {};
    const int why = errno;
    std::string expected = "an existing port; is the device's adapter plugged in?";
    struct stat node {};
    if (why != ENOENT && stat(port.c_str(), &node) == 0) {
        const group* owner = getgrgid(node.st_gid);
        expected = fmt::format("a user in the group {0}: sudo usermod -aG {0} NAME, then log in again",
                               owner != nullptr ? owner->gr_name : std::to_string(node.st_gid).c_str());
        if (owner != nullptr && owner->gr_gid == 0) expected = "a port that users other than root may access";
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

}  // namespace bolt
