// Samples: silence, levels, pitches, and that nothing ever hurts.

#include "game/sound/synth.hpp"

#include "tests/sound/support.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::sound;

namespace {

Synth make(int rate = test::rate, std::uint64_t seed = 1) {
    return make_synth(test::two_joints(), rate, seed);
}

Heard strike(double speed, Met met = Met::casing) {
    Heard heard;
    heard.strike = static_cast<float>(speed);
    heard.met = met;
    return heard;
}

// One tick of something, and what comes of it.
std::vector<float> after(Synth& synth, const Heard& heard, double seconds) {
    std::vector<float> samples = test::listen(synth, heard, 1e-3);
    const std::vector<float> rest = test::listen(synth, {}, seconds);
    samples.insert(samples.end(), rest.begin(), rest.end());
    return samples;
}

// Anything at all, now and then nonsense.
Heard anything(Random& random) {
    const auto number = [&](double most) -> float {
        if (random.chance(0.01)) return std::numeric_limits<float>::quiet_NaN();
        if (random.chance(0.01)) return random.chance(0.5) ? 1e30F : -1e30F;
        if (random.chance(0.5)) return 0.0F;
        return static_cast<float>(random.uniform(0.0, most));
    };
    Heard heard;
    heard.strike = number(5.0);
    heard.met = random.chance(0.5) ? Met::nut : Met::casing;
    heard.slide = number(2.0);
    heard.press = number(30.0);
    heard.run = number(60.0);
    heard.creep = number(5.0);
    heard.load = number(1.5);
    heard.slip = random.chance(0.1) ? number(1.5) : 0.0F;
    heard.click = random.chance(0.2);
    heard.done = random.chance(0.2);
    heard.mistake = random.chance(0.2);
    return heard;
}

}  // namespace

TEST_CASE("silence stays silence, exactly, and every sound comes back to it") {
    Synth synth = make();
    for (const float sample : test::listen(synth, {}, 1.0)) REQUIRE(sample == 0.0F);
    Heard all = strike(1.0);
    all.slide = 0.3F;
    all.press = 5.0F;
    all.run = 9.0F;
    all.creep = 0.5F;
    all.load = 0.8F;
    all.slip = 1.0F;
    all.click = all.done = all.mistake = true;
    CHECK(test::loudest(test::listen(synth, all, 0.5)) > 0.1);
    test::listen(synth, {}, 9.0);
    for (const float sample : test::listen(synth, {}, 1.0)) REQUIRE(sample == 0.0F);
}

TEST_CASE("a strike is the louder the faster it was, and sounds at once") {
    for (const Met met : {Met::casing, Met::nut}) {
        double before = 0.0;
        for (const double speed : {0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0}) {
            Synth synth = make();
            const std::vector<float> heard = after(synth, strike(speed, met), 0.2);
            CAPTURE(speed);
            CHECK(test::rms(heard) > 1.1 * before);
            CHECK(test::loudest(std::span(heard).first(480)) > 0.02);
            before = test::rms(heard);
        }
    }
}

TEST_CASE("iron and nut sound different: the casting lower") {
    std::array<double, 2> low{}, high{};
    for (const Met met : {Met::casing, Met::nut}) {
        Synth synth = make();
        const std::vector<float> heard = after(synth, strike(0.5, met), 0.2);
        const auto i = static_cast<std::size_t>(met);
        for (double f = 150; f < 500; f += 10) low[i] += test::amount(heard, f);
        for (double f = 2700; f < 4500; f += 10) high[i] += test::amount(heard, f);
    }
    CHECK(low[0] > 3.0 * low[1]);
    CHECK(high[1] > 2.0 * high[0]);
}

TEST_CASE("a wrench that is twice as long rings two octaves lower") {
    std::array<double, 2> pitch{};
    for (const int times : {1, 2}) {
        servo::Setup setup = test::two_joints();
        setup.wrench.handle_length *= times;
        Synth synth = make_synth(setup, test::rate);
        pitch[static_cast<std::size_t>(times - 1)] =
            test::dominant(after(synth, strike(0.3, Met::nut), 0.3), 60, 1200, 1);
    }
    CHECK(pitch[0] / pitch[1] == doctest::Approx(4.0).epsilon(0.05));
}

