#include "engine/audio/feeder.hpp"

#include <algorithm>
#include <array>

namespace bolt::audio {

void Feeder::update(double now, double volume) {
    if (!sink_) open(now);
    if (!sink_) return;
    if (Status fed = feed(volume); !fed) lose(now, fed.error());
}

void Feeder::open(double now) {
    if (tried_ && now < next_attempt_) return;
    tried_ = true;
    Result<std::unique_ptr<Sink>> opened = open_();
    if (!opened) {
        status_.problem = opened.error().message();
        next_attempt_ = now + pause_;
        pause_ = std::min(2.0 * pause_, longest_pause);
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
    BOLT_TRY_ASSIGN(const auto room, sink_->room());
    for (std::size_t i = 0; i < room; ++i) {
        std::array<float, block> samples{};
        fill_(samples);
        BOLT_TRY(sink_->play(samples));
        pause_ = first_pause;  // reset only after playing: a device that fails right after opening keeps its
                               // growing pause
        ++status_.blocks;
    }
    return {};
}

void Feeder::lose(double now, const Error& why) {
    sink_.reset();
    status_.playing = false;
    status_.problem = why.message();
    ++status_.losses;
    next_attempt_ = now + pause_;
    pause_ = std::min(2.0 * pause_, longest_pause);
}

}  // namespace bolt::audio
