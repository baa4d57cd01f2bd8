// No shock: the force on the hand while a wrench collides, compared with plain penalty contact. Writes
// steps.csv and no-shock.svg to the build folder.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <span>

#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "tests/no_shock/script.hpp"

using namespace bolt;
using namespace bolt::test;

namespace {

constexpr double speeds[] = {0.05, 0.1, 0.2, 0.35, 0.5};  // m/s

GodObjectParameters for_device(double dt) {
    GodObjectParameters p;
    proxy::CouplingRange range;
    range.dt = dt;
    p.coupling = proxy::make_coupling(range);
    p.radius = 0.165;
    return p;
}

struct CollisionResult {
    std::string name;
    double speed = 0.0;
    Shock god_object, every_point, deepest;
};

std::vector<CollisionResult> run_all(double dt, std::span<const double> at) {
    const GodObjectParameters p = for_device(dt);
    std::vector<CollisionResult> results;
    for (const Script& s : collisions())
        for (const double v : at)
            results.push_back(
                {s.name, v, shock_of(with_god_object(p, s, v, dt), p.coupling, dt),
                 shock_of(with_penalty(p.coupling, s, v, dt, Penalty::every_point), p.coupling, dt),
                 shock_of(with_penalty(p.coupling, s, v, dt, Penalty::deepest), p.coupling, dt)});
    return results;
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
}

std::string csv(const std::vector<CollisionResult>& results) {
    std::string text =
        "collision,speed_m_s,method,step_of_greatest_force_per_ms,step_of_greatest_torque_per_ms,"
        "step_beyond_own_motion_of_force_felt_per_ms\n";
    for (const CollisionResult& r : results)
        for (const auto& [method, shock] :
             {std::pair("god-object", r.god_object), std::pair("penalty, every point", r.every_point),
              std::pair("penalty, deepest point", r.deepest)})
            text += fmt::format("\"{}\",{},\"{}\",{:.4f},{:.4f},{:.4f}\n", r.name, r.speed, method,
                                shock.step, shock.torque_step, shock.event);
    return text;
}

// One line per collision: greatest step over the speed.
plot::Plot step_plot(const std::vector<CollisionResult>& results) {
    plot::Plot plot;
    plot.width = 760.0;
    plot.height = 320.0;
    plot.title = "Greatest change of force in a millisecond, by collision";
    plot.x = {plot::covering_ticks(0.0, 0.5), "speed, m/s"};
    plot.y = {plot::covering_ticks(0.0, 200.0), "change in 1 ms, % of the greatest force"};
    const auto lines = [&](Shock CollisionResult::*method, std::string_view style) {
        for (std::size_t i = 0; i < results.size(); i += std::size(speeds)) {
            plot::PlotLine line{{}, style, false};
            for (std::size_t k = 0; k < std::size(speeds); ++k)
                line.points.push_back({results[i + k].speed, 100.0 * (results[i + k].*method).step});
            plot.lines.push_back(line);
        }
    };
    lines(&CollisionResult::every_point, "ln rest");
    lines(&CollisionResult::deepest, "ln cl");
    lines(&CollisionResult::god_object, "ln p2");
    plot.reference_lines.push_back({10.0, "tgt", "10 %", true});
    return plot;
}

plot::Plot time_plot(const Script& script, double speed, double dt) {
    const GodObjectParameters p = for_device(dt);
    plot::Plot plot;
    plot.width = 760.0;
    plot.height = 320.0;
    plot.title = "Force over time: pressed on a block, slid over its edge and off it";
    const auto line = [&](const Run& run, std::string_view style) {
        plot::PlotLine l{{}, style, false};
        for (std::size_t i = 0; i < run.size(); ++i)
            l.points.push_back({static_cast<double>(i) * dt, glm::length(run[i].command.force)});
        plot.lines.push_back(l);
        plot.x = {plot::covering_ticks(0.0, static_cast<double>(run.size()) * dt), "time, s"};
    };
    line(with_penalty(p.coupling, script, speed, dt, Penalty::every_point), "ln rest");
    line(with_penalty(p.coupling, script, speed, dt, Penalty::deepest), "ln cl");
    line(with_god_object(p, script, speed, dt), "ln p2");
    plot.y = {plot::covering_ticks(0.0, p.coupling.max_force), "force on the hand, N"};
    return plot;
}

std::string figure(const std::vector<CollisionResult>& results, const Script& script, double dt) {
    const plot::Plot steps = step_plot(results), time = time_plot(script, 0.2, dt);
    constexpr double head = 28.0;
    plot::Svg svg(760.0, head + steps.height + time.height,
                  "God-object and penalty contact: what the hand is given");
    double x = 10.0;
    for (const auto& [style, words] :
         {std::pair("ln p2", "god-object"), std::pair("ln cl", "penalty, deepest point of each obstacle"),
          std::pair("ln rest", "penalty, every point")}) {
        svg.line({x, 14.0}, {x + 24.0, 14.0}, style);
        svg.text({x + 30.0, 18.0}, "tk", words);
        x += 260.0;
    }
    svg.begin_clip({0.0, head, steps.width, steps.height});
    plot::draw_into(svg, steps);
    svg.end_clip();
    svg.begin_clip({0.0, head + steps.height, time.width, time.height});
    plot::draw_into(svg, time);
    svg.end_clip();
    return plot::standalone(svg.finish(), plot::style_sheet());
}

}  // namespace