TEST_CASE("a nut that runs sounds at so many marks a turn") {
    for (const double turns : {2.0, 3.5, 5.0, 8.0}) {
        Synth synth = make();
        Heard heard;
        heard.run = static_cast<float>(2.0 * pi * turns);
        test::listen(synth, heard, 0.1);
        const std::vector<float> samples = test::listen(synth, heard, 0.5);
        CAPTURE(turns);
        CHECK(test::dominant(samples, 50, 4000, 2) == doctest::Approx(marks_a_turn * turns).epsilon(0.01));
    }
}

TEST_CASE("a nut that is turned slowly ticks, so often as marks go by") {
    Synth synth = make();
    Heard heard;
    heard.run = static_cast<float>(2.0 * pi * 10.0 / marks_a_turn);  // ten a second
    test::listen(synth, heard, 0.1);
    const std::vector<float> samples = test::listen(synth, heard, 3.0);
    int ticks = 0;
    double envelope = 0.0;
    bool ringing = false;
    for (const float s : samples) {
        envelope = std::max(0.999 * envelope, std::abs(static_cast<double>(s)));
        if (!ringing && envelope > 0.01) ++ticks;
        ringing = ringing ? envelope > 0.002 : envelope > 0.01;
    }
    CHECK(ticks >= 29);
    CHECK(ticks <= 31);
}

TEST_CASE("a joint that is turned groans the louder the more it bears, and not at rest") {
    double before = 0.0;
    for (const double load : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        Synth synth = make();
        Heard heard;
        heard.creep = 0.5F;
        heard.load = static_cast<float>(load);
        const double loud = test::rms(test::listen(synth, heard, 2.0));
        CAPTURE(load);
        CHECK(loud > 1.3 * before);
        before = loud;
    }
    Synth synth = make();
    Heard rest;
    rest.load = 1.0F;
    CHECK(test::loudest(test::listen(synth, rest, 1.0)) == 0.0);
}

TEST_CASE("sliding is the louder the faster and the harder, and needs both") {
    const auto loud = [](double slide, double press) {
        Synth synth = make();
        Heard heard;
        heard.slide = static_cast<float>(slide);
        heard.press = static_cast<float>(press);
        return test::rms(test::listen(synth, heard, 1.0));
    };
    CHECK(loud(0.1, 4.0) > 1.5 * loud(0.03, 4.0));
    CHECK(loud(0.1, 4.0) > 1.5 * loud(0.1, 1.0));
    CHECK(loud(0.1, 1.0) > 0.003);
    CHECK(loud(0.1, 0.0) == 0.0);
    CHECK(loud(0.0, 4.0) == 0.0);
}

TEST_CASE("the faster it slides the higher it sounds") {
    double before = 0.0;
    for (const double slide : {0.15, 0.3, 0.6}) {
        Synth synth = make();
        Heard heard;
        heard.slide = static_cast<float>(slide);
        heard.press = 4.0F;
        test::listen(synth, heard, 0.1);
        const std::vector<float> samples = test::listen(synth, heard, 1.0);
        // The middle of its spectrum.
        double sum = 0.0, weighed = 0.0;
        for (double f = 100.0; f < 6000.0; f += 20.0) {
            const double found = square(test::amount(samples, f));
            sum += found;
            weighed += f * found;
        }
        CAPTURE(slide);
        CHECK(weighed / sum > 1.4 * before);
        before = weighed / sum;
    }
}

TEST_CASE("a click, a slip and both chimes are there and are not each other") {
    const auto heard = [](auto set) {
        Synth synth = make();
        Heard h;
        set(h);
        return after(synth, h, 0.6);
    };
    const auto click = heard([](Heard&h) { h.click = true; }), slip = heard([](Heard&h) { h.slip = 0.8F; }),
               done = heard([](Heard&h) { h.done = true; }),
               mistake = heard([](Heard&h) { h.mistake = true; });
    for (const auto* one : {&click, &slip, &done, &mistake}) {
        CHECK(test::loudest(*one) > 0.15);
        CHECK(test::loudest(*one) < 0.99);
    }
    CHECK(test::dominant(done, 50, 5000, 2) > 700.0);
    CHECK(test::dominant(mistake, 50, 5000, 2) < 250.0);
    CHECK(test::dominant(click, 50, 5000, 2) > 1500.0);
    CHECK(test::loudest(slip) > test::loudest(done));
    // Click and clack, within a tenth of a second.
    CHECK(test::loudest(std::span(click).first(480)) > 0.2);
    CHECK(test::loudest(std::span(click).last(24000)) < 1e-3);
}

