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

// The directions to the right and downwards in a map, in which the bolts point at the reader.
struct MapAxes {
    Vec3 right{1.0, 0.0, 0.0};
    Vec3 down{0.0, 0.0, 1.0};
};

MapAxes map_axes(const content::Assembly& assembly) {
    Vec3 axis{0.0};
    for (const content::AssemblyJoint& joint : assembly.joints) axis += joint.design.axis;
    const double length = glm::length(axis);
    if (!(length > 1e-9)) return {};
    axis /= length;
    const Vec3 across = std::abs(axis.x) < 0.9 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 0.0, -1.0};
    const Vec3 right = glm::normalize(across - axis * glm::dot(across, axis));
    return {right, glm::cross(right, axis)};
}

// Connects two joints that were visited one after the other.
struct OrderArrow {
    plot::SvgPoint from, to;  // centres of two discs
    [[nodiscard]] double length() const { return std::hypot(to.x - from.x, to.y - from.y); }
    [[nodiscard]] plot::SvgPoint at(double share) const {
        return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
    }
};

// Returns a position on the arrow at which its head is clear of all discs and of the heads drawn so far, or
// else the position with the least overlap. Avoids the middle if possible, where the lines of a cross pattern
// meet.
plot::SvgPoint head_position(const OrderArrow& arrow, const JointMapLayout& layout,
                             const std::vector<plot::SvgPoint>& heads) {
    constexpr double head_radius = 6.0;
    plot::SvgPoint best;
    double greatest = -std::numeric_limits<double>::infinity();
    for (const double share : {0.64, 0.68, 0.72, 0.6, 0.76, 0.56, 0.8, 0.5, 0.84, 0.4, 0.35, 0.3, 0.25}) {
        const plot::SvgPoint p = arrow.at(share);
        const auto distance = [&](plot::SvgPoint other) { return std::hypot(p.x - other.x, p.y - other.y); };
        double clearance = 0.0;  // 0: clear; negative: depth of the overlap
        for (const plot::SvgPoint& disc : layout.positions)
            clearance = std::min(clearance, distance(disc) - layout.radius - head_radius);
        for (const plot::SvgPoint& head : heads)
            clearance = std::min(clearance, distance(head) - 2.0 * head_radius);
        if (clearance > greatest + 1e-9) {
            greatest = clearance;
            best = p;
        }
    }
    return best;
}

void draw_arrow_line(plot::Svg& svg, const OrderArrow& arrow, double radius, std::string_view style) {
    const double length = arrow.length();
    if (length < 2.0 * radius + 1.0) return;
    svg.line(arrow.at(radius / length), arrow.at(1.0 - radius / length), style);
}

void draw_arrow_head(plot::Svg& svg, const OrderArrow& arrow, plot::SvgPoint at) {
    const double length = arrow.length();
    if (!(length > 1e-9)) return;
    const double ux = (arrow.to.x - arrow.from.x) / length, uy = (arrow.to.y - arrow.from.y) / length;
    const plot::SvgPoint tip{at.x + 4.0 * ux, at.y + 4.0 * uy};
    const plot::SvgPoint corners[] = {tip,
                                      {tip.x - 8.0 * ux - 3.2 * uy, tip.y - 8.0 * uy + 3.2 * ux},
                                      {tip.x - 8.0 * ux + 3.2 * uy, tip.y - 8.0 * uy - 3.2 * ux}};
    svg.path(corners, "ah", true);
}

std::vector<OrderArrow> order_arrows(const std::vector<std::size_t>& joints, const JointMapLayout& layout) {
    std::vector<OrderArrow> arrows;
    for (std::size_t i = 1; i < joints.size(); ++i)
        if (joints[i] != joints[i - 1])
            arrows.push_back({layout.positions[joints[i - 1]], layout.positions[joints[i]]});
    return arrows;
}

std::vector<std::size_t> actual_joints(const analysis::PassOrder& order) {
    std::vector<std::size_t> joints;
    for (const analysis::OrderEntry& turn : order.actual) joints.push_back(turn.joint);
    return joints;
}

