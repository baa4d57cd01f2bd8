// Tools that reach into a screw or over a nut along the bolt: hexagon keys and bits, sockets on a ratchet
// handle, extension bars and adaptors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/tool_models/glyphs.hpp"
#include "game/tool_models/parts.hpp"

namespace bolt::tool_models {

namespace {

// A socket screw's hexagon is about 0.6 of its width deep (ISO 4762), a nut about 0.8 of its width high.
constexpr double key_engagement = 0.6, nut_engagement = 0.8;
constexpr double drive_play = 0.15;  // mm, of a square drive in its socket

// The outside of a body with bevels at both ends.
void add_outside(std::vector<ProfilePoint>& profile, double from, double to, double radius, double bevel,
                 int steps) {
    for (int i = 0; i <= steps; ++i) {
        const double angle = 0.5 * pi * i / steps;
        profile.push_back({from + bevel * (1.0 - std::cos(angle)), radius - bevel * (1.0 - std::sin(angle))});
    }
    for (int i = steps; i >= 0; --i) {
        const double angle = 0.5 * pi * i / steps;
        profile.push_back({to - bevel * (1.0 - std::cos(angle)), radius - bevel * (1.0 - std::sin(angle))});
    }
}

// The square hole for a drive, from its mouth at the top down to its floor.
void add_square_hole(std::vector<ProfilePoint>& profile, double top, double drive) {
    const double half = 0.5 * (drive + drive_play), lead = 0.06 * drive;
    profile.push_back({top, half + lead, square_radius});
    profile.push_back({top - lead, half, square_radius});
    profile.push_back({top - 0.95 * drive, half, square_radius});
}

// A square drive that points down from `top` to `tip`.
Shell square_pin(double tip, double top, double drive) {
    const double half = 0.5 * drive, lead = 0.1 * drive;
    return lathe_z(
        std::vector<ProfilePoint>{
            {tip, half - lead, square_radius}, {tip + lead, half, square_radius}, {top, half, square_radius}},
        32);
}

// A knurled sleeve about Z: V grooves along the axis.
Shell knurled_z(double from, double to, double radius, double depth, int teeth, Detail detail) {
    if (detail == Detail::contact)
        return lathe_z(std::vector<ProfilePoint>{{from, radius}, {to, radius}}, 24);
    const auto grooves = [=](double angle, double r) {
        const double share = std::abs(std::remainder(angle * teeth / (2.0 * pi), 1.0)) * 2.0;
        return r - depth * share;
    };
    return lathe_z(std::vector<ProfilePoint>{{from, radius - depth},
                                             {from + depth, radius, grooves},
                                             {to - depth, radius, grooves},
                                             {to, radius - depth}},
                   4 * teeth);
}

// A text around a vertical cylinder, with its middle at −Y.
void add_text_around(ToolModelParts& parts, std::string_view text, double height, double radius, double z,
                     Detail detail) {
    if (detail == Detail::contact) return;
    ToolModelPart part{"socket_size", Finish::chrome_vanadium, {}};
    const double raised = std::max(0.2, 0.05 * height);
    for (Shell& stroke : text_shells(text, height, 0.17 * height, -0.4, raised))
        part.shells.push_back(moved(std::move(stroke), [=](const Vec3& p) {
            const double angle = p.x / radius - 0.5 * pi, r = radius + p.z;
            return Vec3(r * std::cos(angle), r * std::sin(angle), z + p.y);
        }));
    parts.push_back(std::move(part));
}

// mm, radius of a key's bend.
double key_bend(double s) { return std::max(1.5 * s, 3.0); }

}  // namespace

ToolModelParts hex_key_parts(const ToolParameters& p, Detail detail) {
    const double s = p.size / mm, flat = 0.5 * p.opening / mm, corner = flat / std::cos(pi / 6.0);
    const KeyArms arms = key_arms(p.size);
    const double tip = -0.5 * key_engagement * s;
    const double bend = key_bend(s), top = tip + arms.arm / mm - flat;  // axis of the long arm
    const bool fine = detail == Detail::drawn;
    const double lead = 0.12 * s;
    std::vector<Loop> loops;
    // A section across the path in the plane y = 0; `angle`: of the path's direction from +Z towards +X.
    const auto add = [&](double x, double z, double angle, double scale) {
        Loop loop;
        for (int i = 0; i < 6; ++i) {
            // Two flats are perpendicular to the plane of the bend.
            const double at = pi / 6.0 + i * pi / 3.0, r = corner * scale;
            const double out = r * std::cos(at), side = r * std::sin(at);
            loop.emplace_back(x + out * std::cos(angle), side, z - out * std::sin(angle));
        }
        loops.push_back(std::move(loop));
    };
    add(0.0, tip, 0.0, 1.0 - lead / corner);
    add(0.0, tip + 0.6 * lead, 0.0, 1.0);
    const int steps = fine ? 14 : 5;
    for (int i = 0; i <= steps; ++i) {
        const double angle = 0.5 * pi * i / steps;
        add(bend * (1.0 - std::cos(angle)), top - bend + bend * std::sin(angle), angle, 1.0);
    }
    const double end = p.length / mm;
    add(end - 0.6 * lead, top, 0.5 * pi, 1.0);
    add(end, top, 0.5 * pi, 1.0 - lead / corner);
    ToolModelParts parts{{"key", Finish::black_oxide, {loft(loops)}}};
    add_text(parts, size_text(s), 0.62 * s, bend + 0.35 * (end - bend), top + flat, detail);
    return parts;
}

ToolModelParts hex_bit_parts(const ToolParameters& p, Detail detail) {
    const double s = p.size / mm, drive = p.drive / mm, flat = 0.5 * p.opening / mm;
    const bool fine = detail == Detail::drawn;
    const double radius = std::max(0.88 * drive, 0.62 * s + 1.0);
    const double tip = -0.5 * key_engagement * s, top = p.length / mm, body = top - 1.55 * drive;
    const double lead = 0.1 * s;
    const Shell bit = lathe_z(std::vector<ProfilePoint>{{tip, flat - lead, hexagon_radius},
                                                        {tip + 0.6 * lead, flat, hexagon_radius},
                                                        {body + 1.0, flat, hexagon_radius}},
                              24);
    std::vector<ProfilePoint> profile;
    add_outside(profile, body, top, radius, 0.8, fine ? 4 : 2);
    add_square_hole(profile, top, drive);
    ToolModelParts parts{{"bit", Finish::black_oxide, {bit}},
                         {"socket", Finish::chrome_vanadium, {lathe_z(profile, fine ? 64 : 32)}}};
    add_text_around(parts, size_text(s), 0.4 * drive, radius, body + 0.75 * drive, detail);
    return parts;
}

namespace {

struct SocketSize {
    double radius, low, high;      // outside; lower and upper end
    double shoulder, bore, floor;  // end of the flats; radius and end of the bore for the end of the bolt
    double lead;                   // leg of the chamfer at the mouth
};

// ⌀ 1.25 s + 3 mm on a drive of 12.5 mm (our estimate; no source). The 3 mm grow with the drive.
SocketSize socket_size(double s, double opening, double drive) {
    const double grip = nut_engagement * s, shoulder = 0.5 * grip + 1.0, floor = shoulder + 0.35 * s;
    const double neck = std::max(0.9 * drive, 0.5 * opening + 1.0);
    return {std::max(0.5 * (1.25 * s + 0.24 * drive), neck),
            -0.5 * grip - 1.0,
            floor + std::max(0.05 * s, 2.0) + 1.1 * drive,
            shoulder,
            0.42 * s,
            floor,
            0.05 * s};
}

Shell socket_shell(const SocketSize& size, double opening, double drive, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double half = 0.5 * opening, lead = size.lead, outside = size.radius;
    const auto mouth = [lead](double angle, double radius) {
        return std::max(twelve_point_radius(angle, radius), radius / std::cos(pi / 6.0) + 0.2 * lead);
    };
    // As in ring_shell(), the hole of the contact model is round.
    std::vector<ProfilePoint> profile{{size.floor, size.bore}, {size.shoulder, size.bore}};
    if (fine)
        profile.insert(profile.end(), {{size.shoulder, half, twelve_point_radius},
                                       {size.low + lead, half, twelve_point_radius},
                                       {size.low, half, mouth}});
    else
        profile.insert(profile.end(),
                       {{size.shoulder, half / std::cos(pi / 6.0)}, {size.low, half / std::cos(pi / 6.0)}});
    add_outside(profile, size.low, size.high, outside, std::min(0.9, 0.3 * (outside - half)), fine ? 4 : 2);
    add_square_hole(profile, size.high, drive);
    return lathe_z(profile, fine ? 96 : 24);
}

// The head of a ratchet.
struct RatchetHead {
    double radius = 0.0, low = 0.0, high = 0.0;  // mm; `high`: its height

