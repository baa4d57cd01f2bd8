#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "game/analysis/session_data.hpp"
#include "game/lesson/fastener_names.hpp"
#include "game/plot/html.hpp"
#include "game/report/report.hpp"
#include "game/statistics/summary.hpp"

namespace bolt::report {

namespace {

using plot::put;

std::string times_text(std::uint64_t n) { return n == 1 ? "once" : fmt::format("{} times", n); }

// " (7.5 %)", or empty if the device's maximum is unknown (0).
std::string share_text(double change, double greatest) {
    return greatest > 0.0 ? fmt::format(" ({}\u00a0%)", plot::number(100.0 * change / greatest, 1)) : "";
}

std::string evenness_mark(const analysis::HapticMetrics& f) {
    if (f.force.above > 0)
        return fmt::format("<span class=\"v vh\">▲ jerked {}</span> ", times_text(f.force.above));
    if (f.force.at_limit > 0)
        return fmt::format("<span class=\"v vl\">▲ limited {}</span> ", times_text(f.force.at_limit));
    return "<span class=\"v vo\">✓ even</span> ";
}

void put_evenness(std::string& out, const analysis::SessionData& s) {
    const analysis::HapticMetrics& f = s.metrics;
    const double greatest = f.device_limits ? f.device_limits->force : 0.0;
    if (f.force.ticks == 0) {
        out += "<p>The device rendered no force.</p>\n";
        return;
    }
    put(out,
        "<p>{}From one millisecond to the next the force on the hand changed by at most {}\u00a0N{}, and in "
        "99\u00a0% of all milliseconds by less than {}\u00a0N{}.",
        greatest > 0.0 ? evenness_mark(f) : "", plot::number(f.force.greatest, 2),
        share_text(f.force.greatest, greatest), plot::number(f.force.p99, 3),
        share_text(f.force.p99, greatest));
    if (greatest > 0.0)
        put(out,
            " Percentages are of the {}\u00a0N that the device can give; more than 10\u00a0% in a "
            "millisecond is felt as a jerk.",
            plot::number(greatest, 0));
    if (f.force.at_limit > 0)
        put(out, " The output stage limited the change {}, to {}\u00a0N in a millisecond.",
            times_text(f.force.at_limit), plot::number(f.device_limits->force_slew_rate * 1e-3, 1));
    const std::string_view fastener = lesson::fastener_name(s.assembly);
    const std::string names[analysis::activity_count] = {"while the output was switched off",
                                                         fmt::format("releasing a {}", fastener),
                                                         fmt::format("engaging a {}", fastener),
                                                         fmt::format("on a {}", fastener),
                                                         "against something",
                                                         "in the air"};
    std::string activities;
    for (std::size_t i = 0; i < analysis::activity_count; ++i)
        if (f.at_limit[i] > 0)
            activities += fmt::format("{}{} {}", activities.empty() ? "" : ", ", f.at_limit[i], names[i]);
    if (!activities.empty()) put(out, " Of these: {}.", activities);
    put(out, " The torque changed by {}\u00a0N·m{} at most.</p>\n", plot::number(f.torque.greatest, 3),
        share_text(f.torque.greatest, f.device_limits ? f.device_limits->torque : 0.0));

    out +=
        "<div class=\"scroll\"><table><thead><tr><th class=\"n\">at</th><th class=\"n\">change in<br/>1 ms, "
        "N</th><th class=\"n\">share</th><th>circumstances</th></tr></thead><tbody>\n";
    for (const analysis::ForceJump& m : f.force_jumps)
        put(out,
            "<tr><td class=\"n\">{} s</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
            "class=\"w\">{}</td></tr>\n",
            plot::number(m.time, 3), plot::number(m.change, 2),
            greatest > 0.0 ? plot::number(100.0 * m.change / greatest, 1) + " %" : "–",
            plot::escape(analysis::describe(m, s.joints, s.header.obstacle_names)));
    out += "</tbody></table></div>\n";
    out += "<p class=\"note\">The largest changes, those within 50\u00a0ms of a larger one left out.</p>\n";
}

void put_obstacle_contacts(std::string& out, const analysis::SessionData& s) {
    const analysis::HapticMetrics& f = s.metrics;
    const std::string_view fastener = lesson::fastener_name(s.assembly);
    out += "<h3>Contacts with obstacles</h3>\n";
    if (!f.has_contacts_and_faults) {
        out += "<p>This session is of an older format, which does not record what the wrench touched.</p>\n";
        return;
    }
    if (!f.has_contact_models) {
        out += "<p>Contact was not simulated: the wrench passed through everything.</p>\n";
        return;
    }
    struct ContactTotal {
        std::uint64_t count = 0;
        double seconds = 0.0, longest = 0.0, peak_force = 0.0;
    };
    std::map<collision::ObstacleId, ContactTotal> by_obstacle;
    ContactTotal all;
    for (const analysis::ObstacleContact& b : f.obstacle_contacts)
        for (ContactTotal* w : {&by_obstacle[b.obstacle], &all}) {
            ++w->count;
            w->seconds += b.length;
            w->longest = std::max(w->longest, b.length);
            w->peak_force = std::max(w->peak_force, b.peak_force);
        }
    if (all.count == 0) {
        put(out, "<p>None: between the {}s the wrench touched nothing.</p>\n", fastener);
        return;
    }
    std::vector<std::pair<collision::ObstacleId, ContactTotal>> rows(by_obstacle.begin(), by_obstacle.end());
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
    put(out,
        "<p>Between the {}s the wrench touched something {}, for {}\u00a0s in total and with at most "
        "{}\u00a0N.</p>\n",
        fastener, times_text(all.count), plot::number(all.seconds, 1), plot::number(all.peak_force, 1));
    out +=
        "<div class=\"scroll\"><table><thead><tr><th>with</th><th class=\"n\">contacts</th><th "
        "class=\"n\">in all, s</th><th class=\"n\">longest, s</th><th class=\"n\">hardest, "
        "N</th></tr></thead><tbody>\n";
    for (const auto& [obstacle, w] : rows)
        put(out,
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
            "<td class=\"n\">{}</td></tr>\n",
            plot::escape(analysis::obstacle_text(obstacle, s.header.obstacle_names)), w.count,
            plot::number(w.seconds, 2), plot::number(w.longest, 2), plot::number(w.peak_force, 1));
    out += "</tbody></table></div>\n";
    put(out,
        "<p class=\"note\">Touches less than 0.1\u00a0s apart count as one contact. Touching the {0} that "
        "the wrench is moving to or has just left does not count, nor does a contact that began with a {0} "
        "in the jaw.</p>\n",
        fastener);
}

void put_arrivals(std::string& out, const analysis::SessionData& s) {
    const analysis::HapticMetrics& f = s.metrics;
    if (f.arrivals.empty()) return;
    const std::string_view fastener = lesson::fastener_name(s.assembly);
    put(out,
        "<h3>Time to get onto the {0}</h3>\n<div class=\"scroll\"><table><thead><tr><th>joint</th>"
        "<th class=\"n\">steps with<br/>the wrench</th><th class=\"n\">median, s</th><th "
        "class=\"n\">slowest, s</th><th class=\"n\">near the {0},<br/>median, s</th>"
        "<th class=\"n\">{0} in<br/>sight</th><th class=\"n\">by hand,<br/>median, "
        "s</th></tr></thead><tbody>\n",
        fastener);
    const auto row = [&](const std::string& name, int joint) {
        std::vector<double> wrench, near, hand;
        double visible_time = 0.0, near_time = 0.0;
        for (const analysis::Arrival& a : f.arrivals) {
            if (joint >= 0 && a.joint != joint) continue;
            (a.wrench ? wrench : hand).push_back(a.duration);
            if (a.wrench) near.push_back(a.near_nut);
            if (!a.wrench || !std::isfinite(a.nut_visible)) continue;
            visible_time += a.nut_visible;
            near_time += a.near_nut;
        }
        if (wrench.empty() && hand.empty()) return;
        const double slowest = wrench.empty() ? nan : *std::max_element(wrench.begin(), wrench.end());
        put(out,
            "<tr{}><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
            "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            joint < 0 ? " class=\"sum\"" : "", plot::escape(name), wrench.size(),
            plot::number(statistics::quartiles(wrench).median, 2), plot::number(slowest, 2),
            plot::number(statistics::quartiles(near).median, 2),
            near_time > 0.0 ? plot::number(100.0 * visible_time / near_time, 0) + " %" : plot::number(nan, 0),
            plot::number(statistics::quartiles(hand).median, 2));
    };
    for (std::size_t j = 0; j < s.joints.size(); ++j) row(s.joints[j].id, static_cast<int>(j));
    row("all", -1);
    put(out,
        "</tbody></table></div>\n<p class=\"note\">Times from when the step was due until its {0} was held. "
        "Near the {0}: within 4\u00a0cm of its seat. In sight: share of the time near it with at least "
        "60\u00a0% of it visible past all obstacles except the wrench. {1}</p>\n",
        fastener, f.guided ? "A guiding force led the hand." : "No force led the hand.");
}

void put_servo(std::string& out, const analysis::SessionData& s) {
    const analysis::HapticMetrics& f = s.metrics;
    std::string faults;
    for (std::size_t i = 1; i < f.faults.size(); ++i)
        if (f.faults[i] > 0.0)
            faults +=
                fmt::format("{}{}: {}\u00a0s", faults.empty() ? "" : "; ",
                            force::message_for(static_cast<force::Fault>(i)), plot::number(f.faults[i], 2));
    if (!f.has_contacts_and_faults) return;
    out += "<h3>Output stage and servo</h3>\n";
    put(out, "<p>{} {}</p>\n",
        faults.empty() ? "The output was never switched off."
                       : "The output was switched off: " + plot::escape(faults) + ".",
        f.timing
            ? "The servo ran on a thread: " + plot::escape(f.servo_text) + "."
            : "There are no wake-up, compute and period times. Servo: " + plot::escape(f.servo_text) + ".");
    if (!f.timing) return;
    out +=
        "<div class=\"scroll\"><table><thead><tr><th>µs</th><th class=\"n\">median</th><th class=\"n\">99 "
        "%</th><th class=\"n\">99.9 %</th><th class=\"n\">greatest</th></tr></thead><tbody>\n";
    const auto row = [&](const char* name, const servo::Histogram& h) {
        put(out,
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
            "class=\"n\">{}</td></tr>\n",
            name, plot::number(1e6 * servo::quantile(h, 0.5), 1),
            plot::number(1e6 * servo::quantile(h, 0.99), 1), plot::number(1e6 * servo::quantile(h, 0.999), 1),
            plot::number(1e-3 * static_cast<double>(h.max), 1));
    };
    row("wake-up", f.timing->wake_up);
    row("compute", f.timing->compute);
    row("period", f.timing->period);
    put(out, "</tbody></table></div>\n<p class=\"note\">{} ticks, {} deadlines missed.</p>\n",
        f.timing->ticks, f.timing->missed);
}

}  // namespace

std::string haptics_section(const analysis::SessionData& session) {
    const analysis::HapticMetrics& f = session.metrics;
    if (f.force.ticks == 0 && f.arrivals.empty()) return {};
    std::string out = "<h2>What the hand felt</h2>\n";
    put_evenness(out, session);
    put_obstacle_contacts(out, session);
    put_arrivals(out, session);
    put_servo(out, session);
    return out;
}

}  // namespace bolt::report