// Positions for the label of an element with the given half width and half height: on the preferred side
// (above or below), on the opposite side, then to the right and left.
std::vector<plot::LabelPosition> label_positions_about(plot::SvgPoint at, double half_width,
                                                       double half_height, bool below_first) {
    const plot::LabelPosition above{{at.x, at.y - half_height - 4.0}, plot::TextAnchor::middle};
    const plot::LabelPosition below{{at.x, at.y + half_height + 12.0}, plot::TextAnchor::middle};
    const plot::LabelPosition right{{at.x + half_width + 4.0, at.y + 4.0}};
    const plot::LabelPosition left{{at.x - half_width - 4.0, at.y + 4.0}, plot::TextAnchor::end};
    const plot::LabelPosition far_above{{at.x, above.baseline.y - 13.0}, plot::TextAnchor::middle};
    const plot::LabelPosition far_below{{at.x, below.baseline.y + 13.0}, plot::TextAnchor::middle};
    const auto from = [&](const plot::LabelPosition& position, plot::TextAnchor anchor) {
        const double side = anchor == plot::TextAnchor::start ? -half_width : half_width;
        return plot::LabelPosition{{at.x + side, position.baseline.y}, anchor};
    };
    std::vector<plot::LabelPosition> positions = {above, far_above, below, far_below};
    if (below_first) std::swap_ranges(positions.begin(), positions.begin() + 2, positions.begin() + 2);
    for (const plot::TextAnchor anchor : {plot::TextAnchor::start, plot::TextAnchor::end})
        for (const plot::LabelPosition& position : {positions[0], positions[2]})
            positions.push_back(from(position, anchor));
    positions.push_back(right);
    positions.push_back(left);
    return positions;
}

void put_label(plot::Svg& svg, plot::LabelLayout& labels, const std::vector<plot::LabelPosition>& positions,
               std::string_view style, std::string_view text, double size) {
    const plot::LabelPosition position = labels.place(positions, text, size);
    svg.text(position.baseline, fmt::format("{}{}", style, plot::anchor_class(position.anchor)), text);
}

bool is_out_of_turn(const analysis::PassOrder& order, std::size_t joint) {
    return std::any_of(order.actual.begin(), order.actual.end(),
                       [&](const analysis::OrderEntry& t) { return t.joint == joint && t.out_of_turn; });
}

// Describes the deviation of a joint from the planned order; empty without any.
std::string order_deviation_text(const analysis::PassOrder& order, std::size_t joint) {
    const std::size_t planned = order.planned_position(joint), visits = order.visits(joint);
    const bool out_of_turn = is_out_of_turn(order, joint);
    std::string text;
    if (planned > 0 && (out_of_turn || order.actual_position(joint) == 0))
        text = fmt::format("planned {}", planned);
    if (visits > 1) text += fmt::format("{}{}×", text.empty() ? "" : ", ", visits);
    if (out_of_turn) return text.empty() ? "▲" : "▲ " + text;
    return text;
}

void draw_order_joint(plot::Svg& svg, const analysis::PassOrder& order, const JointMapLayout& layout,
                      std::size_t joint) {
    const plot::SvgPoint at = layout.positions[joint];
    const std::size_t actual = order.actual_position(joint);
    svg.circle(at, layout.radius, actual == 0 ? "dn" : is_out_of_turn(order, joint) ? "dw" : "dd");
    svg.text({at.x, at.y + 4.0}, "no mid", actual == 0 ? "–" : fmt::format("{}", actual));
}

// Draws names and deviations clear of the discs, if possible on the outer side, away from the lines.
void draw_order_labels(plot::Svg& svg, const analysis::SessionData& session, const analysis::PassOrder& order,
                       const JointMapLayout& layout) {
    plot::LabelLayout labels({0.0, 0.0, layout.width, layout.height});
    const double r = layout.radius;
    for (const plot::SvgPoint& at : layout.positions) labels.occupy({at.x - r, at.y - r, 2.0 * r, 2.0 * r});
    const auto positions = [&](std::size_t joint) {
        return label_positions_about(layout.positions[joint], r, r,
                                     layout.positions[joint].y > 0.5 * layout.height);
    };
    for (std::size_t j = 0; j < layout.positions.size(); ++j)
        put_label(svg, labels, positions(j), "sm", session.joints[j].id, plot::small_print);
    for (std::size_t j = 0; j < layout.positions.size(); ++j)
        if (const std::string fault = order_deviation_text(order, j); !fault.empty())
            put_label(svg, labels, positions(j), "wn", fault, plot::small_print);
}

