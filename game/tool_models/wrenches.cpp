// Open-end, ring and combination wrenches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/tool_models/glyphs.hpp"
#include "game/tool_models/parts.hpp"

namespace bolt::tool_models {

namespace {

// Shares of the size or of the opening. The rounded edges of the jaw lie inside the chamfers of the closed
// form (haptics/collision/jaw.hpp), whose planes are tangent to them.
constexpr double thickness_share = 0.5, depth_share = 0.6, tip_share = 0.7;
constexpr double tip_radius = 0.22, lead_in_radius = 0.06, throat_radius = 0.29, jaw_edge = 0.0425;
constexpr double wall_share = 0.34;  // least metal around the slot

struct HandleSize {
    double half = 0.0, high = 0.0;  // half of the width at the narrowest point, half of the thickness
};

HandleSize handle_size(double size) { return {0.36 * size + 1.25, 0.135 * size + 1.1}; }

// Waisted, and a little wider towards the end.
double waisted(double half, double share) {
    return half * (1.22 - 0.9 * share * (1.0 - share) + 0.06 * share);
}

double smooth_step(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Vec3 rotated(const Vec3& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

}  // namespace

double OpenEndHead::slot_end() const {
    double end = 0.0;
    for (const double x : {-tip, depth})
        for (const double y : {-0.5 * opening, 0.5 * opening})
            end = std::max(end, x * std::cos(angle) - y * std::sin(angle));
    return end;
}

OpenEndHead open_end_head(const ToolParameters& p) {
    OpenEndHead head;
    const auto or_share = [&](double given, double share) {
        return given > 0.0 ? given / mm : share * p.opening / mm;
    };
    head.size = p.size / mm;
    head.opening = p.opening / mm;
    head.angle = p.head_angle.value_or(0.0);
    head.thickness = or_share(p.head_thickness, thickness_share);
    head.depth = or_share(p.jaw_depth, depth_share);
    head.tip = or_share(p.jaw_tip, tip_share);
    head.middle = 0.05 * head.size;
    const double half = 0.5 * head.opening, s = head.size;
    head.radius = std::max({1.06 * s + 1.5, head.depth + wall_share * s - head.middle,
                            std::hypot(head.tip + head.middle, half + 0.36 * s)});
    return head;
}

Shell open_end_shell(const OpenEndHead& h, double edge, Detail detail) {
    const double s = h.size, half = 0.5 * h.opening, R = h.radius, r = tip_radius * s;
    const double jaw = std::min(jaw_edge * h.opening, 0.25 * h.thickness);
    const double outer = std::min(edge, 0.3 * h.thickness);
    const bool fine = detail == Detail::drawn;
    // The rounding of a tip touches the disc from within and the end of the jaws.
    const double x = -h.tip + r, y = std::sqrt(square(R - r) - square(x - h.middle));
    const double meets = std::atan2(y, x - h.middle);
    const double lead = lead_in_radius * s, throat = std::min(throat_radius * s, 0.55 * half);
    const int round = fine ? 6 : 3;
    std::vector<OutlinePoint> outline;
    add_arc(outline, {x, -y}, r, pi, 2.0 * pi - meets, round, outer);
    const int disc = fine ? 56 : 28;
    for (int i = 1; i < disc; ++i) {
        const double angle = -meets + 2.0 * meets * i / disc;
        outline.push_back({Vec2(h.middle + R * std::cos(angle), R * std::sin(angle)), outer});
    }
    add_arc(outline, {x, y}, r, meets, pi, round, outer);
    add_arc(outline, {-h.tip + lead, half + lead}, lead, pi, 1.5 * pi, fine ? 5 : 3, jaw);
    for (int i = 1; i < 4; ++i)  // short edges along the flats
        outline.push_back({{-h.tip + lead + (h.depth - throat + h.tip - lead) * i / 4.0, half}, jaw});
    add_arc(outline, {h.depth - throat, half - throat}, throat, 0.5 * pi, 0.0, fine ? 8 : 4, jaw);
    add_arc(outline, {h.depth - throat, -half + throat}, throat, 0.0, -0.5 * pi, fine ? 8 : 4, jaw);
    for (int i = 3; i > 0; --i)
        outline.push_back({{-h.tip + lead + (h.depth - throat + h.tip - lead) * i / 4.0, -half}, jaw});
    add_arc(outline, {-h.tip + lead, -half - lead}, lead, 0.5 * pi, pi, fine ? 5 : 3, jaw);
    const Shell flat = plate(outline, -0.5 * h.thickness, 0.5 * h.thickness, fine ? 4 : 2);
    return moved(flat, [&](const Vec3& p) { return rotated(p, h.angle); });
}

Shell handle_shell(const std::vector<HandleSection>& sections, Detail detail) {
    const int steps = detail == Detail::drawn ? 4 : 2;
    std::vector<Loop> loops;
    for (const HandleSection& s : sections) {
        // A quarter of the section: out to the side, up, and back from the outline along the handle.
        struct SectionPoint {
            double side, up, back;
        };
        std::vector<SectionPoint> quarter;
        const double e = s.edge, c = std::cos(s.end_angle), b = std::sin(s.end_angle);
        for (int i = 0; i <= steps; ++i) {
            const double angle = 0.5 * pi * i / steps, in = e * (1.0 - std::cos(angle));
            quarter.push_back({s.half_width - in * c, s.half_height - e * (1.0 - std::sin(angle)), in * b});
        }
        const double flat = quarter.back().side;
        const double rim = std::min(s.hollow_half_width > 0.0 ? s.hollow_half_width : flat, 0.92 * flat);
        const double slope = std::min(1.5 * s.hollow_depth + 0.2 * rim, 0.5 * rim);
        constexpr struct {
            double out, down;
        } bowl[] = {{0.0, 0.0}, {0.2, 0.12}, {0.5, 0.5}, {0.8, 0.88}, {1.0, 1.0}};
        for (const auto& [out, down] : bowl)
            quarter.push_back({rim - out * slope, s.half_height - down * s.hollow_depth, e * b});
        Loop loop;
        const double along_x = std::cos(s.slope), along_z = std::sin(s.slope);
        const auto add = [&](const SectionPoint& q, double side, double up) {
            loop.emplace_back(s.x - along_x * q.back - along_z * up * q.up, side * q.side,
                              s.z - along_z * q.back + along_x * up * q.up);
        };
        for (const auto& q : quarter) add(q, 1.0, 1.0);
        for (auto q = quarter.rbegin(); q != quarter.rend(); ++q) add(*q, -1.0, 1.0);
        for (std::size_t i = 1; i < quarter.size(); ++i) add(quarter[i], -1.0, -1.0);
        for (std::size_t i = quarter.size() - 1; i > 0; --i) add(quarter[i], 1.0, -1.0);
        loops.push_back(std::move(loop));
    }
    return loft(loops);
}

void add_round_end(std::vector<HandleSection>& sections, const HandleSection& last, int steps) {
    constexpr double final_angle = 1.48;  // the end is closed by a narrow cap
    for (int i = 1; i <= steps; ++i) {
        HandleSection s = last;
        s.end_angle = final_angle * i / steps;
        s.half_width = last.half_width * std::cos(s.end_angle);
        s.x += std::cos(last.slope) * last.half_width * std::sin(s.end_angle);
        s.z += std::sin(last.slope) * last.half_width * std::sin(s.end_angle);
        s.hollow_half_width = s.hollow_depth = 0.0;
        sections.push_back(s);
    }
}

RingHead ring_head(const ToolParameters& p) {
    // Outside and thickness: the middle of 1.50 to 1.59 and of 0.70 to 0.75 times the size (A-A-1346A).
    return {p.opening / mm, 1.55 * p.size / mm, 0.72 * p.size / mm};
}

Shell ring_shell(const RingHead& ring, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double R = 0.5 * ring.outside, bore = 0.5 * ring.opening, h = 0.5 * ring.thickness;
    const double edge = 0.14 * ring.thickness, lead = 0.05 * ring.opening;
    const int steps = fine ? 5 : 2;
    std::vector<ProfilePoint> profile;
    // The contact of the points with the nut is closed form (haptics/collision/tool_head.hpp), so in the
    // contact model the hole is round and reaches to their corners.
    const double corner = bore / std::cos(pi / 6.0);
    if (!fine) profile.push_back({-h, corner});
    const auto chamfer = [lead](double angle, double radius) {
        return std::max(twelve_point_radius(angle, radius), radius / std::cos(pi / 6.0) + 0.3 * lead);
    };
    if (fine) {
        profile.push_back({-h + lead, bore, twelve_point_radius});
        profile.push_back({-h, bore, chamfer});
    }
    for (const double up : {-1.0, 1.0})
        for (int k = 0; k <= steps; ++k) {
            const double angle = 0.5 * pi * (up < 0.0 ? k : steps - k) / steps;
            profile.push_back(
                {up * (h - edge * (1.0 - std::cos(angle))), R - edge * (1.0 - std::sin(angle))});
        }
    if (!fine) {
        profile.push_back({h, corner});
        return closed_lathe_z(profile, 24);
    }
    profile.push_back({h, bore, chamfer});
    profile.push_back({h - lead, bore, twelve_point_radius});
    return closed_lathe_z(profile, 96);
}

namespace {

// The sections of a forged handle from a head of the radius R about the origin to x = `end`: a neck that is
// rounded into the head, then waisted sides with a hollow on both faces.
std::vector<HandleSection> forged_handle(const ToolParameters& p, double from, double R, double head_high,
                                         double end, Detail detail) {
    const double s = p.size / mm;
    const HandleSize size = handle_size(s);
    const bool fine = detail == Detail::drawn;
    const double neck_radius = 1.1 * s, half0 = waisted(size.half, R / end);
    const double neck_end = std::sqrt(square(R + neck_radius) - square(half0 + neck_radius));
    const double neck_start = neck_end * R / (R + neck_radius);
    const double thick_from = 0.84 * R, thick_to = std::min(thick_from + 1.3 * s, 0.6 * end);
    const double hollow_from = thick_to + 0.35 * s, hollow_to = end - 1.2 * size.half;
    const double deep = 0.34 * size.high;
    std::vector<double> xs;
    const int neck = fine ? 10 : 4, body = fine ? 26 : 8, run_in = fine ? 6 : 0;
    for (int i = 0; i <= neck; ++i) xs.push_back(from + (hollow_from - from) * i / neck);
    const double length = hollow_to - hollow_from, ramp = std::min(1.6 * size.half, 0.3 * length);
    for (int i = 1; i <= run_in; ++i) xs.push_back(hollow_from + ramp * i / run_in);
    const double body_from = xs.back(), body_to = fine ? hollow_to - ramp : end;
    for (int i = 1; i <= body; ++i) xs.push_back(body_from + (body_to - body_from) * i / body);
    for (int i = 1; i <= run_in; ++i) xs.push_back(hollow_to - ramp + ramp * i / run_in);
    if (fine) xs.push_back(end);
    std::vector<HandleSection> sections;
    for (const double x : xs) {
        HandleSection at;
        at.x = x;
        at.half_width = waisted(size.half, x / end);
        if (x < neck_end) {
            const double to_end = neck_end - std::max(x, neck_start);
            at.half_width += neck_radius - std::sqrt(square(neck_radius) - square(to_end));
            if (x < neck_start)
                at.half_width = std::min(at.half_width, 0.96 * std::sqrt(std::max(square(R) - x * x, 1.0)));
        }
        const double thin = smooth_step((x - thick_from) / (thick_to - thick_from));
        at.half_height = (1.0 - thin) * 0.95 * head_high + thin * size.high;
        at.edge = 0.42 * std::min(at.half_height, size.high);
        const double inside = std::min(x - hollow_from, hollow_to - x);
        if (fine && inside > 0.0 && length > 4.0 * size.half) {
            const double share = std::min(inside / ramp, 1.0);
            at.hollow_half_width =
                (at.half_width - 0.34 * size.half) * std::max(0.25, std::sqrt(1.0 - square(1.0 - share)));
            at.hollow_depth = deep * smooth_step(2.5 * share);
        }
        sections.push_back(at);
    }
    return sections;
}

// The size and the steel, raised in the hollows of a forged handle.
void add_forged_texts(ToolModelParts& parts, const ToolParameters& p, double from, double to, Detail detail) {
    const HandleSize size = handle_size(p.size / mm);
    const double floor = 0.66 * size.high, height = 0.85 * size.half;
    if (to - from < 8.0 * height) return;
    add_text(parts, size_text(p.size / mm), height, from + 0.17 * (to - from), floor, detail);
    add_text(parts, "CR-V", height, from + 0.8 * (to - from), floor, detail);
}

double neck_texts_from(const ToolParameters& p, double R) { return 0.84 * R + 1.65 * p.size / mm; }

}  // namespace

ToolModelParts open_end_parts(const ToolParameters& p, Detail detail) {
    const OpenEndHead head = open_end_head(p);
    const HandleSize size = handle_size(head.size);
    const double round_end = waisted(size.half, 1.0), end = p.length / mm - round_end;
    std::vector<HandleSection> sections =
        forged_handle(p, std::min(head.slot_end() + 0.06 * head.size, 0.8 * head.radius), head.radius,
                      0.5 * head.thickness, end, detail);
    const HandleSection last = sections.back();
    add_round_end(sections, last, detail == Detail::drawn ? 10 : 4);
    ToolModelParts parts{{"head", Finish::chrome_vanadium, {open_end_shell(head, 0.42 * size.high, detail)}},
                         {"handle", Finish::chrome_vanadium, {handle_shell(sections, detail)}}};
    add_forged_texts(parts, p, neck_texts_from(p, head.radius), end - size.half, detail);
    return parts;
}

namespace {

constexpr double ring_tilt = to_radians(15.0);

// A ring whose middle is at (`x`, 0, `z`), tilted so that its +X falls by `tilt` rad.
Shell placed_ring(const RingHead& ring, double x, double z, double tilt, Detail detail) {
    const double c = std::cos(tilt), s = std::sin(tilt);
    return moved(ring_shell(ring, detail),
                 [=](const Vec3& p) { return Vec3(x + c * p.x + s * p.z, p.y, z - s * p.x + c * p.z); });
}

}  // namespace

ToolModelParts ring_parts(const ToolParameters& p, Detail detail) {
    const RingHead ring = ring_head(p);
    const double s = p.size / mm, R = 0.5 * ring.outside;
    const HandleSize size = handle_size(s);
    const bool fine = detail == Detail::drawn;
    // The crank lifts the handle over neighbouring heads.
    const double bore = 0.5 * ring.opening / std::cos(pi / 6.0);
    const double from = bore + 0.35 * (R - bore), crank_from = R + 0.1 * s;
    const double lift = 0.55 * s + 4.0, crank = 1.6 * lift;
    const double half = 0.85 * size.half, end = p.length / mm - half;
    std::vector<double> xs{from, crank_from};
    const int bends = fine ? 18 : 6, body = fine ? 14 : 4;
    for (int i = 1; i <= bends; ++i) xs.push_back(crank_from + crank * i / bends);
    for (int i = 1; i <= body; ++i) xs.push_back(crank_from + crank + (end - crank_from - crank) * i / body);
    std::vector<HandleSection> sections;
    for (const double x : xs) {
        const double t = std::clamp((x - crank_from) / crank, 0.0, 1.0);
        HandleSection at;
        at.x = x;
        at.z = lift * smooth_step(t);
        at.slope = std::atan(lift / crank * 6.0 * t * (1.0 - t));
        at.half_width =
            half * (1.0 + 0.12 * smooth_step((x - crank_from - crank) / (end - crank_from - crank)) +
                    0.15 * (1.0 - smooth_step((x - from) / (crank_from + crank - from))));
        at.half_height = 0.3 * ring.thickness + (1.35 * size.high - 0.3 * ring.thickness) * smooth_step(t);
        at.edge = 0.6 * std::min(at.half_height, at.half_width);
        sections.push_back(at);
    }
    const HandleSection last = sections.back();
    add_round_end(sections, last, fine ? 10 : 4);
    ToolModelParts parts{{"ring", Finish::chrome_vanadium, {ring_shell(ring, detail)}},
                         {"handle", Finish::chrome_vanadium, {handle_shell(sections, detail)}}};
    const double first = crank_from + crank, height = 0.75 * half;
    if (end - first > 8.0 * height) {
        const double top = lift + 1.35 * size.high;
        add_text(parts, size_text(s), height, first + 0.15 * (end - first), top, detail);
        add_text(parts, "CR-V", height, first + 0.78 * (end - first), top, detail);
    }
    return parts;
}

ToolModelParts combination_parts(const ToolParameters& p, Detail detail) {
    const OpenEndHead head = open_end_head(p);
    const RingHead ring = ring_head(p);
    const HandleSize size = handle_size(head.size);
    const double R = 0.5 * ring.outside, bore = 0.5 * ring.opening / std::cos(pi / 6.0);
    // The far end of the ring is the far end of the wrench.
    const double c = std::cos(ring_tilt),
                 middle = p.length / mm - c * R - 0.5 * ring.thickness * std::sin(ring_tilt);
    const double end = middle - c * R + 0.3 * (R - bore);
    std::vector<HandleSection> sections =
        forged_handle(p, std::min(head.slot_end() + 0.06 * head.size, 0.8 * head.radius), head.radius,
                      0.5 * head.thickness, end, detail);
    // The ring's near rim is at the height of the handle.
    const double z = R * std::sin(ring_tilt);
    ToolModelParts parts{
        {"head", Finish::chrome_vanadium, {open_end_shell(head, 0.42 * size.high, detail)}},
        {"handle", Finish::chrome_vanadium, {handle_shell(sections, detail)}},
        {"ring", Finish::chrome_vanadium, {placed_ring(ring, middle, z, -ring_tilt, detail)}}};
    add_forged_texts(parts, p, neck_texts_from(p, head.radius), end - size.half, detail);
    return parts;
}

std::string size_text(double size_mm) { return fmt::format("{:g}", size_mm); }

void add_text(ToolModelParts& parts, std::string_view text, double height, double x, double z,
              Detail detail) {
    if (detail == Detail::contact) return;
    if (parts.back().name != "size") parts.push_back({"size", Finish::chrome_vanadium, {}});
    const double raised = std::max(0.25, 0.06 * height);
    for (Shell& stroke : text_shells(text, height, 0.17 * height, z - 0.3, z + raised))
        parts.back().shells.push_back(
            moved(std::move(stroke), [x](const Vec3& p) { return p + Vec3(x, 0.0, 0.0); }));
}

}  // namespace bolt::tool_models
