// Plays the cues of a lesson: live on the speaker (LiveSound), or into a file (Soundtrack).
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/audio/speaker.hpp"
#include "engine/audio/wav.hpp"
#include "engine/base/lock_free.hpp"
#include "game/sound/event_detection.hpp"
#include "game/sound/synth.hpp"

namespace bolt::sound {

// Passes cues from the frame's thread to the speaker's thread, where it renders them. Neither thread waits.
//
// Ticks arrive in bursts, one per frame, and are consumed evenly. The longer the queue, the faster it is
// consumed, so that a burst is used up within about catch_up_time. This does not raise the pitch, as cues are
// speeds and forces, not samples. Without new ticks the last cues last for silence_timeout, then the sound
// fades out.
//
// Must outlive the speaker that it fills.
class CueQueue {
  public:
    static constexpr double catch_up_time = 0.04;    // s
    static constexpr double silence_timeout = 0.25;  // s without a tick
    static constexpr double max_age = 0.5;           // s; ticks that waited for longer are dropped

    CueQueue(Synth synth, double dt);  // `dt`: s per tick

    // For one thread: the producer of the ticks.
    void push(const SoundCues& cues);

    // For one other thread: the speaker's. Does not allocate.
    void fill(std::span<float> samples);

    // Number of ticks that were never rendered, because the queue was full or they were too old.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

  private:
    Synth synth_;
    double dt_;
    SpscRing<SoundCues> ticks_;
    double time_without_ticks_ = 0.0;  // s
    double tick_remainder_ = 0.0;      // fraction of a tick that is still to be consumed
    std::atomic<std::uint64_t> dropped_{0};
};

// The live sound of a lesson: event detection, queue, synthesiser and speaker. For one thread, which steps
// the ticks.
class LiveSound {
  public:
    // Returns at once, also if there is no sound device; status_change() reports that. `setup` must outlive
    // the result. `surfaces`: result of struck_surfaces.
    static Result<LiveSound> start(const servo::Setup& setup, std::vector<StruckSurface> surfaces);
    static Result<LiveSound> start(const servo::Setup& setup, std::vector<StruckSurface> surfaces,
                                   audio::OpenSink open);

    void add_tick(const Audible& world, const LessonCues& lesson) {
        queue_->push(detect_events(detector_, *setup_, world, lesson));
    }
    void set_volume(double volume) { speaker_.set_volume(volume); }  // 0 … 1

    // Returns a message for the user once after each change of the device's state.
    std::optional<std::string> status_change() { return speaker_.status_change(); }

  private:
    LiveSound(const servo::Setup& setup, EventDetector detector, std::shared_ptr<CueQueue> queue,
              audio::Speaker speaker);

    const servo::Setup* setup_;
    EventDetector detector_;
    std::shared_ptr<CueQueue> queue_;  // shared with the speaker's callback
    audio::Speaker speaker_;
};

// Renders tick by tick, without a queue. If the samples per tick are not a whole number, their number varies
// by one from tick to tick, so that the total matches the duration of all ticks.
class CueRenderer {
  public:
    CueRenderer(Synth synth, double dt) : synth_(std::move(synth)), samples_per_tick_(synth_.rate * dt) {}

    // Returns the samples of the next tick; valid until the next call.
    std::span<const float> next(const SoundCues& cues) {
        apply_cues(synth_, cues);
        const double before = std::floor(samples_per_tick_ * static_cast<double>(ticks_));
        const double after = std::floor(samples_per_tick_ * static_cast<double>(++ticks_));
        samples_.resize(static_cast<std::size_t>(after - before));
        render(synth_, samples_);
        return samples_;
    }

  private:
    Synth synth_;
    double samples_per_tick_;
    std::uint64_t ticks_ = 0;
    std::vector<float> samples_;
};

// The sound of a replayed session as a file. Renders every tick from the first one on, so that the sound
// equals that of the lesson, and writes the samples from a given time on.
class Soundtrack {
  public:
    static constexpr int rate = 48000;  // Hz

    // `surfaces`: result of struck_surfaces. `from`: time of the lesson, s, at which the file begins. Fails
    // if the file cannot be written.
    static Result<Soundtrack> create(const std::filesystem::path& wav, const servo::Setup& setup,
                                     std::vector<StruckSurface> surfaces, double from = 0.0);

    // Adds the tick that ends at `time` (s).
    Status add_tick(const servo::Setup& setup, const Audible& world, const LessonCues& lesson, double time);

    // Completes the file, which exists only from then on.
    Status finish() { return wav_.finish(); }

  private:
    Soundtrack(audio::WavWriter wav, const servo::Setup& setup, std::vector<StruckSurface> surfaces,
               double from);

    audio::WavWriter wav_;
    EventDetector detector_;
    CueRenderer renderer_;
    double from_ = 0.0;
};

}  // namespace bolt::sound