// Returns a bar height at which a bar and its label do not touch the bars above and below.
double bar_height_for(const JointMapLayout& layout) {
    constexpr double label_width = 46.0, label_height = 40.0;
    double room = 56.0;
    for (std::size_t i = 0; i < layout.positions.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (std::abs(layout.positions[i].x - layout.positions[k].x) < label_width)
                room = std::min(room, std::abs(layout.positions[i].y - layout.positions[k].y) - label_height);
    return std::max(room, 12.0);
}

constexpr double rows_left = 56.0, rows_right = 72.0, rows_width = 480.0;

// Ticks for all forces that the rows show.
plot::AxisTicks clamp_ticks(const analysis::SessionData& session) {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
    for (std::size_t j = 0; j < session.joints.size(); ++j)
        for (const double force : {session.joints[j].clamp, session.joints[j].clamp_at_release,
                                   analysis::target_clamp(session.assembly, j)}) {
            const bool shown = session.joints[j].overall != Verdict::none && std::isfinite(force);
            lowest = shown ? std::min(lowest, force) : lowest;
            highest = shown ? std::max(highest, force) : highest;
        }
    // The rows have dots, not bars, so the axis need not start at zero if all forces are close together.
    const double from_zero = lowest > 0.5 * highest ? 0.98 * lowest : 0.0;
    return plot::covering_ticks(1e-3 * from_zero, 1.02e-3 * highest, 6);
}

// Returns true if the forces at the release and at the end are distinguishable in the drawing.
bool differs_at_release(const plot::AxisScale& kN, const lesson::JointResult& r) {
    return r.overall != Verdict::none && std::abs(kN(1e-3 * r.clamp) - kN(1e-3 * r.clamp_at_release)) > 2.5;
}

}  // namespace

JointMapLayout joint_map_layout(const content::Assembly& assembly, double width, double margin) {
    const MapAxes axes = map_axes(assembly);
    JointMapLayout layout;
    layout.width = width;
    plot::AxisRange x{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()},
        y = x;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const plot::SvgPoint p{glm::dot(joint.design.seat, axes.right),
                               glm::dot(joint.design.seat, axes.down)};
        layout.positions.push_back(p);
        x = {std::min(x.low, p.x), std::max(x.high, p.x)};
        y = {std::min(y.low, p.y), std::max(y.high, p.y)};
    }
    if (layout.positions.empty()) return layout;
    // Fills the width, but the height is at most half the width.
    const double room = width - 2.0 * margin;
    const double scale = room / std::max({x.span(), 2.0 * y.span(), 1e-6});
    layout.height = y.span() * scale + 2.0 * margin;
    const double left = 0.5 * (width - x.span() * scale);
    for (plot::SvgPoint& p : layout.positions)
        p = {left + (p.x - x.low) * scale, margin + (p.y - y.low) * scale};
    for (std::size_t i = 0; i < layout.positions.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double apart = std::hypot(layout.positions[i].x - layout.positions[k].x,
                                            layout.positions[i].y - layout.positions[k].y);
            layout.radius = std::clamp(0.42 * apart, 4.0, layout.radius);
        }
    return layout;
}

