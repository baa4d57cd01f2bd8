#include "game/trainer/captions.hpp"

#include <algorithm>

namespace bolt::trainer {

namespace {

constexpr float soft_strike = 0.08F;               // m/s; what is softer is hardly heard
constexpr float slow_slide = 0.02F, light = 1.0F;  // m/s; N
constexpr float slow_run = 2.0F;                   // rad/s
constexpr float some_load = 0.3F;
constexpr double enough_creep = 0.02;    // rad under load: it sticks and lets go some times (sound/synth.cpp)
constexpr double creep_forgotten = 1.0;  // s in which it is
constexpr double goes_on = 0.15;         // s that other sounds have to last to be worth a line
constexpr double forgets = 3.0;  // times as fast as they were heard they are forgotten when they have stopped

double& of(std::array<double, caption_count>& all, Caption caption) {
    return all.at(static_cast<std::size_t>(caption));
}

void say(Captions& captions, Caption caption, bool now) {
    if (now) of(captions.left, caption) = caption_stands;
}

// Of what goes on: shares of what it takes to be said. A hand at a mouse moves in jerks, and so do the
// sounds.
void gather(Captions& captions, Caption caption, double more, double less) {
    double& heard = of(captions.heard, caption);
    say(captions, caption, more > 0.0 && heard + more >= 1.0);
    heard = std::clamp(heard + more - less, 0.0, 1.0);
}

void lasting(Captions& captions, Caption caption, bool now, double dt) {
    gather(captions, caption, now ? dt / goes_on : 0.0, now ? 0.0 : forgets * dt / goes_on);
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
    const double crept = heard.load > some_load ? static_cast<double>(heard.creep) * dt : 0.0;
    gather(captions, Caption::groan, crept / enough_creep, dt / creep_forgotten);
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
