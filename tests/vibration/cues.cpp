// The cues of scripted ticks.
#include <cstring>
#include <limits>

#include "engine/base/random.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/vibration/support.hpp"

namespace vibration_cues_test {

using namespace bolt;
using namespace bolt::servo;
using joint::Stage;
using test::VibrationPlayer;

namespace {

VibrationPlayer engaged(Stage stage, double torque = 0.0) {
    VibrationPlayer player;
    player.input.joint = 0;
    player.input.stage = stage;
    player.input.target = 50.0;
    player.input.torque = torque;
    return player;
}

VibrationInput any_input(Random& random) {
    const auto wild = [&](double usual) {
        const double special[] = {bolt::nan, std::numeric_limits<double>::infinity(), 1e300, -1e300, 0.0};
        return random.chance(0.01) ? special[random.bits() % 5] : usual;
    };
    VibrationInput input;
    input.joint = static_cast<std::int16_t>(static_cast<int>(random.bits() % 4) - 1);
    input.stage = static_cast<Stage>(random.bits() % 4);
    input.torque = wild(random.uniform(-100.0, 100.0));
    input.target = wild(random.uniform(-1.0, 80.0));
    input.angle = wild(random.uniform(-20.0, 20.0));
    input.slipped = random.chance(0.02);
    input.clicked = random.chance(0.02);
    input.strike_speed = wild(random.chance(0.05) ? random.uniform(-0.1, 2.0) : 0.0);
    return input;
}

}  // namespace

TEST_CASE("Vibration: silent while nothing moves, in every stage and at every torque") {
    for (const Stage stage : {Stage::navigation, Stage::transition, Stage::linearity, Stage::yield}) {
        VibrationPlayer player = engaged(Stage::navigation);
        player.run(200);
        player.input.stage = stage;
        player.turn(0.0, 40.0, 200);
        player.run(400);  // until the smoothed values and the last pulse are over
        player.sent.clear();
        player.run(5000);
        CHECK(player.sent.empty());
    }
    VibrationPlayer free;
    free.run(5000);
    CHECK(free.sent.empty());
}

TEST_CASE(
    "Vibration: the free nut gives one detent for each 30 degrees, at every speed up to the frame rate") {
    for (const double speed : {0.5, 3.0, 10.0, 20.0})
        for (const double direction : {1.0, -1.0}) {
            CAPTURE(speed);
            VibrationPlayer player = engaged(Stage::navigation);
            player.input.angle = direction * to_radians(15.0);
            player.turn(direction * 12.0 * pi, 0.0, static_cast<int>(12.0 * pi / speed / player.dt));
            player.run(30);
            CHECK(player.count(VibrationCue::detent) == doctest::Approx(72).epsilon(1.1 / 72.0));
            CHECK(player.sent.size() == static_cast<std::size_t>(player.count(VibrationCue::detent)));
        }
    // Faster, detents share frames; a nut that trembles at a detent gives no further cue.
    VibrationPlayer fast = engaged(Stage::navigation);
    fast.turn(60.0, 0.0, 1000);
    CHECK(fast.count(VibrationCue::detent) > 60);
    CHECK(fast.count(VibrationCue::detent) <= 91);
    VibrationPlayer trembling = engaged(Stage::navigation);
    trembling.turn(to_radians(30.1), 0.0, 100);
    for (int i = 0; i < 200; ++i) trembling.turn(to_radians(i % 2 == 0 ? -5.0 : 5.0), 0.0, 20);
    CHECK(trembling.count(VibrationCue::detent) == 1);
}

TEST_CASE("Vibration: undoing a step, which moves the nut at once, gives no cue") {
    VibrationPlayer player = engaged(Stage::navigation);
    player.run(50);
    player.input.angle = 40.0;
    player.run(50);
    player.input.angle = 0.0;
    player.run(50);
    CHECK(player.sent.empty());
}

TEST_CASE(
    "Vibration: the seat gives one pulse, also if the stage flickers, and another after the nut is free") {
    VibrationPlayer player = engaged(Stage::navigation);
    player.turn(1.0, 0.0, 500);
    for (int i = 0; i < 20; ++i) {
        player.input.stage = i % 2 == 0 ? Stage::transition : Stage::navigation;
        player.run(30);
    }
    CHECK(player.count(VibrationCue::seat) == 1);
    player.input.stage = Stage::navigation;
    player.turn(-0.5, 0.0, 300);
    player.turn(0.5, 0.0, 300);
    player.input.stage = Stage::transition;
    player.run(200);
    CHECK(player.count(VibrationCue::seat) == 2);
    // A wrench that takes a seated nut does not reach the seat.
    player.input.joint = -1;
    player.run(20);
    player.input.joint = 1;
    player.input.stage = Stage::linearity;
    player.run(200);
    CHECK(player.count(VibrationCue::seat) == 2);
}

TEST_CASE("Vibration: the amplitude of the load grows with the torque by the stated power") {
    VibrationPlayer player = engaged(Stage::linearity);
    player.turn(0.5, 55.0, 3000);
    const VibrationOptions options;
    double before = 0.0;
    int loads = 0;
    for (const test::SentCommand& one : player.sent) {
        if (one.command.cue != VibrationCue::load_pulse) continue;
        ++loads;
        const double share = one.input.torque / one.input.target;
        CHECK(one.command.amplitude > before);
        CHECK(one.command.amplitude == doctest::Approx(0.6 * std::pow(share, 1.0 / 0.89)).epsilon(1e-9));
        CHECK(one.command.frequency == options.load_pulse.frequency);
        before = one.command.amplitude;
    }
    CHECK(loads > 250);
    // The sensation, amplitude^0.89, is proportional to the torque.
    CHECK(before == doctest::Approx(0.6 * std::pow(1.1, 1.0 / 0.89)).epsilon(0.02));
    // Loosening and releasing: a torque of the other sign is a load too, a torque that falls is not.
    player.sent.clear();
    player.run(400);
    player.sent.clear();
    player.turn(0.0, 5.0, 1000);
    CHECK(player.count(VibrationCue::load_pulse) == 0);
    VibrationPlayer loosened = engaged(Stage::linearity);
    loosened.turn(0.0, -30.0, 1000);
    CHECK(loosened.count(VibrationCue::load_pulse) > 80);
    VibrationPlayer without_target = engaged(Stage::linearity);
    without_target.input.target = 0.0;
    without_target.turn(0.5, 50.0, 1000);
    CHECK(without_target.count(VibrationCue::load_pulse) == 0);
}

TEST_CASE("Vibration: yield gives one pulse, and the load pulses become slower") {
    VibrationPlayer player = engaged(Stage::linearity);
    player.turn(0.3, 50.0, 1000);
    player.input.stage = Stage::yield;
    player.turn(0.02, 50.5, 50);
    player.input.stage = Stage::linearity;  // as a nut that sticks for a moment
    player.run(20);
    player.input.stage = Stage::yield;
    player.turn(0.4, 51.0, 1000);
    CHECK(player.count(VibrationCue::yield) == 1);
    int slow = 0;
    for (const test::SentCommand& one : player.sent)
        if (one.command.cue == VibrationCue::load_pulse && one.time > 1.3) {
            CHECK(one.command.frequency == player.options.yield_frequency);
            ++slow;
        }
    CHECK(slow > 50);
    CHECK(player.options.yield_frequency < player.options.load_pulse.frequency);
}

TEST_CASE("Vibration: a loaded nut that breaks away gives one pulse in each pull, in both directions") {
    for (const double direction : {1.0, -1.0}) {
        VibrationPlayer player = engaged(Stage::linearity);
        for (int pull = 0; pull < 4; ++pull) {
            player.turn(0.0, direction * 30.0, 400);
            player.turn(direction * 0.1, direction * 32.0, 300);
            player.turn(0.0, 0.0, 200);
            player.run(200);
        }
        CHECK(player.count(VibrationCue::breakaway) == 4);
    }
    VibrationPlayer light = engaged(Stage::transition);  // without load there is nothing to break away from
    light.turn(0.0, 1.0, 400);
    light.turn(0.1, 1.0, 300);
    CHECK(light.count(VibrationCue::breakaway) == 0);
    VibrationPlayer creeping = engaged(Stage::linearity);  // a nut that never rests does not break away
    creeping.turn(to_radians(10.0), 40.0, 10000);
    CHECK(creeping.count(VibrationCue::breakaway) == 0);
}

TEST_CASE("Vibration: slip, click and bump give one command each, whatever the frame rate") {
    for (const int frame : {1, 7, 11, 14, 33}) {
        CAPTURE(frame);
        VibrationPlayer player = engaged(Stage::linearity, 20.0);
        player.frame = frame;
        player.run(101);
        player.input.slipped = true;
        player.run(211);
        player.input.clicked = true;
        player.run(207);
        player.input.strike_speed = 0.3;
        player.run(203);
        CHECK(player.count(VibrationCue::slip) == 1);
        CHECK(player.count(VibrationCue::click) == 1);
        CHECK(player.count(VibrationCue::strike) == 1);
        CHECK(player.sent.size() == 3);
    }
    double before = 0.0;  // a faster strike is stronger, up to full_strike
    for (const double speed : {0.05, 0.2, 0.4, 0.5, 3.0}) {
        VibrationPlayer player;
        player.input.strike_speed = speed;
        player.run(100);
        REQUIRE(player.sent.size() == 1);
        CHECK(player.sent[0].command.amplitude == doctest::Approx(0.8 * std::min(1.0, speed / 0.5)));
        CHECK(player.sent[0].command.amplitude >= before);
        before = player.sent[0].command.amplitude;
    }
}

TEST_CASE("Vibration: of several events in a frame the strongest comes first, and the others follow") {
    VibrationPlayer player = engaged(Stage::linearity, 20.0);
    player.run(99);
    player.input.strike_speed = 0.5;
    player.tick();
    player.input.clicked = true;
    player.tick();
    player.input.strike_speed = 0.1;
    player.run(99);
    REQUIRE(player.sent.size() == 2);
    CHECK(player.sent[0].command.cue == VibrationCue::click);
    CHECK(player.sent[1].command.cue == VibrationCue::strike);
    CHECK(player.sent[1].command.amplitude == doctest::Approx(0.8));  // the stronger of two strikes
    CHECK(player.sent[1].time >= player.sent[0].time + player.sent[0].command.duration - 1e-9);
}

TEST_CASE("Vibration: a weaker cue never interrupts an event, a stronger one does") {
    VibrationPlayer player = engaged(Stage::linearity, 20.0);
    player.input.slipped = true;
    player.run(20);
    REQUIRE(player.sent.size() == 1);
    player.turn(0.1, 40.0, 40);  // load that grows
    CHECK(player.sent.size() == 1);
    player.input.clicked = true;
    player.run(12);
    REQUIRE(player.sent.size() == 2);
    CHECK(player.sent[1].command.cue == VibrationCue::click);
}

TEST_CASE("Vibration: the gain scales all amplitudes, and zero sends nothing") {
    std::vector<double> amplitudes;
    for (const double gain : {1.0, 0.5, 0.0}) {
        VibrationPlayer player = engaged(Stage::navigation);
        player.options.gain = gain;
        player.turn(2.0, 0.0, 500);
        player.input.stage = Stage::linearity;
        player.turn(0.5, 50.0, 500);
        player.input.clicked = true;
        player.run(100);
        if (gain == 1.0)
            for (const auto& one : player.sent) amplitudes.push_back(one.command.amplitude);
        if (gain == 0.0) CHECK(player.sent.empty());
        if (gain != 0.5) continue;
        // Commands that are too weak to feel are left out.
        std::size_t at = 0;
        for (const double amplitude : amplitudes) {
            if (0.5 * amplitude < player.options.min_amplitude) continue;
            REQUIRE(at < player.sent.size());
            CHECK(player.sent[at++].command.amplitude == doctest::Approx(0.5 * amplitude));
        }
        CHECK(at == player.sent.size());
    }
    CHECK(amplitudes.size() > 30);
}

TEST_CASE(
    "Vibration: any input gives commands in their bounds, at most one in min_interval, with equal bits") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::vector<VibrationCommand> first;
        for (int repetition = 0; repetition < 2; ++repetition) {
            Random random(seed);
            VibrationPlayer player;
            player.options.gain = random.uniform(0.1, 1.0);
            player.frame = 1 + static_cast<int>(random.bits() % 30);
            for (int i = 0; i < 5000; ++i) {
                if (random.chance(0.1)) player.input = any_input(random);
                player.input.angle += random.uniform(-0.01, 0.03);
                player.tick();
            }
            double last = -1.0;
            std::vector<VibrationCommand> commands;
            for (const test::SentCommand& one : player.sent) {
                REQUIRE(test::is_valid(one.command));
                REQUIRE(one.time - last >= player.options.min_interval - 1e-12);
                last = one.time;
                commands.push_back(one.command);
            }
            REQUIRE(commands.size() > 20);
            if (repetition == 0) first = commands;
            REQUIRE(commands.size() == first.size());
            for (std::size_t i = 0; i < commands.size(); ++i) {
                REQUIRE(std::memcmp(&commands[i].amplitude, &first[i].amplitude, sizeof(double)) == 0);
                REQUIRE(std::memcmp(&commands[i].frequency, &first[i].frequency, sizeof(double)) == 0);
                REQUIRE(commands[i].cue == first[i].cue);
            }
        }
    }
}

TEST_CASE("Vibration: a tick and a frame do not allocate, lock or read a clock") {
    VibrationPlayer player = engaged(Stage::linearity);
    player.input.clicked = player.input.slipped = true;
    std::optional<VibrationCommand> command;
    const auto forbidden = test::forbidden_in([&] {
        for (int i = 0; i < 100; ++i) {
            player.input.torque += 0.3;
            advance_vibration(player.state, player.options, player.input, 1e-3);
            command = next_vibration(player.state, player.options);
        }
    });
    CHECK(forbidden.all() == 0);
    CHECK(player.state.sent_at > 0.0);
}

}  // namespace vibration_cues_test