TEST_CASE("No shock: at 0.05 to 0.5 m/s force steps stay below a tenth of the maximum and imperceptible") {
    const std::vector<CollisionResult> results = run_all(1e-3, speeds);
    Shock worst, worst_every, worst_deepest;
    for (const CollisionResult& r : results) {
        CAPTURE(r.name);
        CAPTURE(r.speed);
        CHECK(r.god_object.step <= 0.1);
        CHECK(r.god_object.torque_step <= 0.1);
        CHECK(r.god_object.event < 0.07);
        worst_every.step = std::max(worst_every.step, r.every_point.step);
        worst_every.event = std::max(worst_every.event, r.every_point.event);
        worst_deepest.step = std::max(worst_deepest.step, r.deepest.step);
        worst_deepest.event = std::max(worst_deepest.event, r.deepest.event);
        worst.step = std::max(worst.step, r.god_object.step);
        worst.event = std::max(worst.event, r.god_object.event);
    }
    MESSAGE(fmt::format(
        "greatest step in a millisecond, of the greatest force: god-object {:.1f} %, penalty {:.0f} % (every "
        "point) and {:.0f} % (deepest); beyond the hand's own motion, of what is felt: {:.1f} %, {:.0f} %, "
        "{:.0f} %",
        100 * worst.step, 100 * worst_every.step, 100 * worst_deepest.step, 100 * worst.event,
        100 * worst_every.event, 100 * worst_deepest.event));
    // Control: plain penalty contact exceeds the limits, also with only the deepest points.
    CHECK(worst_every.step > 0.5);
    CHECK(worst_deepest.step > 0.3);
    CHECK(worst_deepest.event > 0.07);

    const std::vector<Script> scripts = collisions();
    const auto edge = std::find_if(scripts.begin(), scripts.end(),
                                   [](const Script& s) { return s.name == "over an edge and off it"; });
    REQUIRE(edge != scripts.end());
    write(std::filesystem::path(BOLT_NO_SHOCK) / "steps.csv", csv(results));
    write(std::filesystem::path(BOLT_NO_SHOCK) / "no-shock.svg", figure(results, *edge, 1e-3));
}

TEST_CASE("No shock: the limits per millisecond hold at 4 kHz") {
    for (const CollisionResult& r : run_all(0.25e-3, std::array{0.1, 0.5})) {
        CAPTURE(r.name);
        CAPTURE(r.speed);
        CHECK(r.god_object.step <= 0.1);
        CHECK(r.god_object.torque_step <= 0.1);
        CHECK(r.god_object.event < 0.07);
    }
}
