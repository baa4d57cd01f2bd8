#include "game/sound/playback.hpp"

#include <algorithm>
#include <cmath>

#include "engine/audio/sink.hpp"

namespace bolt::sound {

CueQueue::CueQueue(Synth synth, double dt)
    : synth_(std::move(synth)), dt_(dt), ticks_(static_cast<std::size_t>(2.0 * max_age / dt)) {}

void CueQueue::push(const SoundCues& cues) {
    if (!ticks_.push(cues)) dropped_.fetch_add(1, std::memory_order_relaxed);
}

void CueQueue::fill(std::span<float> samples) {
    SoundCues cues;
    const double duration = static_cast<double>(samples.size()) / synth_.rate;  // s
    for (auto over = static_cast<std::int64_t>(ticks_.size()) - std::lround(max_age / dt_);
         over > 0 && ticks_.pop(cues); --over)
        dropped_.fetch_add(1, std::memory_order_relaxed);
    const auto waiting = static_cast<double>(ticks_.size());
    // Consumes as many ticks as the samples last, or more, so that the queue would be empty after
    // catch_up_time.
    tick_remainder_ += std::max(duration / dt_, waiting * std::min(1.0, duration / catch_up_time));
    const auto count = static_cast<std::size_t>(std::min(tick_remainder_, waiting));
    tick_remainder_ = std::min(tick_remainder_ - static_cast<double>(count), 1.0);

    if (count == 0) {
        time_without_ticks_ += duration;
        if (time_without_ticks_ > silence_timeout) fade_out(synth_);
        render(synth_, samples);
        return;
    }
    time_without_ticks_ = 0.0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!ticks_.pop(cues)) break;
        apply_cues(synth_, cues);
        const std::size_t end = samples.size() * (i + 1) / count;
        render(synth_, samples.subspan(begin, end - begin));
        begin = end;
    }
}

LiveSound::LiveSound(const servo::Setup& setup, EventDetector detector, std::shared_ptr<CueQueue> queue,
                     audio::Speaker speaker)
    : setup_(&setup),
      detector_(std::move(detector)),
      queue_(std::move(queue)),
      speaker_(std::move(speaker)) {}

Result<LiveSound> LiveSound::start(const servo::Setup& setup, std::vector<StruckSurface> surfaces) {
    return start(setup, std::move(surfaces), audio::open_openal);
}

Result<LiveSound> LiveSound::start(const servo::Setup& setup, std::vector<StruckSurface> surfaces,
                                   audio::OpenSink open) {
    auto queue = std::make_shared<CueQueue>(make_synth(setup, audio::sample_rate), setup.dt);
    BOLT_TRY_ASSIGN(
        auto speaker,
        audio::Speaker::start([queue](std::span<float> samples) { queue->fill(samples); }, std::move(open)));
    EventDetector detector;
    detector.surfaces = std::move(surfaces);
    return LiveSound(setup, std::move(detector), std::move(queue), std::move(speaker));
}

Soundtrack::Soundtrack(audio::WavWriter wav, const servo::Setup& setup, std::vector<StruckSurface> surfaces,
                       double from)
    : wav_(std::move(wav)), renderer_(make_synth(setup, rate), setup.dt), from_(from) {
    detector_.surfaces = std::move(surfaces);
}

Result<Soundtrack> Soundtrack::create(const std::filesystem::path& wav, const servo::Setup& setup,
                                      std::vector<StruckSurface> surfaces, double from) {
    BOLT_TRY_ASSIGN(auto file, audio::WavWriter::create(wav, rate));
    return Soundtrack(std::move(file), setup, std::move(surfaces), from);
}

Status Soundtrack::add_tick(const servo::Setup& setup, const Audible& world, const LessonCues& lesson,
                            double time) {
    const std::span<const float> samples =
        renderer_.next(sound::detect_events(detector_, setup, world, lesson));
    // The tolerance of half a tick covers the rounding of `time`.
    return time < from_ - 0.5 * setup.dt ? Status() : wav_.write(samples);
}

}  // namespace bolt::sound
