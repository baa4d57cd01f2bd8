#include "game/report/guiding_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "game/analysis/quartiles.hpp"
#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"
#include "game/plot/text.hpp"

namespace bolt::report {

namespace {

template <class... Values>
void put(std::string& out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

struct Measure {
    std::string_view name, unit;
    double Attempt::*value;
    double scale;
    int decimals;
};

constexpr Measure measures[] = {
    {"Time to get onto the nut", "s, median over the steps", &Attempt::to_nut, 1.0, 2},
    {"Time near the nut until it is held", "s, median over the steps", &Attempt::near_nut, 1.0, 2},
    {"Nut in sight meanwhile", "% of the time, with 60 % of it seen or more", &Attempt::seen, 100.0, 0},
    {"Bumps", "in a lesson", &Attempt::bumps, 1.0, 1},
    {"Time against something", "s in a lesson", &Attempt::bump_time, 1.0, 2},
    {"Duration of the lesson", "min", &Attempt::duration, 1.0 / 60.0, 2},
    {"Score", "points", &Attempt::score, 1.0, 1},
    {"Largest change of force in 1 ms", "% of the device's greatest", &Attempt::greatest_change, 100.0, 2},
    {"Usual change of force in 1 ms", "% of the device's greatest, 99th percentile", &Attempt::usual_change,
     100.0, 3},
};

// What is with some lessons and not with others.
struct Factor {
    std::string_view heading, title, with, without;
    bool Attempt::*has;
    std::string_view model;  // how simulated trainees have it
};

constexpr Factor guiding{"guiding", "with and without guiding", "guided", "not guided", &Attempt::guided, ""};
constexpr Factor view{
    "view help",
    "with and without view help",
    "view help",
    "by hand",
    &Attempt::view_help,
    " Whoever sees less of nut and jaw than they want presses V: after a glance of 0.3 s and 0.35 s of "
    "gliding "
    "the eye is where the program's search puts it, and what is still not seen to their content is looked "
    "for by "
    "hand. By hand the eye begins in the assembly's first view and is moved about the place at 60° a second: "
    "up, down or "
    "aside by chance and after a glance of 0.3 s, on while more is seen, back after 30° in vain and another "
    "way, "
    "until they are content or it is worse everywhere. The hand waits meanwhile; who sees less places the "
    "wrench "
    "worse. Nothing else differs: that people forget the key, tire, or lose their way in a view is not "
    "modelled."};

using Group = std::vector<const Attempt*>;

std::vector<double> values_of(const Group& group, const Measure& measure) {
    std::vector<double> values;
    for (const Attempt* a : group) {
        const double value = a->*measure.value * measure.scale;
        if (std::isfinite(value)) values.push_back(value);
    }
    return values;
}

// Dots that would cover each other stand on top of each other, within the row; how many they are is said
// where there is no room for that.
void draw_row(plot::Svg& svg, const std::vector<double>& values, const plot::Scale& x, double left,
              double middle, std::string_view dot) {
    constexpr double radius = 2.6, room = 11.0;
    const analysis::Quartiles q = analysis::quartiles(values);
    if (q.n == 0) return;
    svg.rect({left + x(q.low), middle - room, x(q.high) - x(q.low), 2.0 * room}, "bf", 2.0);
    svg.line({left + x(q.median), middle - room - 2.0}, {left + x(q.median), middle + room + 2.0}, "me1");
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    std::vector<plot::Point> drawn;
    for (const double value : sorted) {
        plot::Point p{left + x(value), middle};
        for (int step = 1; step < 9; ++step) {
            const bool covered = std::any_of(drawn.begin(), drawn.end(), [&](const plot::Point& d) {
                return std::hypot(d.x - p.x, d.y - p.y) < 2.0 * radius;
            });
            if (!covered) break;
            p.y = middle + (step % 2 == 1 ? 1.0 : -1.0) * std::ceil(0.5 * step) * radius;
        }
        drawn.push_back(p);
        svg.circle(p, radius, dot);
    }
    constexpr std::ptrdiff_t most = 5;
    for (auto same = sorted.begin(); same != sorted.end();) {
        const auto end = std::upper_bound(same, sorted.end(), *same);
        if (end - same > most)
            svg.text({left + x(*same) + 2.0 * radius, middle + 4.0}, "sm", fmt::format("×{}", end - same));
        same = end;
    }
}

std::string strip_plot(const Group& with, const Group& without, const Measure& measure,
                       const Factor& factor) {
    const std::vector<double> a = values_of(with, measure), b = values_of(without, measure);
    if (a.empty() || b.empty()) return {};
    const double high =
        std::max(*std::max_element(a.begin(), a.end()), *std::max_element(b.begin(), b.end()));
    constexpr double width = 460.0, height = 112.0, left = 82.0, right = 22.0;
    const plot::Ticks ticks = plot::covering_ticks(0.0, high > 0.0 ? high : 1.0, 5);
    const plot::Scale x{ticks.range, width - left - right, false};
    plot::Svg svg(width, height, fmt::format("{}, {}, {}", measure.name, measure.unit, factor.title));
    for (const double at : ticks.at) {
        svg.line({left + x(at), 4.0}, {left + x(at), 80.0}, "gr");
        svg.text({left + x(at), 93.0}, "tk mid", plot::number(at, ticks.decimals));
    }
    svg.text({left - 8.0, 26.0}, "lb end", factor.with);
    svg.text({left - 8.0, 64.0}, "lb end", factor.without);
    draw_row(svg, a, x, left, 22.0, "mpeak");
    draw_row(svg, b, x, left, 60.0, "mclamp");
    svg.text({left + 0.5 * x.length, 106.0}, "sm mid", measure.unit);
    return plot::figure(fmt::format("<h3>{}</h3>", measure.name), svg.finish(), "");
}

std::string quartile_text(const analysis::Quartiles& q, int decimals) {
    return fmt::format("{} <span class=\"of\">({} to {})</span>", plot::number(q.median, decimals),
                       plot::number(q.low, decimals), plot::number(q.high, decimals));
}

std::string part(const Group& with, const Group& without, const Factor& factor) {
    const Attempt& first = *with.front();
    const bool simulated = first.operator_kind == session::OperatorKind::simulated;
    std::string out;
    put(out, "<h2>With and without {}: {}, {}{}</h2>\n", factor.heading, plot::escape(first.title),
        plot::escape(first.trainee), first.obstacles ? "" : ", without obstacles");
    const auto finished = [](const Group& group) {
        return std::count_if(group.begin(), group.end(), [](const Attempt* a) { return a->finished; });
    };
    put(out, "<p>{}n = {} {} and {} {}; finished: {} and {}.{}</p>\n",
        simulated
            ? "<strong>These trainees are simulated:</strong> this shows what the program does to a model of "
              "a hand, not what it does to people. "
        : first.operator_kind == session::OperatorKind::unrecorded
            ? "These sessions do not record whether a person or a simulated trainee held the tool. "
            : "",
        with.size(), factor.with, without.size(), factor.without, finished(with), finished(without),
        simulated ? factor.model : "");
    put(out,
        "<div class=\"scroll\"><table><thead><tr><th>median (quartiles)</th><th class=\"n\">{}</th><th "
        "class=\"n\">{}</th></tr></thead><tbody>\n",
        factor.with, factor.without);
    for (const Measure& m : measures) {
        const analysis::Quartiles a = analysis::quartiles(values_of(with, m)),
                                  b = analysis::quartiles(values_of(without, m));
        if (a.n + b.n == 0) continue;
        put(out, "<tr><td class=\"w\">{}, {}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            m.name, m.unit, quartile_text(a, m.decimals), quartile_text(b, m.decimals));
    }
    out += "</tbody></table></div>\n<div class=\"grid\">\n";
    for (const Measure& m : measures) out += strip_plot(with, without, m, factor);
    return out +
           "</div>\n<p class=\"note\">Each dot is a lesson; the box is from the lower to the upper quartile "
           "(type 7), the line is the median.</p>\n";
}

std::string study(std::span<const Attempt> attempts, const Factor& factor, bool Attempt::*alike_in) {
    const auto key = [&](const Attempt& a) {
        return std::tie(a.assembly, a.title, a.task, a.variant, a.law, a.mode, a.trainee, a.operator_kind,
                        a.obstacles, a.*alike_in);
    };
    std::string out;
    Group seen;
    for (const Attempt& attempt : attempts) {
        const auto alike = [&](const Attempt* other) { return key(*other) == key(attempt); };
        if (std::any_of(seen.begin(), seen.end(), alike)) continue;
        seen.push_back(&attempt);
        Group with, without;
        for (const Attempt& a : attempts)
            if (a.complete && alike(&a)) (a.*factor.has ? with : without).push_back(&a);
        if (!with.empty() && !without.empty()) out += part(with, without, factor);
    }
    return out;
}

}  // namespace

std::string guiding_study(std::span<const Attempt> attempts) {
    return study(attempts, guiding, &Attempt::view_help);
}

std::string view_study(std::span<const Attempt> attempts) { return study(attempts, view, &Attempt::guided); }

}  // namespace bolt::report
