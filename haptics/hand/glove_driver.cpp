#include "haptics/hand/glove_driver.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "engine/base/lock_free.hpp"
#include "engine/base/steady_seconds.hpp"

namespace bolt::hand {

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
