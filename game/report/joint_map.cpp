#include "game/report/joint_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"

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

struct Arrow {
    plot::Point from, to;  // centres of two discs
    [[nodiscard]] double length() const { return std::hypot(to.x - from.x, to.y - from.y); }
    [[nodiscard]] plot::Point at(double share) const {
        return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
    }
};

// Where along an arrow its head is clear of every disc and of the heads so far, else where it is clearest:
// not in the middle if that can be, where the lines of a cross pattern meet.
plot::Point head_place(const Arrow& arrow, const PlanLayout& layout, const std::vector<plot::Point>& heads) {
    constexpr double reach = 6.0;  // of a head about its middle
    plot::Point best;
    double most = -std::numeric_limits<double>::infinity();
    for (const double share : {0.64, 0.68, 0.72, 0.6, 0.76, 0.56, 0.8, 0.5, 0.84, 0.4, 0.35, 0.3, 0.25}) {
        const plot::Point p = arrow.at(share);
        const auto far = [&](plot::Point other) { return std::hypot(p.x - other.x, p.y - other.y); };
        double clear = 0.0;  // what is missing is negative
        for (const plot::Point& disc : layout.at) clear = std::min(clear, far(disc) - layout.radius - reach);
        for (const plot::Point& head : heads) clear = std::min(clear, far(head) - 2.0 * reach);
        if (clear > most + 1e-9) {
            most = clear;
            best = p;
        }
    }
    return best;
}

void draw_arrow(plot::Svg& svg, const Arrow& arrow, double radius, std::string_view style) {
    const double length = arrow.length();
    if (length < 2.0 * radius + 1.0) return;
    svg.line(arrow.at(radius / length), arrow.at(1.0 - radius / length), style);
}

void draw_head(plot::Svg& svg, const Arrow& arrow, plot::Point at) {
    const double length = arrow.length();
    if (!(length > 1e-9)) return;
    const double ux = (arrow.to.x - arrow.from.x) / length, uy = (arrow.to.y - arrow.from.y) / length;
    const plot::Point tip{at.x + 4.0 * ux, at.y + 4.0 * uy};
    const plot::Point corners[] = {tip,
                                   {tip.x - 8.0 * ux - 3.2 * uy, tip.y - 8.0 * uy + 3.2 * ux},
                                   {tip.x - 8.0 * ux + 3.2 * uy, tip.y - 8.0 * uy - 3.2 * ux}};
    svg.path(corners, "ah", true);
}

std::vector<Arrow> arrows(const std::vector<std::size_t>& joints, const PlanLayout& layout) {
    std::vector<Arrow> found;
    for (std::size_t i = 1; i < joints.size(); ++i)
        if (joints[i] != joints[i - 1]) found.push_back({layout.at[joints[i - 1]], layout.at[joints[i]]});
    return found;
}

std::vector<std::size_t> joints_followed(const analysis::PassOrder& order) {
    std::vector<std::size_t> joints;
    for (const analysis::Turn& turn : order.followed) joints.push_back(turn.joint);
    return joints;
}

constexpr double small_print = 12.0;  // letters on a narrow screen
constexpr double large_print = 13.0;

