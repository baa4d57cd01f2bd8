#include "engine/audio/speaker.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include "engine/audio/openal.hpp"
#include "engine/base/triple_buffer.hpp"

namespace bolt::audio {

namespace {

// Half a block: the sink is looked at twice for every block that it plays.
constexpr auto look_every = std::chrono::milliseconds(5);
// Where there is no sink to feed, only the next attempt has to be in time.
constexpr auto idle_every = std::chrono::milliseconds(200);

// Whether somebody who looks has to hear of it; of blocks alone ten times a second.
bool changed(const Report& now, const Report& before) {
    return now.playing != before.playing || now.trouble != before.trouble ||
           now.openings != before.openings || now.losses != before.losses || now.blocks >= before.blocks + 10;
}

}  // namespace

struct Speaker::Shared {
    Shared(Fill fill, OpenSink open) : feeder(std::move(open), std::move(fill)) {}

    Feeder feeder;
    std::atomic<double> volume{1.0};
    TripleBuffer<Report> reports;
    std::mutex mutex;
    std::condition_variable_any woken;
    std::optional<bool> told_playing;  // what news() said last
    std::jthread thread;               // last: it ends before what it uses

    void run(const std::stop_token& stop) {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point begin = Clock::now();
        Report before;
        while (!stop.stop_requested()) {
            const double now = std::chrono::duration<double>(Clock::now() - begin).count();
            feeder.turn(now, volume.load(std::memory_order_relaxed));
            if (const Report& report = feeder.report(); changed(report, before)) {
                before = report;
                reports.write(report);
            }
            std::unique_lock lock(mutex);
            const auto pause = feeder.report().playing ? look_every : idle_every;
            woken.wait_for(lock, stop, pause, [] { return false; });
        }
        feeder.close();
    }
};

Speaker::Speaker(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Speaker::Speaker(Speaker&&) noexcept = default;
Speaker& Speaker::operator=(Speaker&&) noexcept = default;
Speaker::~Speaker() = default;

Result<Speaker> Speaker::start(Fill fill) { return start(std::move(fill), open_openal); }

Result<Speaker> Speaker::start(Fill fill, OpenSink open) {
    auto shared = std::make_unique<Shared>(std::move(fill), std::move(open));
    try {
        shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    } catch (const std::system_error& error) {
        return fail(ErrorCode::failed, fmt::format("the thread for sound does not start: {}", error.what()));
    }
    return Speaker(std::move(shared));
}

void Speaker::set_volume(double volume) { shared_->volume.store(volume, std::memory_order_relaxed); }

const Report& Speaker::report() {
    shared_->reports.update();
    return shared_->reports.latest();
}

std::optional<std::string> Speaker::news() {
    Shared& s = *shared_;
    const Report& now = report();
    if (!now.playing && now.trouble.empty()) return std::nullopt;  // it has not tried yet
    if (s.told_playing == now.playing) return std::nullopt;
    s.told_playing = now.playing;
    if (now.playing) return fmt::format("sound: {}", now.device);
    return fmt::format("no sound: {}", now.trouble);
}

}  // namespace bolt::audio
