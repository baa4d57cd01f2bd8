// The sound of a lesson while it is played: ear, synthesiser, feed and speaker put together for whoever steps
// the ticks.
#pragma once

#include <memory>
#include <vector>

#include "engine/audio/speaker.hpp"
#include "game/sound/event_detection.hpp"
#include "game/sound/feed.hpp"

namespace bolt::sound {

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

}  // namespace bolt::sound