// About a thing of that half width and half height: on the preferred side, on the other, beside it.
std::vector<plot::Spot> spots_about(plot::Point at, double half_width, double half_height, bool under_first) {
    const plot::Spot above{{at.x, at.y - half_height - 4.0}, plot::Anchor::middle};
    const plot::Spot below{{at.x, at.y + half_height + 12.0}, plot::Anchor::middle};
    const plot::Spot right{{at.x + half_width + 4.0, at.y + 4.0}};
    const plot::Spot left{{at.x - half_width - 4.0, at.y + 4.0}, plot::Anchor::end};
    const plot::Spot far_above{{at.x, above.at.y - 13.0}, plot::Anchor::middle};
    const plot::Spot far_below{{at.x, below.at.y + 13.0}, plot::Anchor::middle};
    const auto from = [&](const plot::Spot& spot, plot::Anchor anchor) {
        const double side = anchor == plot::Anchor::start ? -half_width : half_width;
        return plot::Spot{{at.x + side, spot.at.y}, anchor};
    };
    std::vector<plot::Spot> spots = {above, far_above, below, far_below};
    if (under_first) std::swap_ranges(spots.begin(), spots.begin() + 2, spots.begin() + 2);
    for (const plot::Anchor anchor : {plot::Anchor::start, plot::Anchor::end})
        for (const plot::Spot& spot : {spots[0], spots[2]}) spots.push_back(from(spot, anchor));
    spots.push_back(right);
    spots.push_back(left);
    return spots;
}

void put_words(plot::Svg& svg, plot::Placer& placer, const std::vector<plot::Spot>& spots,
               std::string_view style, std::string_view words, double size) {
    const plot::Spot spot = placer.choose(spots, words, size);
    svg.text(spot.at, fmt::format("{}{}", style, plot::anchor_style(spot.anchor)), words);
}

bool is_out_of_turn(const analysis::PassOrder& order, std::size_t joint) {
    return std::any_of(order.followed.begin(), order.followed.end(),
                       [&](const analysis::Turn& t) { return t.joint == joint && t.out_of_turn; });
}

// What is wrong with a joint's turn; empty if nothing is.
std::string fault_text(const analysis::PassOrder& order, std::size_t joint) {
    const std::size_t asked = order.place_asked(joint), visits = order.visits(joint);
    const bool out_of_turn = is_out_of_turn(order, joint);
    std::string text;
    if (asked > 0 && (out_of_turn || order.place_followed(joint) == 0)) text = fmt::format("asked {}", asked);
    if (visits > 1) text += fmt::format("{}{}×", text.empty() ? "" : ", ", visits);
    if (out_of_turn) return text.empty() ? "▲" : "▲ " + text;
    return text;
}

void draw_order_joint(plot::Svg& svg, const analysis::PassOrder& order, const PlanLayout& layout,
                      std::size_t joint) {
    const plot::Point at = layout.at[joint];
    const std::size_t followed = order.place_followed(joint);
    svg.circle(at, layout.radius, followed == 0 ? "dn" : is_out_of_turn(order, joint) ? "dw" : "dd");
    svg.text({at.x, at.y + 4.0}, "no mid", followed == 0 ? "–" : fmt::format("{}", followed));
}

// Names and faults, clear of the discs: on the outer side if there is room, away from the lines.
void draw_order_words(plot::Svg& svg, const analysis::SessionData& session, const analysis::PassOrder& order,
                      const PlanLayout& layout) {
    plot::Placer placer({0.0, 0.0, layout.width, layout.height});
    const double r = layout.radius;
    for (const plot::Point& at : layout.at) placer.take({at.x - r, at.y - r, 2.0 * r, 2.0 * r});
    const auto spots = [&](std::size_t joint) {
        return spots_about(layout.at[joint], r, r, layout.at[joint].y > 0.5 * layout.height);
    };
    for (std::size_t j = 0; j < layout.at.size(); ++j)
        put_words(svg, placer, spots(j), "sm", session.joints[j].id, small_print);
    for (std::size_t j = 0; j < layout.at.size(); ++j)
        if (const std::string fault = fault_text(order, j); !fault.empty())
            put_words(svg, placer, spots(j), "wn", fault, small_print);
}

