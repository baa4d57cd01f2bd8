#include "tools/emulate/glove.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "engine/base/lock_free.hpp"
#include "engine/base/math.hpp"

namespace bolt::emulate {

namespace {

void append(std::vector<std::uint8_t>& out, std::string_view text) {
    out.insert(out.end(), text.begin(), text.end());
}

void append_value(std::vector<std::uint8_t>& out, char letter, std::size_t value) {
    out.insert(out.end(), {'?', static_cast<std::uint8_t>(letter), static_cast<std::uint8_t>(value), 0});
}

std::uint8_t raw_value(double angle, const hand::LinearFit& fit) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(angle / fit.gain + fit.offset), 1L, 255L));
}

}  // namespace

hand::PerSensor<std::uint8_t> raw_values(hand::Posture posture) {
    hand::PerSensor<std::uint8_t> raw{};
    for (std::size_t i = 0; i < raw.size(); ++i) {
        const double angle = hand::posture_angle(posture, static_cast<hand::Sensor>(i)).value_or(0.0);
        raw[i] = raw_value(angle, sensor_fit);
    }
    return raw;
}

hand::PerSensor<std::uint8_t> raw_values(const hand::Angles& hand,
                                         const hand::PerSensor<hand::LinearFit>& fits) {
    using hand::Sensor;
    hand::PerSensor<double> angle{};
    const auto set = [&](Sensor sensor, double value) { angle[hand::index(sensor)] = value; };
    set(Sensor::thumb_roll, hand.thumb.roll);
    set(Sensor::thumb_abduction, hand.thumb.abduction);
    set(Sensor::thumb_mpj, hand.thumb.mcp);
    set(Sensor::thumb_ij, hand.thumb.ip);
    constexpr std::array<Sensor, 4> first{Sensor::index_mpj, Sensor::middle_mpj, Sensor::ring_mpj,
                                          Sensor::little_mpj};
    for (std::size_t i = 0; i < first.size(); ++i) {
        angle[hand::index(first[i])] = hand.fingers[i].mcp;
        angle[hand::index(first[i]) + 1] = hand.fingers[i].pip;
        angle[hand::index(first[i]) + 2] = hand.fingers[i].dip;
    }
    set(Sensor::palm_arch, hand.arch);
    hand::PerSensor<std::uint8_t> raw{};
    for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = raw_value(angle[i], fits[i]);
    return raw;
}

hand::PerSensor<std::uint8_t> raw_values(const hand::Angles& hand, const hand::LinearFit& all) {
    hand::PerSensor<hand::LinearFit> fits;
    fits.fill(all);
    return raw_values(hand, fits);
}

EmulatedGlove::EmulatedGlove(const EmulatedGloveOptions& options)
    : options_(options),
      random_(options.seed, 0x610e),
      streaming_(options.streaming),
      status_(options.status),
      time_(options.time),
      samples_(options.sensors) {
    raw.fill(120);
}

std::vector<std::uint8_t> EmulatedGlove::advance(std::span<const std::uint8_t> received, double now) {
    Bytes out;
    if (stalled) {
        next_ = now;
        return out;
    }
    for (const std::uint8_t byte : received) receive(byte, out);
    if (streaming_ && now - next_ > 1.0) next_ = now;
    for (; streaming_ && next_ <= now; next_ += 1.0 / rate_) {
        append_frame('S', out);
        ++sent_;
    }
    if (!streaming_) next_ = now;
    return with_faults(out);
}

void EmulatedGlove::receive(std::uint8_t byte, Bytes& out) {
    if (byte == 0x03) {
        streaming_ = false;
        received_.clear();
        return;
    }
    received_.push_back(byte);
    if (answer_command(out)) received_.clear();
}

// Answers the command in the received bytes. Returns whether the command was complete.
bool EmulatedGlove::answer_command(Bytes& out) {
    const auto reject = [&] {
        append(out, std::string_view("e?\r\n\0", 5));
        return true;
    };
    const bool modern = !options_.old_firmware;
    const std::uint8_t first = received_.front();
    const std::size_t n = received_.size();
    switch (first) {
        case '\r':
        case '\n':
            return true;
        case 'S':
            streaming_ = true;
            return true;
        case 'G':
            append_frame('G', out);
            return true;
        case 'N':
            if (n < 2) return false;
            samples_ = received_[1];
            out.insert(out.end(), {first, 0});
            return true;
        case 'U':
        case 'D':
            if (n < 2) return false;
            if (!modern) return reject();
            (first == 'U' ? status_ : time_) = received_[1] != 0;
            out.insert(out.end(), {first, 0});
            return true;
        case 't': {
            if (received_.back() != '\r') return n > 24 ? reject() : false;
            if (!modern) return reject();
            const std::string text(received_.begin() + 1, received_.end());
            const double ticks = std::atof(text.c_str());
            if (!(ticks >= 200.0)) return reject();
            rate_ = 115200.0 / ticks;
            append(out, std::string_view("t\r\n\0", 4));
            return true;
        }
        case '?':
            if (n < 2) return false;
            switch (received_[1]) {
                case 'S':
                    append_value(out, 'S', options_.sensors);
                    return true;
                case 'N':
                    append_value(out, 'N', samples_);
                    return true;
                case 'R':
                    append_value(out, 'R', options_.hand == hand::Side::right ? 1 : 0);
                    return true;
                case 'G':
                    if (!modern) return reject();
                    append_value(out, 'G', options_.plugged ? 3 : 0);
                    return true;
                case 'V':
                    if (!modern) return reject();
                    append(out, "?V" + options_.version);
                    out.push_back(0);
                    return true;
                default:
                    return reject();
            }
        default:
            return reject();
    }
}

