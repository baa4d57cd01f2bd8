// The synthesiser's samples: silence, levels, pitches and limits.
#include "game/sound/synth.hpp"

#include "tests/sound/support.hpp"
#include "tests/support/forbidden.hpp"

namespace sound_synth_test {

using namespace bolt;
using namespace bolt::sound;

namespace {

Synth make(int rate = test::rate, std::uint64_t seed = 1) {
    return make_synth(test::two_joints(), rate, seed);
}

SoundCues strike(double speed, StruckSurface met = StruckSurface::casing) {
    SoundCues cues;
    cues.strike_speed = static_cast<float>(speed);
    cues.surface = met;
    return cues;
}

// Renders one tick with `cues`, then silence for `seconds`.
std::vector<float> after(Synth& synth, const SoundCues& cues, double seconds) {
    std::vector<float> samples = test::listen(synth, cues, 1e-3);
    const std::vector<float> rest = test::listen(synth, {}, seconds);
    samples.insert(samples.end(), rest.begin(), rest.end());
    return samples;
}

// Random cues, sometimes with invalid numbers.
SoundCues anything(Random& random) {
    const auto number = [&](double most) -> float {
        if (random.chance(0.01)) return std::numeric_limits<float>::quiet_NaN();
        if (random.chance(0.01)) return random.chance(0.5) ? 1e30F : -1e30F;
        if (random.chance(0.5)) return 0.0F;
        return static_cast<float>(random.uniform(0.0, most));
    };
    SoundCues cues;
    cues.strike_speed = number(5.0);
    cues.surface = random.chance(0.5) ? StruckSurface::nut : StruckSurface::casing;
    cues.slide_speed = number(2.0);
    cues.contact_force = number(30.0);
    cues.run_speed = number(60.0);
    cues.creep_speed = number(5.0);
    cues.load = number(1.5);
    cues.slip = random.chance(0.1) ? number(1.5) : 0.0F;
    cues.click = random.chance(0.2);
    cues.tooth = random.chance(0.2);
    cues.done = random.chance(0.2);
    cues.mistake = random.chance(0.2);
    return cues;
}

}  // namespace

TEST_CASE("Synth: silence gives exact zeros, and every sound fades to exact zeros") {
    Synth synth = make();
    for (const float sample : test::listen(synth, {}, 1.0)) REQUIRE(sample == 0.0F);
    SoundCues all = strike(1.0);
    all.slide_speed = 0.3F;
    all.contact_force = 5.0F;
    all.run_speed = 9.0F;
    all.creep_speed = 0.5F;
    all.load = 0.8F;
    all.slip = 1.0F;
    all.click = all.tooth = all.done = all.mistake = true;
    CHECK(test::loudest(test::listen(synth, all, 0.5)) > 0.1);
    test::listen(synth, {}, 9.0);
    for (const float sample : test::listen(synth, {}, 1.0)) REQUIRE(sample == 0.0F);
}

TEST_CASE("Synth: a strike starts at once and is louder at a higher speed") {
    for (const StruckSurface met : {StruckSurface::casing, StruckSurface::nut}) {
        double before = 0.0;
        for (const double speed : {0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0}) {
            Synth synth = make();
            const std::vector<float> samples = after(synth, strike(speed, met), 0.2);
            CAPTURE(speed);
            CHECK(test::rms(samples) > 1.1 * before);
            CHECK(test::loudest(std::span(samples).first(480)) > 0.02);
            before = test::rms(samples);
        }
    }
}

TEST_CASE("Synth: a casting sounds lower than a nut") {
    std::array<double, 2> low{}, high{};
    for (const StruckSurface met : {StruckSurface::casing, StruckSurface::nut}) {
        Synth synth = make();
        const std::vector<float> samples = after(synth, strike(0.5, met), 0.2);
        const auto i = static_cast<std::size_t>(met);
        for (double f = 150; f < 500; f += 10) low[i] += test::amount(samples, f);
        for (double f = 2700; f < 4500; f += 10) high[i] += test::amount(samples, f);
    }
    CHECK(low[0] > 3.0 * low[1]);
    CHECK(high[1] > 2.0 * high[0]);
}

TEST_CASE("Synth: a wrench of twice the length sounds two octaves lower") {
    std::array<double, 2> pitch{};
    for (const int times : {1, 2}) {
        servo::Setup setup = test::two_joints();
        setup.wrench.handle_length *= times;
        Synth synth = make_synth(setup, test::rate);
        pitch[static_cast<std::size_t>(times - 1)] =
            test::dominant(after(synth, strike(0.3, StruckSurface::nut), 0.3), 60, 1200, 1);
    }
    CHECK(pitch[0] / pitch[1] == doctest::Approx(4.0).epsilon(0.05));
}

TEST_CASE("Synth: the pitch of a running nut is proportional to its speed") {
    for (const double turns : {2.0, 3.5, 5.0, 8.0}) {
        Synth synth = make();
        SoundCues cues;
        cues.run_speed = static_cast<float>(2.0 * pi * turns);
        test::listen(synth, cues, 0.1);
        const std::vector<float> samples = test::listen(synth, cues, 0.5);
        CAPTURE(turns);
        CHECK(test::dominant(samples, 50, 4000, 2) == doctest::Approx(pulses_per_turn * turns).epsilon(0.01));
    }
}

TEST_CASE("Synth: a nut that is turned slowly gives one tick per pulse") {
    Synth synth = make();
    SoundCues cues;
    cues.run_speed = static_cast<float>(2.0 * pi * 10.0 / pulses_per_turn);  // ten a second
    test::listen(synth, cues, 0.1);
    const std::vector<float> samples = test::listen(synth, cues, 3.0);
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

TEST_CASE("Synth: a turned joint groans louder under a higher load, and not at rest") {
    double before = 0.0;
    for (const double load : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        Synth synth = make();
        SoundCues cues;
        cues.creep_speed = 0.5F;
        cues.load = static_cast<float>(load);
        const double loud = test::rms(test::listen(synth, cues, 2.0));
        CAPTURE(load);
        CHECK(loud > 1.3 * before);
        before = loud;
    }
    Synth synth = make();
    SoundCues rest;
    rest.load = 1.0F;
    CHECK(test::loudest(test::listen(synth, rest, 1.0)) == 0.0);
}

TEST_CASE("Synth: sliding is louder at higher speed and force, and needs both") {
    const auto loud = [](double slide, double press) {
        Synth synth = make();
        SoundCues cues;
        cues.slide_speed = static_cast<float>(slide);
        cues.contact_force = static_cast<float>(press);
        return test::rms(test::listen(synth, cues, 1.0));
    };
    CHECK(loud(0.1, 4.0) > 1.5 * loud(0.03, 4.0));
    CHECK(loud(0.1, 4.0) > 1.5 * loud(0.1, 1.0));
    CHECK(loud(0.1, 1.0) > 0.003);
    CHECK(loud(0.1, 0.0) == 0.0);
    CHECK(loud(0.0, 4.0) == 0.0);
}

TEST_CASE("Synth: faster sliding sounds higher") {
    double before = 0.0;
    for (const double slide : {0.15, 0.3, 0.6}) {
        Synth synth = make();
        SoundCues cues;
        cues.slide_speed = static_cast<float>(slide);
        cues.contact_force = 4.0F;
        test::listen(synth, cues, 0.1);
        const std::vector<float> samples = test::listen(synth, cues, 1.0);
        // Centroid of the spectrum.
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

TEST_CASE("Synth: click, slip and both chimes are audible and differ") {
    const auto samples_of_cue = [](auto set) {
        Synth synth = make();
        SoundCues h;
        set(h);
        return after(synth, h, 0.6);
    };
    const auto click = samples_of_cue([](SoundCues&h) { h.click = true; }),
               slip = samples_of_cue([](SoundCues&h) { h.slip = 0.8F; }),
               done = samples_of_cue([](SoundCues&h) { h.done = true; }),
               mistake = samples_of_cue([](SoundCues&h) { h.mistake = true; });
    for (const auto* one : {&click, &slip, &done, &mistake}) {
        CHECK(test::loudest(*one) > 0.15);
        CHECK(test::loudest(*one) < 0.99);
    }
    CHECK(test::dominant(done, 50, 5000, 2) > 700.0);
    CHECK(test::dominant(mistake, 50, 5000, 2) < 250.0);
    CHECK(test::dominant(click, 50, 5000, 2) > 1500.0);
    CHECK(test::loudest(slip) > test::loudest(done));
    // Both parts of the click end within a tenth of a second.
    CHECK(test::loudest(std::span(click).first(480)) > 0.2);
    CHECK(test::loudest(std::span(click).last(24000)) < 1e-3);
}

TEST_CASE("Synth: a ratchet's tooth is audible, quieter than a click, and sounds at most 60 times a second") {
    Synth synth = make(), clicking = make();
    SoundCues tooth, click;
    tooth.tooth = click.click = true;
    const double loud = test::loudest(after(synth, tooth, 0.2));
    CHECK(loud > 0.01);
    CHECK(loud < 0.4 * test::loudest(after(clicking, click, 0.2)));
    const auto pulses_of = [&](int period) {  // ms between the cues, over one second
        Synth ratchet = make();
        int pulses = 0;
        for (int i = 0; i < 1000; ++i) {
            const double before = ratchet.since_tooth;
            apply_cues(ratchet, i % period == 0 ? tooth : SoundCues{});
            pulses += ratchet.since_tooth < before ? 1 : 0;
            std::vector<float> samples(48);
            render(ratchet, samples);
            CHECK(test::loudest(samples) < 0.3);
        }
        return pulses;
    };
    CHECK(pulses_of(40) == 25);
    const int fast = pulses_of(2);
    CHECK(fast > 50);
    CHECK(fast <= 60);
}

TEST_CASE("Synth: no single sound except a slip reaches a limiter") {
    std::vector<SoundCues> sounds{strike(1.0, StruckSurface::casing), strike(1.0, StruckSurface::nut)};
    const auto add = [&](auto set) { set(sounds.emplace_back()); };
    add([](SoundCues& h) { h.slide_speed = 0.5F, h.contact_force = 10.0F; });
    add([](SoundCues& h) { h.run_speed = 12.0F; });
    add([](SoundCues& h) { h.run_speed = 60.0F; });
    add([](SoundCues& h) { h.creep_speed = 1.0F, h.load = 1.0F; });
    add([](SoundCues& h) { h.click = true; });
    add([](SoundCues& h) { h.tooth = true; });
    add([](SoundCues& h) { h.done = true; });
    add([](SoundCues& h) { h.mistake = true; });
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        Synth synth = make();
        SoundCues continued = sounds[i];
        continued.strike_speed = 0.0F;
        continued.click = continued.tooth = continued.done = continued.mistake = false;
        std::vector<float> samples = test::listen(synth, sounds[i], 1e-3);
        const std::vector<float> more = test::listen(synth, continued, 1.0);
        samples.insert(samples.end(), more.begin(), more.end());
        CAPTURE(i);
        CHECK(test::steepest_step(samples) < 0.999 * max_slope / test::rate);
        CHECK(test::loudest(samples) < 0.75);
        CHECK(test::loudest(samples) > 0.03);
    }
}

TEST_CASE("Synth: any cues give samples below 1 without steps") {
    for (const int rate : {8000, 22050, 44100, 48000, 96000}) {
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            Random random(seed);
            Synth synth = make(rate, seed);
            // Sounds at random, with silence in between.
            float before = 0.0F;
            for (int i = 0; i < 3000; ++i) {
                sound::apply_cues(synth, (i / 500) % 3 == 2 ? SoundCues{} : anything(random));
                std::array<float, 48> samples{};
                render(synth, samples);
                for (const float s : samples) {
                    REQUIRE(std::isfinite(s));
                    REQUIRE(std::abs(s) < 1.0F);
                    REQUIRE(std::abs(s - before) <= 1.0001 * max_slope / rate);
                    before = s;
                }
            }
        }
    }
}

TEST_CASE("Synth: samples depend on cues and seed, not on the block size") {
    const auto render_all = [](std::uint64_t seed, std::uint64_t blocks) {
        Random random(3), sizes(blocks);
        Synth synth = make(test::rate, seed);
        std::vector<float> all;
        for (int i = 0; i < 2000; ++i) {
            sound::apply_cues(synth, anything(random));
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
    const std::vector<float> once = render_all(1, 0);
    CHECK(once == render_all(1, 0));
    CHECK(once == render_all(1, 1));
    CHECK(once == render_all(1, 2));
    CHECK(once != render_all(2, 0));
}

TEST_CASE("Cue renderer: the number of samples follows the duration of the ticks") {
    for (const int rate : {44100, 48000}) {
        CueRenderer renderer(make(rate), 1e-3);
        std::size_t samples = 0;
        for (int i = 0; i < 10000; ++i) samples += renderer.next({}).size();
        CHECK(samples == static_cast<std::size_t>(10 * rate));
    }
    CueRenderer fast(make(), 0.25e-3);  // 4 kHz
    std::size_t samples = 0;
    for (int i = 0; i < 4000; ++i) samples += fast.next({}).size();
    CHECK(samples == static_cast<std::size_t>(test::rate));
}

TEST_CASE("Synth: rendering does not allocate, lock or call the system") {
    Synth synth = make();
    Random random(5);
    std::array<float, 480> samples{};
    const test::Forbidden found = test::forbidden_in([&] {
        for (int i = 0; i < 100; ++i) {
            sound::apply_cues(synth, anything(random));
            render(synth, samples);
        }
    });
    CHECK(found.all() == 0);
}

}  // namespace sound_synth_test
