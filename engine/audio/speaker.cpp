#include "engine/audio/speaker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include "engine/audio/sink.hpp"
#include "engine/base/lock_free.hpp"

namespace bolt::audio {

void Feeder::update(double now, double volume) {
    if (!sink_) open(now);
    if (!sink_) return;
    if (Status fed = feed(volume); !fed) handle_loss(now, fed.error());
}

void Feeder::open(double now) {
    if (attempted_ && now < next_attempt_) return;
    attempted_ = true;
    Result<std::unique_ptr<Sink>> opened = open_();
    if (!opened) {
        status_.problem = opened.error().message();
        next_attempt_ = now + pause_;
        pause_ = std::min(2.0 * pause_, max_pause);
        return;
    }
    sink_ = std::move(*opened);
    volume_ = -1.0;
    status_.playing = true;
    status_.device = sink_->name();
    status_.problem.clear();
    ++status_.openings;
}

Status Feeder::feed(double volume) {
    volume = std::clamp(volume, 0.0, 1.0);
    if (volume != volume_) {
        BOLT_TRY(sink_->set_volume(volume));
        volume_ = volume;
    }
    BOLT_TRY_ASSIGN(const auto free_blocks, sink_->free_blocks());
    for (std::size_t i = 0; i < free_blocks; ++i) {
        std::array<float, block_size> samples{};
        fill_(samples);
        BOLT_TRY(sink_->play(samples));
        // Reset only after playing: for a device that fails right after opening, the pause keeps growing.
        pause_ = first_pause;
        ++status_.blocks;
    }
    return {};
}

void Feeder::handle_loss(double now, const Error& error) {
    sink_.reset();
    status_.playing = false;
    status_.problem = error.message();
    ++status_.losses;
    next_attempt_ = now + pause_;
    pause_ = std::min(2.0 * pause_, max_pause);
}

namespace {

// Half a block, so that the sink is polled twice per block.
constexpr auto feed_interval = std::chrono::milliseconds(5);
// Without a sink the thread only checks whether the next attempt to open one is due.
constexpr auto retry_interval = std::chrono::milliseconds(200);

// Returns whether to publish the status. A new block count alone is published ten times per second.
bool is_worth_publishing(const PlaybackStatus& now, const PlaybackStatus& before) {
    return now.playing != before.playing || now.problem != before.problem ||
           now.openings != before.openings || now.losses != before.losses || now.blocks >= before.blocks + 10;
}

}  // namespace

struct Speaker::Shared {
    Shared(FillSamples fill, OpenSink open) : feeder(std::move(open), std::move(fill)) {}

    Feeder feeder;
    std::atomic<double> volume{1.0};
    TripleBuffer<PlaybackStatus> published;
    std::mutex mutex;
    std::condition_variable_any stop_condition;
    std::optional<bool> reported_playing;  // `playing` in the last line that status_change() returned
    std::jthread thread;  // the last member: it joins before the members that it uses are destroyed

    void run(const std::stop_token& stop) {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point begin = Clock::now();
        PlaybackStatus before;
        while (!stop.stop_requested()) {
            const double now = std::chrono::duration<double>(Clock::now() - begin).count();
            feeder.update(now, volume.load(std::memory_order_relaxed));
            if (const PlaybackStatus& current = feeder.status(); is_worth_publishing(current, before)) {
                before = current;
                published.write(current);
            }
            std::unique_lock lock(mutex);
            const auto pause = feeder.status().playing ? feed_interval : retry_interval;
            stop_condition.wait_for(lock, stop, pause, [] { return false; });
        }
        feeder.close();
    }
};

Speaker::Speaker(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Speaker::Speaker(Speaker&&) noexcept = default;
Speaker& Speaker::operator=(Speaker&&) noexcept = default;
Speaker::~Speaker() = default;

Result<Speaker> Speaker::start(FillSamples fill) { return start(std::move(fill), open_openal); }

Result<Speaker> Speaker::start(FillSamples fill, OpenSink open) {
    auto shared = std::make_unique<Shared>(std::move(fill), std::move(open));
    try {
        shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    } catch (const std::system_error& error) {
        return fail(ErrorCode::failed, fmt::format("the sound thread cannot be started: {}", error.what()),
                    "a system that can start another thread");
    }
    return Speaker(std::move(shared));
}

void Speaker::set_volume(double volume) { shared_->volume.store(volume, std::memory_order_relaxed); }

const PlaybackStatus& Speaker::status() {
    shared_->published.update();
    return shared_->published.latest();
}

std::optional<std::string> Speaker::status_change() {
    Shared& s = *shared_;
    const PlaybackStatus& now = status();
    if (!now.playing && now.problem.empty()) return std::nullopt;  // no attempt has been made yet
    if (s.reported_playing == now.playing) return std::nullopt;
    s.reported_playing = now.playing;
    if (now.playing) return fmt::format("sound: {}", now.device);
    return fmt::format("no sound: {}", now.problem);
}

}  // namespace bolt::audio
