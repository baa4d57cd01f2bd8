#include "engine/audio/feeder.hpp"

#include <algorithm>
#include <array>

namespace bolt::audio {

void Feeder::turn(double now, double volume) {
    if (!sink_) open(now);
    if (!sink_) return;
    if (Status fed = feed(volume); !fed) lose(now, fed.error());
}

void Feeder::open(double now) {
    if (tried_ && now < next_attempt_) return;
    tried_ = true;
    Result<std::unique_ptr<Sink>> opened = open_();
    if (!opened) {
        report_.trouble = opened.error().message();
        next_attempt_ = now + pause_;
        pause_ = std::min(2.0 * pause_, longest_pause);
        return;
    }
    sink_ = std::move(*opened);
    volume_ = -1.0;
    report_.playing = true;
    report_.device = sink_->name();
    report_.trouble.clear();
    ++report_.openings;
}

Status Feeder::feed(double volume) {
    volume = std::clamp(volume, 0.0, 1.0);
    if (volume != volume_) {
        if (Status set = sink_->set_volume(volume); !set) return set;
        volume_ = volume;
    }
    const Result<std::size_t> room = sink_->room();
    if (!room) return fail(room.error());
    for (std::size_t i = 0; i < *room; ++i) {
        std::array<float, block> samples{};
        fill_(samples);
        if (Status played = sink_->play(samples); !played) return played;
        pause_ = first_pause;  // it does play: a card that opens and fails at once is not asked ever faster
        ++report_.blocks;
    }
    return {};
}

void Feeder::lose(double now, const Error& why) {
    sink_.reset();
    report_.playing = false;
    report_.trouble = why.message();
    ++report_.losses;
    next_attempt_ = now + pause_;
    pause_ = std::min(2.0 * pause_, longest_pause);
}

}  // namespace bolt::audio