    [[nodiscard]] double middle() const { return low + 0.5 * high; }
};

RatchetHead ratchet_head(double drive, double low) { return {1.35 * drive + 2.0, low, 1.5 * drive + 3.0}; }

// A round head on the drive, with a lever for the direction.
ToolModelParts ratchet_head_parts(const RatchetHead& r, double drive, Detail detail) {
    const bool fine = detail == Detail::drawn;
    std::vector<ProfilePoint> head;
    add_outside(head, r.low, r.low + r.high, r.radius, 0.12 * r.high, fine ? 5 : 2);
    ToolModelParts parts{
        {"drive", Finish::chrome_vanadium, {square_pin(r.low - 0.9 * drive, r.low + 1.0, drive)}},
        {"head", Finish::chrome_vanadium, {lathe_z(head, fine ? 64 : 24)}}};
    if (!fine) return parts;
    // The lever and the disc that carries it stand on top of the head.
    const double top = r.low + r.high;
    std::vector<ProfilePoint> disc;
    add_outside(disc, top - 1.0, top + 1.4, 0.66 * r.radius, 0.5, 3);
    parts.push_back({"cover", Finish::black_oxide, {lathe_z(disc, 48)}});
    const Shell lever = block({-0.14 * r.radius, -0.2 * r.radius, top + 1.0},
                              {0.95 * r.radius, 0.2 * r.radius, top + 4.2}, 0.18 * r.radius, 0.9, 4);
    parts.push_back({"lever", Finish::black_oxide, {moved(lever, [](const Vec3& q) {
                         const double c = std::cos(0.5), s = std::sin(0.5);
                         return Vec3(c * q.x - s * q.y, s * q.x + c * q.y, q.z);
                     })}});
    return parts;
}

// The neck and the grip of a ratchet, to x = `end`.
ToolModelParts ratchet_handle_parts(const RatchetHead& head, double drive, int teeth, double end,
                                    Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double radius = head.radius, high = head.high, z = head.middle();
    ToolModelParts parts;
    std::vector<HandleSection> neck;
    const double grip_from = 0.45 * end, grip_half = 0.85 * drive + 3.0;
    const int steps = fine ? 16 : 5;
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        HandleSection at;
        at.x = 0.55 * radius + (grip_from + 2.0 - 0.55 * radius) * t;
        at.z = z;
        at.half_width = radius * (0.52 + 0.3 * square(square(1.0 - t))) - 0.08 * radius * std::sin(pi * t);
        at.half_height = 0.5 * high * (0.62 + 0.25 * square(1.0 - t));
        at.edge = 0.55 * std::min(at.half_width, at.half_height);
        neck.push_back(at);
    }
    parts.push_back({"neck", Finish::chrome_vanadium, {handle_shell(neck, detail)}});
    std::vector<ProfilePoint> grip;
    const int grip_steps = fine ? 40 : 8;
    grip.push_back({grip_from, 0.72 * grip_half});
    for (int i = 0; i <= grip_steps; ++i) {
        const double t = static_cast<double>(i) / grip_steps;
        const double swell = 1.0 - 0.10 * square(std::cos(2.0 * pi * t)) + 0.08 * t;
        const bool groove = fine && t > 0.12 && t < 0.88 && i % 4 == 0;
        grip.push_back(
            {grip_from + 2.0 + (end - grip_from - 4.0) * t, grip_half * swell - (groove ? 0.7 : 0.0)});
    }
    grip.push_back({end - 0.6, 0.86 * grip_half});
    grip.push_back({end, 0.6 * grip_half});
    parts.push_back({"grip", Finish::rubber, {moved(lathe_x(grip, fine ? 48 : 16), [z](const Vec3& q) {
                         return q + Vec3(0.0, 0.0, z);
                     })}});
    add_text(parts, fmt::format("{}", teeth), 0.7 * neck[neck.size() / 2].half_width, 0.3 * end,
             z + neck[neck.size() * 3 / 5].half_height - 0.05, detail);
    return parts;
}

// A shaft with a square drive below and a square hole above. The origin is in the middle of the lower drive.
ToolModelParts shaft_parts(double lower, double upper, double top, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double tip = -0.45 * lower, shoulder = 0.45 * lower;
    const double upper_radius = 0.88 * upper, upper_from = std::max(top - 1.6 * upper, shoulder + 1.0);
    const double shaft = std::min(0.72 * lower + 0.6, upper_radius);
    const double slope_from = std::max(upper_from - 1.2 * (upper_radius - shaft), shoulder + 0.5);
    std::vector<ProfilePoint> profile{{shoulder, shaft - 0.8}, {shoulder + 0.8, shaft}};
    if (slope_from > shoulder + 1.0) profile.push_back({slope_from, shaft});
    add_outside(profile, upper_from, top, upper_radius, 0.9, fine ? 4 : 2);
    add_square_hole(profile, top, upper);
    ToolModelParts parts{{"drive", Finish::chrome_vanadium, {square_pin(tip, shoulder + 1.0, lower)}},
                         {"shaft", Finish::chrome_vanadium, {lathe_z(profile, fine ? 64 : 32)}}};
    const double knurl = upper_from + 0.45 * (top - upper_from), wide = 0.22 * (top - upper_from);
    parts.push_back({"grip",
                     Finish::chrome_vanadium,
                     {knurled_z(knurl - wide, knurl + wide, upper_radius + 0.5, 0.5, 36, detail)}});
    return parts;
}

constexpr double bit_length = 55.0;  // mm, of a bit on a ratchet

// The parts on the square drive of a ratchet: a socket or a bit, with its extension bar. The drive's shoulder
// is at the height `top`.
struct AttachmentParts {
    ToolModelParts parts;
    double top = 0.0;
};

AttachmentParts attachment_parts(const ToolParameters& p, Detail detail) {
    const double s = p.size / mm, drive = p.drive / mm, opening = p.opening / mm;
    AttachmentParts end;
    if (measure_of(p) == SizeMeasure::socket_screw) {
        ToolParameters bit = p;
        bit.length = bit_length * mm;
        end = {hex_bit_parts(bit, detail), bit_length};
    } else {
        const SocketSize size = socket_size(s, opening, drive);
        end.parts.push_back(
            {"socket", Finish::chrome_vanadium, {socket_shell(size, opening, drive, detail)}});
        add_text_around(end.parts, size_text(s), 0.42 * std::min(drive, 0.7 * s), size.radius,
                        size.high - 0.8 * drive, detail);
        end.top = size.high;
    }
    if (p.extension <= 0.0) return end;
    // A shaft's origin is in the middle of its lower drive.
    const double shoulder = 0.45 * drive, from = end.top + 0.5 - shoulder;
    for (ToolModelPart& part : shaft_parts(drive, drive, shoulder + p.extension / mm, detail)) {
        for (Shell& shell : part.shells)
            shell = moved(std::move(shell), [from](const Vec3& q) { return q + Vec3(0.0, 0.0, from); });
        part.name = "bar_" + part.name;
        end.parts.push_back(std::move(part));
    }
    end.top += 0.5 + p.extension / mm;
    return end;
}

void append(ToolModelParts& parts, ToolModelParts more) {
    for (ToolModelPart& part : more) parts.push_back(std::move(part));
}

}  // namespace

