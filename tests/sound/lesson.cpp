// A whole simulated lesson, listened to.

#include "engine/audio/wav.hpp"

#include <bit>

#include "engine/base/file.hpp"
#include "game/session/replay.hpp"
#include "tests/sound/support.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;

namespace {

// How loud it was while something was the case: 20 ms at a time, the median and the most.
struct Level {
    std::vector<double> pieces;
    std::vector<float> samples;

    void add(std::span<const float> more) {
        samples.insert(samples.end(), more.begin(), more.end());
        if (samples.size() < 960) return;
        pieces.push_back(test::rms(samples));
        samples.clear();
    }
    [[nodiscard]] double share(double part) {
        REQUIRE(pieces.size() > 10);
        std::sort(pieces.begin(), pieces.end());
        return pieces[static_cast<std::size_t>(part * static_cast<double>(pieces.size() - 1))];
    }
};

struct Sum {
    std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
    void add(std::span<const float> samples) {
        for (const float s : samples) hash = (hash ^ std::bit_cast<std::uint32_t>(s)) * 1099511628211ULL;
    }
};

}  // namespace

TEST_CASE("an expert's lesson can be heard: its stages differ, its steps chime, its wrench clicks") {
    const test::Folder folder;
    const auto path = folder / "lesson.wav";
    auto wav = audio::WavWriter::create(path, test::rate);
    REQUIRE(wav);
    Level air, spun, half, full;
    int clicks = 0, felt = 0, chimes = 0, mistakes = 0, strikes = 0;
    std::size_t count = 0, ticks = 0, since = 0;
    double most = 0.0, step = 0.0;
    float before = 0.0F;
    const session::Played played = test::hear_lesson(
        "cover-m8", "expert", 300.0, "torque_wrench", folder / "a.boltwright",
        [&](const servo::Output& output, const sound::Heard& heard, std::span<const float> samples) {
            REQUIRE(wav->write(samples));
            ++ticks;
            count += samples.size();
            for (const float s : samples) {
                most = std::max(most, std::abs(static_cast<double>(s)));
                step = std::max(step, std::abs(static_cast<double>(s - before)));
                before = s;
            }
            clicks += heard.click ? 1 : 0;
            chimes += heard.done ? 1 : 0;
            mistakes += heard.mistake ? 1 : 0;
            strikes += heard.strike > 0.0F ? 1 : 0;
            felt += output.clicked ? 1 : 0;
            // Away from what rings on for itself.
            since = heard.click || heard.done || heard.strike > 0.0F ? 0 : since + 1;
            if (since < 2000) return;
            if (output.joint < 0 && output.touched.is_none()) air.add(samples);
            if (heard.run > 5.0F) spun.add(samples);
            if (heard.creep > 0.2F && heard.load > 0.2F && heard.load < 0.4F) half.add(samples);
            if (heard.creep > 0.2F && heard.load > 0.6F) full.add(samples);
        });
    REQUIRE(wav->finish());
    REQUIRE(played.result.finished);
    CHECK(chimes == 16);  // four nuts: run down, half, full, looked at again
    CHECK(mistakes == 0);
    CHECK(clicks == felt);
    CHECK(clicks >= 8);  // four nuts to half and to their full torque; a check ends before where one moves
    CHECK(strikes > 4);
    CHECK(strikes < 100);
    CHECK(most < 1.0);
    CHECK(step <= 1.0001 * sound::steepest / test::rate);
    // In the air all is silent but for what rings out.
    CHECK(air.share(0.5) < 2e-3);
    CHECK(spun.share(0.5) > 0.02);
    CHECK(half.share(0.5) > 2e-3);
    CHECK(full.share(0.5) > 2.5 * half.share(0.5));
    CHECK(count == ticks * 48);
    const auto bytes = read_file(path, 1U << 28U, ErrorCode::failed);
    std::filesystem::remove(path);
    REQUIRE(bytes);
    CHECK(bytes->size() == 44 + 2 * count);
}

TEST_CASE("a replay sounds as the lesson did, sample for sample") {
    const test::Folder folder;
    Sum lesson;
    int strikes = 0, chimes = 0, clicks = 0;
    test::hear_lesson("cover-m8", "expert", 60.0, "torque_wrench", folder / "a.boltwright",
                      [&](const servo::Output&, const sound::Heard& heard, std::span<const float> samples) {
                          lesson.add(samples);
                          strikes += heard.strike > 0.0F ? 1 : 0;
                          chimes += heard.done ? 1 : 0;
                          clicks += heard.click ? 1 : 0;
                      });
    CHECK(clicks > 0);
    CHECK(strikes > 0);
    CHECK(chimes > 4);
    const auto reader = session::Reader::open(folder / "a.boltwright");
    REQUIRE(reader);
    for (const bool changed : {false, true}) {
        auto again = session::prepare_again(*reader);
        REQUIRE(again);
        sound::Ear ear;
        ear.still = sound::materials(again->assembly, again->obstacle_names);
        sound::Track track(sound::make_synth(again->setup, test::rate), again->setup.dt);
        Sum replay;
        world::World world;
        world::add_haptics(world, again->state);
        const auto replayed = session::replay(*reader, std::move(*again), [&](const session::Moment& moment) {
            servo::Output output = moment.output;
            if (changed) output.clicked = false;
            const sound::Cues cues = sound::cues_of(moment.lesson.events);
            world::write_snapshot(world, {moment.state, moment.input, output});
            replay.add(track.next(sound::hear(ear, moment.setup, world, cues)));
            return true;
        });
        REQUIRE(replayed);
        CHECK(replayed->wrong == 0);
        CHECK((replay.hash == lesson.hash) != changed);
    }
}
