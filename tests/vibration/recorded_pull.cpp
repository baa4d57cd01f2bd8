// The vibration of recorded work: a session in which a bolt is tightened to yield, and measured loosening
// runs.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "game/analysis/measured.hpp"
#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "game/session/session_file.hpp"
#include "tests/support/oracle.hpp"
#include "tests/vibration/support.hpp"

namespace recorded_pull_test {

using namespace bolt;
using namespace bolt::servo;
using joint::Stage;
using test::VibrationPlayer;

namespace {

constexpr double target = 72.0;  // N·m, of the session's joint

std::vector<session::TickRecord> recorded() {
    const auto reader = session::SessionReader::open(test::test_file("data/format-4.boltwright"));
    REQUIRE(reader);
    std::vector<session::TickRecord> ticks;
    REQUIRE(reader->for_each_chunk([&](std::uint64_t, std::span<const session::TickRecord> chunk) {
        ticks.insert(ticks.end(), chunk.begin(), chunk.end());
    }));
    return ticks;
}

VibrationInput recorded_input(const session::TickRecord& tick) {
    Output output;
    output.joint = tick.joint;
    output.stage = static_cast<Stage>(tick.stage);
    output.wrench_torque = static_cast<double>(tick.wrench_torque);
    output.nut_angle = static_cast<double>(tick.nut_angle);
    return vibration_input(output, target, 0.0);
}

VibrationPlayer played(std::span<const session::TickRecord> ticks) {
    VibrationPlayer player;
    for (const session::TickRecord& tick : ticks) {
        player.input = recorded_input(tick);
        player.tick();
    }
    return player;
}

std::vector<double> times_of(const VibrationPlayer& player, VibrationCue cue) {
    std::vector<double> times;
    for (const test::SentCommand& one : player.sent)
        if (one.command.cue == cue) times.push_back(one.time);
    return times;
}

// Torque and nut angle above, the commands below: a bar of the amplitude for each.
void draw(std::span<const session::TickRecord> ticks, const VibrationPlayer& player) {
    const double end = static_cast<double>(ticks.size()) * player.dt;
    plot::Plot torque, vibration;
    for (plot::Plot* one : {&torque, &vibration}) {
        one->width = 900.0;
        one->height = 300.0;
        one->x = {plot::covering_ticks(0.0, end), "time, s"};
    }
    torque.title = "Torque on the nut";
    torque.y = {plot::covering_ticks(0.0, 80.0), "N·m"};
    vibration.title = "Vibration";
    vibration.y = {plot::covering_ticks(0.0, 1.0), "amplitude"};
    plot::PlotLine line{{}, "ln p2", false};
    for (std::size_t i = 0; i < ticks.size(); i += 10)
        line.points.push_back(
            {static_cast<double>(i) * player.dt, static_cast<double>(ticks[i].wrench_torque)});
    torque.lines.push_back(line);
    for (const test::SentCommand& one : player.sent) {
        const bool load = one.command.cue == VibrationCue::load_pulse;
        const double until = one.time + (load ? 0.011 : one.command.duration);
        vibration.lines.push_back({{{one.time, 0.0},
                                    {one.time, one.command.amplitude},
                                    {until, one.command.amplitude},
                                    {until, 0.0}},
                                   load ? "ln p2" : "ln cl",
                                   false});
    }
    for (const auto& [cue, label] :
         {std::pair(VibrationCue::seat, "seat"), std::pair(VibrationCue::breakaway, "breakaway"),
          std::pair(VibrationCue::yield, "yield")})
        for (const double time : times_of(player, cue))
            torque.markers.push_back({{time, 0.0}, plot::MarkerShape::dot, "dot", label, false, true});
    plot::Svg svg(900.0, 600.0, "Vibration of a recorded pull");
    svg.begin_clip({0.0, 0.0, 900.0, 300.0});
    plot::draw_into(svg, torque);
    svg.end_clip();
    svg.begin_clip({0.0, 300.0, 900.0, 300.0});
    plot::draw_into(svg, vibration);
    svg.end_clip();
    const std::filesystem::path folder = BOLT_VIBRATION_OUT;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "pull.svg") << plot::standalone(svg.finish(), plot::style_sheet());
    std::ofstream table(folder / "pull.csv");
    table << "time_s,cue,amplitude,frequency_Hz,duration_s,torque_Nm,angle_deg\n";
    for (const test::SentCommand& one : player.sent)
        table << fmt::format("{:.3f},{},{:.3f},{:.0f},{:.3f},{:.2f},{:.1f}\n", one.time,
                             static_cast<int>(one.command.cue), one.command.amplitude, one.command.frequency,
                             one.command.duration, one.input.torque, to_degrees(one.input.angle));
}

}  // namespace

