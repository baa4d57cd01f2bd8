// Ticks on their way from the picture's thread to the speaker's, which makes them sound: neither waits.
//
// Ticks come in bursts, one a picture, and are needed evenly. What waits is heard a little faster the more of
// it there is, so that a burst is used up within some `behind`; speeds and forces are heard, not samples, so
// that no pitch rises with it. When none come, what goes on goes on for a moment, and then comes to rest.
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

// Outlives the speaker that it fills.
class Feed {
  public:
    static constexpr double behind = 0.04;    // s
    static constexpr double patience = 0.25;  // s without a tick
    static constexpr double stale = 0.5;      // s: what waited for longer is not heard any more

    Feed(Synth synth, double dt);

    // For one caller: who takes the ticks.
    void push(const Heard& heard);

    // For one other: the speaker's thread. Allocates nothing.
    void fill(std::span<float> samples);

    // Ticks that were never heard: nobody filled, or too late.
    [[nodiscard]] std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

  private:
    Synth synth_;
    double dt_;
    SpscRing<Heard> ticks_;
    double quiet_ = 0.0;  // s since a tick came
    double owed_ = 0.0;   // ticks, less than one
    std::atomic<std::uint64_t> lost_{0};
};

// The sound of a lesson while it is played: ear, synthesiser, feed and speaker put together for whoever steps
// the ticks.

// For one thread, but for the speaker's own.
class Live {
  public:
    // Returns at once, also where there is no sound device: that is news(), and the lesson goes on without.
    // `setup` outlives it; `still` is what materials.hpp says.
    static Result<Live> start(const servo::Setup& setup, std::vector<Met> still);
    static Result<Live> start(const servo::Setup& setup, std::vector<Met> still, audio::OpenSink open);

    void tick(const Audible& world, const Cues& cues) { feed_->push(hear(ear_, *setup_, world, cues)); }
    void set_volume(double volume) { speaker_.set_volume(volume); }  // 0 … 1
    std::optional<std::string> news() {
        return speaker_.status_change();
    }  // a line to show, once for every change

  private:
    Live(const servo::Setup& setup, Ear ear, std::shared_ptr<Feed> feed, audio::Speaker speaker);

    const servo::Setup* setup_;
    Ear ear_;
    std::shared_ptr<Feed> feed_;  // also of the speaker, for as long as it fills
    audio::Speaker speaker_;
};

// A tick's samples after another's, for a file beside a video: as many as the ticks last, whole ones.

class Track {
  public:
    Track(Synth synth, double dt) : synth_(std::move(synth)), each_(synth_.rate * dt) {}

    // Valid until the next call.
    std::span<const float> next(const Heard& heard) {
        sound(synth_, heard);
        const double before = std::floor(each_ * static_cast<double>(ticks_));
        const double after = std::floor(each_ * static_cast<double>(++ticks_));
        samples_.resize(static_cast<std::size_t>(after - before));
        render(synth_, samples_);
        return samples_;
    }

  private:
    Synth synth_;
    double each_;
    std::uint64_t ticks_ = 0;
    std::vector<float> samples_;
};

// A replayed session's sound as a file: every tick is heard from the first on, so that what is written is
// what the lesson sounded like, and what lies before `from` is left out.

class Soundtrack {
  public:
    static constexpr int rate = 48000;  // Hz

    // `still` is what materials.hpp says; `from`: s of the lesson at which the file begins. An error: the
    // file cannot be written.
    static Result<Soundtrack> create(const std::filesystem::path& wav, const servo::Setup& setup,
                                     std::vector<Met> still, double from = 0.0);

    // The tick that ends at `time` (s).
    Status hear(const servo::Setup& setup, const Audible& world, const Cues& cues, double time);

    // Until here there is no file.
    Status finish() { return wav_.finish(); }

  private:
    Soundtrack(audio::WavWriter wav, const servo::Setup& setup, std::vector<Met> still, double from);

    audio::WavWriter wav_;
    Ear ear_;
    Track track_;
    double from_ = 0.0;
};

}  // namespace bolt::sound
