// The sound of a whole simulated lesson.
#include "engine/audio/wav.hpp"

#include <bit>

#include "engine/base/file.hpp"
#include "game/session/replay.hpp"
#include "tests/sound/support.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;

namespace {

// The distribution of loudness over pieces of 20 ms.
struct Loudness {
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

struct SampleHash {
    std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
    void add(std::span<const float> samples) {
        for (const float s : samples) hash = (hash ^ std::bit_cast<std::uint32_t>(s)) * 1099511628211ULL;
    }
};

}  // namespace

TEST_CASE("Lesson sound: stages differ in loudness, steps chime and the torque wrench clicks") {
    const test::Folder folder;
    const auto path = folder / "lesson.wav";
    auto wav = audio::WavWriter::create(path, test::rate);
    REQUIRE(wav);
    Loudness air, spun, half, full;
    int clicks = 0, felt = 0, teeth = 0, chimes = 0, mistakes = 0, strikes = 0;
    std::size_t count = 0, ticks = 0, since = 0;
    double most = 0.0, step = 0.0;
    float before = 0.0F;
    const session::LessonOutcome outcome = test::run_lesson(
        "cover-m8", "expert", 300.0, "torque_wrench", folder / "a.boltwright",
        [&](const servo::Output& output, const sound::SoundCues& cues, std::span<const float> samples) {
            REQUIRE(wav->write(samples));
            ++ticks;
            count += samples.size();
            for (const float s : samples) {
                most = std::max(most, std::abs(static_cast<double>(s)));
                step = std::max(step, std::abs(static_cast<double>(s - before)));
                before = s;
            }
            clicks += cues.click ? 1 : 0;
            chimes += cues.done ? 1 : 0;
            mistakes += cues.mistake ? 1 : 0;
            strikes += cues.strike_speed > 0.0F ? 1 : 0;
            teeth += cues.tooth ? 1 : 0;
            felt += output.clicked ? 1 : 0;
            // Skips the decay of single sounds.
            since = cues.click || cues.done || cues.strike_speed > 0.0F ? 0 : since + 1;
            if (since < 2000) return;
            if (output.joint < 0 && output.touched.is_none()) air.add(samples);
            if (cues.run_speed > 5.0F) spun.add(samples);
            if (cues.creep_speed > 0.2F && cues.load > 0.2F && cues.load < 0.4F) half.add(samples);
            if (cues.creep_speed > 0.2F && cues.load > 0.6F) full.add(samples);
        });
    REQUIRE(wav->finish());
    REQUIRE(outcome.result.finished);
    CHECK(chimes == 16);  // four nuts: run-down, half torque, full torque, re-check
    CHECK(mistakes == 0);
    CHECK(clicks == felt);
    CHECK(teeth == 0);  // the torque wrench has no ratchet
    CHECK(clicks >=
          8);  // four nuts at half and full torque; a re-check ends before the click if the nut moves
    CHECK(strikes > 4);
    CHECK(strikes < 100);
    CHECK(most < 1.0);
    CHECK(step <= 1.0001 * sound::max_slope / test::rate);
    // In the air everything is silent except for decaying sounds.
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

TEST_CASE("Lesson sound: a recorded swing back sounds once for each tooth, in the lesson and in its replay") {
    const test::Folder folder;
    content::LoadedAssembly loaded = content::load_assembly("pump-32-160");
    REQUIRE(loaded.ok());
    auto started = session::LessonSession::begin(loaded.assembly, {}, folder / "a.boltwright");
    REQUIRE(started);
    session::LessonSession& lesson = **started;
    const servo::Setup& setup = lesson.setup();
    const servo::NutGeometry& nut = setup.nuts[0];
    const double tooth_angle = setup.wrench.ratchet.tooth_angle;
    REQUIRE(tooth_angle > 0.0);
    sound::EventDetector live;
    world::World lesson_world;
    world::add_haptics(lesson_world, lesson.state());
    double handle = 0.0;
    const auto heard = [&](double by) {
        const double angle = lesson.state().joints[0].nut.angle;
        handle += by;
        const auto output = lesson.tick(
            lesson_world,
            test::holding(servo::Grip::wrench, test::tool_at(nut, servo::nut_centre(nut, angle), handle)));
        REQUIRE(output);
        return sound::detect_events(live, setup, lesson_world).tooth ? 1 : 0;
    };
    int teeth = 0;
    for (int i = 0; i < 100; ++i) teeth += heard(0.0);
    REQUIRE(lesson.state().engagement.joint == 0);
    for (int i = 0; i < 60000 && lesson.state().joints[0].torque < 10.0; ++i) teeth += heard(0.005);
    REQUIRE(lesson.state().joints[0].torque >= 10.0);
    CHECK(teeth == 0);
    while (lesson.state().joints[0].torque > 0.0) heard(-1e-4);
    while (lesson.state().engagement.ratchet_slack == 0.0) heard(-1e-4);
    for (int i = 0; i < 4000; ++i) teeth += heard(-9.5 * tooth_angle / 4000);
    CHECK(teeth == 9);
    REQUIRE(lesson.finish(lesson_world));
    const auto reader = session::SessionReader::open(folder / "a.boltwright");
    REQUIRE(reader);
    auto again = session::restore_setup(*reader);
    REQUIRE(again);
    sound::EventDetector detector;
    world::World world;
    world::add_haptics(world, again->state);
    int replayed = 0, falls = 0;
    double before = 0.0;
    const auto status = session::replay(*reader, std::move(*again), [&](const session::ReplayTick& moment) {
        world::write_haptics(world, {moment.state, moment.input, moment.output});
        replayed += sound::detect_events(detector, moment.setup, world).tooth ? 1 : 0;
        // A held ratchet whose slack was almost a tooth and is almost none has passed a tooth.
        const servo::Engagement& engagement = moment.state.engagement;
        const double tooth = moment.setup.wrench.ratchet.tooth_angle;
        const bool held = engagement.joint >= 0 && tooth > 0.0;
        falls += held && before > 0.7 * tooth && engagement.ratchet_slack < 0.3 * tooth ? 1 : 0;
        before = engagement.ratchet_slack;
        return true;
    });
    REQUIRE(status);
    CHECK(replayed == teeth);
    CHECK(falls == teeth);
}

TEST_CASE("Lesson sound: a replay gives the same samples") {
    const test::Folder folder;
    SampleHash lesson;
    int strikes = 0, chimes = 0, clicks = 0;
    test::run_lesson("cover-m8", "expert", 60.0, "torque_wrench", folder / "a.boltwright",
                     [&](const servo::Output&, const sound::SoundCues& cues, std::span<const float> samples) {
                         lesson.add(samples);
                         strikes += cues.strike_speed > 0.0F ? 1 : 0;
                         chimes += cues.done ? 1 : 0;
                         clicks += cues.click ? 1 : 0;
                     });
    CHECK(clicks > 0);
    CHECK(strikes > 0);
    CHECK(chimes > 4);
    const auto reader = session::SessionReader::open(folder / "a.boltwright");
    REQUIRE(reader);
    for (const bool changed : {false, true}) {
        auto again = session::restore_setup(*reader);
        REQUIRE(again);
        sound::EventDetector detector;
        detector.surfaces = sound::struck_surfaces(again->assembly, again->obstacle_names);
        sound::CueRenderer renderer(sound::make_synth(again->setup, test::rate), again->setup.dt);
        SampleHash replay;
        world::World world;
        world::add_haptics(world, again->state);
        const auto replayed =
            session::replay(*reader, std::move(*again), [&](const session::ReplayTick& moment) {
                servo::Output output = moment.output;
                if (changed) output.clicked = false;
                const sound::LessonCues cues = sound::lesson_cues(moment.lesson.events);
                world::write_haptics(world, {moment.state, moment.input, output});
                replay.add(renderer.next(sound::detect_events(detector, moment.setup, world, cues)));
                return true;
            });
        REQUIRE(replayed);
        CHECK(replayed->mismatches == 0);
        CHECK((replay.hash == lesson.hash) != changed);
    }
}
