#include "game/sound/soundtrack.hpp"

namespace bolt::sound {

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
