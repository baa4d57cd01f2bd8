#include "game/report/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "game/report/text.hpp"

namespace bolt::report {

namespace {

using lesson::Verdict;

std::string_view verdict_style(Verdict verdict) {
    constexpr std::string_view styles[] = {"vn", "vl", "vo", "vh"};
    return styles[static_cast<std::size_t>(verdict)];
}

// Axes of the paper: to the right and down, when the bolts point at the reader.
struct Paper {
    Vec3 right{1.0, 0.0, 0.0};
    Vec3 down{0.0, 0.0, 1.0};
};

Paper paper_of(const content::Assembly& assembly) {
    Vec3 axis{0.0};
    for (const content::AssemblyJoint& joint : assembly.joints) axis += joint.design.axis;
    const double length = glm::length(axis);
    if (!(length > 1e-9)) return {};
    axis /= length;
    const Vec3 across = std::abs(axis.x) < 0.9 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 0.0, -1.0};
    const Vec3 right = glm::normalize(across - axis * glm::dot(across, axis));
    return {right, glm::cross(right, axis)};
}

// An arrow from disc to disc. Its head is off the middle, where the lines of a cross pattern meet.
void draw_arrow(Svg& svg, Point a, Point b, double radius, std::string_view style, bool head) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length < 2.0 * radius + 1.0) return;
    const double ux = dx / length, uy = dy / length;
    svg.line({a.x + ux * radius, a.y + uy * radius}, {b.x - ux * radius, b.y - uy * radius}, style);
    if (!head) return;
    const Point tip{a.x + 0.64 * dx + 4.0 * ux, a.y + 0.64 * dy + 4.0 * uy};
    const Point corners[] = {tip,
                             {tip.x - 8.0 * ux - 3.2 * uy, tip.y - 8.0 * uy + 3.2 * ux},
                             {tip.x - 8.0 * ux + 3.2 * uy, tip.y - 8.0 * uy - 3.2 * ux}};
    svg.path(corners, "ah", true);
}

std::vector<std::size_t> joints_followed(const PassOrder& order) {
    std::vector<std::size_t> joints;
    for (const Turn& turn : order.followed) joints.push_back(turn.joint);
    return joints;
}

void draw_order_joint(Svg& svg, const SessionData& session, const PassOrder& order, const PlanLayout& layout,
                      std::size_t joint) {
    const Point at = layout.at[joint];
    const std::size_t asked = order.place_asked(joint), followed = order.place_followed(joint);
    const auto wrong = [&](const Turn& t) { return t.joint == joint && t.out_of_turn; };
    const bool out_of_turn = std::any_of(order.followed.begin(), order.followed.end(), wrong);
    svg.circle(at, layout.radius, followed == 0 ? "dn" : out_of_turn ? "dw" : "dd");
    svg.text({at.x, at.y + 4.0}, "no mid", followed == 0 ? "–" : fmt::format("{}", followed));
    // Words stand on the outer side, away from the lines.
    const bool under = at.y > 0.5 * layout.height;
    const double near = layout.radius + (under ? 12.0 : 4.0), far = near + 11.0;
    svg.text({at.x, at.y + (under ? near : -near)}, "sm mid", session.joints[joint].id);
    const std::size_t visits = order.visits(joint);
    std::string below;
    if (out_of_turn || (followed == 0 && asked > 0)) below = fmt::format("asked {}", asked);
    if (visits > 1) below += fmt::format("{}{}×", below.empty() ? "" : ", ", visits);
    if (below.empty()) return;
    svg.text({at.x, at.y + (under ? far : -far)}, "wn mid", (out_of_turn ? "▲ " : "") + below);
}

// Height of a bar such that those above and below, with their words, do not touch.
double bar_room(const PlanLayout& layout) {
    constexpr double words_wide = 40.0, words_high = 32.0;
    double room = 56.0;
    for (std::size_t i = 0; i < layout.at.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (std::abs(layout.at[i].x - layout.at[k].x) < words_wide)
                room = std::min(room, std::abs(layout.at[i].y - layout.at[k].y) - words_high);
    return std::max(room, 12.0);
}

}  // namespace

PlanLayout plan_layout(const content::Assembly& assembly, double width, double margin) {
    const Paper paper = paper_of(assembly);
    PlanLayout layout;
    layout.width = width;
    Range x{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}, y = x;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const Point p{glm::dot(joint.design.seat, paper.right), glm::dot(joint.design.seat, paper.down)};
        layout.at.push_back(p);
        x = {std::min(x.low, p.x), std::max(x.high, p.x)};
        y = {std::min(y.low, p.y), std::max(y.high, p.y)};
    }
    if (layout.at.empty()) return layout;
    // As wide as there is room for, and no taller than half of that.
    const double room = width - 2.0 * margin;
    const double scale = room / std::max({x.span(), 2.0 * y.span(), 1e-6});
    layout.height = y.span() * scale + 2.0 * margin;
    const double left = 0.5 * (width - x.span() * scale);
    for (Point& p : layout.at) p = {left + (p.x - x.low) * scale, margin + (p.y - y.low) * scale};
    for (std::size_t i = 0; i < layout.at.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double apart = std::hypot(layout.at[i].x - layout.at[k].x, layout.at[i].y - layout.at[k].y);
            layout.radius = std::clamp(0.42 * apart, 4.0, layout.radius);
        }
    return layout;
}

