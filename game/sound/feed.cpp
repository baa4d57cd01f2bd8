#include "game/sound/feed.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::sound {

Feed::Feed(Synth synth, double dt)
    : synth_(std::move(synth)), dt_(dt), ticks_(static_cast<std::size_t>(2.0 * stale / dt)) {}

void Feed::push(const Heard& heard) {
    if (!ticks_.push(heard)) lost_.fetch_add(1, std::memory_order_relaxed);
}

void Feed::fill(std::span<float> samples) {
    Heard heard;
    const double lasts = static_cast<double>(samples.size()) / synth_.rate;  // s
    for (auto over = static_cast<std::int64_t>(ticks_.size()) - std::lround(stale / dt_);
         over > 0 && ticks_.pop(heard); --over)
        lost_.fetch_add(1, std::memory_order_relaxed);
    const auto waiting = static_cast<double>(ticks_.size());
    // As many as last as long as the samples do, or so many more that all would be gone in `behind`.
    owed_ += std::max(lasts / dt_, waiting * std::min(1.0, lasts / behind));
    const auto count = static_cast<std::size_t>(std::min(owed_, waiting));
    owed_ = std::min(owed_ - static_cast<double>(count), 1.0);

    if (count == 0) {
        quiet_ += lasts;
        if (quiet_ > patience) rest(synth_);
        render(synth_, samples);
        return;
    }
    quiet_ = 0.0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!ticks_.pop(heard)) break;
        sound(synth_, heard);
        const std::size_t end = samples.size() * (i + 1) / count;
        render(synth_, samples.subspan(begin, end - begin));
        begin = end;
    }
}

}  // namespace bolt::sound