TEST_CASE("Vibration of a recorded pull: the cues come in the order of the stages, one for each event") {
    const std::vector<session::TickRecord> ticks = recorded();
    const VibrationPlayer player = played(ticks);
    for (const test::SentCommand& one : player.sent) REQUIRE(test::is_valid(one.command));

    const auto detents = times_of(player, VibrationCue::detent), seats = times_of(player, VibrationCue::seat),
               loads = times_of(player, VibrationCue::load_pulse),
               yields = times_of(player, VibrationCue::yield);
    // The nut is run down by 720° by hand until it reaches its seat.
    const auto seat = std::find_if(ticks.begin(), ticks.end(), [](const session::TickRecord& tick) {
        return tick.joint >= 0 && static_cast<Stage>(tick.stage) != Stage::navigation;
    });
    REQUIRE(seat != ticks.end());
    const double run_down = to_degrees(static_cast<double>(seat->nut_angle));
    CHECK(detents.size() == doctest::Approx(std::floor(run_down / 30.0)).epsilon(1.1 / 24.0));
    REQUIRE(seats.size() == 1);
    REQUIRE(yields.size() == 1);  // the stage changes to yield twice within 20 ms
    REQUIRE(!loads.empty());
    const double seat_time = static_cast<double>(seat - ticks.begin()) * player.dt;
    CHECK(std::abs(seats[0] - seat_time) < 0.03);
    CHECK(detents.back() <= seats[0]);
    CHECK(seats[0] < loads.front());
    CHECK(loads.front() < yields[0]);
    draw(ticks, player);
}

TEST_CASE("Vibration of a recorded pull: silent while the nut is not touched, and while nothing changes") {
    const std::vector<session::TickRecord> ticks = recorded();
    const VibrationPlayer player = played(ticks);
    for (const test::SentCommand& one : player.sent) {
        // In the last 0.3 s a nut was held that turned, or whose torque grew.
        const auto now = static_cast<std::size_t>(one.time / player.dt);
        bool active = false;
        for (std::size_t i = now > 300 ? now - 300 : 1; i < now; ++i)
            active = active || (ticks[i].joint >= 0 && ticks[i - 1].joint == ticks[i].joint &&
                                (std::abs(ticks[i].nut_angle - ticks[i - 1].nut_angle) > 1e-7F ||
                                 ticks[i].wrench_torque > ticks[i - 1].wrench_torque));
        CAPTURE(one.time);
        REQUIRE(active);
    }
    double longest = 0.0, last = 0.0;  // the hand moves to the nut for seconds
    for (const test::SentCommand& one : player.sent) {
        longest = std::max(longest, one.time - last);
        last = one.time;
    }
    CHECK(longest > 1.0);
}

TEST_CASE("Vibration of a recorded pull: in the linear stage a larger torque gives a larger amplitude") {
    const VibrationPlayer player = played(recorded());
    std::vector<std::pair<double, double>> loads;  // torque, amplitude
    for (const test::SentCommand& one : player.sent)
        if (one.command.cue == VibrationCue::load_pulse && one.input.stage == Stage::linearity)
            loads.emplace_back(one.input.torque, one.command.amplitude);
    REQUIRE(loads.size() > 50);
    std::sort(loads.begin(), loads.end());
    CHECK(loads.back().first > 60.0);
    for (std::size_t i = 1; i < loads.size(); ++i) REQUIRE(loads[i].second >= loads[i - 1].second);
}

TEST_CASE("Vibration of a recorded pull: repeated, it has the same bits") {
    const std::vector<session::TickRecord> ticks = recorded();
    const VibrationPlayer first = played(ticks), second = played(ticks);
    REQUIRE(first.sent.size() == second.sent.size());
    for (std::size_t i = 0; i < first.sent.size(); ++i) {
        CHECK(first.sent[i].command.amplitude == second.sent[i].command.amplitude);
        CHECK(first.sent[i].command.cue == second.sent[i].command.cue);
        CHECK(first.sent[i].time == second.sent[i].time);
    }
}

// M8 nuts that a robot loosened at 40 rpm: the torque falls within a turn, then the nut runs freely.
TEST_CASE("Vibration of measured loosening: a load at the beginning, then one detent for each 30 degrees") {
    constexpr double speed = to_radians(240.0), loaded = 0.15;  // rad/s, N·m
    const auto record = analysis::read_measured(test::test_file("data/m8_releasable.csv"));
    REQUIRE_MESSAGE(record, record.error().message());
    REQUIRE(record->cycles.size() == 5);
    for (const analysis::Cycle& cycle : record->cycles) {
        CAPTURE(cycle.name);
        VibrationPlayer player;
        player.input.joint = 0;
        player.input.target = 2.0;
        double free_from = 0.0;  // rad
        bool load = true;
        std::size_t at = 0;
        for (double angle = 0.0; angle < cycle.angle.back(); angle += speed * player.dt) {
            while (at + 1 < cycle.angle.size() && cycle.angle[at + 1] <= angle) ++at;
            player.input.angle = -angle;
            player.input.torque = -std::abs(cycle.torque[at]);
            load = load && std::abs(cycle.torque[at]) > loaded;
            player.input.stage = load ? Stage::transition : Stage::navigation;
            if (load) free_from = angle;
            player.tick();
        }
        const double free = cycle.angle.back() - free_from;
        CHECK(player.count(VibrationCue::detent) ==
              doctest::Approx(to_degrees(free) / 30.0).epsilon(1.1 / 25.0));
        for (const test::SentCommand& one : player.sent) {
            REQUIRE(test::is_valid(one.command));
            if (one.command.cue == VibrationCue::load_pulse) CHECK(-one.input.angle < 2.0 * pi + 0.5);
        }
    }
}

}  // namespace recorded_pull_test