std::string order_plan(const SessionData& session, const PassOrder& order) {
    const PlanLayout layout = plan_layout(session.assembly, 340.0, 40.0);
    Svg svg(layout.width, layout.height, fmt::format("Order of the joints, {}", order.label));
    const std::vector<std::size_t> followed = joints_followed(order);
    for (std::size_t i = 1; i < order.asked.size(); ++i)
        draw_arrow(svg, layout.at[order.asked[i - 1]], layout.at[order.asked[i]], layout.radius, "oa", false);
    for (std::size_t i = 1; i < followed.size(); ++i)
        draw_arrow(svg, layout.at[followed[i - 1]], layout.at[followed[i]], layout.radius, "of", true);
    for (std::size_t j = 0; j < layout.at.size(); ++j) draw_order_joint(svg, session, order, layout, j);
    return svg.finish();
}

std::string clamp_plan(const SessionData& session) {
    constexpr double bar_width = 12.0, full = 1.25;  // of the target: top of the bar's frame
    const PlanLayout layout = plan_layout(session.assembly, 480.0, 52.0);
    const double bar_height = bar_room(layout);
    Svg svg(layout.width, layout.height, "Clamp force of each joint against its target");
    for (std::size_t j = 0; j < layout.at.size(); ++j) {
        const lesson::JointResult& r = session.joints[j];
        const double share = r.clamp / target_clamp(session.assembly, j);
        const double height = bar_height * std::clamp(std::isfinite(share) ? share / full : 0.0, 0.0, 1.0);
        const Point at = layout.at[j];
        const double bottom = at.y + 0.5 * bar_height, mark = bottom - bar_height / full;
        svg.rect({at.x - 0.5 * bar_width, bottom - bar_height, bar_width, bar_height}, "bf");
        svg.rect({at.x - 0.5 * bar_width, bottom - height, bar_width, height},
                 fmt::format("bar {}", verdict_style(r.overall)));
        svg.line({at.x - 0.5 * bar_width - 3.0, mark}, {at.x + 0.5 * bar_width + 3.0, mark}, "tgt");
        svg.text({at.x, bottom + 13.0}, "no mid", number(r.clamp * 1e-3, 1));
        svg.text({at.x, bottom - bar_height - 5.0}, "sm mid", r.id);
    }
    return svg.finish();
}

std::string clamp_rows(const SessionData& session) {
    constexpr double row = 20.0, top = 14.0, left = 56.0, right = 72.0, width = 480.0, bottom = 40.0;
    const Summary summary = summarise(session);
    double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
    for (std::size_t j = 0; j < session.joints.size(); ++j)
        for (const double force : {session.joints[j].clamp, session.joints[j].clamp_at_release,
                                   target_clamp(session.assembly, j)}) {
            const bool shown = session.joints[j].overall != Verdict::none && std::isfinite(force);
            lowest = shown ? std::min(lowest, force) : lowest;
            highest = shown ? std::max(highest, force) : highest;
        }
    // Dots, not bars: where all lie close together the axis need not start at zero.
    const double from_zero = lowest > 0.5 * highest ? 0.98 * lowest : 0.0;
    const Ticks ticks = covering_ticks(1e-3 * from_zero, 1.02e-3 * highest, 6);
    const Scale x{ticks.range, width - left - right, false};
    const double foot = top + row * static_cast<double>(session.joints.size());
    Svg svg(width, foot + bottom, "Clamp force of each joint when released and in the end");
    if (std::isfinite(summary.clamp_deviation)) {
        const double from = x(1e-3 * (summary.clamp_mean - summary.clamp_deviation));
        const double to = x(1e-3 * (summary.clamp_mean + summary.clamp_deviation));
        svg.rect({left + std::max(0.0, from), top, to - std::max(0.0, from), foot - top}, "s1");
        svg.line({left + x(1e-3 * summary.clamp_mean), top}, {left + x(1e-3 * summary.clamp_mean), foot},
                 "mean");
    }
    for (const double at : ticks.at) {
        svg.line({left + x(at), top}, {left + x(at), foot}, "gr");
        svg.text({left + x(at), foot + 16.0}, "tk mid", number(at, ticks.decimals));
    }
    for (std::size_t j = 0; j < session.joints.size(); ++j) {
        const lesson::JointResult& r = session.joints[j];
        const double y = top + row * (static_cast<double>(j) + 0.5);
        const double end = left + x(1e-3 * r.clamp), released = left + x(1e-3 * r.clamp_at_release);
        const double target = left + x(1e-3 * target_clamp(session.assembly, j));
        svg.text({left - 8.0, y + 4.0}, "no end", r.id);
        svg.line({target, y - 6.0}, {target, y + 6.0}, "tgt");
        if (r.overall == Verdict::none) continue;
        svg.line({released, y}, {end, y}, "cln");
        svg.circle({released, y}, 3.2, "mclamp");
        svg.circle({end, y}, 4.0, fmt::format("bar {}", verdict_style(r.overall)));
        svg.text({width - 4.0, y + 4.0}, "no end", number(1e-3 * r.clamp, 1) + " kN");
    }
    svg.line({left, foot}, {width - right, foot}, "ax");
    svg.text({left + 0.5 * (width - left - right), foot + 32.0}, "lb mid", "clamp force, kN");
    return svg.finish();
}

}  // namespace bolt::report
