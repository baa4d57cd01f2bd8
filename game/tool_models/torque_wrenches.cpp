// Torque wrenches with an open-end insert, or with a ratchet and a socket or a bit: one that clicks, and an
// electronic one with a display and a light.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/tool_models/display.hpp"
#include "game/tool_models/glyphs.hpp"
#include "game/tool_models/parts.hpp"

namespace bolt::tool_models {

namespace {

constexpr double tube_radius = 12.5, flat_height = tube_radius - 1.2;

// The x of the far end of each part, mm. A short wrench has short parts.
struct TorqueWrenchEnds {
    double insert, adaptor, holder, tube, ring, sleeve, grip, knob;
};

// `head_end`: the far end of its head. `adaptor`: length of an adaptor between insert and holder.
TorqueWrenchEnds ends_of(double head_end, double adaptor, double length) {
    TorqueWrenchEnds x{};
    x.insert = std::max(62.0, head_end + 12.0);
    x.adaptor = x.insert + adaptor;
    const double rest = length - x.adaptor, share = std::min(1.0, rest / 330.0);
    x.holder = x.adaptor + 50.0 * share;
    x.knob = length;
    x.grip = x.knob - 16.0 * share;
    x.sleeve = x.grip - 115.0 * share;
    x.ring = x.sleeve - 36.0 * share;
    x.tube = x.ring - 5.0 * share;
    return x;
}

Shell knurled_x(double from, double to, double radius, double depth, int teeth, Detail detail) {
    if (detail == Detail::contact)
        return lathe_x(std::vector<ProfilePoint>{{from, radius}, {to, radius}}, 24);
    const auto grooves = [=](double angle, double r) {
        return r - depth * 2.0 * std::abs(std::remainder(angle * teeth / (2.0 * pi), 1.0));
    };
    return lathe_x(std::vector<ProfilePoint>{{from, radius - 1.6 * depth},
                                             {from + 1.6 * depth, radius, grooves},
                                             {to - 1.6 * depth, radius, grooves},
                                             {to, radius - 1.6 * depth}},
                   4 * teeth);
}

// The insert: the head and the shank that reaches into the holder.
ToolModelPart insert_part(const OpenEndHead& head, double end, Detail detail) {
    const double edge = std::min(1.6, 0.2 * head.thickness), half = std::min(14.0, 0.8 * head.radius);
    const double from = std::min(head.slot_end() + 0.06 * head.size, 0.8 * head.radius);
    std::vector<HandleSection> shank;
    const int steps = detail == Detail::drawn ? 12 : 4;
    for (int i = 0; i <= steps; ++i) {
        HandleSection at;
        at.x = from + (end + 6.0 - from) * i / steps;
        const double spread = std::max(0.0, 1.0 - (at.x - from) / (head.radius + 6.0 - from));
        at.half_width = half + (std::min(0.75 * head.radius, half + 8.0) - half) * square(spread);
        at.half_height = 0.5 * head.thickness - 0.15;
        at.edge = edge;
        shank.push_back(at);
    }
    return {
        "insert", Finish::chrome_vanadium, {open_end_shell(head, edge, detail), handle_shell(shank, detail)}};
}

// The adaptor: a socket for the insert's shank and a shank of its own, which reaches into the holder.
ToolModelPart adaptor_part(double from, double to, double thickness, Detail detail) {
    const int steps = detail == Detail::drawn ? 4 : 2;
    const double high = std::max(11.5, 0.5 * thickness + 1.5), socket = std::min(30.0, 0.6 * (to - from));
    return {"adaptor",
            Finish::chrome_vanadium,
            {block({from, -15.0, -high}, {from + socket, 15.0, high}, 3.0, 1.8, steps),
             block({from + socket - 2.0, -10.0, -8.0}, {to + 6.0, 10.0, 8.0}, 2.0, 1.2, steps)}};
}

ToolModelPart holder_part(double from, double to, double thickness, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double length = to - from, high = std::max(13.0, 0.5 * thickness + 2.5);
    const Shell square =
        moved(block({from, -17.0, -high}, {from + 0.76 * length, 17.0, high}, 4.0, 2.2, fine ? 4 : 2),
              [](const Vec3& p) { return p; });
    const Shell neck = lathe_x(std::vector<ProfilePoint>{{from + 0.6 * length, 12.9},
                                                         {from + 0.82 * length, 12.9},
                                                         {from + 0.86 * length, 14.0},
                                                         {from + 0.98 * length, 14.0},
                                                         {to, 13.0}},
                               fine ? 64 : 24);
    ToolModelPart part{"holder", Finish::black_oxide, {square, neck}};
    return part;
}

// The tube with a flat on top for the scale.
Shell tube_shell(double from, double to, double flat_from, double flat_to, Detail detail) {
    const auto cut = [](double angle, double r) {
        const double up = std::sin(angle);  // of (y, z) = r (cos, sin)
        return up > 0.0 ? std::min(r, flat_height / std::max(up, 1e-9)) : r;
    };
    const int segments = detail == Detail::drawn ? 96 : 24;
    if (detail == Detail::contact)
        return lathe_x(std::vector<ProfilePoint>{{from, tube_radius}, {to, tube_radius}}, segments);
    return lathe_x(std::vector<ProfilePoint>{{from, tube_radius},
                                             {flat_from - 1.0, tube_radius},
                                             {flat_from, tube_radius, cut},
                                             {flat_to, tube_radius, cut},
                                             {flat_to + 1.0, tube_radius},
                                             {to - 1.0, tube_radius},
                                             {to, tube_radius - 1.0}},
                   segments);
}

// The painted marks of the scale, 40 to 200 N·m.
ToolModelPart scale_part(double from, double to) {
    ToolModelPart part{"scale", Finish::black_oxide, {}};
    const double z = flat_height, pitch = (to - from) / 160.0;
    const double height = std::min(3.4, 14.0 * pitch);
    const auto place = [&](Shell shell, double x, double y) {
        part.shells.push_back(moved(std::move(shell), [=](const Vec3& p) { return p + Vec3(x, y, 0.0); }));
    };
    for (int torque = 40; torque <= 200; torque += 10) {
        const double x = from + pitch * (torque - 40), length = torque % 20 == 0 ? 3.2 : 1.8;
        part.shells.push_back(
            block({x - 0.2, -4.6, z - 0.2}, {x + 0.2, -4.6 + length, z + 0.08}, 0.1, 0.05, 1));
        if (torque % 40 != 0) continue;
        for (Shell& stroke : text_shells(fmt::format("{}", torque), height, 0.45, z - 0.2, z + 0.08))
            place(std::move(stroke), x, 1.3);
    }
    for (Shell& stroke : text_shells("N*m", height, 0.45, z - 0.2, z + 0.08))
        place(std::move(stroke), from - 3.2 * height, 1.3);
    return part;
}

// A rubber grip, barely waisted, with flutes along it.
Shell grip_shell(double from, double to, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double length = to - from;
    const auto flutes = [](double angle, double r) {
        const double near = std::abs(std::remainder(angle * 16.0 / (2.0 * pi), 1.0)) / 0.25;
        return r - (near < 1.0 ? 0.9 * (1.0 - near * near) : 0.0);
    };
    const RadiusOfAngle shape = fine ? RadiusOfAngle(flutes) : RadiusOfAngle{};
    return lathe_x(std::vector<ProfilePoint>{{from, 14.5},
                                             {from + 0.5, 15.6},
                                             {from + 1.6, 16.0},
                                             {from + 0.09 * length, 16.0},
                                             {from + 0.13 * length, 15.9, shape},
                                             {from + 0.37 * length, 15.3, shape},
                                             {to - 0.37 * length, 15.3, shape},
                                             {to - 0.13 * length, 15.9, shape},
                                             {to - 0.09 * length, 16.0},
                                             {to - 1.6, 16.0},
                                             {to - 0.5, 15.6},
                                             {to, 14.5}},
                   fine ? 128 : 24);
}

ToolModelParts click_parts(const TorqueWrenchEnds& x, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const double room = x.tube - x.holder;
    const double scale_from = x.holder + 0.46 * room, scale_to = x.tube - 0.1 * room;
    ToolModelParts parts;
    parts.push_back(
        {"tube",
         Finish::chrome_vanadium,
         {tube_shell(x.holder - 2.0, x.tube, scale_from - 0.075 * room, scale_to + 0.04 * room, detail)}});
    if (fine && room > 60.0) parts.push_back(scale_part(scale_from, scale_to));
    parts.push_back({"ring",
                     Finish::signal_red,
                     {lathe_x(
                         std::vector<ProfilePoint>{
                             {x.tube, 14.2}, {x.tube + 0.5, 14.7}, {x.ring - 0.5, 14.7}, {x.ring, 14.2}},
                         fine ? 64 : 24)}});
    parts.push_back(
        {"sleeve", Finish::chrome_vanadium, {knurled_x(x.ring, x.sleeve, 15.2, 0.7, 48, detail)}});
    parts.push_back({"grip", Finish::rubber, {grip_shell(x.sleeve, x.grip, detail)}});
    parts.push_back(
        {"knob",
         Finish::black_oxide,
         {lathe_x(std::vector<ProfilePoint>{{x.grip - 1.0, 9.0}, {x.grip + 3.0, 9.0}}, fine ? 48 : 24),
          knurled_x(x.grip + 2.0, x.knob, 13.0, 0.7, 40, detail)}});
    return parts;
}

ToolModelParts electronic_parts(const TorqueWrenchEnds& x, Detail detail) {
    const bool fine = detail == Detail::drawn;
    const int steps = fine ? 4 : 2;
    ToolModelParts parts;
    parts.push_back(
        {"tube",
         Finish::chrome_vanadium,
         {lathe_x(std::vector<ProfilePoint>{{x.holder - 2.0, tube_radius}, {x.sleeve, tube_radius}},
                  fine ? 64 : 24)}});
    // The housing of the display, between the tube and the grip.
    const double room = x.sleeve - x.holder, from = x.sleeve - std::min(100.0, 0.6 * room), to = x.sleeve;
    parts.push_back(
        {"housing", Finish::rubber, {block({from, -20.0, -15.0}, {to, 20.0, 19.0}, 7.0, 4.0, steps)}});
    const double screen_from = from + 0.16 * (to - from), screen_to = from + 0.66 * (to - from);
    parts.push_back({"screen",
                     Finish::screen,
                     {block({screen_from, -13.0, 17.0}, {screen_to, 13.0, 19.4}, 2.0, 0.3, steps)}});
    if (fine)
        for (ToolModelPart& part : number_parts(screen_from, screen_to, 19.4))
            parts.push_back(std::move(part));
    ToolModelPart keys{"keys", Finish::signal_red, {}};
    for (const double y : {-7.0, 7.0}) {
        const double key = from + 0.82 * (to - from), wide = 0.06 * (to - from);
        keys.shells.push_back(
            block({key - wide, y - 4.0, 18.0}, {key + wide, y + 4.0, 20.2}, 2.0, 0.6, steps));
    }
    parts.push_back(std::move(keys));
    for (ToolModelPart& part : light_parts(from, detail)) parts.push_back(std::move(part));
    parts.push_back({"grip", Finish::rubber, {grip_shell(x.sleeve - 0.5, x.grip, detail)}});
    parts.push_back(
        {"knob",
         Finish::black_oxide,
         {lathe_x(std::vector<ProfilePoint>{{x.grip - 1.0, 14.0}, {x.knob - 2.0, 14.0}, {x.knob, 11.5}},
                  fine ? 48 : 24)}});
    return parts;
}

}  // namespace

namespace {

ToolModelParts body_parts(const ToolParameters& p, const TorqueWrenchEnds& x, Detail detail) {
    return p.kind == ModelKind::click_torque_wrench ? click_parts(x, detail) : electronic_parts(x, detail);
}

// A torque wrench with a ratchet head; its handle is at the height of this head.
ToolModelParts ratchet_torque_wrench_parts(const ToolParameters& p, Detail detail) {
    RatchetWithAttachment head = ratchet_with_attachment(p, detail);
    const TorqueWrenchEnds x = ends_of(head.radius, 0.0, p.length / mm);
    ToolModelParts body = body_parts(p, x, detail);
    const double thickness = 0.8 * head.high;
    body.push_back(holder_part(0.7 * head.radius, x.holder, thickness, detail));
    for (ToolModelPart& part : body) {
        for (Shell& shell : part.shells)
            shell = moved(std::move(shell), [&](const Vec3& q) { return q + Vec3(0.0, 0.0, head.middle); });
        if (part.name == "ring") part.name = "band";
        head.parts.push_back(std::move(part));
    }
    return std::move(head.parts);
}

}  // namespace

ToolModelParts torque_wrench_parts(const ToolParameters& p, Detail detail) {
    if (has_ratchet(p)) return ratchet_torque_wrench_parts(p, detail);
    const OpenEndHead head = open_end_head(p);
    const TorqueWrenchEnds x = ends_of(head.middle + head.radius, p.adaptor_length / mm, p.length / mm);
    ToolModelParts parts = body_parts(p, x, detail);
    parts.insert(parts.begin(), {insert_part(head, x.insert, detail),
                                 holder_part(x.adaptor, x.holder, head.thickness, detail)});
    if (x.adaptor > x.insert) parts.push_back(adaptor_part(x.insert, x.adaptor, head.thickness, detail));
    const double holder = x.adaptor + 0.38 * (x.holder - x.adaptor),
                 top = std::max(13.0, 0.5 * head.thickness + 2.5);
    if (x.holder - x.adaptor > 30.0) {
        add_text(parts, size_text(head.size), 9.0, holder, top, detail);
    }
    return parts;
}

}  // namespace bolt::tool_models
