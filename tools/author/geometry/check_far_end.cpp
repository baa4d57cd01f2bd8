// The end of a joint's bolt that is not turned: a head, a nut, or a thread in a tapped hole.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/author/geometry/joint_check.hpp"

namespace bolt::geometry {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Height of the bearing face under the head: the highest point wider than the shank and its fillet; nullopt
// without a head.
std::optional<double> head_underside(const JointCheck& s) {
    std::optional<double> top;
    for (const Triangle& t : s.parts.bolt.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (std::hypot(p.x, p.z) > 0.62 * s.size().d && p.y < 0.0) top = std::max(top.value_or(p.y), p.y);
    return top;
}

// Compares the diameter of the bolt between two heights with its thread.
void check_thread_diameter(const JointCheck& s, double low, double high) {
    double radius = 0.0;
    for (const Triangle& t : s.parts.bolt.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (p.y > low && p.y < high) radius = std::max(radius, std::hypot(p.x, p.z));
    if (std::abs(2.0 * radius - s.size().d) > 0.3 * mm)
        s.error(fmt::format("{} measures {:.2f} mm across its thread", content::in_quotes(s.parts.bolt.name),
                            2.0 * radius / mm),
                fmt::format("{:g} mm for {}", s.size().d / mm, s.size().name));
}

// Compares a measured length (m) of the bolt with its design. `where`: "under its head".
void check_bolt_length(const JointCheck& s, double length, const char* where) {
    const double designed = s.joint.design.bolt_length;
    if (std::abs(length - designed) > length_tolerance)
        s.error(fmt::format("{} measures {:.2f} mm {}", content::in_quotes(s.parts.bolt.name), length / mm,
                            where),
                fmt::format("{:g} mm (bolt_length_mm)", designed / mm));
}

// Checks the seat of a nut or a head whose bearing face points along +Y and lies at the height `face`, and of
// the washer on it.
void check_lower_seat(const JointCheck& s, const std::string& name, double face, const Fastener& washer,
                      const char* noun) {
    const double grip = s.grip();
    const std::string member = fmt::format("the member under the {}", noun);
    // check_seat() expects the part above its seat, so all heights are negated.
    if (washer.exists()) {
        check_seat(s, name, -face, content::in_quotes(washer.name), -washer.box.low.y);
        check_seat(s, washer.name, -washer.box.high.y, member, grip);
    } else {
        check_seat(s, name, -face, member, grip);
    }
}

void check_head(const JointCheck& s) {
    const auto underside = head_underside(s);
    if (!underside) {
        s.error(fmt::format("{} has no head on the other side of the members",
                            content::in_quotes(s.parts.bolt.name)),
                "the head at -Y of the joint's node");
        return;
    }
    check_thread_diameter(s, *underside + 0.1 * s.joint.design.bolt_length, infinity);
    check_bolt_length(s, s.parts.bolt.box.high.y - *underside, "under its head");
    check_lower_seat(s, s.parts.bolt.name, *underside, s.parts.washer_head, "head");
}

// Checks the thread and the length of a bolt or a screw that is turned at its head.
void check_turned_bolt(const JointCheck& s) {
    if (!s.parts.turned.exists()) return;
    const double face = s.parts.turned.box.low.y;
    check_thread_diameter(s, -infinity, face - 0.1 * s.joint.design.bolt_length);
    check_bolt_length(s, face - s.parts.bolt.box.low.y, "under its head");
}

// Checks the nut of a bolt that is turned at its head.
void check_held_nut(const JointCheck& s) {
    const Fastener& nut = s.parts.nut;
    if (!nut.exists()) return;
    check_hexagon(s, nut, s.size().across_flats, "nut");
    check_lower_seat(s, nut.name, nut.box.high.y, s.parts.washer_nut, "nut");
}

constexpr double widest_tapped_hole = 1.02;  // in diameters of the thread; import-step accepts 1.01

// The wall that surrounds the end of a screw or a stud.
struct TappedWall {
    std::map<std::uint32_t, std::vector<Vec3>> corners;  // of the triangles that were hit, by part
    double depth = 0.0;   // m from the members, of the deepest ring of rays that met it; 0: none
    double needed = 0.0;  // m, the depth of the last ring: the engagement without a chamfer of one pitch
};

// Casts a ring of rays `depth` m behind the members. Returns true if at least half of them meet a wall, and
// adds it to `wall`.
bool find_tapped_wall(const JointCheck& s, double depth, TappedWall& wall) {
    constexpr int rays = 24;
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        const double angle = (i + 0.5) * 2.0 * pi / rays;
        const auto hit = s.ray({0.0, -s.grip() - depth, 0.0}, {std::cos(angle), 0.0, std::sin(angle)},
                               0.5 * widest_tapped_hole * s.size().d);
        if (!hit) continue;
        ++hits;
        for (const Vec3& corner : s.corners_of(*hit)) wall.corners[s.part_of(*hit)].push_back(corner);
    }
    if (hits < rays / 2) return false;
    wall.depth = std::max(wall.depth, depth);
    return true;
}

// Finds the wall of the tapped hole along the engagement.
TappedWall measure_tapped_wall(const JointCheck& s) {
    constexpr int rings = 8;
    const double engagement = s.joint.design.hole.engagement, pitch = s.joint.design.thread.thread.pitch;
    TappedWall wall;
    wall.needed = std::max(engagement - pitch, 0.5 * engagement);
    bool reaches_end = false;
    for (int i = 1; i <= rings; ++i) reaches_end = find_tapped_wall(s, wall.needed * i / rings, wall);
    if (reaches_end || wall.depth <= 0.0) return wall;
    double inside = wall.depth, beyond = wall.depth + wall.needed / rings;
    while (beyond - inside > 0.1 * length_tolerance) {
        const double middle = 0.5 * (inside + beyond);
        (find_tapped_wall(s, middle, wall) ? inside : beyond) = middle;
    }
    return wall;
}

// Checks the diameter and the axis of the tapped hole in each part; a hole that is not round passes.
void check_tapped_diameter(const JointCheck& s, const TappedWall& wall) {
    const double least = s.joint.design.thread.thread.d3, most = widest_tapped_hole * s.size().d;
    for (const auto& [part, corners] : wall.corners) {
        const auto circle = fit_circle(corners);
        if (!circle || circle->residual > offset_tolerance) continue;
        if (report_hole_off_axis(s, part, *circle, "tapped hole")) continue;
        if (2.0 * circle->radius < least)
            s.error(fmt::format("the tapped hole in {} measures {:.2f} mm", s.name_of(part),
                                2.0 * circle->radius / mm),
                    fmt::format("{:.2f} to {:.2f} mm for {}", least / mm, most / mm, s.size().name));
    }
}

// Checks that a hole surrounds the thread of a screw or a stud along its engagement, and that the thread does
// not reach through its bottom. Returns the parts around the thread.
std::set<std::uint32_t> check_tapped_hole(const JointCheck& s) {
    const auto& design = s.joint.design;
    const std::string name = content::in_quotes(s.parts.bolt.name);
    const TappedWall wall = measure_tapped_wall(s);
    std::set<std::uint32_t> parts;
    for (const auto& [part, corners] : wall.corners) parts.insert(part);
    if (wall.depth <= 0.0) {
        s.error(fmt::format("no hole is around the end of {}", name),
                fmt::format("the tapped hole, at most {:g} mm wide", widest_tapped_hole * s.size().d / mm));
        return parts;
    }
    check_tapped_diameter(s, wall);
    const double reach = -s.grip() - s.parts.bolt.box.low.y;
    // Inside a hole of the core diameter, and beyond the tip of a drill.
    const auto bottom = find_face(s, 0.3 * s.size().d, -s.grip() - length_tolerance, -1.0, reach);
    if (bottom && bottom->distance + length_tolerance < reach - contact_tolerance)
        s.error(fmt::format(
                    "{} reaches {:.2f} mm behind the members, and the tapped hole in {} is {:.2f} mm deep",
                    name, reach / mm, s.name_of(bottom->part), (bottom->distance + length_tolerance) / mm),
                "a deeper hole, or a shorter thread");
    else if (wall.depth < wall.needed - length_tolerance)
        s.error(
            fmt::format("the tapped hole around {} ends {:.2f} mm behind the members", name, wall.depth / mm),
            fmt::format("at least {:g} mm, the engagement", design.hole.engagement / mm));
    return parts;
}

// Checks both ends of a stud against the face of the tapped part, which ends the grip.
void check_stud(const JointCheck& s) {
    const auto& design = s.joint.design;
    const double face = -s.grip(), reach = face - s.parts.bolt.box.low.y;
    check_thread_diameter(s, -infinity, infinity);
    check_bolt_length(s, s.parts.bolt.box.high.y - face, "from the tapped part to its end at the nut");
    if (reach < design.hole.engagement - length_tolerance)
        s.error(fmt::format("{} reaches {:.2f} mm into the tapped part",
                            content::in_quotes(s.parts.bolt.name), std::max(reach, 0.0) / mm),
                fmt::format("at least {:g} mm (engagement_mm)", design.hole.engagement / mm));
}

}  // namespace

std::set<std::uint32_t> check_far_end(const JointCheck& s) {
    const auto& design = s.joint.design;
    const bool exists = s.parts.bolt.exists();
    switch (design.form) {
        case joint::JointForm::through_bolt:
            if (exists && design.turned == joint::TurnedPart::nut) check_head(s);
            if (exists && design.turned == joint::TurnedPart::head) check_turned_bolt(s);
            if (design.turned == joint::TurnedPart::head) check_held_nut(s);
            return {};
        case joint::JointForm::tapped_hole:
            if (exists) check_turned_bolt(s);
            break;
        case joint::JointForm::stud:
            if (exists) check_stud(s);
            break;
    }
    return exists ? check_tapped_hole(s) : std::set<std::uint32_t>{};
}

}  // namespace bolt::geometry
