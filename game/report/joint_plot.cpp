#include "game/report/joint_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/math.hpp"
#include "game/analysis/session_data.hpp"
#include "game/lesson/fastener_names.hpp"
#include "game/lesson/lesson.hpp"
#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"

namespace bolt::report {

namespace {

// Nut angle that is drawn: before the first contact, before the end, and of a loose nut.
constexpr double min_degrees_before_contact = 12.0;
constexpr double max_degrees_before_end = 540.0;
constexpr double max_free_degrees = 180.0;

constexpr std::string_view stage_styles[] = {"s0", "s1", "s2", "s3"};
// The last pass is drawn in the strongest colour.
constexpr std::string_view pass_styles[] = {"ln p0", "ln p1", "ln p2"};

std::string_view pass_style(int passes_after) {
    return pass_styles[static_cast<std::size_t>(std::clamp(2 - passes_after, 0, 2))];
}

bool is_loosening(const analysis::SessionData& session) {
    return session.direction() == joint::Direction::loosen;
}

// Degrees from the frame's origin, increasing in the direction of work.
double drawn_angle(const JointPlotFrame& frame, double nut_angle, bool loosening) {
    return to_degrees(loosening ? frame.origin - nut_angle : nut_angle - frame.origin);
}

using SampleValue = double (*)(const analysis::CurvePoint&);

std::vector<plot::SvgPoint> visit_line(const analysis::Visit& visit, const JointPlotFrame& frame,
                                       bool loosening, SampleValue value) {
    std::vector<plot::SvgPoint> points;
    for (std::size_t i = 0; i < visit.points.size(); ++i) {
        const analysis::CurvePoint& p = visit.points[i];
        if (i > 0 && p.hold != visit.points[i - 1].hold) points.push_back({nan, nan});
        points.push_back({drawn_angle(frame, p.angle, loosening), value(p)});
    }
    return points;
}

// A line split into the stretches in which the nut turned, and those in which the wrench was loaded and
// unloaded while the nut stood still. Each has gaps (NaN) at the stretches of the other.
struct SplitLine {
    std::vector<plot::SvgPoint> turning, resting;
};

SplitLine split_line(const std::vector<plot::SvgPoint>& line) {
    constexpr double still = 0.05;       // degrees within which the nut counts as still
    constexpr double noticeable = 0.03;  // of the highest torque; a smaller change is a nut that turns slowly
    double highest = 0.0;
    for (const plot::SvgPoint& p : line)
        highest = std::isfinite(p.y) ? std::max(highest, std::abs(p.y)) : highest;
    const auto append = [&](std::vector<plot::SvgPoint>& part, std::size_t from, std::size_t to) {
        const bool continues =
            !part.empty() && part.back().x == line[from].x && part.back().y == line[from].y;
        if (!continues && !part.empty()) part.push_back({nan, nan});
        part.insert(part.end(), line.begin() + static_cast<std::ptrdiff_t>(from + (continues ? 1 : 0)),
                    line.begin() + static_cast<std::ptrdiff_t>(to + 1));
    };
    SplitLine parts;
    for (std::size_t i = 0; i + 1 < line.size();) {
        plot::AxisRange torque{line[i].y, line[i].y};
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

bool is_in_frame(const JointPlotFrame& frame, double nut_angle, bool loosening) {
    const double at = drawn_angle(frame, nut_angle, loosening);
    return at >= frame.range.low - 1e-6 && at <= frame.range.high + 1e-6;
}

// The range of the drawn values of one joint; includes 0.
plot::AxisRange value_range(const analysis::SessionData& session, std::size_t joint, SampleValue value) {
    const bool loosening = is_loosening(session);
    const JointPlotFrame frame = joint_plot_frame(session, joint);
    plot::AxisRange range{0.0, 0.0};
    for (const analysis::Visit& visit : session.curves[joint].visits) {
        for (const analysis::CurvePoint& p : visit.points) {
            if (!is_in_frame(frame, p.angle, loosening)) continue;
            range.low = std::min(range.low, value(p));
            range.high = std::max(range.high, value(p));
        }
    }
    return range;
}

// Loosened joints have no targets and are compared with each other, so their plots share the axes.
plot::AxisRange shared_value_range(const analysis::SessionData& session, std::size_t joint,
                                   SampleValue value) {
    if (!is_loosening(session)) return value_range(session, joint, value);
    plot::AxisRange range{0.0, 0.0};
    for (std::size_t j = 0; j < session.curves.size(); ++j) {
        const plot::AxisRange one = value_range(session, j, value);
        range = {std::min(range.low, one.low), std::max(range.high, one.high)};
    }
    return range;
}

plot::PlotAxis value_axis(plot::AxisRange range, std::string label) {
    // Noise around zero (the weight of the nut) needs no tick below zero.
    if (range.low > -0.03 * range.high) range.low = 0.0;
    if (range.high < -0.03 * range.low) range.high = 0.0;
    const double room = 0.04 * range.span();
    const double low = range.low < 0.0 ? range.low - room : 0.0,
                 high = range.high > 0.0 ? range.high + room : 0.0;
    return {plot::covering_ticks(low, high, 5), std::move(label)};
}

void add_targets(plot::Plot& plot, const content::Specification& spec) {
    plot.bands.push_back({{spec.torque.low, spec.torque.high}, "win", "", true});
    plot.reference_lines.push_back({spec.torque.target, "tgt", "", true});
    if (!spec.has_angle) return;
    plot.bands.push_back(
        {{to_degrees(spec.angle.low), to_degrees(spec.angle.high)}, "wins", "", false, true});
}

// True for passes that lead to the target of a joint.
bool leads_to_target(const content::Pass& pass) {
    return pass.kind == content::PassKind::tighten || pass.kind == content::PassKind::turn;
}

// Index of the last pass that leads to the target. A re-check after it is drawn in the same style.
int last_pass_of(const analysis::SessionData& session) {
    if (is_loosening(session)) return 0;
    const std::vector<content::Pass>& passes = session.assembly.passes;
    const auto last = std::find_if(passes.rbegin(), passes.rend(), leads_to_target);
    return std::max(0, static_cast<int>(passes.rend() - last) - 1);
}

void add_visits(plot::Plot& plot, const analysis::JointCurve& curve, const JointPlotFrame& frame,
                bool loosening, int last_pass) {
    for (const analysis::Visit& visit : curve.visits)
        if (visit.worked)
            plot.lines.push_back({visit_line(visit, frame, loosening, clamp_kN), "ln cl", true});
    for (const analysis::Visit& visit : curve.visits) {
        if (!visit.worked) continue;
        SplitLine parts = split_line(visit_line(visit, frame, loosening, torque_of));
        plot.lines.push_back({std::move(parts.resting), "ln rest", false});
        plot.lines.push_back({std::move(parts.turning), pass_style(last_pass - visit.pass), false});
    }
}

const content::Pass* pass_of(const analysis::SessionData& session, const analysis::Visit& visit) {
    const auto pass = static_cast<std::size_t>(visit.pass);
    const bool recorded = !session.pass_texts.empty() && pass < session.assembly.passes.size();
    return recorded && !is_loosening(session) ? &session.assembly.passes[pass] : nullptr;
}

bool is_recheck(const analysis::SessionData& session, const analysis::Visit& visit) {
    const content::Pass* pass = pass_of(session, visit);
    return pass != nullptr && pass->kind == content::PassKind::recheck;
}

bool nut_turned(const analysis::Visit& visit) {
    return std::abs(visit.release.angle - visit.begin_angle) > to_radians(2.0);
}

// Two kinds of visits count, as in game/lesson: the last pass to the full target, and re-checks in which the
// nut turned. A re-check in which the nut only began to move shows the breakaway torque, not the tightening
// torque.
bool is_judged(const analysis::SessionData& session, const analysis::Visit& visit) {
    const content::Pass* pass = pass_of(session, visit);
    if (pass == nullptr) return true;
    if (pass->kind == content::PassKind::recheck) return nut_turned(visit);
    const auto full = [](const content::Pass& p) { return leads_to_target(p) && p.fraction > 0.999; };
    const std::vector<content::Pass>& passes = session.assembly.passes;
    const auto last = std::find_if(passes.rbegin(), passes.rend(), full);
    return last != passes.rend() && pass == &*last;
}

// Returns the point of the curve with the torque of the joint's result: a sample, otherwise the last crossing
// of that torque. `any_visit`: also visits that are not judged.
std::optional<analysis::CurvePoint> judged_point(const analysis::SessionData& session, std::size_t joint,
                                                 bool any_visit) {
    const double torque = session.joints[joint].torque;
    if (!(torque > 0.0)) return std::nullopt;
    double tolerance = 0.02 + 1e-4 * torque;  // N·m; the samples are single precision
    std::optional<analysis::CurvePoint> sample, crossing;
    const auto consider = [&](const analysis::CurvePoint& p) {
        const double error = std::abs(std::abs(p.torque) - torque);
        if (error > tolerance) return;
        tolerance = error;
        sample = p;
    };
    for (const analysis::Visit& visit : session.curves[joint].visits) {
        if (!visit.worked || !(any_visit || is_judged(session, visit))) continue;
        consider(visit.peak);
        for (std::size_t i = 0; i < visit.points.size(); ++i) {
            consider(visit.points[i]);
            if (i == 0) continue;
            const analysis::CurvePoint &a = visit.points[i - 1], &b = visit.points[i];
            const double from = std::abs(a.torque) - torque, to = std::abs(b.torque) - torque;
            if (a.hold != b.hold || a.angle == b.angle || from * to > 0.0 || from == to) continue;
            crossing = a;
            crossing->angle += from / (from - to) * (b.angle - a.angle);
            crossing->torque = b.torque;
        }
    }
    return sample ? sample : crossing;
}

void add_judged(plot::Plot& plot, const analysis::SessionData& session, std::size_t joint,
                const JointPlotFrame& frame) {
    const bool loosening = is_loosening(session);
    std::optional<analysis::CurvePoint> judged = judged_point(session, joint, false);
    // A joint that never had a pass to the full target is judged by the passes so far.
    if (!judged) judged = judged_point(session, joint, true);
    if (!judged || !is_in_frame(frame, judged->angle, loosening)) return;
    const double torque =
        std::copysign(session.joints[joint].torque, judged->torque);  // the same value as in the table
    plot.markers.push_back({{drawn_angle(frame, judged->angle, loosening), torque},
                            plot::MarkerShape::dot,
                            "mpeak",
                            plot::number(torque, 1),
                            false,
                            false});
}

void add_releases(plot::Plot& plot, const analysis::SessionData& session, const analysis::JointCurve& curve,
                  const JointPlotFrame& frame) {
    const bool loosening = is_loosening(session);
    for (const analysis::Visit& visit : curve.visits) {
        const double at = visit.release.angle;
        if (!visit.worked || !is_in_frame(frame, at, loosening)) continue;
        const content::Pass* pass = pass_of(session, visit);
        const bool named = pass != nullptr && leads_to_target(*pass) && pass->fraction < 1.0;
        plot.markers.push_back({{drawn_angle(frame, at, loosening), clamp_kN(visit.release)},
                                plot::MarkerShape::square,
                                "mclamp",
                                named ? analysis::pass_label(*pass) : "",
                                true,
                                true});
    }
}

// Marks the highest torque among the re-checks whose peak is not the judged torque: the nut did not turn, or
// it turned at a lower torque.
void add_breakaway(plot::Plot& plot, const analysis::SessionData& session, std::size_t joint,
                   const JointPlotFrame& frame) {
    const analysis::Visit* highest = nullptr;
    for (const analysis::Visit& visit : session.curves[joint].visits) {
        if (!visit.worked || !is_recheck(session, visit)) continue;
        if (nut_turned(visit) && visit.peak.torque <= session.joints[joint].torque + 0.05) continue;
        if (highest == nullptr || visit.peak.torque > highest->peak.torque) highest = &visit;
    }
    if (highest == nullptr || !is_in_frame(frame, highest->peak.angle, false)) return;
    plot.markers.push_back({{drawn_angle(frame, highest->peak.angle, false), torque_of(highest->peak)},
                            plot::MarkerShape::ring,
                            "mbreak",
                            fmt::format("breakaway {}", plot::number(torque_of(highest->peak), 1)),
                            false,
                            true});
}

// Draws the whole run as an inset below the target window, where the curve leaves room.
void draw_inset(plot::Svg& svg, const plot::Plot& plot, const analysis::JointCurve& curve,
                const JointPlotFrame& frame, double below, bool loosening) {
    const plot::SvgBox area = plot::plot_area(plot);
    const plot::AxisScale torque{plot.y.ticks.range, area.height, true};
    const plot::SvgBox box{area.x + 8.0, area.y + std::min(torque(below) + 12.0, 0.5 * area.height), 96.0,
                           34.0};
    const plot::AxisScale x{{curve.start_angle, curve.end_angle}, box.width, false};
    const plot::AxisScale y{plot.y.ticks.range, box.height - 2.0, true};
    svg.rect(box, "inset");
    svg.begin_clip(box);
    for (const analysis::Visit& visit : curve.visits) {
        std::vector<plot::SvgPoint> points = visit_line(visit, frame, loosening, torque_of);
        for (plot::SvgPoint& p : points) p = {x(frame.origin + to_radians(p.x)), y(p.y)};
        svg.path(plot::decimate(points, 1.0), "ln in");
    }
    svg.end_clip();
    const double turns = (curve.end_angle - curve.start_angle) / (2.0 * pi);
    svg.text({box.x, box.y + box.height + 12.0}, "sm",
             fmt::format("whole run, {} turns", plot::number(turns, 1)));
}

}  // namespace

JointPlotFrame joint_plot_frame(const analysis::SessionData& session, std::size_t joint) {
    const analysis::JointCurve& curve = session.curves[joint];
    const bool loosening = is_loosening(session);
    const auto contact =
        std::find_if(curve.stages.begin(), curve.stages.end(),
                     [](const analysis::StageSpan& s) { return s.stage != joint::Stage::navigation; });
    const bool has_contact = contact != curve.stages.end();
    JointPlotFrame frame;
    frame.origin = loosening || !has_contact ? curve.start_angle : contact->from;
    frame.origin_name = loosening || !has_contact ? "start" : "first contact";
    if (!loosening && std::isfinite(curve.mark)) {
        frame.origin = curve.mark;
        frame.origin_name = lesson::turns_by_angle(session.assembly) ? "mark" : "snug";
    }
    const double start = drawn_angle(frame, curve.start_angle, loosening);
    double end = drawn_angle(frame, curve.end_angle, loosening);
    double from = start;
    if (!loosening && has_contact) {
        const double touch = drawn_angle(frame, contact->from, loosening);
        from = std::max({start, touch - std::max(min_degrees_before_contact, 0.12 * (end - touch)),
                         end - max_degrees_before_end});
    }
    if (loosening) {  // the end of the free rotation is not drawn
        const auto free =
            std::find_if(curve.stages.begin(), curve.stages.end(),
                         [](const analysis::StageSpan& s) { return s.stage == joint::Stage::navigation; });
        const double loose = free == curve.stages.end() ? end : drawn_angle(frame, free->from, loosening);
        frame.cut_after = end - loose > max_free_degrees;
        if (frame.cut_after) end = loose + max_free_degrees;
    }
    frame.cut_before = from > start + 1.0;
    const double margin = std::max(0.5, 0.04 * (end - from));
    frame.range = {frame.cut_before ? from : from - margin, end + margin};
    return frame;
}

plot::Plot joint_plot(const analysis::SessionData& session, std::size_t joint) {
    const analysis::JointCurve& curve = session.curves[joint];
    const content::Specification& spec = session.assembly.joints[joint].spec;
    const bool loosening = is_loosening(session);
    const JointPlotFrame frame = joint_plot_frame(session, joint);

    plot::Plot plot;
    const std::string_view fastener = lesson::fastener_name(session.assembly.joints[joint].design);
    plot.title =
        fmt::format("{}: torque and clamp force over the {} angle", session.joints[joint].id, fastener);
    plot.x = {plot::degree_ticks(frame.range, 7), ""};
    plot.x.ticks.range = frame.range;
    plot.x.label =
        loosening ? "angle turned back, °" : fmt::format("{} angle from {}, °", fastener, frame.origin_name);
    if (frame.cut_before) plot.x.label += fmt::format(" (drawn from {}°)", plot::number(frame.range.low, 0));
    if (frame.cut_after) plot.x.label += fmt::format(" (drawn to {}°)", plot::number(frame.range.high, 0));
    plot::AxisRange torque = shared_value_range(session, joint, torque_of);
    if (!loosening) torque.high = std::max(torque.high, spec.torque.high);
    plot.y = value_axis(torque, "torque, N·m");
    plot::AxisRange clamp = shared_value_range(session, joint, clamp_kN);
    if (!loosening) clamp.high = std::max(clamp.high, analysis::target_clamp(session.assembly, joint) * 1e-3);
    clamp.high *= 1.3;  // keeps the curves of force and torque apart
    plot.y2 = value_axis(clamp, "clamp, kN");

    for (const analysis::StageSpan& span : curve.stages) {
        const auto stage = static_cast<std::size_t>(span.stage);
        const double from = drawn_angle(frame, span.from, loosening),
                     to = drawn_angle(frame, span.to, loosening);
        // The last stage extends over the margin, which would otherwise look like a change of stage.
        const bool last = &span == &curve.stages.back();
        plot.bands.push_back(
            {{from, last ? frame.range.high : to}, stage_styles[stage], std::string(name(span.stage))});
    }
    if (!loosening) add_targets(plot, spec);
    add_visits(plot, curve, frame, loosening, last_pass_of(session));
    add_releases(plot, session, curve, frame);
    add_breakaway(plot, session, joint, frame);
    add_judged(plot, session, joint, frame);
    return plot;
}

std::string joint_figure(const analysis::SessionData& session, std::size_t joint) {
    const plot::Plot plot = joint_plot(session, joint);
    plot::Svg svg(plot.width, plot.height, plot.title);
    plot::draw_into(svg, plot);
    const JointPlotFrame frame = joint_plot_frame(session, joint);
    const double below = session.assembly.joints[joint].spec.torque.low;
    if (frame.cut_before) draw_inset(svg, plot, session.curves[joint], frame, below, is_loosening(session));
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
