// The sound file of a replayed session.
#include "game/sound/playback.hpp"

#include "engine/audio/sink.hpp"
#include "engine/base/file.hpp"
#include "game/session/replay.hpp"
#include "tests/sound/support.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using test::Folder;

namespace {

constexpr std::size_t header = 44;  // bytes

std::vector<std::int16_t> samples_of(const std::filesystem::path& wav) {
    const auto bytes = read_file(wav, 1U << 28U, ErrorCode::failed);
    REQUIRE(bytes);
    REQUIRE(bytes->size() >= header);
    std::vector<std::int16_t> samples;
    for (std::size_t i = header; i + 1 < bytes->size(); i += 2)
        samples.push_back(static_cast<std::int16_t>(static_cast<unsigned char>((*bytes)[i]) |
                                                    static_cast<unsigned char>((*bytes)[i + 1]) << 8));
    return samples;
}

void write_track(const session::SessionReader& session, const std::filesystem::path& wav, double from) {
    auto at = session::restore_setup(session);
    REQUIRE(at);
    auto track = sound::Soundtrack::create(wav, at->setup,
                                           sound::struck_surfaces(at->assembly, at->obstacle_names), from);
    REQUIRE(track);
    world::World world;
    world::add_haptics(world, at->state);
    const auto replayed = session::replay(session, std::move(*at), world, [&](const session::ReplayTick& m) {
        REQUIRE(track->add_tick(m.setup, world, sound::lesson_cues(m.lesson.events), m.time));
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->mismatches == 0);
    REQUIRE(track->finish());
}

}  // namespace

TEST_CASE("Soundtrack: has the samples of the lesson, from whatever time it begins") {
    const Folder folder;
    const std::filesystem::path session = folder / "a.boltwright", wav = folder / "a.wav";
    std::vector<std::int16_t> lesson;
    test::run_lesson("cover-m8", "expert", 30.0, "", session,
                     [&](const servo::Output&, const sound::SoundCues&, std::span<const float> samples) {
                         for (const float s : samples) lesson.push_back(audio::to_pcm16(s));
                     });
    CHECK(std::any_of(lesson.begin(), lesson.end(), [](int s) { return std::abs(s) > 1000; }));
    const auto reader = session::SessionReader::open(session);
    REQUIRE(reader);
    write_track(*reader, wav, 0.0);
    CHECK((samples_of(wav) == lesson));

    // The file begins with the tick that ends at `from` and includes the decay of earlier sounds.
    write_track(*reader, wav, 10.0);
    const std::size_t left_out = (10000 - 1) * 48;
    CHECK((samples_of(wav) ==
           std::vector<std::int16_t>(lesson.begin() + static_cast<std::ptrdiff_t>(left_out), lesson.end())));
}
