#include "haptics/glove/driver.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "engine/base/triple_buffer.hpp"
#include "haptics/glove/serial_line.hpp"

namespace bolt::glove {

namespace {

constexpr double first_pause = 0.1, longest_pause = 1.0;  // s between two tries to open the port
constexpr double patience = 5e-3;                         // s: as long as the thread may sleep in one go

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void put(std::array<char, 200>& words, const std::string& text) {
    const std::size_t n = std::min(text.size(), words.size() - 1);
    std::copy_n(text.begin(), n, words.begin());
    words[n] = '\0';
}

// Before the first frame nothing is missed.
void listen(Report& report, std::uint64_t frames, double time) {
    if (frames > 0) report.longest_silence = std::max(report.longest_silence, time - report.newest);
}

}  // namespace

struct Driver::Shared {
    std::filesystem::path port;
    ConversationOptions options;
    TripleBuffer<Sample> samples;
    TripleBuffer<Report> reports;
    std::jthread thread;

    // One life of the port: until it is gone or the thread is to stop.
    void talk(SerialLine& line, Report& report, std::uint64_t& number, const std::stop_token& stop) {
        Conversation conversation(options);
        const Report before = report;
        std::vector<std::uint8_t> received;
        while (!stop.stop_requested()) {
            const double time = now();
            listen(report, number, time);
            const auto said = conversation.go_on(received, time, [&](const Frame& frame) {
                samples.write({frame, ++number, time});
                report.newest = time;
            });
            report.state = conversation.state();
            // Of the one before, until it is known again.
            if (conversation.greetings() > 0) report.identity = conversation.identity();
            report.frames = before.frames + conversation.frames();
            report.lost_bytes = before.lost_bytes + conversation.lost_bytes();
            report.greetings = before.greetings + conversation.greetings();
            put(report.trouble, conversation.trouble());
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
        Report report;
        std::uint64_t number = 0;
        double pause = first_pause;
        while (!stop.stop_requested()) {
            Result<SerialLine> line = SerialLine::open(port);
            if (line) {
                ++report.openings;
                report.open = true;
                talk(*line, report, number, stop);
                pause = first_pause;
            } else {
                put(report.trouble, line.error().message());
            }
            report.open = false;
            report.state = State::silent;
            listen(report, number, now());
            reports.write(report);
            for (double until = now() + pause; now() < until && !stop.stop_requested();)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            pause = std::min(2.0 * pause, longest_pause);
        }
    }
};

Driver::Driver(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Driver::Driver(Driver&&) noexcept = default;
Driver& Driver::operator=(Driver&&) noexcept = default;
Driver::~Driver() = default;

Driver Driver::start(std::filesystem::path port, const ConversationOptions& options) {
    auto shared = std::make_unique<Shared>();
    shared->port = std::move(port);
    shared->options = options;
    shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    return Driver(std::move(shared));
}

const Sample& Driver::sample() {
    shared_->samples.update();
    return shared_->samples.latest();
}

const Report& Driver::report() {
    shared_->reports.update();
    return shared_->reports.latest();
}

}  // namespace bolt::glove
