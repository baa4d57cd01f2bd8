// Measurements of samples, and a simulated lesson rendered to samples.
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

// Amplitude of a frequency: Fourier sum under a Hann window.
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

// Renders some seconds with constant cues.
inline std::vector<float> listen(sound::Synth& synth, const sound::SoundCues& cues, double seconds) {
    sound::apply_cues(synth, cues);
    std::vector<float> samples(static_cast<std::size_t>(seconds * rate));
    sound::render(synth, samples);
    return samples;
}

// Runs a lesson as boltwright train does and records it to `session`. Calls `visit` with each tick's output,
// cues and samples.
using Visit = std::function<void(const servo::Output&, const sound::SoundCues&, std::span<const float>)>;
inline session::LessonOutcome run_lesson(const char* name, const char* trainee, double longest,
                                         const char* tool, const std::filesystem::path& session,
                                         const Visit& visit) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, tool));
    session::LessonOptions options;
    options.obstacles = session::ObstacleUse::required;
    auto started = session::LessonSession::begin(loaded.assembly, options, session);
    REQUIRE(started);
    session::LessonSession& lesson_session = **started;
    trainees::SimulatedTrainee hand(trainees::find_profile(trainee).value(), options.seed,
                                    lesson_session.setup());
    sound::EventDetector detector;
    detector.surfaces = sound::struck_surfaces(lesson_session.assembly(), lesson_session.obstacle_names());
    sound::CueRenderer renderer(sound::make_synth(lesson_session.setup(), rate), lesson_session.setup().dt);
    world::World world;
    world::add_haptics(world, lesson_session.state());
    while (!lesson_session.finished() && lesson_session.time() < longest) {
        const auto output = lesson_session.tick(
            world, hand.act(lesson_session.setup(), lesson_session.state(), lesson_session.lesson()));
        REQUIRE(output);
        const sound::SoundCues cues = sound::detect_events(detector, lesson_session.setup(), world,
                                                           sound::lesson_cues(lesson_session.events()));
        visit(*output, cues, renderer.next(cues));
    }
    const auto outcome = lesson_session.finish(world);
    REQUIRE(outcome);
    return *outcome;
}

}  // namespace bolt::test
