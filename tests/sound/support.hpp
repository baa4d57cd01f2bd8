// What sound tests share: ticks made by hand, spectra, a simulated lesson that is listened to.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <functional>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/session/lesson_session.hpp"
#include "game/sound/event_detection.hpp"
#include "game/sound/playback.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/servo/support.hpp"
#include "tests/support/haptic_world.hpp"

namespace bolt::test {

inline constexpr int rate = 48000;

inline double loudest(std::span<const float> samples) {
    double most = 0.0;
    for (const float s : samples) most = std::max(most, std::abs(static_cast<double>(s)));
    return most;
}

inline double rms(std::span<const float> samples) {
    double sum = 0.0;
    for (const float s : samples) sum += square(static_cast<double>(s));
    return samples.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(samples.size()));
}

inline double steepest_step(std::span<const float> samples) {
    double most = 0.0;
    for (std::size_t i = 1; i < samples.size(); ++i)
        most =
            std::max(most, std::abs(static_cast<double>(samples[i]) - static_cast<double>(samples[i - 1])));
    return most;
}

// How much of a frequency there is, by its Fourier sum under a Hann window.
inline double amount(std::span<const float> samples, double frequency) {
    const auto n = static_cast<double>(samples.size());
    const std::complex<double> turn = std::polar(1.0, 2.0 * pi * frequency / rate),
                               slow = std::polar(1.0, 2.0 * pi / n);
    std::complex<double> phase = 1.0, window = 1.0, sum = 0.0;
    for (const float sample : samples) {
        sum += static_cast<double>(sample) * (1.0 - window.real()) * phase;
        phase *= turn;
        window *= slow;
    }
    return std::abs(sum) / n;
}

inline double dominant(std::span<const float> samples, double from, double to, double step) {
    double best = 0.0, most = -1.0;
    for (double f = from; f <= to; f += step) {
        const double found = amount(samples, f);
        if (found > most) {
            most = found;
            best = f;
        }
    }
    return best;
}

// So many seconds of one thing that is heard over and over.
inline std::vector<float> listen(sound::Synth& synth, const sound::Heard& heard, double seconds) {
    sound::sound(synth, heard);
    std::vector<float> samples(static_cast<std::size_t>(seconds * rate));
    sound::render(synth, samples);
    return samples;
}

// A lesson as boltwright train plays it, listened to and recorded; `visit` gets every tick's output and
// samples.
using Visit = std::function<void(const servo::Output&, const sound::Heard&, std::span<const float>)>;
inline session::Played hear_lesson(const char* name, const char* trainee, double longest, const char* tool,
                                   const std::filesystem::path& session, const Visit& visit) {
    content::Loaded loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, tool));
    session::CourseOptions options;
    options.obstacles = session::Obstacles::required;
    auto begun = session::Course::begin(loaded.assembly, options, session);
    REQUIRE(begun);
    session::Course& course = **begun;
    trainees::Operator hand(trainees::find_profile(trainee).value(), options.seed, course.setup());
    sound::Ear ear;
    ear.still = sound::materials(course.assembly(), course.obstacle_names());
    sound::Track track(sound::make_synth(course.setup(), rate), course.setup().dt);
    world::World world;
    world::add_haptics(world, course.state());
    while (!course.over() && course.time() < longest) {
        const auto output = course.step(hand.act(course.setup(), course.state(), course.lesson()));
        REQUIRE(output);
        world::write_joints(world, course.state().joints, course.state().rounded);
        world::write_output(world, *output);
        const sound::Heard heard = sound::hear(ear, course.setup(), world, sound::cues_of(course.events()));
        visit(*output, heard, track.next(heard));
    }
    const auto played = course.finish();
    REQUIRE(played);
    return *played;
}

}  // namespace bolt::test
