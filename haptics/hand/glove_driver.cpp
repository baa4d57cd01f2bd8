#include "haptics/hand/glove_driver.hpp"

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
#include <chrono>
#include <cstring>
#include <fstream>
#include <optional>
#include <thread>
#include <utility>

#include "engine/base/lock_free.hpp"
#include "engine/base/steady_seconds.hpp"

namespace bolt::hand {

namespace {

tl::unexpected<Error> port_lost(const char* what) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("the glove's port is lost: {} ({})", what, std::strerror(errno));
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
        expected = "an existing port; is the glove's adapter plugged in?";
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
                    "the port of the glove, such as /dev/ttyUSB0");
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
    std::string expected = "an existing port; is the glove's adapter plugged in?";
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

namespace {

constexpr double first_retry_delay = 0.1, max_retry_delay = 1.0;  // s between two attempts to open the port
constexpr double read_timeout = 5e-3;                             // s, longest wait of the thread

void copy_text(std::array<char, 200>& target, const std::string& text) {
    const std::size_t n = std::min(text.size(), target.size() - 1);
    std::copy_n(text.begin(), n, target.begin());
    target[n] = '\0';
}

// Updates the longest silence, which counts from the first frame on.
void update_silence(GloveReport& report, std::uint64_t frames, double time) {
    if (frames > 0) report.longest_silence = std::max(report.longest_silence, time - report.newest);
}

}  // namespace

struct GloveDriver::Shared {
    std::filesystem::path port;
    GloveSessionOptions options;
    TripleBuffer<GloveSample> samples;
    TripleBuffer<GloveReport> reports;
    std::jthread thread;

    // Serves one opening of the port, until it is lost or the thread stops.
    void serve(SerialPort& serial, GloveReport& report, std::uint64_t& number, const std::stop_token& stop) {
        GloveSession session(options);
        const GloveReport before = report;
        std::vector<std::uint8_t> received;
        while (!stop.stop_requested()) {
            const double time = steady_seconds();
            update_silence(report, number, time);
            const auto outgoing = session.update(received, time, [&](const GloveFrame& frame) {
                samples.write({frame, ++number, time});
                report.newest = time;
            });
            report.state = session.state();
            // Keeps the identity of the previous session until the new handshake ends.
            if (session.handshakes() > 0) report.identity = session.identity();
            report.frames = before.frames + session.frames();
            report.lost_bytes = before.lost_bytes + session.lost_bytes();
            report.handshakes = before.handshakes + session.handshakes();
            copy_text(report.fault_message, session.fault_message());
            reports.write(report);
            if (!outgoing.empty())
                if (const Status sent = serial.write(outgoing); !sent)
                    return copy_text(report.fault_message, sent.error().message());
            auto read = serial.read(read_timeout);
            if (!read) return copy_text(report.fault_message, read.error().message());
            received = std::move(*read);
        }
    }

    void run(const std::stop_token& stop) {
        GloveReport report;
        std::uint64_t number = 0;
        double pause = first_retry_delay;
        while (!stop.stop_requested()) {
            Result<SerialPort> serial = SerialPort::open(port);
            if (serial) {
                ++report.openings;
                report.open = true;
                serve(*serial, report, number, stop);
                pause = first_retry_delay;
            } else {
                copy_text(report.fault_message, serial.error().message());
            }
            report.open = false;
            report.state = GloveState::silent;
            update_silence(report, number, steady_seconds());
            reports.write(report);
            for (double until = steady_seconds() + pause; steady_seconds() < until && !stop.stop_requested();)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            pause = std::min(2.0 * pause, max_retry_delay);
        }
    }
};

GloveDriver::GloveDriver(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
GloveDriver::GloveDriver(GloveDriver&&) noexcept = default;
GloveDriver& GloveDriver::operator=(GloveDriver&&) noexcept = default;
GloveDriver::~GloveDriver() = default;

GloveDriver GloveDriver::start(std::filesystem::path port, const GloveSessionOptions& options) {
    auto shared = std::make_unique<Shared>();
    shared->port = std::move(port);
    shared->options = options;
    shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    return GloveDriver(std::move(shared));
}

const GloveSample& GloveDriver::sample() {
    shared_->samples.update();
    return shared_->samples.latest();
}

const GloveReport& GloveDriver::report() {
    shared_->reports.update();
    return shared_->reports.latest();
}

}  // namespace bolt::hand
