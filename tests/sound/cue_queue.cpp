// The queue of cues between the frame's thread and the speaker's.
#include "game/sound/playback.hpp"

#include <atomic>
#include <thread>

#include "tests/sound/support.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/forbidden.hpp"

namespace sound_cue_queue_test {

using namespace bolt;
using namespace bolt::sound;

namespace {

constexpr double dt = 1e-3;
constexpr std::size_t block = 480;

Synth make() { return make_synth(test::two_joints(), test::rate); }

SoundCues running(double speed) {
    SoundCues cues;
    cues.run_speed = static_cast<float>(speed);
    return cues;
}

std::vector<float> fill(CueQueue& queue, std::size_t blocks) {
    std::vector<float> samples(blocks * block);
    for (std::size_t i = 0; i < blocks; ++i) queue.fill(std::span(samples).subspan(i * block, block));
    return samples;
}

}  // namespace

TEST_CASE("Cue queue: ticks that arrive evenly are rendered one by one") {
    CueQueue queue(make(), dt);
    CueRenderer renderer(make(), dt);
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        std::vector<float> expected;
        for (int k = 0; k < 10; ++k) {
            SoundCues cues = running(random.uniform(0.0, 20.0));
            cues.click = random.chance(0.05);
            queue.push(cues);
            const auto samples = renderer.next(cues);
            expected.insert(expected.end(), samples.begin(), samples.end());
        }
        REQUIRE(fill(queue, 1) == expected);
    }
    CHECK(queue.dropped() == 0);
}

TEST_CASE("Cue queue: bursts of slow frames cause no gap, no change of pitch and no loss") {
    for (const int burst : {17, 33, 100, 200}) {  // ms
        CAPTURE(burst);
        CueQueue queue(make(), dt);
        std::vector<float> all;
        int pushed = 0;
        for (int now = 0; now < 3000; now += 10) {
            if (now / burst != (now - 10) / burst || now == 0)
                for (int k = 0; k < burst; ++k, ++pushed) queue.push(running(2.0 * pi * 4.0));
            const std::vector<float> samples = fill(queue, 1);
            all.insert(all.end(), samples.begin(), samples.end());
        }
        CHECK(queue.dropped() == 0);
        const auto late = std::span(all).subspan(48000, 24000);
        CHECK(test::dominant(late, 100, 2000, 2) == doctest::Approx(4.0 * pulses_per_turn).epsilon(0.01));
        for (std::size_t at = 0; at + 2400 < late.size(); at += 2400)
            CHECK(test::rms(late.subspan(at, 2400)) > 0.02);
    }
}

TEST_CASE("Cue queue: a burst is consumed quickly, so that the sound is not late") {
    CueQueue queue(make(), dt);
    for (int k = 0; k < 150; ++k) queue.push({});
    SoundCues click;
    click.click = true;
    queue.push(click);
    const std::vector<float> samples = fill(queue, 40);
    const auto first = std::find_if(samples.begin(), samples.end(), [](float s) { return s != 0.0F; });
    CHECK(first - samples.begin() < static_cast<std::ptrdiff_t>(0.11 * test::rate));
}

TEST_CASE("Cue queue: when ticks stop, the last sound lasts for a moment and fades out") {
    CueQueue queue(make(), dt);
    for (int k = 0; k < 100; ++k) queue.push(running(30.0));
    fill(queue, 10);
    CHECK(test::rms(fill(queue, 15)) > 0.02);  // a frame may take that long
    fill(queue, 30);
    CHECK(test::loudest(fill(queue, 30)) < 1e-5);  // a hanging window is silent
    for (int k = 0; k < 100; ++k) queue.push(running(30.0));
    CHECK(test::rms(fill(queue, 10)) > 0.02);
}

TEST_CASE("Cue queue: without a consumer old ticks are dropped and never rendered") {
    CueQueue queue(make(), dt);
    SoundCues click;
    click.click = true;
    for (int k = 0; k < 60000; ++k) queue.push(k < 300 ? click : SoundCues{});
    CHECK(queue.dropped() > 58000);
    CHECK(test::loudest(fill(queue, 100)) == 0.0);
    queue.push(click);
    CHECK(test::loudest(fill(queue, 5)) > 0.1);
}

TEST_CASE("Live sound: the speaker plays the ticks that a window adds in each frame") {
    // Takes the samples instead of a sound card, as fast as they are rendered.
    struct Card final : audio::Sink {
        explicit Card(std::atomic<double>& most) : loudest(most) {}
        [[nodiscard]] std::string name() const override { return "card"; }
        Result<std::size_t> free_blocks() override { return std::size_t{1}; }
        Status play(std::span<const float, audio::block_size> samples) override {
            loudest = std::max(loudest.load(), test::loudest(samples));
            return {};
        }
        Status set_volume(double) override { return {}; }
        std::atomic<double>& loudest;
    };
    std::atomic<double> loudest = 0.0;
    const servo::Setup setup = test::two_joints();
    auto live = LiveSound::start(
        setup, {}, [&]() -> Result<std::unique_ptr<audio::Sink>> { return std::make_unique<Card>(loudest); });
    REQUIRE(live);
    servo::Output output;
    output.joint = 0;
    test::HapticWorld world(2);
    CHECK(test::eventually([&] {
        for (int tick = 0; tick < 17; ++tick) {
            output.nut_angle += 9.0 * setup.dt;
            live->add_tick(world.write(output), {});
        }
        return loudest > 0.02;
    }));
    CHECK(live->status_change() == "sound: card");
    auto other = LiveSound::start(setup, {}, [] { return fail(ErrorCode::no_device, "no card", {}); });
    REQUIRE(other);
    CHECK(test::eventually([&] { return other->status_change() == "no sound: no card"; }));
    *other = std::move(*live);
    loudest = 0.0;
    CHECK(test::eventually([&] {
        output.nut_angle += 9.0 * setup.dt;
        other->add_tick(world.write(output), {});
        return loudest > 0.01;
    }));
}

TEST_CASE("Cue queue: filling does not allocate, and two threads can use the queue") {
    CueQueue queue(make(), dt);
    for (int k = 0; k < 100; ++k) queue.push(running(10.0));
    std::array<float, block> samples{};
    CHECK(test::forbidden_in([&] { queue.fill(samples); }).all() == 0);
    std::jthread speaker([&](const std::stop_token& stop) {
        std::array<float, block> more{};
        while (!stop.stop_requested()) queue.fill(more);
    });
    for (int k = 0; k < 20000; ++k) queue.push(running(10.0));
}

}  // namespace sound_cue_queue_test
