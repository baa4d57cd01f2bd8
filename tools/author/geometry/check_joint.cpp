#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "tools/author/geometry/drawn_thread.hpp"
#include "tools/author/geometry/joint_check.hpp"

namespace bolt::geometry {

namespace {

constexpr double jaw_play = 0.6 * mm;  // a jaw may be wider than the nut by this

// Reports a fastener that is missing, or a washer that the joint type does not have.
void check_presence(const JointCheck& s, const Fastener& fastener, bool wanted) {
    if (fastener.exists() == wanted) return;
    std::vector<std::string> names;
    for (const ModelNode& node : s.scene.nodes)
        if (!node.name.empty() && node.parent >= 0 &&
            s.scene.nodes[static_cast<std::size_t>(node.parent)].name == s.joint.node)
            names.push_back(node.name);
    const std::string near = content::nearest_name(fastener.name, names);
    if (wanted)
        s.error(fmt::format("there is no node {} with a mesh under {}", content::in_quotes(fastener.name),
                            content::in_quotes(s.joint.node)),
                near.empty() || near == fastener.name
                    ? "a node with this name"
                    : fmt::format("did you mean {}?", content::in_quotes(near)));
    else
        s.error(fmt::format("the model has {}, but the joint type has no such washer",
                            content::in_quotes(fastener.name)),
                "washer_under_head and washer_under_nut as in the model");
}

// Reports a jaw that is too small or too wide for the nut. `flats`: measured width across flats, m.
void check_jaw(const JointCheck& s, const JawOpening& jaw, double flats) {
    const std::string name = content::in_quotes(s.parts.turned.name);
    const auto report = [&](const char* how) {
        s.error(fmt::format("a jaw of {:g} mm{} is too {} for {}, {:.2f} mm across flats", jaw.opening / mm,
                            jaw.owner, how, name, flats / mm),
                fmt::format("jaw_mm from {:.2f} to {:.2f}", flats / mm, (flats + jaw_play) / mm));
    };
    if (jaw.opening < flats - 1e-6)
        report("small");
    else if (jaw.opening > flats + jaw_play + 1e-6)
        report("wide");
}

// Checks the hexagon of the nut or of the head that is turned, and that the jaws fit it, or the socket of the
// head. Returns false if no tool can grip it.
bool check_turned_hexagon(const JointCheck& s, std::span<const JawOpening> jaws) {
    const joint::TurnedPartSize size = joint::turned_part_size(s.joint.design);
    if (size.depth > 0.0) {
        check_socket(s, size);
        return true;
    }
    const auto flats = check_hexagon(s, s.parts.turned, size.across_flats, s.turned_name());
    if (!flats) return false;
    for (const JawOpening& jaw : jaws) check_jaw(s, jaw, *flats);
    return true;
}

// The ring of rays that finds the faces under the turned part: its radius, and its height above them.
struct FaceRing {
    double radius = 0.0, above = 0.0;  // m
};

FaceRing face_ring(const JointCheck& s) {
    const joint::TurnedPartSize part = joint::turned_part_size(s.joint.design);
    const bool washer = s.joint.design.washer_under_turned() > 0.0;
    return {0.25 * (s.size().hole + (washer ? s.size().washer_outer : part.bearing)), 0.5 * part.height};
}

// Returns the height of the member's face under the turned part, and reports a face away from position_mm;
// nullopt after reporting that there is none.
std::optional<double> check_face(const JointCheck& s, const FaceRing& ring) {
    const auto top = find_face(s, ring.radius, ring.above, -1.0, ring.above + s.grip());
    if (!top) {
        s.error(fmt::format("no member is under the {} at position_mm", s.turned_name()),
                "a face at position_mm");
        return std::nullopt;
    }
    const double face = ring.above - top->distance;
    if (std::abs(face) > contact_tolerance)
        s.error(fmt::format("the face of {} under the {} is {:.2f} mm {} position_mm", s.name_of(top->part),
                            s.turned_name(), std::abs(face) / mm, face > 0.0 ? "beyond" : "below"),
                "position_mm on the face");
    return face;
}

void check_members(const JointCheck& s) {
    const FaceRing ring = face_ring(s);
    const double grip = s.grip(), above = ring.above;
    const bool nut_turned = s.joint.design.turned == joint::TurnedPart::nut;
    const auto face = check_face(s, ring);
    if (!face) return;
    const auto bottom = find_face(s, ring.radius, -grip - above, 1.0, above + grip);
    const double measured = bottom ? grip + above - bottom->distance : 0.0;
    if (!bottom || std::abs(measured + *face - grip) > length_tolerance)
        s.error(bottom
                    ? fmt::format("the members measure {:.2f} mm in the model, and {:g} mm in the joint type",
                                  (measured + *face) / mm, grip / mm)
                    : fmt::format("no member is under the {}", nut_turned ? "head" : "nut"),
                "both within 0.1 mm");
}

// Measures the hole in each part with rays from the axis. Returns the parts whose hole is smaller than the
// bolt.
std::set<std::uint32_t> check_hole(const JointCheck& s) {
    constexpr int heights = 8, rays = 36;
    const double grip = s.grip();
    std::set<std::uint32_t> tight;
    std::map<std::uint32_t, std::vector<Vec3>> walls;
    for (int i = 0; i < heights; ++i)
        for (int k = 0; k < rays; ++k) {
            const double angle = k * 2.0 * pi / rays;
            const auto hit = s.ray({0.0, -(i + 0.5) / heights * grip, 0.0},
                                   {std::cos(angle), 0.0, std::sin(angle)}, s.size().d);
            if (!hit) continue;
            for (const Vec3& p : s.corners_of(*hit)) walls[s.part_of(*hit)].push_back(p);
        }
    for (const auto& [part, points] : walls) {
        const auto circle = fit_circle(points);
        if (!circle || circle->residual > offset_tolerance)
            continue;  // no round hole: check_overlaps() finds overlaps
        if (2.0 * circle->radius < s.size().d) {
            tight.insert(part);
            s.error(fmt::format("the hole in {} measures {:.2f} mm, and the bolt {:g} mm", s.name_of(part),
                                2.0 * circle->radius / mm, s.size().d / mm),
                    fmt::format("{:g} mm (ISO 273 medium)", s.size().hole / mm));
        } else {
            report_hole_off_axis(s, part, *circle, "hole");
        }
    }
    return tight;
}

// Checks the face under the turned part of a screw or a stud, and that the tapped part begins at the end of
// the grip.
void check_tapped_members(const JointCheck& s) {
    const auto& design = s.joint.design;
    const FaceRing ring = face_ring(s);
    const double grip = s.grip();
    if (!check_face(s, ring)) return;
    // From inside the last member to its far face, which lies on the tapped part.
    const bool stud = design.form == joint::JointForm::stud;
    const double inside = 0.5 * (stud ? design.members.front() : design.members.back()).thickness;
    const auto bottom = find_face(s, ring.radius, -grip + inside, -1.0, 2.0 * inside + grip);
    if (!bottom)
        s.error("no part with a tapped hole is behind the members", "a part whose face ends the grip");
    else if (std::abs(bottom->distance - inside) > length_tolerance)
        s.error(fmt::format("the members measure {:.2f} mm in the model, and {:g} mm in the joint type",
                            (grip + bottom->distance - inside) / mm, grip / mm),
                "both within 0.1 mm");
}

// The lower and upper end of what a point at the height `y` belongs to: the head or the shank of a bolt, or
// the whole of another fastener. Head and shank shrink separately, so that the bearing face under the head
// leaves the member.
std::pair<double, double> section_around(const JointCheck& s, const Fastener& fastener, double y) {
    const double low = fastener.box.low.y, high = fastener.box.high.y;
    if (&fastener != &s.parts.bolt || s.joint.design.form == joint::JointForm::stud) return {low, high};
    const bool head_up = s.joint.design.turned == joint::TurnedPart::head;
    const Fastener& washer = s.parts.washer_head;
    const double face = head_up ? s.parts.turned.box.low.y : washer.exists() ? washer.box.low.y : -s.grip();
    if (head_up ? y > face - contact_tolerance : y > face + contact_tolerance) return {face, high};
    return {low, face};
}

// Reports a part outside the joint that crosses the fastener after shrinking it by the contact tolerance.
// `reported`: parts that already have an error.
void check_overlaps(const JointCheck& s, const Fastener& fastener, const std::set<std::uint32_t>& reported) {
    if (!fastener.exists()) return;
    std::vector<Triangle> smaller = fastener.triangles;
    for (Triangle& t : smaller)
        for (Vec3* p : {&t.a, &t.b, &t.c}) {
            const double radius = std::hypot(p->x, p->z);
            const double in = radius > contact_tolerance ? 1.0 - contact_tolerance / radius : 0.0;
            const auto [low, high] = section_around(s, fastener, p->y);
            const double y =
                p->y - std::clamp(p->y - 0.5 * (low + high), -contact_tolerance, contact_tolerance);
            *p = Vec3(s.parts.to_assembly * glm::dvec4(p->x * in, y, p->z * in, 1.0));
        }
    const auto hit =
        first_crossing(s.everything, Bvh(std::move(smaller)), RigidMotion{},
                       [&](std::uint32_t part) { return s.parts.owns(part) || reported.contains(part); });
    if (hit)
        s.error(fmt::format("{} overlaps {}", content::in_quotes(fastener.name),
                            s.name_of(s.everything.triangles()[*hit].part)),
                "parts that do not overlap");
}

// Notes a thread that is drawn in the other direction than the file names. The lesson works nevertheless.
void check_drawn_thread(const JointCheck& s, const Fastener& fastener) {
    const auto drawn = measure_drawn_thread(fastener.triangles, s.size().d);
    const joint::ThreadDirection named = s.joint.design.thread_direction;
    if (drawn && drawn->direction != named)
        s.messages.note(joint_pointer(s.index),
                        fmt::format("{} is drawn with a {}-hand thread, but \"thread_direction\" is \"{}\"",
                                    content::in_quotes(fastener.name), name(drawn->direction), name(named)));
}

// Reports an axis that points to the wrong end of a through-bolt, because all further findings follow from
// it. Returns true after an error.
bool axis_points_to_other_end(const JointCheck& s) {
    const joint::JointDesign& design = s.joint.design;
    if (design.form != joint::JointForm::through_bolt || !s.parts.nut.exists()) return false;
    const bool head_is_turned = design.turned == joint::TurnedPart::head;
    const bool nut_is_at_the_axis = s.parts.nut.box.middle().y > -0.5 * s.grip();
    if (head_is_turned != nut_is_at_the_axis) return false;
    s.error(fmt::format("the axis points from the members to the {}, but the {} is turned",
                        head_is_turned ? "nut" : "head", head_is_turned ? "head" : "nut"),
            fmt::format("position_mm and axis at the {}, also of the node, or \"turned\": \"{}\"",
                        head_is_turned ? "head" : "nut", head_is_turned ? "nut" : "head"));
    return true;
}

}  // namespace

bool check_fasteners_and_members(const content::AssemblyJoint& joint, std::size_t index,
                                 const JointParts& parts, const FlattenedModel& scene, const Bvh& everything,
                                 std::span<const JawOpening> jaws, const Messages& messages) {
    const JointCheck s{joint, index, parts, scene, everything, messages};
    if (axis_points_to_other_end(s)) return false;
    check_presence(s, parts.bolt, true);
    check_presence(s, parts.washer_head, joint.design.washer_under_head);
    check_presence(s, parts.washer_nut, joint.design.washer_under_nut);
    if (joint.design.form != joint::JointForm::tapped_hole) check_presence(s, parts.nut, true);
    if (joint.design.is_tapped())
        check_tapped_members(s);
    else
        check_members(s);
    const std::set<std::uint32_t> tight = check_hole(s);
    const std::set<std::uint32_t> tapped = check_far_end(s);
    const bool gripped = parts.turned.exists() && check_turned_hexagon(s, jaws);
    const Fastener& washer = parts.turned_washer;
    const std::string member = fmt::format("the member under the {}", s.turned_name());
    if (washer.exists()) {
        check_seat(s, washer.name, washer.box.low.y, member, 0.0);
        if (parts.turned.exists())
            check_seat(s, parts.turned.name, parts.turned.box.low.y, content::in_quotes(washer.name),
                       washer.box.high.y);
    } else if (parts.turned.exists()) {
        check_seat(s, parts.turned.name, parts.turned.box.low.y, member, 0.0);
    }
    for (const Fastener* fastener : {&parts.bolt, &parts.nut}) check_drawn_thread(s, *fastener);
    // The thread of a screw or a stud may overlap the part that it is screwed into.
    std::set<std::uint32_t> accepted = tight;
    accepted.insert(tapped.begin(), tapped.end());
    check_overlaps(s, parts.bolt, accepted);
    for (const Fastener* fastener : {&parts.washer_head, &parts.washer_nut, &parts.nut})
        check_overlaps(s, *fastener, tight);
    return gripped;
}

}  // namespace bolt::geometry
