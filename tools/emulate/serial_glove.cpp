#include "tools/emulate/serial_glove.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "engine/base/math.hpp"
#include "engine/base/triple_buffer.hpp"

namespace bolt::emulate {

struct SerialGlove::Shared {
    explicit Shared(const GloveOptions& design) : glove(design) {}
    ~Shared() {
        thread = {};  // stopped and joined before the line goes
        if (keep >= 0) close(keep);
        if (master >= 0) close(master);
    }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;

    Glove glove;
    int master = -1;
    int keep = -1;  // of the port: as long as it is open, a driver that closes it does not hang us up
    std::filesystem::path port;
    std::atomic<bool> stalled{false};
    TripleBuffer<hand::PerSensor<std::uint8_t>> shown;
    std::jthread thread;

    void run(const std::stop_token& stop, double period) {
        const auto start = std::chrono::steady_clock::now();
        while (!stop.stop_requested()) {
            pollfd wait{master, POLLIN, 0};
            poll(&wait, 1, 2);
            std::array<std::uint8_t, 256> heard{};
            const ssize_t n = (wait.revents & POLLIN) != 0 ? read(master, heard.data(), heard.size()) : 0;
            const double now =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            if (period > 0.0) {
                const double bent = 0.5 - 0.5 * std::cos(2.0 * pi * now / period);
                glove.raw.fill(static_cast<std::uint8_t>(60.0 + 120.0 * bent));
            }
            if (shown.update()) glove.raw = shown.latest();
            glove.stalled = stalled;
            const auto out =
                glove.advance(std::span(heard).first(static_cast<std::size_t>(std::max<ssize_t>(n, 0))), now);
            // Nobody reads: what does not fit is lost, as on a line.
            if (!out.empty()) [[maybe_unused]]
                const ssize_t sent = write(master, out.data(), out.size());
        }
    }
};

Result<SerialGlove> SerialGlove::start(const GloveOptions& design, double period) {
    auto shared = std::make_unique<Shared>(design);
    const auto failed = [](const char* what) {
        return fail(ErrorCode::failed, fmt::format("no pseudo-terminal: {}: {}", what, std::strerror(errno)));
    };
    shared->master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (shared->master < 0) return failed("open");
    std::array<char, 128> name{};
    if (grantpt(shared->master) != 0 || unlockpt(shared->master) != 0 ||
        ptsname_r(shared->master, name.data(), name.size()) != 0)
        return failed("grant");
    shared->port = name.data();
    shared->keep = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (shared->keep < 0) return failed("port");
    termios raw{};
    if (tcgetattr(shared->keep, &raw) != 0) return failed("settings");
    cfmakeraw(&raw);  // or it would echo what the glove says back to it
    if (tcsetattr(shared->keep, TCSANOW, &raw) != 0) return failed("settings");
    shared->thread =
        std::jthread([s = shared.get(), period](const std::stop_token& stop) { s->run(stop, period); });
    return SerialGlove(std::move(shared));
}

SerialGlove::SerialGlove(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
SerialGlove::SerialGlove(SerialGlove&&) noexcept = default;
SerialGlove& SerialGlove::operator=(SerialGlove&&) noexcept = default;
SerialGlove::~SerialGlove() = default;

const std::filesystem::path& SerialGlove::port() const { return shared_->port; }
void SerialGlove::show(const hand::PerSensor<std::uint8_t>& raw) { shared_->shown.write(raw); }
void SerialGlove::stall(bool stalled) { shared_->stalled = stalled; }

}  // namespace bolt::emulate
