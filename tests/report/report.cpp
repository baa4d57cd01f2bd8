#include "game/report/report.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/base/math.hpp"
#include "game/plot/html.hpp"
#include "game/report/attempts.hpp"
#include "game/report/joint_plot.hpp"
#include "tests/report/synthetic.hpp"
#include "tests/report/well_formed.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::plot;
using namespace bolt::report;

namespace {

std::string report_of(const SessionData& session) {
    return make_report(std::span<const SessionData>(&session, 1));
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Report: is well-formed, self-contained and reproducible") {
    SyntheticOptions options;
    options.slips = true;
    const SyntheticSession session = synthetic_session(options);
    const std::string html = report_of(session.data);
    CHECK(markup_fault(html) == "");
    CHECK(html == report_of(synthetic_session(options).data));
    for (const char* outside : {"<script", "<link", "<img", "src=", "@import", "url(", "href=\"http"})
        CHECK_FALSE_MESSAGE(has(html, outside), outside);
    CHECK(has(html, "Split casing, upper half"));
    CHECK(has(html, "mechanistic"));
    CHECK_FALSE(has(html, "cut short"));
    CHECK(html.size() < 1'000'000);
}

TEST_CASE("Report: shows the figures of the results") {
    SyntheticOptions options;
    options.slips = true;
    const SessionData session = synthetic_session(options).data;
    const std::string html = report_of(session);
    for (const lesson::JointResult& r : session.joints) {
        const std::size_t row = html.find(">" + r.id + "</a>");
        REQUIRE(row != std::string::npos);
        const std::string cells = html.substr(row, html.find("</tr>", row) - row);
        CHECK(has(cells, ">" + number(r.torque, 1) + " <"));
        CHECK(has(cells, ">" + number(to_degrees(r.angle), 1) + "°<"));
        CHECK(has(cells, ">" + number(1e-3 * r.clamp, 1) + " <"));
        CHECK(has(cells, ">" + std::to_string(r.strokes) + "<"));
        if (r.condition == joint::JointCondition::intact) {
            CHECK(has(cells, std::string(name(r.overall))));
        } else {
            CHECK(has(cells, "✕ stripped"));
        }
    }
    CHECK(has(html, ">" + number(session.score, 1) + " <small>/ 100"));
    for (const lesson::Deduction& reason : session.reasons) {
        CHECK(has(html, ">" + signed_number(reason.points, 1) + "<"));
        CHECK(has(html, escape(reason.text)));
    }
}

TEST_CASE("Report: verdicts have a shape as well as a colour") {
    SyntheticOptions options;
    options.slips = true;
    const std::string html = report_of(synthetic_session(options).data);
    for (const char* mark : {"✓ OK", "▲ HIGH", "▼ LOW", "✕ stripped"}) CHECK_MESSAGE(has(html, mark), mark);
}

TEST_CASE("Report: a verdict names torque or angle if both are judged") {
    lesson::JointResult r;
    r.overall = r.angle_verdict = lesson::Verdict::high;
    r.torque_verdict = lesson::Verdict::ok;
    CHECK(has(verdict_mark(r), "▲ HIGH angle<"));
    r.torque_verdict = lesson::Verdict::high;
    CHECK(has(verdict_mark(r), "▲ HIGH torque and angle<"));
    r.angle_verdict = lesson::Verdict::none;
    CHECK(has(verdict_mark(r), "▲ HIGH<"));
}

TEST_CASE("Report: names with markup are escaped") {
    SyntheticSession session = synthetic_session({});
    const std::string attack = "</title><script>alert(1)</script>\"' onload=\"x";
    SessionData& data = session.data;
    data.assembly.title["en"] = attack;
    data.header.trainee_profile = attack;
    data.header.variant = attack;
    data.header.program = attack;
    data.file = "/tmp/" + attack;
    data.reasons.push_back({1.0, attack});
    data.assembly.joints[0].design.id = attack;
    data.assembly.joints[0].design.bolt_class.name = attack;
    data.joints[0].id = attack;
    data.pass_texts[0] = attack;
    for (const std::string& html : {report_of(data), make_report(std::vector<SessionData>{data, data})}) {
        CHECK(markup_fault(html) == "");
        CHECK_FALSE(has(html, "<script"));
        CHECK_FALSE(has(html, "\" onload"));
    }
}

TEST_CASE("Report: a session that was cut short shows this first") {
    SyntheticOptions options;
    options.cut_short = true;
    const std::string html = report_of(synthetic_session(options).data);
    CHECK(html.find("This session was cut short") < html.find("<h2>"));
    CHECK(markup_fault(html) == "");
}

TEST_CASE("Report: an empty session gives a well-formed page without NaN") {
    SessionData empty;
    empty.assembly = synthetic_assembly();
    empty.joints = results_by_joint(empty.assembly, {});
    empty.curves.resize(empty.joints.size());
    empty.header.task = lesson::Task::tighten;
    const std::string html = report_of(empty);
    CHECK(markup_fault(html) == "");
    CHECK(has(html, "not reached"));
    CHECK(has(html, "Never worked on: J01"));
    CHECK_FALSE(has(html, "nan"));
    empty.assembly.joints.clear();
    empty.assembly.passes.clear();
    empty.joints.clear();
    empty.curves.clear();
    CHECK(markup_fault(report_of(empty)) == "");
}

TEST_CASE("Report: several sessions begin with the overview") {
    std::vector<SessionData> sessions;
    for (std::uint64_t i = 0; i < 4; ++i) {
        SyntheticOptions options;
        options.seed = i;
        options.cut_short = i == 1;
        sessions.push_back(synthetic_session(options).data);
        sessions.back().score = 61.5 + 10.0 * static_cast<double>(i);
    }
    const std::string html = make_report(sessions);
    CHECK(markup_fault(html) == "");
    CHECK(has(html, "4 attempts"));
    for (const SessionData& session : sessions) CHECK(has(html, ">" + number(session.score, 1) + "<"));
    CHECK(count_of(html, "<section class=\"session\"") == 4);
    CHECK(html.find("Learning curve") < html.find("<section"));
}

TEST_CASE("Joint plot: the run-down is cut off, and the angle axis begins shortly before snug") {
    const SyntheticSession session = synthetic_session({});
    const JointPlotFrame frame = joint_plot_frame(session.data, 0);
    CHECK(frame.cut_before);
    CHECK(frame.origin_name == "snug");
    CHECK(frame.range.span() < 120.0);
    CHECK(frame.range.low < 0.0);
    const double end = to_degrees(session.data.curves[0].end_angle - session.data.curves[0].mark);
    CHECK(frame.range.high > end);
    const Plot plot = joint_plot(session.data, 0);
    CHECK(has(plot.x.label, "drawn from"));
    CHECK(plot.y.ticks.range.high >= session.data.joints[0].torque);
    CHECK(plot.bands.size() >= 4);  // three stages and the window
    CHECK(run_down_text(session.data.curves[0].run_down).starts_with("Run-down of 17.9 turns in "));
}

TEST_CASE("Summary: equals a manual calculation") {
    SessionData session;
    session.assembly = synthetic_assembly();
    session.joints = results_by_joint(session.assembly, {});
    const double clamps[] = {70e3, 80e3, 90e3};
    const double torques[] = {206.0 * 0.9, 206.0, 206.0 * 1.2};
    for (std::size_t i = 0; i < 3; ++i) {
        session.joints[i].overall = i == 2 ? lesson::Verdict::high : lesson::Verdict::ok;
        session.joints[i].clamp = clamps[i];
        session.joints[i].torque = torques[i];
    }
    const Summary s = summarise(session);
    CHECK(s.judged == 3);
    CHECK(s.ok == 2);
    CHECK(s.clamp_mean == doctest::Approx(80e3));
    CHECK(s.clamp_deviation == doctest::Approx(10e3));
    CHECK(s.mean_torque_error == doctest::Approx(0.1));
    CHECK(s.lowest == 0);
    CHECK(s.highest == 2);
}

TEST_CASE("Clamp target: follows from the target torque if it is not specified") {
    content::Assembly assembly = synthetic_assembly();
    CHECK(target_clamp(assembly, 0) == doctest::Approx(80.9e3));
    assembly.joints[0].spec.target_clamp = 0.0;
    // VDI 2230 table A1: M16 8.8 at μ 0.12 holds 80.9 kN at 206 N·m.
    CHECK(target_clamp(assembly, 0) == doctest::Approx(80.9e3).epsilon(0.01));
    assembly.law = joint::Law::published;
    assembly.joints[0].spec.torque.target = 59.976;
    CHECK(target_clamp(assembly, 0) == doctest::Approx(59.976 / 12.464e-3).epsilon(0.001));
}

namespace {

// A joint tightened to torque `full` and then re-checked with torque `check`, which turns the nut by
// `degrees`.
SessionData checked_again(double full, double check, double degrees) {
    SessionData session;
    session.assembly = synthetic_assembly();
    session.assembly.joints.resize(1);
    session.assembly.passes = {{content::PassKind::tighten, 0.5, {0}},
                               {content::PassKind::tighten, 1.0, {0}},
                               {content::PassKind::recheck, 1.0, {0}}};
    session.pass_texts = {"50 %", "100 %", "re-check"};
    session.joints = results_by_joint(session.assembly, {});
    session.header.task = lesson::Task::tighten;
    CurveRequest request{{20.0}, 0.001, joint::Direction::tighten, {0, 1000, 2000}};
    std::vector<session::TickRecord> ticks;
    const auto pass = [&](double from, double to, double low, double high) {
        for (int i = 0; i < 1000; ++i) {
            session::TickRecord t;
            t.joint = i < 900 ? 0 : -1;
            t.nut_angle = static_cast<float>(to_radians(from + (to - from) * i / 900.0));
            t.wrench_torque = static_cast<float>(low + (high - low) * i / 899.0);
            t.stage = static_cast<std::uint8_t>(joint::Stage::linearity);
            ticks.push_back(t);
        }
    };
    pass(0.0, 30.0, 1.0, 0.5 * full);
    pass(30.0, 60.0, 0.5 * full, full);
    pass(60.0, 60.0 + degrees, 0.5 * check, check);
    CurveBuilder builder(request);
    builder.add(0, ticks);
    session.curves = builder.finish();
    session.joints[0].torque = degrees > 2.0 ? std::max(full, check) : full;
    session.joints[0].overall = lesson::Verdict::ok;
    return session;
}

const Marker* marker_with(const Plot& plot, std::string_view style) {
    for (const Marker& marker : plot.markers)
        if (marker.style == style) return &marker;
    return nullptr;
}

}  // namespace

TEST_CASE("Joint plot: the judged marker shows the result's torque, and a breakaway has its own marker") {
    const SessionData moved = checked_again(200.0, 221.0, 1.0);
    const Plot plot = joint_plot(moved, 0);
    const Marker* judged = marker_with(plot, "mpeak");
    REQUIRE(judged != nullptr);
    CHECK(judged->position.y == doctest::Approx(200.0));
    CHECK(judged->label == "200.0");
    const Marker* breakaway = marker_with(plot, "mbreak");
    REQUIRE(breakaway != nullptr);
    CHECK(breakaway->label == "breakaway 221.0");
    CHECK(breakaway->small_label);
    CHECK(has(report_of(moved), "breakaway in the re-check, not judged"));

    const SessionData turned = checked_again(200.0, 210.0, 5.0);
    const Plot again = joint_plot(turned, 0);
    REQUIRE(marker_with(again, "mpeak") != nullptr);
    CHECK(marker_with(again, "mpeak")->position.y == doctest::Approx(210.0));
    CHECK(marker_with(again, "mbreak") == nullptr);
    CHECK_FALSE(has(report_of(turned), "breakaway in the re-check"));
}

TEST_CASE("Joint plot: a result between two samples is marked at the crossing") {
    SessionData session = checked_again(200.0, 221.0, 1.0);
    session.joints[0].torque = 150.04;
    for (Visit& visit : session.curves[0].visits)
        std::erase_if(visit.points, [](const CurvePoint& p) { return p.torque > 149.0 && p.torque < 151.0; });
    const Marker* judged = nullptr;
    const Plot plot = joint_plot(session, 0);
    judged = marker_with(plot, "mpeak");
    REQUIRE(judged != nullptr);
    CHECK(judged->position.y == doctest::Approx(150.04));
}

TEST_CASE("Report: a pitch other than the coarse one is part of the bolt's name") {
    content::AssemblyJoint joint = synthetic_assembly().joints[0];
    joint.design.bolt_length = 70e-3;
    for (const auto& [size, text] :
         {std::pair{"M12", "M12×70 · 8.8"}, std::pair{"M12x1.25", "M12×1.25×70 · 8.8"},
          std::pair{"M8x1", "M8×1×70 · 8.8"}}) {
        const auto thread = joint::parse_thread(size);
        REQUIRE(thread);
        joint.design.thread = *thread;
        CHECK(bolt_text(joint) == text);
    }
}

TEST_CASE("Report: paths break only after a slash") {
    CHECK(path_fact("session", "out/a b/session.boltwright") ==
          "<div class=\"path\"><dt>session</dt><dd>out/<wbr/>a b/<wbr/>session.boltwright</dd></div>\n");
    CHECK(path_fact("session", "").empty());
    CHECK(has(path_fact("session", "<a>/&"), "&lt;a&gt;/<wbr/>&amp;"));
    const SessionData session = synthetic_session({}).data;
    CHECK_FALSE(has(report_of(session), "<dt>session</dt>"));
    CHECK(has(make_report(std::vector<SessionData>{session, session}), "out/<wbr/>session.bolt"));
}

TEST_CASE("Report: only attempts with the same assembly, task, variant and law are compared") {
    std::vector<SessionData> sessions(4, synthetic_session({}).data);
    sessions[1].header.task = lesson::Task::loosen;
    sessions[3].header.law = joint::Law::published;
    std::vector<Attempt> attempts;
    for (const SessionData& session : sessions) attempts.push_back(attempt_of(session));
    CHECK(attempt_groups(attempts) == std::vector<std::vector<std::size_t>>{{0, 2}, {1}, {3}});
    const std::string html = attempts_section(attempts);
    CHECK(markup_fault(html) == "");
    CHECK(count_of(html, "Learning curve: ") == 1);
    CHECK(has(html, "attempts <a href=\"#session-1\">1</a>, <a href=\"#session-3\">3</a></span>"));
    CHECK(has(html, "<th>task</th>"));
    CHECK_FALSE(has(html, "– %"));
    attempts.resize(2);
    CHECK_FALSE(has(attempts_section(attempts), "<h2>"));
}

TEST_CASE("Report: a study has the difference of the groups, its interval and its exact test") {
    std::vector<Attempt> attempts;
    for (int i = 0; i < 12; ++i) {
        Attempt a = attempt_of(synthetic_session({}).data);
        a.guided = i % 2 == 0;
        a.score = (a.guided ? 60.0 : 40.0) + i / 2;
        attempts.push_back(a);
    }
    const std::string html = guiding_study(attempts);
    CHECK(markup_fault(html) == "");
    // The 6th smallest and largest of the 36 differences.
    CHECK(has(html, "<td class=\"n\">20.0 <span class=\"of\">(17.0 to 23.0)</span></td>"));
    const double rows = static_cast<double>(count_of(html, "<td class=\"w\">"));
    CHECK(has(html, fmt::format("<td class=\"n\">{:.3f}</td>", rows * 2.0 / 924.0)));
    CHECK(has(html, "<td class=\"n\">1.000</td>"));
    std::vector<Attempt> many;
    for (int i = 0; i < 10; ++i) many.insert(many.end(), attempts.begin(), attempts.end());
    CHECK(has(guiding_study(many), "20.0 <span class=\"of\">(19.0 to 21.0)</span>"));
    attempts.resize(2);
    CHECK(has(guiding_study(attempts), "<td class=\"n\">20.0</td>"));  // too few for an interval
}

TEST_CASE("Learning curves: one for each trainee, with the axes of all") {
    std::vector<Attempt> attempts;
    for (int i = 0; i < 10; ++i) {
        Attempt a = attempt_of(synthetic_session({}).data);
        a.trainee = std::vector<std::string>{"Ada", "Bo", "<Cy>", "expert"}[static_cast<std::size_t>(i % 4)];
        a.trainee_kind = session::TraineeKind::person;
        a.score = 10.0 * i;
        a.duration = i == 9 ? 3000.0 : 60.0;
        attempts.push_back(a);
    }
    attempts[7].trainee_kind = session::TraineeKind::simulated;  // another "expert"
    const std::vector<std::size_t> all = attempt_groups(attempts).front();
    CHECK(split_by_trainee(attempts, all) ==
          std::vector<std::vector<std::size_t>>{{0, 4, 8}, {1, 5, 9}, {2, 6}, {3}, {7}});
    const std::string html = learning_curves_section(attempts, all, true);
    CHECK(markup_fault(page("t", html)) == "");
    CHECK(count_of(html, "<div class=\"trainee\">") == 3);  // a trainee with one attempt has no curve
    CHECK(count_of(html, "<td class=\"w\">") == 5);
    CHECK(has(html, "<td class=\"w\">&lt;Cy&gt;</td>"));
    CHECK(count_of(html, ">60</text>") == 3);  // each time axis ends at 60 min: the longest lesson takes 50
    CHECK(count_of(html, "class=\"ln p2\"") == 12);  // four plots for each of three
    CHECK(count_of(html, "class=\"ln cl\"") == 12);  // the median of the first and second attempts
    const std::vector<std::size_t> two = {0, 1};
    CHECK(learning_curves_section(attempts, two, true).empty());
}

TEST_CASE("Trainees: the kind of operator follows from the session's record, not from the name") {
    session::Header header;
    header.trainee_profile = "person";
    header.trainee = "novice";
    CHECK(session::trainee_kind(header) == session::TraineeKind::person);
    CHECK(trainee_text(header) == "novice");
    header.trainee = "";
    CHECK(trainee_text(header) == "person without a name");
    header.trainee_profile = "novice";
    CHECK(trainee_text(header) == "novice (simulated)");
    header.trainee = "Ada";
    CHECK(trainee_text(header) == "Ada (simulated novice)");
    // Older programs: no key for the trainee.
    header.trainee.reset();
    CHECK(trainee_text(header) == "novice (person or simulated: not recorded)");
    header.view_help = false;
    CHECK(trainee_text(header) == "novice (simulated)");
    header.view_help.reset();
    header.tool = "ratchet";
    CHECK(session::trainee_kind(header) == session::TraineeKind::person);
    CHECK(trainee_text(header) == "novice");
    header.tool.clear();
    header.trainee_profile = "person";
    CHECK(session::trainee_kind(header) == session::TraineeKind::person);
    CHECK(trainee_text(header) == "person without a name");
}

TEST_CASE("Report: explains only elements that are drawn") {
    SessionData session = synthetic_session({}).data;
    const std::string html = report_of(session);
    CHECK(has(html, "open dot"));
    CHECK(has(html, "nut at rest</li>"));
    CHECK(has(html, "Judged: torque; clamp force is shown, a wrench cannot measure it."));
    CHECK_FALSE(has(html, "angle window, along the axis"));
    CHECK_FALSE(has(html, "dotted line"));
    CHECK(has(html, ", wrench torque "));
    for (lesson::JointResult& r : session.joints) r.clamp = r.clamp_at_release;
    CHECK_FALSE(has(report_of(session), "open dot"));
}

TEST_CASE("Joint plot: loosened joints share their axes and are shown to the end") {
    SessionData session;
    session.assembly = synthetic_assembly();
    session.assembly.joints.resize(2);
    session.joints = results_by_joint(session.assembly, {});
    session.header.task = lesson::Task::loosen;
    CurveRequest request{{20.0, 20.0}, 0.001, joint::Direction::loosen, {}};
    std::vector<session::TickRecord> ticks;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i <= 900; ++i) {
            session::TickRecord t;
            const double back = 0.1 * i, left = std::max(0.0, 1.0 - back / 30.0);
            t.joint = static_cast<std::int16_t>(j);
            t.nut_angle = static_cast<float>(to_radians(500.0 - back));
            t.wrench_torque = static_cast<float>(-(j == 0 ? 60.0 : 90.0) * left);
            t.clamp = static_cast<float>((j == 0 ? 20e3 : 34e3) * left);
            t.stage =
                static_cast<std::uint8_t>(left > 0.0 ? joint::Stage::linearity : joint::Stage::navigation);
            ticks.push_back(t);
        }
    CurveBuilder builder(request);
    builder.add(0, ticks);
    session.curves = builder.finish();
    session.joints[0].torque = 60.0;
    session.joints[1].torque = 90.0;
    const Plot one = joint_plot(session, 0), two = joint_plot(session, 1);
    CHECK(one.y.ticks.range.low == two.y.ticks.range.low);
    CHECK(one.y2->ticks.range.high == two.y2->ticks.range.high);
    CHECK(one.x.ticks.range.high > 90.0);
    REQUIRE(marker_with(one, "mpeak") != nullptr);
    CHECK(marker_with(one, "mpeak")->label == "−60.0");
    const std::string html = report_of(session);
    CHECK(markup_fault(html) == "");
    for (const char* absent : {"torque window", "earlier passes", "judged", "yield</li>"})
        CHECK_FALSE_MESSAGE(has(html, absent), absent);
}
