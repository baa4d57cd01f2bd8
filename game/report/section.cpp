#include "game/report/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/base/math.hpp"
#include "game/report/html.hpp"
#include "game/report/joint_plot.hpp"
#include "game/report/plan.hpp"
#include "game/report/text.hpp"

namespace bolt::report {

namespace {

template <class... Values>
void put(std::string& out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

void put_fact(std::string& out, std::string_view name, std::string_view value) {
    if (!value.empty()) put(out, "<div><dt>{}</dt><dd>{}</dd></div>\n", name, escape(value));
}

void put_heading(std::string& out, const SessionData& s, std::size_t index) {
    const Summary summary = summarise(s);
    put(out, "<div class=\"head\"><div><p class=\"over\">{}</p>\n<h1>{}</h1></div>\n",
        index == 0 ? "Boltwright training report" : fmt::format("Attempt {}", index),
        escape(title_of(s.assembly)));
    put(out, "<div class=\"score\"><div><span class=\"big\">{} <small>/ 100</small></span>score</div>\n",
        number(s.score, 1));
    put(out, "<div><span class=\"big\">{} <small>of {}</small></span>joints OK</div></div></div>\n",
        summary.ok, summary.joints);
    if (!s.complete)
        put(out,
            "<div class=\"banner\" role=\"note\"><strong>This session was cut short.</strong> It was "
            "recorded for "
            "{}; the results are those known at that moment.</div>\n",
            duration_text(s.recorded));
    else if (!s.finished)
        put(out,
            "<div class=\"banner\" role=\"note\"><strong>The lesson was not finished.</strong> Some steps "
            "were never "
            "done.</div>\n");
    out += "<dl class=\"facts\">\n";
    put_fact(out, "operator", s.header.operator_name);
    put_fact(out, "task", s.header.task);
    put_fact(out, "mode", s.header.mode);
    put_fact(out, "law", s.header.law);
    put_fact(out, "variant", s.header.variant);
    put_fact(out, "duration", duration_text(s.duration));
    put_fact(out, "seed", fmt::format("{}", s.header.seed));
    put_fact(out, "session", s.file.substr(s.file.find_last_of('/') + 1));
    out += "</dl>\n";
}

void put_score(std::string& out, const SessionData& s) {
    if (s.reasons.empty()) return;
    out +=
        "<h2>Score</h2>\n<table><thead><tr><th class=\"n\" "
        "style=\"width:5.5em\">points</th><th>reason</th></tr></thead>"
        "<tbody>\n";
    for (const lesson::ScoreReason& reason : s.reasons)
        put(out, "<tr><td class=\"n\">{}</td><td class=\"w\">{}</td></tr>\n", signed_number(reason.points, 1),
            escape(reason.text));
    put(out, "<tr class=\"sum\"><td class=\"n\">{}</td><td>score</td></tr></tbody></table>\n",
        number(s.score, 1));
}

std::string size_of(const content::AssemblyJoint& joint) {
    const joint::JointDesign& d = joint.design;
    return fmt::format("{}×{} · {}", d.thread.size.name, number(1e3 * d.bolt_length, 0), d.bolt_class.name);
}

void put_joint_row(std::string& out, const SessionData& s, std::size_t j) {
    const lesson::JointResult& r = s.joints[j];
    const content::AssemblyJoint& joint = s.assembly.joints[j];
    const bool loosening = s.direction() == joint::Direction::loosen;
    const bool reached = r.overall != lesson::Verdict::none || r.strokes > 0;
    put(out, "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{}</td>", escape(s.file + "-" + r.id),
        escape(r.id), reached ? verdict_mark(r) : "<span class=\"v vn\">not reached</span>",
        escape(size_of(joint)));
    if (!reached) {
        for (int i = loosening ? 1 : 0; i < 4; ++i) out += "<td class=\"n\">–</td>";
    } else if (loosening) {
        put(out, "<td class=\"n\">{}</td><td class=\"n\">{}°</td><td class=\"n\">{}</td>",
            number(r.torque, 1), number(to_degrees(r.angle), 1), number(1e-3 * r.clamp, 1));
    } else {
        const double target = target_clamp(s.assembly, j);
        put(out, "<td class=\"n\">{} <span class=\"of\">/ {}</span></td><td class=\"n\">{}°</td>",
            number(r.torque, 1), number(joint.spec.torque.target, 1), number(to_degrees(r.angle), 1));
        put(out, "<td class=\"n\">{} <span class=\"of\">/ {}</span></td><td class=\"n\">{} %</td>",
            number(1e-3 * r.clamp, 1), number(1e-3 * target, 1),
            signed_number(100.0 * (r.clamp / target - 1.0), 1));
    }
    const auto count = [&](int n) { put(out, "<td class=\"n{}\">{}</td>", n > 0 ? " bad" : "", n); };
    put(out, "<td class=\"n\">{}</td>", r.strokes);
    count(r.rehits);
    count(r.order_errors);
    out += "</tr>\n";
}

void put_joints(std::string& out, const SessionData& s) {
    const bool loosening = s.direction() == joint::Direction::loosen;
    out +=
        "<h2>Joints</h2>\n<div "
        "class=\"scroll\"><table><thead><tr><th>joint</th><th>verdict</th><th>bolt</th>";
    out += loosening ? "<th class=\"n\">breakaway,<br/>N·m</th><th class=\"n\">angle<br/>turned back</th>"
                       "<th class=\"n\">clamp left,<br/>kN</th>"
                     : "<th class=\"n\">torque, N·m<br/>/ target</th><th class=\"n\">angle<br/>from snug</th>"
                       "<th class=\"n\">clamp, kN<br/>/ target</th><th class=\"n\">clamp<br/>error</th>";
    out +=
        "<th class=\"n\">strokes</th><th class=\"n\">re-hits</th><th "
        "class=\"n\">order<br/>errors</th></tr></thead>"
        "<tbody>\n";
    for (std::size_t j = 0; j < s.joints.size(); ++j) put_joint_row(out, s, j);
    out +=
        "</tbody></table></div>\n<p class=\"note\">Torque: highest at the wrench in the last visit. Clamp: "
        "at the end of "
        "the session.";
    const auto unstated = [](const content::AssemblyJoint& j) { return j.spec.target_clamp <= 0.0; };
    if (!loosening && std::any_of(s.assembly.joints.begin(), s.assembly.joints.end(), unstated))
        out +=
            " Clamp targets that the assembly does not state follow from the target torque and the nominal "
            "friction.";
    out += "</p>\n";
}

std::string order_verdict(const PassOrder& order) {
    if (order.followed.empty()) return "<span class=\"v vn\">not begun</span>";
    if (order.asked.empty()) return "<span class=\"v vn\">no order asked</span>";
    if (!order.in_turn()) return "<span class=\"v vl\">▲ not as asked</span>";
    if (order.left_out() == 0) return "<span class=\"v vo\">✓ as asked</span>";
    return fmt::format("<span class=\"v vl\">▼ {} left out</span>", order.left_out());
}

void put_order(std::string& out, const SessionData& s) {
    const std::vector<PassOrder> orders = pass_orders(s);
    out +=
        "<h2>Order</h2>\n<p class=\"note\">Seen from the nuts. Numbers and solid line: the order followed; "
        "dotted line: "
        "the order asked. ▲: out of turn, the fewest joints that would have to move.</p>\n<div class=\"grid "
        "small\">\n";
    for (const PassOrder& order : orders) {
        out += figure(fmt::format("<h3>{}</h3>{}", escape(order.label), order_verdict(order)),
                      order_plan(s, order), "");
    }
    out += "</div>\n";
}

void put_clamp(std::string& out, const SessionData& s) {
    const Summary m = summarise(s);
    out += "<h2>Clamp force</h2>\n";
    if (m.judged > 0) {
        put(out, "<p>Mean {} kN, lowest {} kN ({}), highest {} kN ({})", number(1e-3 * m.clamp_mean, 1),
            number(1e-3 * m.clamp_low, 1), escape(s.joints[m.lowest].id), number(1e-3 * m.clamp_high, 1),
            escape(s.joints[m.highest].id));
        if (std::isfinite(m.clamp_deviation) && m.clamp_mean > 0.0)
            put(out, "; standard deviation {} kN, {}\u00a0% of the mean", number(1e-3 * m.clamp_deviation, 1),
                number(100.0 * m.clamp_deviation / m.clamp_mean, 1));
        out += ".</p>\n";
    }
    out += "<div class=\"grid\">\n";
    out += figure("<h3>On the flange</h3>", clamp_plan(s),
                  "Clamp force, kN; green line: target; colour: verdict of the joint.");
    out += figure(
        "<h3>Joint by joint</h3>", clamp_rows(s),
        "Open dot: when the wrench left. Filled: in the end, after embedding and the neighbours. Green line: "
        "target. Dashed and shaded: mean ± standard deviation.");
    out += "</div>\n";
}

std::string legend() {
    const auto item = [](std::string_view drawing, std::string_view words) {
        return fmt::format("<li><svg viewBox=\"0 0 22 14\">{}</svg>{}</li>", drawing, words);
    };
    std::string out = "<ul class=\"legend\">";
    const auto box = [&](std::string_view style, std::string_view words) {
        out += item(
            fmt::format(
                "<rect x=\".5\" y=\".5\" width=\"21\" height=\"13\" class=\"{}\" stroke=\"var(--rule)\"/>",
                style),
            words);
    };
    const auto line = [&](std::string_view style, std::string_view words) {
        out += item(fmt::format("<path d=\"M1 7L21 7\" class=\"ln {}\"/>", style), words);
    };
    line("p2", "torque, last pass");
    line("p0", "earlier passes");
    line("rest", "nut at rest");
    line("cl", "clamp force");
    box("s0", "navigation");
    box("s1", "transition");
    box("s2", "linearity");
    box("s3", "yield");
    box("win", "torque window");
    box("wins", "angle window, along the axis");
    out += item("<circle cx=\"11\" cy=\"7\" r=\"3.5\" class=\"mpeak\"/>", "highest torque, judged");
    out += item("<rect x=\"7.5\" y=\"3.5\" width=\"7\" height=\"7\" class=\"mclamp\"/>", "wrench released");
    return out + "</ul>\n";
}

void put_joint_figures(std::string& out, const SessionData& s) {
    out += "<h2>Torque over angle</h2>\n" + legend() + "<div class=\"grid\">\n";
    std::string untouched;
    for (std::size_t j = 0; j < s.joints.size(); ++j) {
        const lesson::JointResult& r = s.joints[j];
        const std::vector<Visit>& visits = s.curves[j].visits;
        if (std::none_of(visits.begin(), visits.end(), [](const Visit& v) { return v.worked; })) {
            untouched += (untouched.empty() ? "" : ", ") + r.id;
            continue;
        }
        std::string caption = run_down_text(s.curves[j].run_down);
        if (r.clamp_at_release > 0.0)
            caption += fmt::format(" Clamp {} kN when released, {} kN in the end.",
                                   number(1e-3 * r.clamp_at_release, 1), number(1e-3 * r.clamp, 1));
        const std::string heading =
            fmt::format("<h3 id=\"{}\">{} <span class=\"note\">{}</span></h3>{}", escape(s.file + "-" + r.id),
                        escape(r.id), escape(size_of(s.assembly.joints[j])), verdict_mark(r));
        out += figure(heading, joint_figure(s, j), escape(caption));
    }
    out += "</div>\n";
    if (!untouched.empty()) put(out, "<p class=\"note\">Never worked on: {}.</p>\n", escape(untouched));
}

void put_method(std::string& out, const SessionData& s) {
    put(out,
        "<footer>Torque is the true torque at the wrench, about the bolt’s axis and unscaled, not what the "
        "device put "
        "out. Clamp force comes from the joint model, law “{}”: it is computed, not measured. Curves keep "
        "every highest "
        "and lowest value. {}</footer>\n",
        escape(s.header.law),
        escape(s.header.program.empty() ? "" : "Recorded by " + s.header.program + "."));
}

}  // namespace

std::string title_of(const content::Assembly& assembly) {
    const auto english = assembly.title.find("en");
    if (english != assembly.title.end()) return english->second;
    return assembly.title.empty() ? assembly.name : assembly.title.begin()->second;
}

std::string session_section(const SessionData& session, std::size_t number) {
    std::string out = fmt::format("<section class=\"session{}\" id=\"session-{}\">\n",
                                  number == 0 ? " alone" : "", std::max<std::size_t>(1, number));
    put_heading(out, session, number);
    put_score(out, session);
    put_joints(out, session);
    put_order(out, session);
    if (session.direction() == joint::Direction::tighten) put_clamp(out, session);
    put_joint_figures(out, session);
    put_method(out, session);
    return out + "</section>\n";
}

}  // namespace bolt::report
