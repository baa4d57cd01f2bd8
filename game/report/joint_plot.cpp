#include "game/report/joint_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/math.hpp"
#include "game/analysis/session_data.hpp"
#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"

namespace bolt::report {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double lead_in = 12.0;        // degrees drawn before the first contact, at least
constexpr double longest = 540.0;       // degrees drawn before the end, at most
constexpr double longest_free = 180.0;  // degrees drawn of a loose nut, at most

constexpr std::string_view stage_styles[] = {"s0", "s1", "s2", "s3"};
// The last pass stands out, those before step back.
constexpr std::string_view pass_styles[] = {"ln p0", "ln p1", "ln p2"};

std::string_view pass_style(int passes_after) {
    return pass_styles[static_cast<std::size_t>(std::clamp(2 - passes_after, 0, 2))];
}

bool is_loosening(const analysis::SessionData& session) {
    return session.direction() == joint::Direction::loosen;
}

// Degrees from the view's zero, growing in the direction of work.
double drawn_angle(const JointView& view, double nut_angle, bool loosening) {
    return to_degrees(loosening ? view.zero - nut_angle : nut_angle - view.zero);
}

using Value = double (*)(const analysis::CurvePoint&);

std::vector<plot::Point> line_of(const analysis::Visit& visit, const JointView& view, bool loosening,
                                 Value value) {
    std::vector<plot::Point> points;
    for (std::size_t i = 0; i < visit.points.size(); ++i) {
        const analysis::CurvePoint& p = visit.points[i];
        if (i > 0 && p.stroke != visit.points[i - 1].stroke) points.push_back({nan, nan});
        points.push_back({drawn_angle(view, p.angle, loosening), value(p)});
    }
    return points;
}

// Loading and unloading the wrench while the nut stands still is part of the record, but not what is looked
// at: the line is parted into what turned the nut and the rest, each with gaps where the other is.
struct Parted {
    std::vector<plot::Point> turning, resting;
};

Parted parted(const std::vector<plot::Point>& line) {
    constexpr double still = 0.05;       // degrees within which the nut counts as standing
    constexpr double noticeable = 0.03;  // of the highest torque: a smaller change is the nut creeping on
    double highest = 0.0;
    for (const plot::Point& p : line)
        highest = std::isfinite(p.y) ? std::max(highest, std::abs(p.y)) : highest;
    const auto append = [&](std::vector<plot::Point>& part, std::size_t from, std::size_t to) {
        const bool goes_on = !part.empty() && part.back().x == line[from].x && part.back().y == line[from].y;
        if (!goes_on && !part.empty()) part.push_back({nan, nan});
        part.insert(part.end(), line.begin() + static_cast<std::ptrdiff_t>(from + (goes_on ? 1 : 0)),
                    line.begin() + static_cast<std::ptrdiff_t>(to + 1));
    };
    Parted parts;
    for (std::size_t i = 0; i + 1 < line.size();) {
        plot::Range torque{line[i].y, line[i].y};
        std::size_t end = i;
        while (end + 1 < line.size() && std::abs(line[end + 1].x - line[i].x) <= still) {
            ++end;
            torque = {std::min(torque.low, line[end].y), std::max(torque.high, line[end].y)};
        }
        const bool rests = torque.span() > noticeable * highest;
        const bool gap = !std::isfinite(line[i].x) || !std::isfinite(line[i + 1].x);
        if (!gap) append(rests ? parts.resting : parts.turning, i, rests ? end : i + 1);
        i = rests ? end : i + 1;
    }
    return parts;
}

double torque_of(const analysis::CurvePoint& p) { return p.torque; }
double clamp_kN(const analysis::CurvePoint& p) { return p.clamp * 1e-3; }

bool is_in_view(const JointView& view, double nut_angle, bool loosening) {
    const double at = drawn_angle(view, nut_angle, loosening);
    return at >= view.shown.low - 1e-6 && at <= view.shown.high + 1e-6;
}

// Highest and lowest of what is drawn of one joint.
plot::Range extent(const analysis::SessionData& session, std::size_t joint, Value value) {
    const bool loosening = is_loosening(session);
    const JointView view = joint_view(session, joint);
    plot::Range range{0.0, 0.0};
    for (const analysis::Visit& visit : session.curves[joint].visits) {
        for (const analysis::CurvePoint& p : visit.points) {
            if (!is_in_view(view, p.angle, loosening)) continue;
            range.low = std::min(range.low, value(p));
            range.high = std::max(range.high, value(p));
        }
    }
    return range;
}

// Loosened joints are compared with each other, as nothing else is asked of them: they share their axes.
plot::Range shared_extent(const analysis::SessionData& session, std::size_t joint, Value value) {
    if (!is_loosening(session)) return extent(session, joint, value);
    plot::Range range{0.0, 0.0};
    for (std::size_t j = 0; j < session.curves.size(); ++j) {
        const plot::Range one = extent(session, j, value);
        range = {std::min(range.low, one.low), std::max(range.high, one.high)};
    }
    return range;
}

plot::Axis value_axis(plot::Range range, std::string label) {
    // Noise around zero (the weight of the nut) does not ask for a tick below it.
    if (range.low > -0.03 * range.high) range.low = 0.0;
    if (range.high < -0.03 * range.low) range.high = 0.0;
    const double room = 0.04 * range.span();
    const double low = range.low < 0.0 ? range.low - room : 0.0,
                 high = range.high > 0.0 ? range.high + room : 0.0;
    return {plot::covering_ticks(low, high, 5), std::move(label)};
}

void add_targets(plot::Plot& plot, const content::Specification& spec) {
    plot.bands.push_back({{spec.torque.low, spec.torque.high}, "win", "", true});
    plot.rules.push_back({spec.torque.target, "tgt", "", true});
    if (!spec.has_angle) return;
    plot.bands.push_back(
        {{to_degrees(spec.angle.low), to_degrees(spec.angle.high)}, "wins", "", false, true});
}

// The last pass that tightens: a re-check after it is drawn like it.
int last_pass_of(const analysis::SessionData& session) {
    if (is_loosening(session)) return 0;
    const std::vector<content::Pass>& passes = session.assembly.passes;
    const auto last = std::find_if(passes.rbegin(), passes.rend(), [](const content::Pass& p) {
        return p.kind == content::StepKind::tighten;
    });
    return std::max(0, static_cast<int>(passes.rend() - last) - 1);
}

void add_visits(plot::Plot& plot, const analysis::JointCurve& curve, const JointView& view, bool loosening,
                int last_pass) {
    for (const analysis::Visit& visit : curve.visits)
        if (visit.worked) plot.lines.push_back({line_of(visit, view, loosening, clamp_kN), "ln cl", true});
    for (const analysis::Visit& visit : curve.visits) {
        if (!visit.worked) continue;
        Parted parts = parted(line_of(visit, view, loosening, torque_of));
        plot.lines.push_back({std::move(parts.resting), "ln rest", false});
        plot.lines.push_back({std::move(parts.turning), pass_style(last_pass - visit.pass), false});
    }
}

const content::Pass* pass_of(const analysis::SessionData& session, const analysis::Visit& visit) {
    const auto pass = static_cast<std::size_t>(visit.pass);
    const bool told = !session.pass_texts.empty() && pass < session.assembly.passes.size();
    return told && !is_loosening(session) ? &session.assembly.passes[pass] : nullptr;
}

bool is_recheck(const analysis::SessionData& session, const analysis::Visit& visit) {
    const content::Pass* pass = pass_of(session, visit);
    return pass != nullptr && pass->kind == content::StepKind::recheck;
}

bool turned_on(const analysis::Visit& visit) {
    return std::abs(visit.release.angle - visit.begin_angle) > to_radians(2.0);
}

// As game/lesson judges it: the last pass to the full target, and re-checks that turned the nut on. One that
// only saw it begin to move shows its breakaway, which is not what it was tightened with.
bool is_judged(const analysis::SessionData& session, const analysis::Visit& visit) {
    const content::Pass* pass = pass_of(session, visit);
    if (pass == nullptr) return true;
    if (pass->kind == content::StepKind::recheck) return turned_on(visit);
    const auto full = [](const content::Pass& p) {
        return p.kind == content::StepKind::tighten && p.fraction > 0.999;
    };
    const std::vector<content::Pass>& passes = session.assembly.passes;
    const auto last = std::find_if(passes.rbegin(), passes.rend(), full);
    return last != passes.rend() && pass == &*last;
}

// Where the curve shows the torque of the joint's result: a sample of it, else the last way through it.
std::optional<analysis::CurvePoint> judged_point(const analysis::SessionData& session, std::size_t joint,
                                                 bool any_visit) {
    const double torque = session.joints[joint].torque;
    if (!(torque > 0.0)) return std::nullopt;
    double least = 0.02 + 1e-4 * torque;  // N·m by which it may differ: the samples are single precision
    std::optional<analysis::CurvePoint> sample, passed;
    const auto look = [&](const analysis::CurvePoint& p) {
        const double off = std::abs(std::abs(p.torque) - torque);
        if (off > least) return;
        least = off;
        sample = p;
    };
    for (const analysis::Visit& visit : session.curves[joint].visits) {
        if (!visit.worked || !(any_visit || is_judged(session, visit))) continue;
        look(visit.peak);
        for (std::size_t i = 0; i < visit.points.size(); ++i) {
            look(visit.points[i]);
            if (i == 0) continue;
            const analysis::CurvePoint &a = visit.points[i - 1], &b = visit.points[i];
            const double from = std::abs(a.torque) - torque, to = std::abs(b.torque) - torque;
            if (a.stroke != b.stroke || a.angle == b.angle || from * to > 0.0 || from == to) continue;
            passed = a;
            passed->angle += from / (from - to) * (b.angle - a.angle);
            passed->torque = b.torque;
        }
    }
    return sample ? sample : passed;
}

void add_judged(plot::Plot& plot, const analysis::SessionData& session, std::size_t joint,
                const JointView& view) {
    const bool loosening = is_loosening(session);
    std::optional<analysis::CurvePoint> judged = judged_point(session, joint, false);
    // A joint that was never brought to its target in full is judged by what it has seen so far.
    if (!judged) judged = judged_point(session, joint, true);
    if (!judged || !is_in_view(view, judged->angle, loosening)) return;
    const double torque = std::copysign(session.joints[joint].torque, judged->torque);  // as the table has it
    plot.marks.push_back({{drawn_angle(view, judged->angle, loosening), torque},
                          plot::Shape::dot,
                          "mpeak",
                          plot::number(torque, 1),
                          false,
                          false});
}

void add_releases(plot::Plot& plot, const analysis::SessionData& session, const analysis::JointCurve& curve,
                  const JointView& view) {
    const bool loosening = is_loosening(session);
    for (const analysis::Visit& visit : curve.visits) {
        const double at = visit.release.angle;
        if (!visit.worked || !is_in_view(view, at, loosening)) continue;
        const content::Pass* pass = pass_of(session, visit);
        const bool named =
            pass != nullptr && pass->kind == content::StepKind::tighten && pass->fraction < 1.0;
        plot.marks.push_back({{drawn_angle(view, at, loosening), clamp_kN(visit.release)},
                              plot::Shape::square,
                              "mclamp",
                              named ? analysis::pass_label(*pass) : "",
                              true,
                              true});
    }
}

// Highest torque of re-checks where it is not what is judged: the nut did not turn on, or not with it.
void add_breakaway(plot::Plot& plot, const analysis::SessionData& session, std::size_t joint,
                   const JointView& view) {
    const analysis::Visit* highest = nullptr;
    for (const analysis::Visit& visit : session.curves[joint].visits) {
        if (!visit.worked || !is_recheck(session, visit)) continue;
        if (turned_on(visit) && visit.peak.torque <= session.joints[joint].torque + 0.05) continue;
        if (highest == nullptr || visit.peak.torque > highest->peak.torque) highest = &visit;
    }
    if (highest == nullptr || !is_in_view(view, highest->peak.angle, false)) return;
    plot.marks.push_back({{drawn_angle(view, highest->peak.angle, false), torque_of(highest->peak)},
                          plot::Shape::ring,
                          "mbreak",
                          fmt::format("breakaway {}", plot::number(torque_of(highest->peak), 1)),
                          false,
                          true});
}

// The whole run, small, under the target window where the curve leaves room.
void draw_inset(plot::Svg& svg, const plot::Plot& plot, const analysis::JointCurve& curve,
                const JointView& view, double below, bool loosening) {
    const plot::Box area = plot::plot_area(plot);
    const plot::Scale torque{plot.y.ticks.range, area.height, true};
    const plot::Box box{area.x + 8.0, area.y + std::min(torque(below) + 12.0, 0.5 * area.height), 96.0, 34.0};
    const plot::Scale x{{curve.start_angle, curve.end_angle}, box.width, false};
    const plot::Scale y{plot.y.ticks.range, box.height - 2.0, true};
    svg.rect(box, "inset");
    svg.enter(box);
    for (const analysis::Visit& visit : curve.visits) {
        std::vector<plot::Point> points = line_of(visit, view, loosening, torque_of);
        for (plot::Point& p : points) p = {x(view.zero + to_radians(p.x)), y(p.y)};
        svg.path(plot::decimate(points, 1.0), "ln in");
    }
    svg.leave();
    const double turns = (curve.end_angle - curve.start_angle) / (2.0 * pi);
    svg.text({box.x, box.y + box.height + 12.0}, "sm",
             fmt::format("whole run, {} turns", plot::number(turns, 1)));
}

}  // namespace

