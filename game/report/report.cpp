#include "game/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>

#include "engine/base/math.hpp"
#include "game/lesson/fastener_names.hpp"
#include "game/lesson/lesson.hpp"
#include "game/people/page_trainees.hpp"
#include "game/plot/html.hpp"
#include "game/report/attempts.hpp"
#include "game/report/joint_map.hpp"
#include "game/report/joint_plot.hpp"

namespace bolt::report {

namespace {

using plot::put;

void put_heading(std::string& out, const analysis::SessionData& s, std::size_t index,
                 const TraineeNames& names) {
    const analysis::Summary summary = analysis::summarise(s);
    put(out, "<div class=\"head\"><div><p class=\"over\">{}</p>\n<h1>{}</h1></div>\n",
        index == 0 ? "Boltwright training report" : fmt::format("Attempt {}", index),
        plot::escape(analysis::title_of(s.assembly)));
    put(out, "<div class=\"score\"><div><span class=\"big\">{} <small>/ 100</small></span>score</div>\n",
        plot::number(s.score, 1));
    put(out, "<div><span class=\"big\">{} <small>of {}</small></span>joints OK</div></div></div>\n",
        summary.ok, summary.joints);
    if (!s.complete)
        put(out,
            "<div class=\"banner\" role=\"note\"><strong>This session was cut short.</strong> It was "
            "recorded for {}; the results are those known at that moment.</div>\n",
            plot::duration_text(s.recorded_duration));
    else if (!s.finished)
        put(out,
            "<div class=\"banner\" role=\"note\"><strong>The lesson was not finished.</strong> Some steps "
            "were never done.</div>\n");
    out += "<dl class=\"facts\">\n";
    out += plot::fact("trainee", trainee_text(s.header, names));
    if (s.header.hand == hand::Side::left) out += plot::fact("hand", "left");
    out += plot::fact("task", lesson::name(s.header.task));
    out += plot::fact("mode", lesson::name(s.header.mode));
    if (s.metrics.has_contacts_and_faults) {
        out += plot::fact("guiding force", s.metrics.guided ? "on" : "off");
        if (s.header.view_help) out += plot::fact("view help", *s.header.view_help ? "on" : "off");
        out += plot::fact("obstacles", s.metrics.has_contact_models ? "on" : "off");
    }
    out += plot::fact("law", joint::name(s.header.law));
    out += plot::fact("variant", s.header.variant);
    if (!s.header.tool.empty()) out += plot::fact("tool", s.header.tool);
    out += plot::fact("duration", plot::duration_text(s.duration));
    for (const std::uint64_t ticks : s.header.continued_after)
        out += plot::fact("interrupted and continued",
                          "after " + plot::duration_text(static_cast<double>(ticks) * s.header.dt));
    out += plot::fact("seed", fmt::format("{}", s.header.seed));
    if (index > 0)
        out += plot::path_fact("session", s.file);  // the report of a single session lies beside that file
    out += "</dl>\n";
}

void put_score(std::string& out, const analysis::SessionData& s) {
    if (s.reasons.empty()) return;
    out +=
        "<h2>Score</h2>\n<table><thead><tr><th class=\"n\" "
        "style=\"width:5.5em\">points</th><th>reason</th></tr></thead><tbody>\n";
    for (const lesson::Deduction& reason : s.reasons)
        put(out, "<tr><td class=\"n\">{}</td><td class=\"w\">{}</td></tr>\n",
            plot::signed_number(reason.points, 1), plot::escape(reason.text));
    put(out, "<tr class=\"sum\"><td class=\"n\">{}</td><td>score</td></tr></tbody></table>\n",
        plot::number(s.score, 1));
}

void put_joint_row(std::string& out, const analysis::SessionData& s, std::size_t j) {
    const lesson::JointResult& r = s.joints[j];
    const content::AssemblyJoint& joint = s.assembly.joints[j];
    const bool loosening = s.direction() == joint::Direction::loosen;
    const bool reached = r.overall != lesson::Verdict::none || r.strokes > 0;
    put(out, "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{}</td>", plot::escape(s.file + "-" + r.id),
        plot::escape(r.id), reached ? verdict_mark(r) : "<span class=\"v vn\">not reached</span>",
        plot::escape(bolt_text(joint)));
    if (!reached) {
        for (int i = loosening ? 1 : 0; i < 4; ++i) out += "<td class=\"n\">–</td>";
    } else if (loosening) {
        put(out, "<td class=\"n\">{}</td><td class=\"n\">{}°</td><td class=\"n\">{}</td>",
            plot::number(r.torque, 1), plot::number(to_degrees(r.angle), 1), plot::number(1e-3 * r.clamp, 1));
    } else {
        const double target = analysis::target_clamp(s.assembly, j);
        put(out, "<td class=\"n\">{} <span class=\"of\">/ {}</span></td><td class=\"n\">{}°</td>",
            plot::number(r.torque, 1), plot::number(joint.spec.torque.target, 1),
            plot::number(to_degrees(r.angle), 1));
        put(out, "<td class=\"n\">{} <span class=\"of\">/ {}</span></td><td class=\"n\">{} %</td>",
            plot::number(1e-3 * r.clamp, 1), plot::number(1e-3 * target, 1),
            plot::signed_number(100.0 * (r.clamp / target - 1.0), 1));
    }
    const auto count = [&](int n) { put(out, "<td class=\"n{}\">{}</td>", n > 0 ? " bad" : "", n); };
    put(out, "<td class=\"n\">{}</td>", r.strokes);
    count(r.done_already);
    count(r.out_of_turn);
    out += "</tr>\n";
}

constexpr std::string_view loosening_note =
    "<p class=\"note\">Breakaway: highest torque at the wrench while the joint was loosened; it does not "
    "affect the verdict. Clamp: at the end of the session.</p>\n";

std::string judging_note(const analysis::SessionData& s) {
    const std::vector<content::AssemblyJoint>& joints = s.assembly.joints;
    const bool angle =
        std::any_of(joints.begin(), joints.end(), [](const auto& j) { return j.spec.has_angle; });
    const bool recheck = std::any_of(s.assembly.passes.begin(), s.assembly.passes.end(),
                                     [](const auto& p) { return p.kind == content::PassKind::recheck; });
    std::string out = fmt::format(
        "<p class=\"note\">Judged: {}; clamp force is shown, a wrench cannot measure it. Torque: highest at "
        "the wrench in the 100\u00a0% {} pass.",
        angle ? "torque and angle" : "torque", lesson::turns_by_angle(s.assembly) ? "angle" : "tightening");
    if (recheck)
        put(out,
            " A re-check, like any other pull, counts only if it turned the {0} further by more than 2°. If "
            "the {0} only begins to move, the wrench shows the breakaway torque, which is higher by the "
            "static friction and is not judged.",
            lesson::fastener_name(s.assembly));
    out += " Clamp: at the end of the session.";
    if (std::any_of(joints.begin(), joints.end(), [](const auto& j) { return j.spec.target_clamp <= 0.0; }))
        out +=
            " Clamp targets that the assembly does not state follow from the target torque and the nominal "
            "friction.";
    return out + "</p>\n";
}

void put_joints(std::string& out, const analysis::SessionData& s) {
    const bool loosening = s.direction() == joint::Direction::loosen;
    const bool turns = lesson::turns_by_angle(s.assembly);
    out +=
        "<h2>Joints</h2>\n<div "
        "class=\"scroll\"><table><thead><tr><th>joint</th><th>verdict</th><th>bolt</th>";
    out += loosening
               ? "<th class=\"n\">breakaway,<br/>N·m</th><th class=\"n\">angle<br/>turned back</th><th "
                 "class=\"n\">clamp left,<br/>kN</th>"
               : fmt::format(
                     "<th class=\"n\">torque, N·m<br/>/ target</th><th class=\"n\">angle<br/>from {}</th><th "
                     "class=\"n\">clamp, kN<br/>/ target</th><th class=\"n\">clamp<br/>error</th>",
                     turns ? "mark" : "snug");
    out +=
        "<th class=\"n\">strokes</th><th class=\"n\">worked<br/>again</th><th class=\"n\">out "
        "of<br/>turn</th></tr></thead><tbody>\n";
    for (std::size_t j = 0; j < s.joints.size(); ++j) put_joint_row(out, s, j);
    out += "</tbody></table></div>\n" + (loosening ? std::string(loosening_note) : judging_note(s));
}

std::string order_verdict(const analysis::PassOrder& order) {
    if (order.planned.empty()) return "<span class=\"v vn\">no planned order</span>";
    if (!order.in_turn()) return "<span class=\"v vl\">▲ not as planned</span>";
    if (order.skipped_joints() == 0) return "<span class=\"v vo\">✓ as planned</span>";
    return fmt::format("<span class=\"v vl\">▼ {} left out</span>", order.skipped_joints());
}

std::string number_word(std::size_t passes) {
    constexpr std::string_view words[] = {"two", "three", "four", "five", "six", "seven", "eight", "nine"};
    return passes >= 2 && passes <= 9 ? std::string(words[passes - 2]) : fmt::format("{}", passes);
}

// Draws one map for all passes that followed the planned order, and one for each other pass.
void put_order(std::string& out, const analysis::SessionData& s) {
    const std::vector<analysis::PassOrder> orders = analysis::pass_orders(s);
    const std::vector<analysis::OrderDrawing> drawings = analysis::order_drawings(orders);
    const auto any = [&](auto test) { return std::any_of(drawings.begin(), drawings.end(), test); };
    const auto any_turn = [&](bool analysis::OrderEntry::*flag) {
        return any([&](const analysis::OrderDrawing& d) {
            return std::any_of(d.order.actual.begin(), d.order.actual.end(),
                               [&](const analysis::OrderEntry& t) { return t.*flag; });
        });
    };
    put(out,
        "<h2>Order</h2>\n<p class=\"note\">Seen from the {}s. Numbers and solid line: the order followed",
        lesson::fastener_name(s.assembly));
    if (any([](const analysis::OrderDrawing& d) {
            return !d.order.planned.empty() && !d.order.as_planned();
        }))
        out += "; dotted line: the planned order";
    if (any([](const analysis::OrderDrawing& d) { return d.order.skipped_joints() > 0; }))
        out += "; –: left out";
    if (any_turn(&analysis::OrderEntry::out_of_turn))
        out += "; ▲: out of turn (the fewest joints that would have to move to give the planned order)";
    if (any_turn(&analysis::OrderEntry::repeated)) out += "; 2×: taken twice";
    out += ".</p>\n<div class=\"grid small\">\n";
    for (const analysis::OrderDrawing& drawing : drawings) {
        const bool all = drawing.passes > 1 && drawing.passes == orders.size();
        const std::string label = all ? fmt::format("all {} passes", number_word(drawing.passes))
                                      : plot::escape(drawing.order.label);
        out += plot::figure(fmt::format("<h3>{}</h3>{}", label, order_verdict(drawing.order)),
                            order_map(s, drawing.order), "");
    }
    out += "</div>\n";
    std::string not_begun;
    for (const analysis::PassOrder& order : orders)
        if (order.actual.empty()) not_begun += (not_begun.empty() ? "" : ", ") + order.label;
    if (!not_begun.empty()) put(out, "<p class=\"note\">Not begun: {}.</p>\n", plot::escape(not_begun));
}

void put_clamp(std::string& out, const analysis::SessionData& s) {
    const analysis::Summary m = analysis::summarise(s);
    out += "<h2>Clamp force</h2>\n";
    if (m.judged > 0) {
        put(out, "<p>Mean {} kN, lowest {} kN ({}), highest {} kN ({})", plot::number(1e-3 * m.clamp_mean, 1),
            plot::number(1e-3 * m.clamp_low, 1), plot::escape(s.joints[m.lowest].id),
            plot::number(1e-3 * m.clamp_high, 1), plot::escape(s.joints[m.highest].id));
        if (std::isfinite(m.clamp_deviation) && m.clamp_mean > 0.0)
            put(out, "; standard deviation {} kN, {}\u00a0% of the mean",
                plot::number(1e-3 * m.clamp_deviation, 1),
                plot::number(100.0 * m.clamp_deviation / m.clamp_mean, 1));
        out += ".</p>\n";
    }
    out += "<div class=\"grid\">\n";
    out += plot::figure("<h3>On the flange</h3>", clamp_map(s),
                        "Clamp force, kN; green line: target; colour: verdict of the joint.");
    std::string rows = "Dot: at the end, after embedding and the work on other joints";
    if (has_release_differences(s)) rows += "; open dot: when the wrench left";
    rows += ". Green line: target.";
    if (std::isfinite(m.clamp_deviation)) rows += " Dashed and shaded: mean ± standard deviation.";
    out += plot::figure("<h3>Joint by joint</h3>", clamp_rows(s), rows);
    out += "</div>\n";
}

bool is_worked(const analysis::JointCurve& curve) {
    return std::any_of(curve.visits.begin(), curve.visits.end(),
                       [](const analysis::Visit& v) { return v.worked; });
}

// Returns the styles of all visible elements in the plots of a session.
std::set<std::string_view> drawn_styles(const analysis::SessionData& s) {
    std::set<std::string_view> styles;
    for (std::size_t j = 0; j < s.curves.size(); ++j) {
        if (!is_worked(s.curves[j])) continue;
        const plot::Plot plot = joint_plot(s, j);
        const plot::AxisRange x = plot.x.ticks.range;
        const auto visible = [&](const plot::AxisRange& r) {
            return std::max(r.low, r.high) > x.low && std::min(r.low, r.high) < x.high;
        };
        for (const plot::PlotBand& band : plot.bands)
            if (band.of_y || visible(band.range)) styles.insert(band.style);
        for (const plot::PlotLine& line : plot.lines)
            if (std::any_of(line.points.begin(), line.points.end(), [&](const plot::SvgPoint& p) {
                    return std::isfinite(p.y) && p.x >= x.low && p.x <= x.high;
                }))
                styles.insert(line.style);
        for (const plot::Marker& marker : plot.markers) styles.insert(marker.style);
    }
    return styles;
}

std::string legend(const analysis::SessionData& s) {
    const std::set<std::string_view> drawn = drawn_styles(s);
    const bool loosening = s.direction() == joint::Direction::loosen;
    std::string out = "<ul class=\"legend\">";
    const auto item = [&](std::string_view style, std::string_view drawing, std::string_view text) {
        if (drawn.contains(style)) put(out, "<li><svg viewBox=\"0 0 22 14\">{}</svg>{}</li>", drawing, text);
    };
    const auto box = [&](std::string_view style, std::string_view text) {
        item(style,
             fmt::format(
                 "<rect x=\".5\" y=\".5\" width=\"21\" height=\"13\" class=\"{}\" stroke=\"var(--rule)\"/>",
                 style),
             text);
    };
    const auto line = [&](std::string_view style, std::string_view text) {
        item(style, fmt::format("<path d=\"M1 7L21 7\" class=\"{}\"/>", style), text);
    };
    line("ln p2", loosening ? "torque" : "torque, last pass");
    line(drawn.contains("ln p0") ? "ln p0" : "ln p1", "earlier passes");
    line("ln rest", fmt::format("{} at rest", lesson::fastener_name(s.assembly)));
    line("ln cl", "clamp force");
    box("s0", "navigation");
    box("s1", "transition");
    box("s2", "linearity");
    box("s3", "yield");
    box("win", "torque window");
    box("wins", "angle window, along the axis");
    item("mpeak", "<circle cx=\"11\" cy=\"7\" r=\"3.5\" class=\"mpeak\"/>",
         loosening ? "highest torque" : "torque that is judged");
    item("mbreak", "<circle cx=\"11\" cy=\"7\" r=\"3.5\" class=\"mbreak\"/>",
         "breakaway in the re-check, not judged");
    item("mclamp", "<rect x=\"7.5\" y=\"3.5\" width=\"7\" height=\"7\" class=\"mclamp\"/>",
         "wrench released");
    return out + "</ul>\n";
}

void put_joint_figures(std::string& out, const analysis::SessionData& s) {
    out += "<h2>Torque over angle</h2>\n" + legend(s) + "<div class=\"grid\">\n";
    std::string untouched;
    for (std::size_t j = 0; j < s.joints.size(); ++j) {
        const lesson::JointResult& r = s.joints[j];
        if (!is_worked(s.curves[j])) {
            untouched += (untouched.empty() ? "" : ", ") + r.id;
            continue;
        }
        std::string caption = run_down_text(s.curves[j].run_down);
        if (r.clamp_at_release > 0.0)
            caption +=
                fmt::format(" Clamp {} kN when released, {} kN at the end.",
                            plot::number(1e-3 * r.clamp_at_release, 1), plot::number(1e-3 * r.clamp, 1));
        const std::string heading = fmt::format(
            "<h3 id=\"{}\">{} <span class=\"note\">{}</span></h3>{}", plot::escape(s.file + "-" + r.id),
            plot::escape(r.id), plot::escape(bolt_text(s.assembly.joints[j])), verdict_mark(r));
        out += plot::figure(heading, joint_figure(s, j), plot::escape(caption));
    }
    out += "</div>\n";
    if (!untouched.empty()) put(out, "<p class=\"note\">Never worked on: {}.</p>\n", plot::escape(untouched));
}

void put_method(std::string& out, const analysis::SessionData& s) {
    put(out,
        "<footer>Torque is the true torque at the wrench, about the bolt’s axis and unscaled, not what the "
        "device rendered. Clamp force comes from the joint model, law “{}”: it is computed, not measured. "
        "Curves keep every highest and lowest value. {}</footer>\n",
        joint::name(s.header.law),
        plot::escape(s.header.program.empty() ? "" : "Recorded by " + s.header.program + "."));
}

}  // namespace

std::string verdict_mark(const lesson::JointResult& result) {
    using lesson::Verdict;
    if (result.condition != joint::JointCondition::intact)
        return fmt::format("<span class=\"v vh\">✕ {}</span>", joint::name(result.condition));
    constexpr std::string_view styles[] = {"vn", "vl", "vo", "vh"};
    constexpr std::string_view shapes[] = {"–", "▼ LOW", "✓ OK", "▲ HIGH"};
    const auto i = static_cast<std::size_t>(result.overall);
    std::string judged;
    const bool wrong = result.overall == Verdict::low || result.overall == Verdict::high;
    if (wrong && result.angle_verdict != Verdict::none) {
        if (result.torque_verdict == result.overall) judged = " torque";
        if (result.angle_verdict == result.overall) judged += judged.empty() ? " angle" : " and angle";
    }
    return fmt::format("<span class=\"v {}\">{}{}</span>", styles[i], shapes[i], judged);
}

std::string bolt_text(const content::AssemblyJoint& joint) {
    const joint::JointDesign& d = joint.design;
    const double coarse = d.thread.size.coarse_pitch, pitch = d.thread.thread.pitch;
    const bool fine = coarse > 0.0 && std::abs(pitch - coarse) > 1e-6;
    return fmt::format("{}{}×{}{} · {}", d.thread.size.name, fine ? fmt::format("×{:.4g}", 1e3 * pitch) : "",
                       plot::number(1e3 * d.bolt_length, 0), joint::size_suffix(d.thread_direction),
                       d.bolt_class.name);
}

std::string session_section(const analysis::SessionData& session, std::size_t number,
                            const TraineeNames& names) {
    std::string out = fmt::format("<section class=\"session{}\" id=\"session-{}\">\n",
                                  number == 0 ? " alone" : "", std::max<std::size_t>(1, number));
    put_heading(out, session, number, names);
    put_score(out, session);
    put_joints(out, session);
    put_order(out, session);
    if (session.direction() == joint::Direction::tighten) put_clamp(out, session);
    put_joint_figures(out, session);
    out += haptics_section(session);
    put_method(out, session);
    return out + "</section>\n";
}

namespace {

// Collects the parts of a page.
struct ReportBuilder {
    const TraineeNames& names;
    std::vector<Attempt> attempts{};
    std::string sections{};