TEST_CASE("no sound by itself is so steep or so loud that a limiter would bend it, but a slip's") {
    std::vector<Heard> sounds{strike(1.0, Met::casing), strike(1.0, Met::nut)};
    const auto add = [&](auto set) { set(sounds.emplace_back()); };
    add([](Heard& h) { h.slide = 0.5F, h.press = 10.0F; });
    add([](Heard& h) { h.run = 12.0F; });
    add([](Heard& h) { h.run = 60.0F; });
    add([](Heard& h) { h.creep = 1.0F, h.load = 1.0F; });
    add([](Heard& h) { h.click = true; });
    add([](Heard& h) { h.done = true; });
    add([](Heard& h) { h.mistake = true; });
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        Synth synth = make();
        Heard goes_on = sounds[i];
        goes_on.strike = 0.0F;
        goes_on.click = goes_on.done = goes_on.mistake = false;
        std::vector<float> samples = test::listen(synth, sounds[i], 1e-3);
        const std::vector<float> more = test::listen(synth, goes_on, 1.0);
        samples.insert(samples.end(), more.begin(), more.end());
        CAPTURE(i);
        CHECK(test::steepest_step(samples) < 0.999 * steepest / test::rate);
        CHECK(test::loudest(samples) < 0.75);
        CHECK(test::loudest(samples) > 0.03);
    }
}

TEST_CASE("nothing is louder than 1 and nothing leaps, whatever the ticks say") {
    for (const int rate : {8000, 22050, 44100, 48000, 96000}) {
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            Random random(seed);
            Synth synth = make(rate, seed);
            // All at once now and then, rests and storms.
            float before = 0.0F;
            for (int i = 0; i < 3000; ++i) {
                sound::sound(synth, (i / 500) % 3 == 2 ? Heard{} : anything(random));
                std::array<float, 48> samples{};
                render(synth, samples);
                for (const float s : samples) {
                    REQUIRE(std::isfinite(s));
                    REQUIRE(std::abs(s) < 1.0F);
                    REQUIRE(std::abs(s - before) <= 1.0001 * steepest / rate);
                    before = s;
                }
            }
        }
    }
}

TEST_CASE("the same ticks give the same samples, in blocks of whatever size; another seed another noise") {
    const auto hear_all = [](std::uint64_t seed, std::uint64_t blocks) {
        Random random(3), sizes(blocks);
        Synth synth = make(test::rate, seed);
        std::vector<float> all;
        for (int i = 0; i < 2000; ++i) {
            sound::sound(synth, anything(random));
            std::array<float, 48> samples{};
            for (std::size_t at = 0; at < samples.size();) {
                const auto most = samples.size() - at;
                const std::size_t size = blocks == 0 ? most : std::min<std::size_t>(sizes.bits() % 20, most);
                render(synth, std::span(samples).subspan(at, size));
                at += size;
            }
            all.insert(all.end(), samples.begin(), samples.end());
        }
        return all;
    };
    const std::vector<float> once = hear_all(1, 0);
    CHECK(once == hear_all(1, 0));
    CHECK(once == hear_all(1, 1));
    CHECK(once == hear_all(1, 2));
    CHECK(once != hear_all(2, 0));
}

TEST_CASE("a track has as many samples as its ticks last") {
    for (const int rate : {44100, 48000}) {
        Track track(make(rate), 1e-3);
        std::size_t samples = 0;
        for (int i = 0; i < 10000; ++i) samples += track.next({}).size();
        CHECK(samples == static_cast<std::size_t>(10 * rate));
    }
    Track fast(make(), 0.25e-3);  // 4 kHz
    std::size_t samples = 0;
    for (int i = 0; i < 4000; ++i) samples += fast.next({}).size();
    CHECK(samples == static_cast<std::size_t>(test::rate));
}

TEST_CASE("rendering allocates nothing, locks nothing and asks nobody") {
    Synth synth = make();
    Random random(5);
    std::array<float, 480> samples{};
    const test::Forbidden found = test::forbidden_in([&] {
        for (int i = 0; i < 100; ++i) {
            sound::sound(synth, anything(random));
            render(synth, samples);
        }
    });
    CHECK(found.all() == 0);
}