// Height of a bar such that those above and below, with their words, do not touch.
double bar_room(const PlanLayout& layout) {
    constexpr double words_wide = 46.0, words_high = 40.0;
    double room = 56.0;
    for (std::size_t i = 0; i < layout.at.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (std::abs(layout.at[i].x - layout.at[k].x) < words_wide)
                room = std::min(room, std::abs(layout.at[i].y - layout.at[k].y) - words_high);
    return std::max(room, 12.0);
}

constexpr double rows_left = 56.0, rows_right = 72.0, rows_width = 480.0;

// Of all forces that the rows show.
plot::Ticks clamp_ticks(const analysis::SessionData& session) {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
    for (std::size_t j = 0; j < session.joints.size(); ++j)
        for (const double force : {session.joints[j].clamp, session.joints[j].clamp_at_release,
                                   analysis::target_clamp(session.assembly, j)}) {
            const bool shown = session.joints[j].overall != Verdict::none && std::isfinite(force);
            lowest = shown ? std::min(lowest, force) : lowest;
            highest = shown ? std::max(highest, force) : highest;
        }
    // Dots, not bars: where all lie close together the axis need not start at zero.
    const double from_zero = lowest > 0.5 * highest ? 0.98 * lowest : 0.0;
    return plot::covering_ticks(1e-3 * from_zero, 1.02e-3 * highest, 6);
}

// The force when released and the force in the end can be told from each other.
bool is_apart(const plot::Scale& kN, const lesson::JointResult& r) {
    return r.overall != Verdict::none && std::abs(kN(1e-3 * r.clamp) - kN(1e-3 * r.clamp_at_release)) > 2.5;
}

}  // namespace

PlanLayout plan_layout(const content::Assembly& assembly, double width, double margin) {
    const Paper paper = paper_of(assembly);
    PlanLayout layout;
    layout.width = width;
    plot::Range x{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}, y = x;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const plot::Point p{glm::dot(joint.design.seat, paper.right),
                            glm::dot(joint.design.seat, paper.down)};
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
    for (plot::Point& p : layout.at) p = {left + (p.x - x.low) * scale, margin + (p.y - y.low) * scale};
    for (std::size_t i = 0; i < layout.at.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double apart = std::hypot(layout.at[i].x - layout.at[k].x, layout.at[i].y - layout.at[k].y);
            layout.radius = std::clamp(0.42 * apart, 4.0, layout.radius);
        }
    return layout;
}

std::string order_plan(const analysis::SessionData& session, const analysis::PassOrder& order) {
    const PlanLayout layout = plan_layout(session.assembly, 340.0, 40.0);
    plot::Svg svg(layout.width, layout.height, fmt::format("Order of the joints, {}", order.label));
    if (!order.as_asked())
        for (const Arrow& arrow : arrows(order.asked, layout)) draw_arrow(svg, arrow, layout.radius, "oa");
    const std::vector<Arrow> followed = arrows(joints_followed(order), layout);
    for (const Arrow& arrow : followed) draw_arrow(svg, arrow, layout.radius, "of");
    for (std::size_t j = 0; j < layout.at.size(); ++j) draw_order_joint(svg, order, layout, j);
    std::vector<plot::Point> heads;
    for (const Arrow& arrow : followed) {
        heads.push_back(head_place(arrow, layout, heads));
        draw_head(svg, arrow, heads.back());
    }
    draw_order_words(svg, session, order, layout);
    return svg.finish();
}

