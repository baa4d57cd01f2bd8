#include "game/sound/live.hpp"

#include "engine/audio/openal.hpp"

namespace bolt::sound {

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

}  // namespace bolt::sound