    void add(const analysis::SessionData& session, bool alone,
             ReportExtent extent = ReportExtent::everything) {
        attempts.push_back(attempt_of(session, names));
        if (alone || extent == ReportExtent::everything)
            sections += session_section(session, alone ? 0 : attempts.size(), names);
    }

    [[nodiscard]] std::string finish(ReportExtent extent = ReportExtent::everything) const {
        if (attempts.size() == 1)
            return plot::page(attempts.front().title + " – training report", sections, people_of_page());
        return plot::page(fmt::format("{} attempts – training report", attempts.size()),
                          attempts_section(attempts, extent == ReportExtent::overview) + sections,
                          people_of_page());
    }
    [[nodiscard]] std::string people_of_page() const {
        std::set<std::string> people;
        for (const Attempt& attempt : attempts)
            if (attempt.trainee_kind == session::TraineeKind::person) people.insert(attempt.person);
        return people::people_list(people);
    }
};

}  // namespace

Result<std::string> make_report(std::span<const session::SessionReader* const> sessions, ReportExtent extent,
                                const TraineeNames& names) {
    if (sessions.empty())
        return fail(ErrorCode::usage, "no session was given to report", "one or more session files");
    ReportBuilder builder{names};
    for (const session::SessionReader* session : sessions) {
        BOLT_TRY_ASSIGN(const auto data, analysis::read_session(*session));
        builder.add(data, sessions.size() == 1, extent);
    }
    return builder.finish(extent);
}

std::string make_report(std::span<const analysis::SessionData> sessions, const TraineeNames& names) {
    ReportBuilder builder{names};
    for (const analysis::SessionData& session : sessions) builder.add(session, sessions.size() == 1);
    return builder.finish();
}

}  // namespace bolt::report