std::string clamp_plan(const analysis::SessionData& session) {
    constexpr double bar_width = 12.0, full = 1.25;  // of the target: top of the bar's frame
    const PlanLayout layout = plan_layout(session.assembly, 480.0, 52.0);
    const double bar_height = bar_room(layout);
    plot::Svg svg(layout.width, layout.height, "Clamp force of each joint against its target");
    plot::Placer placer({0.0, 0.0, layout.width, layout.height});
    for (std::size_t j = 0; j < layout.at.size(); ++j) {
        const lesson::JointResult& r = session.joints[j];
        const double share = r.clamp / analysis::target_clamp(session.assembly, j);
        const double height = bar_height * std::clamp(std::isfinite(share) ? share / full : 0.0, 0.0, 1.0);
        const plot::Point at = layout.at[j];
        const double bottom = at.y + 0.5 * bar_height, mark = bottom - bar_height / full;
        const plot::Box frame{at.x - 0.5 * bar_width, bottom - bar_height, bar_width, bar_height};
        svg.rect(frame, "bf");
        svg.rect({frame.x, bottom - height, bar_width, height},
                 fmt::format("bar {}", verdict_style(r.overall)));
        svg.line({at.x - 0.5 * bar_width - 3.0, mark}, {at.x + 0.5 * bar_width + 3.0, mark}, "tgt");
        placer.take(frame);
    }
    for (std::size_t j = 0; j < layout.at.size(); ++j)
        put_words(svg, placer, spots_about(layout.at[j], 0.5 * bar_width, 0.5 * bar_height, false), "sm",
                  session.joints[j].id, small_print);
    for (std::size_t j = 0; j < layout.at.size(); ++j)
        put_words(svg, placer, spots_about(layout.at[j], 0.5 * bar_width, 0.5 * bar_height, true), "no",
                  plot::number(session.joints[j].clamp * 1e-3, 1), large_print);
    return svg.finish();
}

std::string clamp_rows(const analysis::SessionData& session) {
    constexpr double row = 20.0, top = 14.0, left = rows_left, right = rows_right, width = rows_width,
                     bottom = 40.0;
    const analysis::Summary summary = analysis::summarise(session);
    const plot::Ticks ticks = clamp_ticks(session);
    const plot::Scale x{ticks.range, width - left - right, false};
    const double foot = top + row * static_cast<double>(session.joints.size());
    plot::Svg svg(width, foot + bottom, "Clamp force of each joint when released and in the end");
    if (std::isfinite(summary.clamp_deviation)) {
        const double from = x(1e-3 * (summary.clamp_mean - summary.clamp_deviation));
        const double to = x(1e-3 * (summary.clamp_mean + summary.clamp_deviation));
        svg.rect({left + std::max(0.0, from), top, to - std::max(0.0, from), foot - top}, "s1");
        svg.line({left + x(1e-3 * summary.clamp_mean), top}, {left + x(1e-3 * summary.clamp_mean), foot},
                 "mean");
    }
    for (const double at : ticks.at) {
        svg.line({left + x(at), top}, {left + x(at), foot}, "gr");
        svg.text({left + x(at), foot + 16.0}, "tk mid", plot::number(at, ticks.decimals));
    }
    for (std::size_t j = 0; j < session.joints.size(); ++j) {
        const lesson::JointResult& r = session.joints[j];
        const double y = top + row * (static_cast<double>(j) + 0.5);
        const double end = left + x(1e-3 * r.clamp), released = left + x(1e-3 * r.clamp_at_release);
        const double target = left + x(1e-3 * analysis::target_clamp(session.assembly, j));
        svg.text({left - 8.0, y + 4.0}, "no end", r.id);
        svg.line({target, y - 6.0}, {target, y + 6.0}, "tgt");
        if (r.overall == Verdict::none) continue;
        if (is_apart(x, r)) {
            svg.line({released, y}, {end, y}, "cln");
            svg.circle({released, y}, 3.2, "mclamp");
        }
        svg.circle({end, y}, 4.0, fmt::format("bar {}", verdict_style(r.overall)));
        svg.text({width - 4.0, y + 4.0}, "no end", plot::number(1e-3 * r.clamp, 1) + " kN");
    }
    svg.line({left, foot}, {width - right, foot}, "ax");
    svg.text({left + 0.5 * (width - left - right), foot + 32.0}, "lb mid", "clamp force, kN");
    return svg.finish();
}

bool released_apart(const analysis::SessionData& session) {
    const plot::Scale x{clamp_ticks(session).range, rows_width - rows_left - rows_right, false};
    return std::any_of(session.joints.begin(), session.joints.end(),
                       [&](const lesson::JointResult& r) { return is_apart(x, r); });
}

}  // namespace bolt::report
