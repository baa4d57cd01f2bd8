#include "tools/author/curve_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "game/plot/decimate.hpp"
#include "game/plot/plot.hpp"
#include "game/plot/style.hpp"

namespace bolt::author {

namespace {

constexpr double lead_in = 20.0;  // degrees drawn before the first contact

std::size_t first_contact(std::span<const joint::CurveSample> run) {
    const auto touches = [](const joint::CurveSample& s) { return s.stage != joint::Stage::navigation; };
    return static_cast<std::size_t>(std::find_if(run.begin(), run.end(), touches) - run.begin());
}

}  // namespace

std::string curve_svg(const content::AssemblyJoint& joint, std::span<const joint::CurveSample> run,
                      joint::Direction direction, std::string_view title) {
    const bool on = direction == joint::Direction::tighten;
    const std::size_t contact = on ? std::min(first_contact(run), run.size() - 1) : 0;
    const double zero = to_degrees(run[contact].angle);

    plot::Plot plot;
    plot.width = 760.0;
    plot.height = 400.0;
    plot.title = std::string(title);
    std::vector<plot::Point> torque, clamp;
    double highest_torque = 0.0, highest_clamp = 0.0;
    for (const joint::CurveSample& s : run) {
        const double x = to_degrees(s.angle) - zero;
        if (on && x < -lead_in) continue;
        torque.push_back({x, on ? s.torque : -s.torque});
        clamp.push_back({x, s.clamp / 1e3});
        highest_torque = std::max(highest_torque, torque.back().y);
        highest_clamp = std::max(highest_clamp, s.clamp / 1e3);
    }
    const plot::Range shown{torque.front().x, torque.back().x};
    plot.x = {plot::degree_ticks(shown, 9),
              on ? "nut angle from first contact, °" : "nut angle turned back, °"};
    plot.y = {plot::covering_ticks(0.0, std::max(highest_torque, on ? joint.spec.torque.high : 0.0)),
              "torque, N·m"};
    plot.y2 = plot::Axis{plot::covering_ticks(0.0, highest_clamp), "clamp, kN"};

    constexpr std::string_view stage_styles[] = {"s0", "s1", "s2", "s3"};
    for (std::size_t i = 0, begin = 0; i <= run.size(); ++i) {
        if (i < run.size() && run[i].stage == run[begin].stage) continue;
        const double low = std::max(to_degrees(run[begin].angle) - zero, shown.low);
        const double high = to_degrees(run[std::min(i, run.size() - 1)].angle) - zero;
        const auto stage = static_cast<std::size_t>(run[begin].stage);
        if (high > low)
            plot.bands.push_back(
                {{low, high}, stage_styles[stage], std::string(name(run[begin].stage)), false, false});
        begin = i;
    }
    if (on) {
        plot.bands.push_back({{joint.spec.torque.low, joint.spec.torque.high}, "win", {}, true, false});
        plot.rules.push_back({joint.spec.torque.target, "tgt", "target", true});
    }
    const double column = (shown.high - shown.low) / 1500.0;
    plot.lines.push_back({plot::decimate(clamp, column), "ln cl", true});
    plot.lines.push_back({plot::decimate(torque, column), "ln p2", false});
    return plot::standalone(plot::draw(plot), plot::style_sheet());
}

}  // namespace bolt::author