SocketGrip socket_grip(const ToolParameters& p) {
    const SocketSize size = socket_size(p.size / mm, p.opening / mm, p.drive / mm);
    return {size.low, size.shoulder, size.lead, 2.0 * size.radius};
}

KeyGrip key_grip(const ToolParameters& p) {
    const double s = p.size / mm, flat = 0.5 * p.opening / mm, tip = -0.5 * key_engagement * s;
    if (p.kind != ModelKind::hex_key) return {tip, 0.06 * s, bit_length - 1.55 * p.drive / mm - tip};
    return {tip, 0.072 * s, key_arms(p.size).arm / mm - flat - key_bend(s)};
}

RatchetWithAttachment ratchet_with_attachment(const ToolParameters& p, Detail detail) {
    const double drive = p.drive / mm;
    AttachmentParts end = attachment_parts(p, detail);
    const RatchetHead head = ratchet_head(drive, end.top + 0.5);
    append(end.parts, ratchet_head_parts(head, drive, detail));
    return {std::move(end.parts), head.radius, head.middle(), head.high};
}

ToolModelParts ratchet_parts(const ToolParameters& p, Detail detail) {
    const double drive = p.drive / mm;
    AttachmentParts end = attachment_parts(p, detail);
    const RatchetHead head = ratchet_head(drive, end.top + 0.5);
    append(end.parts, ratchet_head_parts(head, drive, detail));
    append(end.parts, ratchet_handle_parts(head, drive, p.teeth, p.length / mm, detail));
    return std::move(end.parts);
}

ToolModelParts extension_bar_parts(const ToolParameters& p, Detail detail) {
    const double drive = p.size / mm, top = p.length / mm;
    ToolModelParts parts = shaft_parts(drive, drive, top, detail);
    add_text_around(parts, size_text(drive), 0.6 * drive, 0.72 * drive + 0.6, 0.5 * top - 0.6 * drive,
                    detail);
    return parts;
}

ToolModelParts adaptor_parts(const ToolParameters& p, Detail detail) {
    return shaft_parts(p.size / mm, p.drive / mm, p.length / mm, detail);
}

}  // namespace bolt::tool_models
