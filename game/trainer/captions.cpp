#include "game/trainer/captions.hpp"

#include <algorithm>

namespace bolt::trainer {

namespace {

constexpr float soft_strike = 0.08F;               // m/s; what is softer is hardly heard
constexpr float slow_slide = 0.02F, light = 1.0F;  // m/s; N
constexpr float slow_run = 2.0F;                   // rad/s
constexpr float slow_creep = 0.01F, some_load = 0.3F;
constexpr double goes_on = 0.15;  // s that a sound has to last to be worth a line
constexpr double forgets = 3.0;   // times as fast as it was heard, what has stopped is forgotten

double& of(std::array<double, caption_count>& all, Caption caption) {
    return all.at(static_cast<std::size_t>(caption));
}

void say(Captions& captions, Caption caption, bool now) {
    if (now) of(captions.left, caption) = caption_stands;
}

void lasting(Captions& captions, Caption caption, bool now, double dt) {
    double& heard = of(captions.heard, caption);
    heard = std::clamp(heard + (now ? dt : -forgets * dt), 0.0, goes_on);
    say(captions, caption, now && heard >= goes_on);
}

}  // namespace

void note(Captions& captions, const sound::Heard& heard, double dt) {
    const bool struck = heard.strike > soft_strike;
    say(captions, Caption::slip, heard.slip > 0.0F);
    say(captions, Caption::mistake, heard.mistake);
    say(captions, Caption::click, heard.click);
    say(captions, Caption::done, heard.done);
    say(captions, Caption::strike_casing, struck && heard.met == sound::Met::casing);
    say(captions, Caption::strike_nut, struck && heard.met == sound::Met::nut);
    lasting(captions, Caption::groan, heard.creep > slow_creep && heard.load > some_load, dt);
    lasting(captions, Caption::scrape, heard.slide > slow_slide && heard.press > light, dt);
    lasting(captions, Caption::run, heard.run > slow_run, dt);
}

void update(Captions& captions, double seconds) {
    for (double& left : captions.left) left = std::max(0.0, left - seconds);
}

std::vector<Caption> shown(const Captions& captions) {
    std::vector<Caption> all;
    for (std::size_t i = 0; i < caption_count && all.size() < most_captions; ++i)
        if (captions.left.at(i) > 0.0) all.push_back(static_cast<Caption>(i));
    return all;
}

words::Key term(Caption caption) {
    constexpr words::Key keys[] = {"caption.slip",  "caption.mistake",       "caption.click",
                                   "caption.done",  "caption.strike_casing", "caption.strike_nut",
                                   "caption.groan", "caption.scrape",        "caption.run"};
    static_assert(std::size(keys) == caption_count);
    return keys[static_cast<std::size_t>(caption)];
}

}  // namespace bolt::trainer