std::string order_map(const analysis::SessionData& session, const analysis::PassOrder& order) {
    const JointMapLayout layout = joint_map_layout(session.assembly, 340.0, 40.0);
    plot::Svg svg(layout.width, layout.height, fmt::format("Order of the joints, {}", order.label));
    if (!order.as_planned())
        for (const OrderArrow& arrow : order_arrows(order.planned, layout))
            draw_arrow_line(svg, arrow, layout.radius, "oa");
    const std::vector<OrderArrow> actual = order_arrows(actual_joints(order), layout);
    for (const OrderArrow& arrow : actual) draw_arrow_line(svg, arrow, layout.radius, "of");
    for (std::size_t j = 0; j < layout.positions.size(); ++j) draw_order_joint(svg, order, layout, j);
    std::vector<plot::SvgPoint> heads;
    for (const OrderArrow& arrow : actual) {
        heads.push_back(head_position(arrow, layout, heads));
        draw_arrow_head(svg, arrow, heads.back());
    }
    draw_order_labels(svg, session, order, layout);
    return svg.finish();
}

std::string clamp_map(const analysis::SessionData& session) {
    constexpr double bar_width = 12.0, full = 1.25;  // `full`: the top of the frame, relative to the target
    const JointMapLayout layout = joint_map_layout(session.assembly, 480.0, 52.0);
    const double bar_height = bar_height_for(layout);
    plot::Svg svg(layout.width, layout.height, "Clamp force of each joint against its target");
    plot::LabelLayout labels({0.0, 0.0, layout.width, layout.height});
    for (std::size_t j = 0; j < layout.positions.size(); ++j) {
        const lesson::JointResult& r = session.joints[j];
        const double share = r.clamp / analysis::target_clamp(session.assembly, j);
        const double height = bar_height * std::clamp(std::isfinite(share) ? share / full : 0.0, 0.0, 1.0);
        const plot::SvgPoint at = layout.positions[j];
        const double bottom = at.y + 0.5 * bar_height, mark = bottom - bar_height / full;
        const plot::SvgBox frame{at.x - 0.5 * bar_width, bottom - bar_height, bar_width, bar_height};
        svg.rect(frame, "bf");
        svg.rect({frame.x, bottom - height, bar_width, height},
                 fmt::format("bar {}", verdict_style(r.overall)));
        svg.line({at.x - 0.5 * bar_width - 3.0, mark}, {at.x + 0.5 * bar_width + 3.0, mark}, "tgt");
        labels.occupy(frame);
    }
    for (std::size_t j = 0; j < layout.positions.size(); ++j)
        put_label(svg, labels,
                  label_positions_about(layout.positions[j], 0.5 * bar_width, 0.5 * bar_height, false), "sm",
                  session.joints[j].id, plot::small_print);
    for (std::size_t j = 0; j < layout.positions.size(); ++j)
        put_label(svg, labels,
                  label_positions_about(layout.positions[j], 0.5 * bar_width, 0.5 * bar_height, true), "no",
                  plot::number(session.joints[j].clamp * 1e-3, 1), plot::large_print);
    return svg.finish();
}

std::string clamp_rows(const analysis::SessionData& session) {
    constexpr double row = 20.0, top = 14.0, left = rows_left, right = rows_right, width = rows_width,
                     bottom = 40.0;
    const analysis::Summary summary = analysis::summarise(session);
    const plot::AxisTicks ticks = clamp_ticks(session);
    const plot::AxisScale x{ticks.range, width - left - right, false};
    const double foot = top + row * static_cast<double>(session.joints.size());
    plot::Svg svg(width, foot + bottom, "Clamp force of each joint when released and at the end");
    if (std::isfinite(summary.clamp_deviation)) {
        const double from = x(1e-3 * (summary.clamp_mean - summary.clamp_deviation));
        const double to = x(1e-3 * (summary.clamp_mean + summary.clamp_deviation));
        svg.rect({left + std::max(0.0, from), top, to - std::max(0.0, from), foot - top}, "s1");
        svg.line({left + x(1e-3 * summary.clamp_mean), top}, {left + x(1e-3 * summary.clamp_mean), foot},
                 "mean");
    }
    for (const double at : ticks.values) {
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
        if (differs_at_release(x, r)) {
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

bool has_release_differences(const analysis::SessionData& session) {
    const plot::AxisScale x{clamp_ticks(session).range, rows_width - rows_left - rows_right, false};
    return std::any_of(session.joints.begin(), session.joints.end(),
                       [&](const lesson::JointResult& r) { return differs_at_release(x, r); });
}

}  // namespace bolt::report
