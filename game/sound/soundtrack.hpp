// A replayed session's sound as a file: every tick is heard from the first on, so that what is written is
// what the lesson sounded like, and what lies before `from` is left out.
#pragma once

#include "engine/audio/wav.hpp"
#include "game/sound/event_detection.hpp"
#include "game/sound/track.hpp"

namespace bolt::sound {

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