JointView joint_view(const analysis::SessionData& session, std::size_t joint) {
    const analysis::JointCurve& curve = session.curves[joint];
    const bool loosening = is_loosening(session);
    const auto contact =
        std::find_if(curve.stages.begin(), curve.stages.end(),
                     [](const analysis::StageSpan& s) { return s.stage != joint::Stage::navigation; });
    const bool met = contact != curve.stages.end();
    JointView view;
    view.zero = loosening || !met ? curve.start_angle : contact->from;
    view.zero_name = loosening || !met ? "start" : "first contact";
    if (!loosening && std::isfinite(curve.snug_angle)) {
        view.zero = curve.snug_angle;
        view.zero_name = "snug";
    }
    const double start = drawn_angle(view, curve.start_angle, loosening);
    double end = drawn_angle(view, curve.end_angle, loosening);
    double from = start;
    if (!loosening && met) {
        const double touch = drawn_angle(view, contact->from, loosening);
        from = std::max({start, touch - std::max(lead_in, 0.12 * (end - touch)), end - longest});
    }
    if (loosening) {  // once the nut is free nothing more happens, however far it is turned
        const auto free =
            std::find_if(curve.stages.begin(), curve.stages.end(),
                         [](const analysis::StageSpan& s) { return s.stage == joint::Stage::navigation; });
        const double loose = free == curve.stages.end() ? end : drawn_angle(view, free->from, loosening);
        view.cut_after = end - loose > longest_free;
        if (view.cut_after) end = loose + longest_free;
    }
    view.cut = from > start + 1.0;
    const double margin = std::max(0.5, 0.04 * (end - from));
    view.shown = {view.cut ? from : from - margin, end + margin};
    return view;
}

