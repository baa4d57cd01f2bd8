#include "game/sound/playback.hpp"

#include <algorithm>
#include <cmath>

#include "engine/audio/sink.hpp"

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

Live::Live(const servo::Setup& setup, Ear ear, std::shared_ptr<Feed> feed, audio::Speaker speaker)
    : setup_(&setup), ear_(std::move(ear)), feed_(std::move(feed)), speaker_(std::move(speaker)) {}

Result<Live> Live::start(const servo::Setup& setup, std::vector<Met> still) {
    return start(setup, std::move(still), audio::open_openal);
}

Result<Live> Live::start(const servo::Setup& setup, std::vector<Met> still, audio::OpenSink open) {
    auto feed = std::make_shared<Feed>(make_synth(setup, audio::rate), setup.dt);
    BOLT_TRY_ASSIGN(
        auto speaker,
        audio::Speaker::start([feed](std::span<float> samples) { feed->fill(samples); }, std::move(open)));
    Ear ear;
    ear.still = std::move(still);
    return Live(setup, std::move(ear), std::move(feed), std::move(speaker));
}

Soundtrack::Soundtrack(audio::WavWriter wav, const servo::Setup& setup, std::vector<Met> still, double from)
    : wav_(std::move(wav)), track_(make_synth(setup, rate), setup.dt), from_(from) {
    ear_.still = std::move(still);
}

Result<Soundtrack> Soundtrack::create(const std::filesystem::path& wav, const servo::Setup& setup,
                                      std::vector<Met> still, double from) {
    BOLT_TRY_ASSIGN(auto file, audio::WavWriter::create(wav, rate));
    return Soundtrack(std::move(file), setup, std::move(still), from);
}

Status Soundtrack::hear(const servo::Setup& setup, const Audible& world, const Cues& cues, double time) {
    const std::span<const float> samples = track_.next(sound::hear(ear_, setup, world, cues));
    // Half a tick's grace: a time is a count of ticks, rounded.
    return time < from_ - 0.5 * setup.dt ? Status() : wav_.write(samples);
}

}  // namespace bolt::sound