void EmulatedGlove::append_frame(std::uint8_t letter, Bytes& out) const {
    out.push_back(letter);
    const auto sensors = hand::sensors_of(options_.sensors);
    for (std::size_t i = 0; i < std::min(samples_, sensors.size()); ++i) {
        const std::uint8_t value = raw[hand::index(sensors[i])];
        out.push_back(std::max<std::uint8_t>(value, 1));
    }
    if (time_) out.insert(out.end(), {12, 0, 34, 0, 5});
    if (status_) out.push_back(0x02);
    if (!options_.plugged) append(out, "eg");
    out.push_back(0);
}

std::vector<std::uint8_t> EmulatedGlove::with_faults(const Bytes& bytes) {
    const ByteFaults& f = options_.faults;
    if (f.dropped + f.changed + f.added <= 0.0) return bytes;
    Bytes out;
    for (const std::uint8_t byte : bytes) {
        if (random_.uniform(0.0, 1.0) < f.added) out.push_back(static_cast<std::uint8_t>(random_.bits()));
        if (random_.uniform(0.0, 1.0) < f.dropped) continue;
        const bool changed = random_.uniform(0.0, 1.0) < f.changed;
        out.push_back(changed ? static_cast<std::uint8_t>(random_.bits()) : byte);
    }
    return out;
}

struct SerialGlove::Shared {
    explicit Shared(const EmulatedGloveOptions& options) : glove(options) {}
    ~Shared() {
        thread = {};  // stop and join before closing the file descriptors
        if (port_file >= 0) close(port_file);
        if (master >= 0) close(master);
    }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;

    EmulatedGlove glove;
    int master = -1;
    int port_file = -1;  // the port, kept open so that a driver's close does not hang up the terminal
    std::filesystem::path port;
    std::atomic<bool> stalled{false};
    TripleBuffer<hand::PerSensor<std::uint8_t>> requested_values;
    std::jthread thread;

    void run(const std::stop_token& stop, double period) {
        const auto start = std::chrono::steady_clock::now();
        while (!stop.stop_requested()) {
            pollfd wait{master, POLLIN, 0};
            poll(&wait, 1, 2);
            std::array<std::uint8_t, 256> received{};
            const ssize_t n =
                (wait.revents & POLLIN) != 0 ? read(master, received.data(), received.size()) : 0;
            const double now =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            if (period > 0.0) {
                const double closure = 0.5 - 0.5 * std::cos(2.0 * pi * now / period);
                glove.raw.fill(static_cast<std::uint8_t>(60.0 + 120.0 * closure));
            }
            if (requested_values.update()) glove.raw = requested_values.latest();
            glove.stalled = stalled;
            const auto out = glove.advance(
                std::span(received).first(static_cast<std::size_t>(std::max<ssize_t>(n, 0))), now);
            // If nobody reads, bytes that do not fit are lost, as on a serial line.
            if (!out.empty()) [[maybe_unused]]
                const ssize_t sent = write(master, out.data(), out.size());
        }
    }
};

Result<SerialGlove> SerialGlove::start(const EmulatedGloveOptions& options, double period) {
    auto shared = std::make_unique<Shared>(options);
    const auto failed = [](const char* what) {
        return fail(ErrorCode::failed, fmt::format("pseudo-terminal: {}: {}", what, std::strerror(errno)),
                    "a system with free pseudo-terminals");
    };
    shared->master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (shared->master < 0) return failed("cannot open");
    std::array<char, 128> name{};
    if (grantpt(shared->master) != 0 || unlockpt(shared->master) != 0 ||
        ptsname_r(shared->master, name.data(), name.size()) != 0)
        return failed("cannot unlock the port");
    shared->port = name.data();
    shared->port_file = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (shared->port_file < 0) return failed("cannot open the port");
    termios raw{};
    if (tcgetattr(shared->port_file, &raw) != 0) return failed("cannot read the settings");
    cfmakeraw(&raw);  // otherwise the terminal echoes the glove's bytes back
    if (tcsetattr(shared->port_file, TCSANOW, &raw) != 0) return failed("cannot change the settings");
    shared->thread =
        std::jthread([s = shared.get(), period](const std::stop_token& stop) { s->run(stop, period); });
    return SerialGlove(std::move(shared));
}

SerialGlove::SerialGlove(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
SerialGlove::SerialGlove(SerialGlove&&) noexcept = default;
SerialGlove& SerialGlove::operator=(SerialGlove&&) noexcept = default;
SerialGlove::~SerialGlove() = default;

const std::filesystem::path& SerialGlove::port() const { return shared_->port; }
void SerialGlove::set_raw(const hand::PerSensor<std::uint8_t>& raw) { shared_->requested_values.write(raw); }
void SerialGlove::stall(bool stalled) { shared_->stalled = stalled; }

}  // namespace bolt::emulate
