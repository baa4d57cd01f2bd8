#include "haptics/hand/glove_driver.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "engine/base/triple_buffer.hpp"
#include "haptics/hand/serial_port.hpp"

namespace bolt::hand {

namespace {

constexpr double first_retry_delay = 0.1, max_retry_delay = 1.0;  // s between two tries to open the port
constexpr double patience = 5e-3;  // s: as long as the thread may sleep in one go

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void put(std::array<char, 200>& words, const std::string& text) {
    const std::size_t n = std::min(text.size(), words.size() - 1);
    std::copy_n(text.begin(), n, words.begin());
    words[n] = '\0';
}

// Silence counts from the first frame on.
void listen(GloveReport& report, std::uint64_t frames, double time) {
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
    void talk(SerialPort& line, GloveReport& report, std::uint64_t& number, const std::stop_token& stop) {
        GloveSession session(options);
        const GloveReport before = report;
        std::vector<std::uint8_t> received;
        while (!stop.stop_requested()) {
            const double time = now();
            listen(report, number, time);
            const auto said = session.update(received, time, [&](const GloveFrame& frame) {
                samples.write({frame, ++number, time});
                report.newest = time;
            });
            report.state = session.state();
            // Keeps the identity of the previous session until the new handshake ends.
            if (session.handshakes() > 0) report.identity = session.identity();
            report.frames = before.frames + session.frames();
            report.lost_bytes = before.lost_bytes + session.lost_bytes();
            report.handshakes = before.handshakes + session.handshakes();
            put(report.trouble, session.trouble());
            reports.write(report);
            if (!said.empty())
                if (const Status sent = line.write(said); !sent)
                    return put(report.trouble, sent.error().message());
            auto read = line.read(patience);
            if (!read) return put(report.trouble, read.error().message());
            received = std::move(*read);
        }
    }

    void run(const std::stop_token& stop) {
        GloveReport report;
        std::uint64_t number = 0;
        double pause = first_retry_delay;
        while (!stop.stop_requested()) {
            Result<SerialPort> line = SerialPort::open(port);
            if (line) {
                ++report.openings;
                report.open = true;
                talk(*line, report, number, stop);
                pause = first_retry_delay;
            } else {
                put(report.trouble, line.error().message());
            }
            report.open = false;
            report.state = GloveState::silent;
            listen(report, number, now());
            reports.write(report);
            for (double until = now() + pause; now() < until && !stop.stop_requested();)
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