plot::Plot joint_plot(const analysis::SessionData& session, std::size_t joint) {
    const analysis::JointCurve& curve = session.curves[joint];
    const content::Specification& spec = session.assembly.joints[joint].spec;
    const bool loosening = is_loosening(session);
    const JointView view = joint_view(session, joint);

    plot::Plot plot;
    plot.title = fmt::format("{}: torque and clamp force over the nut angle", session.joints[joint].id);
    plot.x = {plot::degree_ticks(view.shown, 7), ""};
    plot.x.ticks.range = view.shown;
    plot.x.label = loosening ? "angle turned back, °" : fmt::format("nut angle from {}, °", view.zero_name);
    if (view.cut) plot.x.label += fmt::format(" (drawn from {}°)", plot::number(view.shown.low, 0));
    if (view.cut_after) plot.x.label += fmt::format(" (drawn to {}°)", plot::number(view.shown.high, 0));
    plot::Range torque = shared_extent(session, joint, torque_of);
    if (!loosening) torque.high = std::max(torque.high, spec.torque.high);
    plot.y = value_axis(torque, "torque, N·m");
    plot::Range clamp = shared_extent(session, joint, clamp_kN);
    if (!loosening) clamp.high = std::max(clamp.high, analysis::target_clamp(session.assembly, joint) * 1e-3);
    clamp.high *= 1.3;  // the forces follow the torque: apart they can be told from each other
    plot.y2 = value_axis(clamp, "clamp, kN");

    for (const analysis::StageSpan& span : curve.stages) {
        const auto stage = static_cast<std::size_t>(span.stage);
        const double from = drawn_angle(view, span.from, loosening),
                     to = drawn_angle(view, span.to, loosening);
        // Beyond the last sample the stage goes on; a plain margin would look like a change.
        const bool last = &span == &curve.stages.back();
        plot.bands.push_back(
            {{from, last ? view.shown.high : to}, stage_styles[stage], std::string(name(span.stage))});
    }
    if (!loosening) add_targets(plot, spec);
    add_visits(plot, curve, view, loosening, last_pass_of(session));
    add_releases(plot, session, curve, view);
    add_breakaway(plot, session, joint, view);
    add_judged(plot, session, joint, view);
    return plot;
}

std::string joint_figure(const analysis::SessionData& session, std::size_t joint) {
    const plot::Plot plot = joint_plot(session, joint);
    plot::Svg svg(plot.width, plot.height, plot.title);
    plot::draw_into(svg, plot);
    const JointView view = joint_view(session, joint);
    const double below = session.assembly.joints[joint].spec.torque.low;
    if (view.cut) draw_inset(svg, plot, session.curves[joint], view, below, is_loosening(session));
    return svg.finish();
}

std::string run_down_text(const analysis::RunDown& run) {
    if (run.angle < to_radians(15.0)) return {};
    const std::string low = plot::number(run.torque_low, 2), high = plot::number(run.torque_high, 2);
    return fmt::format("Run-down of {} turns in {}, wrench torque {} N·m.",
                       plot::number(run.angle / (2.0 * pi), 1), plot::duration_text(run.time),
                       low == high ? high : low + "…" + high);
}

}  // namespace bolt::report
