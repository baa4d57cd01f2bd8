// Ticks on their way to the speaker, in bursts and without.

#include "game/sound/playback.hpp"

#include <atomic>
#include <thread>

#include "tests/sound/support.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::sound;

namespace {

constexpr double dt = 1e-3;
constexpr std::size_t block = 480;

Synth make() { return make_synth(test::two_joints(), test::rate); }

Heard running(double speed) {
    Heard heard;
    heard.run = static_cast<float>(speed);
    return heard;
}

std::vector<float> fill(Feed& feed, std::size_t blocks) {
    std::vector<float> samples(blocks * block);
    for (std::size_t i = 0; i < blocks; ++i) feed.fill(std::span(samples).subspan(i * block, block));
    return samples;
}

}  // namespace

TEST_CASE("ticks that come as they are needed are heard as they are") {
    Feed feed(make(), dt);
    Track track(make(), dt);
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        std::vector<float> expected;
        for (int k = 0; k < 10; ++k) {
            Heard heard = running(random.uniform(0.0, 20.0));
            heard.click = random.chance(0.05);
            feed.push(heard);
            const auto samples = track.next(heard);
            expected.insert(expected.end(), samples.begin(), samples.end());
        }
        REQUIRE(fill(feed, 1) == expected);
    }
    CHECK(feed.lost() == 0);
}

TEST_CASE("pictures that are slow make bursts: no gap, no other pitch, nothing lost") {
    for (const int burst : {17, 33, 100, 200}) {  // ms
        CAPTURE(burst);
        Feed feed(make(), dt);
        std::vector<float> all;
        int pushed = 0;
        for (int now = 0; now < 3000; now += 10) {
            if (now / burst != (now - 10) / burst || now == 0)
                for (int k = 0; k < burst; ++k, ++pushed) feed.push(running(2.0 * pi * 4.0));
            const std::vector<float> samples = fill(feed, 1);
            all.insert(all.end(), samples.begin(), samples.end());
        }
        CHECK(feed.lost() == 0);
        const auto late = std::span(all).subspan(48000, 24000);
        CHECK(test::dominant(late, 100, 2000, 2) == doctest::Approx(4.0 * marks_a_turn).epsilon(0.01));
        for (std::size_t at = 0; at + 2400 < late.size(); at += 2400)
            CHECK(test::rms(late.subspan(at, 2400)) > 0.02);
    }
}

TEST_CASE("a burst is used up soon, so that the sound is not late") {
    Feed feed(make(), dt);
    for (int k = 0; k < 150; ++k) feed.push({});
    Heard click;
    click.click = true;
    feed.push(click);
    const std::vector<float> samples = fill(feed, 40);
    const auto first = std::find_if(samples.begin(), samples.end(), [](float s) { return s != 0.0F; });
    CHECK(first - samples.begin() < static_cast<std::ptrdiff_t>(0.11 * test::rate));
}

TEST_CASE("when ticks stop coming, what goes on goes on for a moment and then rests") {
    Feed feed(make(), dt);
    for (int k = 0; k < 100; ++k) feed.push(running(30.0));
    fill(feed, 10);
    CHECK(test::rms(fill(feed, 15)) > 0.02);  // a picture may take that long
    fill(feed, 30);
    CHECK(test::loudest(fill(feed, 30)) < 1e-5);  // a window that hangs does not hum
    for (int k = 0; k < 100; ++k) feed.push(running(30.0));
    CHECK(test::rms(fill(feed, 10)) > 0.02);
}

TEST_CASE("while nobody listens nothing piles up, and what is old is not heard later") {
    Feed feed(make(), dt);
    Heard click;
    click.click = true;
    for (int k = 0; k < 60000; ++k) feed.push(k < 300 ? click : Heard{});
    CHECK(feed.lost() > 58000);
    CHECK(test::loudest(fill(feed, 100)) == 0.0);
    feed.push(click);
    CHECK(test::loudest(fill(feed, 5)) > 0.1);
}

TEST_CASE("a window pushes the ticks of each picture and the speaker plays them") {
    // What is heard goes here instead of to a card, as fast as it is made.
    struct Card final : audio::Sink {
        explicit Card(std::atomic<double>& most) : loudest(most) {}
        [[nodiscard]] std::string name() const override { return "card"; }
        Result<std::size_t> room() override { return std::size_t{1}; }
        Status play(std::span<const float, audio::block> samples) override {
            loudest = std::max(loudest.load(), test::loudest(samples));
            return {};
        }
        Status set_volume(double) override { return {}; }
        std::atomic<double>& loudest;
    };
    std::atomic<double> loudest = 0.0;
    const servo::Setup setup = test::two_joints();
    auto live = Live::start(
        setup, {}, [&]() -> Result<std::unique_ptr<audio::Sink>> { return std::make_unique<Card>(loudest); });
    REQUIRE(live);
    servo::Output output;
    output.joint = 0;
    test::HapticWorld world(2);
    CHECK(test::eventually([&] {
        for (int tick = 0; tick < 17; ++tick) {
            output.nut_angle += 9.0 * setup.dt;
            live->tick(world.write(output), {});
        }
        return loudest > 0.02;
    }));
    CHECK(live->news() == "sound: card");
    auto other = Live::start(setup, {}, [] { return fail(ErrorCode::no_device, "no card"); });
    REQUIRE(other);
    CHECK(test::eventually([&] { return other->news() == "no sound: no card"; }));
    *other = std::move(*live);
    loudest = 0.0;
    CHECK(test::eventually([&] {
        output.nut_angle += 9.0 * setup.dt;
        other->tick(world.write(output), {});
        return loudest > 0.01;
    }));
}

TEST_CASE("filling allocates nothing, and two threads get along") {
    Feed feed(make(), dt);
    for (int k = 0; k < 100; ++k) feed.push(running(10.0));
    std::array<float, block> samples{};
    CHECK(test::forbidden_in([&] { feed.fill(samples); }).all() == 0);
    std::jthread speaker([&](const std::stop_token& stop) {
        std::array<float, block> more{};
        while (!stop.stop_requested()) feed.fill(more);
    });
    for (int k = 0; k < 20000; ++k) feed.push(running(10.0));
}
