#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

namespace {

constexpr double offset_tolerance = 0.01 * mm;   // of nut and hole from the joint's axis
constexpr double contact_tolerance = 0.05 * mm;  // penetration or gap of two parts that should touch
constexpr double length_tolerance = 0.1 * mm;
constexpr double nut_play = 0.5 * mm;  // ISO 4032 lets the width across flats be smaller by up to 2 %
constexpr double jaw_play = 0.6 * mm;  // a jaw may be wider than the nut by this

// One joint, and what its checks need.
struct JointCheck {
    const content::AssemblyJoint& joint;
    std::size_t index;
    const JointParts& parts;
    const FlattenedModel& scene;
    const Bvh& everything;
    const Messages& messages;

    void error(std::string what, std::string expected) const {
        messages.error(joint_pointer(index), std::move(what), std::move(expected));
    }
    [[nodiscard]] const joint::FastenerSize& size() const { return joint.design.thread.size; }
    [[nodiscard]] double across_flats() const { return joint::turned_part_size(joint.design).across_flats; }
    [[nodiscard]] const char* turned_name() const {
        return joint.design.turned == joint::TurnedPart::head ? "head" : "nut";
    }
    [[nodiscard]] double grip() const {  // m, of the members
        double sum = 0.0;
        for (const joint::Member& member : joint.design.members) sum += member.thickness;
        return sum;
    }
    [[nodiscard]] std::string name_of(std::uint32_t part) const {
        return content::in_quotes(scene.parts[part].name);
    }
    // Casts a ray, given in the joint's frame, that ignores the joint's own fasteners.
    [[nodiscard]] std::optional<RayHit> ray(const Vec3& origin, const Vec3& direction, double reach) const {
        return first_hit(everything, Vec3(parts.to_assembly * glm::dvec4(origin, 1.0)),
                         glm::normalize(Vec3(parts.to_assembly * glm::dvec4(direction, 0.0))), reach,
                         [this](std::uint32_t part) { return parts.owns(part); });
    }
};

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
void check_jaw(const JointCheck& s, const content::Tool& tool, bool is_default, double flats) {
    const std::string owner =
        is_default ? std::string{} : fmt::format(" (the tool {})", content::in_quotes(tool.name));
    const std::string name = content::in_quotes(s.parts.turned.name);
    const double jaw = tool.wrench.jaw;
    const auto report = [&](const char* how) {
        s.error(fmt::format("a jaw of {:g} mm{} is too {} for {}, {:.2f} mm across flats", jaw / mm, owner,
                            how, name, flats / mm),
                fmt::format("jaw_mm from {:.2f} to {:.2f}", flats / mm, (flats + jaw_play) / mm));
    };
    if (jaw < flats - 1e-6)
        report("small");
    else if (jaw > flats + jaw_play + 1e-6)
        report("wide");
}

// Checks the hexagon of the nut or of the head that is turned.
bool check_hexagon(const JointCheck& s, std::span<const content::Tool> tools) {
    if (joint::turned_part_size(s.joint.design).depth > 0.0) {
        s.messages.note(joint_pointer(s.index),
                        fmt::format("{} has a socket head, and a lesson has no hexagon key yet",
                                    content::in_quotes(s.parts.turned.name)));
        return false;
    }
    const auto hexagon = measure_hexagon(s.parts.turned.triangles);
    if (!hexagon || hexagon->unevenness > 0.1 * mm) {
        s.error(fmt::format("{} is not a hexagon about the joint's axis",
                            content::in_quotes(s.parts.turned.name)),
                fmt::format("a hexagon {}, {:g} mm across flats", s.turned_name(), s.across_flats() / mm));
        return false;
    }
    const double flats = hexagon->across_flats, off = std::hypot(hexagon->centre.x, hexagon->centre.z);
    const std::string name = content::in_quotes(s.parts.turned.name);
    if (off > offset_tolerance)
        s.error(fmt::format("{} is {:.3g} mm beside the joint's axis", name, off / mm), "at most 0.01 mm");
    if (flats > s.across_flats() + contact_tolerance || flats < s.across_flats() - nut_play)
        s.error(fmt::format("{} measures {:.2f} mm across flats", name, flats / mm),
                fmt::format("{:g} mm for {}", s.across_flats() / mm, s.size().name));
    for (const content::Tool& tool : tools) check_jaw(s, tool, &tool == tools.data(), flats);
    return true;
}

// Reports a gap or a penetration between the part `upper`, which begins at the height `bottom`, and the part
// `lower`, which ends at the height `level` (m, along the axis).
void check_seat(const JointCheck& s, const std::string& upper, double bottom, const std::string& lower,
                double level) {
    const double gap = bottom - level;
    if (std::abs(gap) <= contact_tolerance) return;
    if (gap < 0.0)
        s.error(fmt::format("{} is {:.2f} mm deep in {}", content::in_quotes(upper), -gap / mm, lower),
                "the two faces in contact");
    else
        s.error(fmt::format("{} is {:.2f} mm away from {}", content::in_quotes(upper), gap / mm, lower),
                "the two faces in contact");
}

struct FaceHit {
    double distance = 0.0;  // m
    std::uint32_t part = 0;
};

// Casts rays from a ring about the axis at `height` along ±Y and returns the hit at the median distance;
// nullopt if fewer than half of them hit.
std::optional<FaceHit> find_face(const JointCheck& s, double radius, double height, double direction,
                                 double reach) {
    constexpr int rays = 24;
    std::vector<FaceHit> hits;
    for (int i = 0; i < rays; ++i) {
        const double angle = (i + 0.5) * 2.0 * pi / rays;
        const Vec3 origin{radius * std::cos(angle), height, radius * std::sin(angle)};
        if (const auto hit = s.ray(origin, {0.0, direction, 0.0}, reach))
            hits.push_back({hit->distance, s.everything.triangles()[hit->triangle].part});
    }
    if (hits.size() < rays / 2) return std::nullopt;
    std::sort(hits.begin(), hits.end(),
              [](const FaceHit& a, const FaceHit& b) { return a.distance < b.distance; });
    return hits[hits.size() / 2];
}

// Height of the bearing face under the head: the highest point wider than the shank and its fillet; nullopt
// without a head.
std::optional<double> head_underside(const JointCheck& s) {
    std::optional<double> top;
    for (const Triangle& t : s.parts.bolt.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (std::hypot(p.x, p.z) > 0.62 * s.size().d && p.y < 0.0) top = std::max(top.value_or(p.y), p.y);
    return top;
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

struct CircleFit {
    double x = 0.0, z = 0.0, radius = 0.0, residual = 0.0;  // m; residual: largest radial distance
};

// Least-squares circle (I. Kåsa, 1976): minimises the sum of (x² + z² + ax + bz + c)². Returns nullopt for
// fewer than six points or points on a line.
std::optional<CircleFit> fit_circle(const std::vector<Vec3>& points) {
    glm::dmat3 m(0.0);
    Vec3 right(0.0);
    for (const Vec3& p : points) {
        const Vec3 row{p.x, p.z, 1e-2};  // the constant is scaled to the size of a hole
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) m[k][i] += row[i] * row[k];
        right -= (p.x * p.x + p.z * p.z) * row;
    }
    if (points.size() < 6 || std::abs(glm::determinant(m)) < 1e-30) return std::nullopt;
    const Vec3 abc = glm::inverse(m) * right;
    CircleFit circle;
    circle.x = -0.5 * abc.x;
    circle.z = -0.5 * abc.y;
    circle.radius = std::sqrt(std::max(circle.x * circle.x + circle.z * circle.z - 1e-2 * abc.z, 0.0));
    for (const Vec3& p : points)
        circle.residual =
            std::max(circle.residual, std::abs(std::hypot(p.x - circle.x, p.z - circle.z) - circle.radius));
    return circle;
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
            const Triangle& t = s.everything.triangles()[hit->triangle];
            for (const Vec3& p : {t.a, t.b, t.c})
                walls[t.part].push_back(Vec3(s.parts.to_joint * glm::dvec4(p, 1.0)));
        }
    for (const auto& [part, points] : walls) {
        const auto circle = fit_circle(points);
        if (!circle || circle->residual > offset_tolerance)
            continue;  // no round hole: check_overlaps() finds overlaps
        const double off = std::hypot(circle->x, circle->z);
        if (2.0 * circle->radius < s.size().d) {
            tight.insert(part);
            s.error(fmt::format("the hole in {} measures {:.2f} mm, and the bolt {:g} mm", s.name_of(part),
                                2.0 * circle->radius / mm, s.size().d / mm),
                    fmt::format("{:g} mm (ISO 273 medium)", s.size().hole / mm));
        } else if (off > offset_tolerance)
            s.error(
                fmt::format("the hole in {} is {:.3g} mm beside the joint's axis", s.name_of(part), off / mm),
                "at most 0.01 mm");
    }
    return tight;
}

void check_bolt(const JointCheck& s) {
    const auto underside = head_underside(s);
    if (!underside) {
        s.error(fmt::format("{} has no head on the other side of the members",
                            content::in_quotes(s.parts.bolt.name)),
                "the head at -Y of the joint's node");
        return;
    }
    double radius = 0.0;
    for (const Triangle& t : s.parts.bolt.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (p.y > *underside + 0.1 * s.joint.design.bolt_length)
                radius = std::max(radius, std::hypot(p.x, p.z));
    if (std::abs(2.0 * radius - s.size().d) > 0.3 * mm)
        s.error(fmt::format("{} measures {:.2f} mm across its thread", content::in_quotes(s.parts.bolt.name),
                            2.0 * radius / mm),
                fmt::format("{:g} mm for {}", s.size().d / mm, s.size().name));
    const double length = s.parts.bolt.box.high.y - *underside;
    if (std::abs(length - s.joint.design.bolt_length) > length_tolerance)
        s.error(fmt::format("{} measures {:.2f} mm under its head", content::in_quotes(s.parts.bolt.name),
                            length / mm),
                fmt::format("{:g} mm (bolt_length_mm)", s.joint.design.bolt_length / mm));
    const double grip = s.grip();
    // These faces look along -Y, so all heights are negated.
    if (s.parts.washer_head.exists()) {
        check_seat(s, s.parts.bolt.name, -*underside, content::in_quotes(s.parts.washer_head.name),
                   -s.parts.washer_head.box.low.y);
        check_seat(s, s.parts.washer_head.name, -s.parts.washer_head.box.high.y, "the member under the head",
                   grip);
    } else {
        check_seat(s, s.parts.bolt.name, -*underside, "the member under the head", grip);
    }
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

// The parts around the end of a screw or a stud in its tapped hole.
std::set<std::uint32_t> parts_around_end(const JointCheck& s) {
    constexpr int rays = 12;
    constexpr double widest = 1.02;  // of the hole, in diameters; import-step accepts 1.01
    std::set<std::uint32_t> found;
    if (!s.joint.design.is_tapped()) return found;
    const double height = -s.grip() - 0.5 * s.joint.design.hole.engagement;
    for (int i = 0; i < rays; ++i) {
        const double angle = (i + 0.5) * 2.0 * pi / rays;
        if (const auto hit =
                s.ray({0.0, height, 0.0}, {std::cos(angle), 0.0, std::sin(angle)}, 0.5 * widest * s.size().d))
            found.insert(s.everything.triangles()[hit->triangle].part);
    }
    if (found.empty())
        s.error(fmt::format("no hole is around the end of {}", content::in_quotes(s.parts.bolt.name)),
                fmt::format("the tapped hole, at most {:g} mm wide", widest * s.size().d / mm));
    return found;
}

// Checks the thread and the length of a screw in a tapped hole.
void check_screw(const JointCheck& s) {
    const auto& design = s.joint.design;
    const double face = s.parts.turned.box.low.y;
    double radius = 0.0;
    for (const Triangle& t : s.parts.bolt.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (p.y < face - 0.1 * design.bolt_length) radius = std::max(radius, std::hypot(p.x, p.z));
    if (std::abs(2.0 * radius - s.size().d) > 0.3 * mm)
        s.error(fmt::format("{} measures {:.2f} mm across its thread", content::in_quotes(s.parts.bolt.name),
                            2.0 * radius / mm),
                fmt::format("{:g} mm for {}", s.size().d / mm, s.size().name));
    const double length = face - s.parts.bolt.box.low.y;
    if (std::abs(length - design.bolt_length) > length_tolerance)
        s.error(fmt::format("{} measures {:.2f} mm under its head", content::in_quotes(s.parts.bolt.name),
                            length / mm),
                fmt::format("{:g} mm (bolt_length_mm)", design.bolt_length / mm));
}

// Reports a part outside the joint that crosses the fastener after shrinking it by the contact tolerance.
// `reported`: parts that already have an error.
void check_overlaps(const JointCheck& s, const Fastener& fastener, const std::set<std::uint32_t>& reported) {
    if (!fastener.exists()) return;
    std::vector<Triangle> smaller = fastener.triangles;
    const double middle = fastener.box.middle().y;
    for (Triangle& t : smaller)
        for (Vec3* p : {&t.a, &t.b, &t.c}) {
            const double radius = std::hypot(p->x, p->z);
            const double in = radius > contact_tolerance ? 1.0 - contact_tolerance / radius : 0.0;
            const double y = p->y - std::clamp(p->y - middle, -contact_tolerance, contact_tolerance);
            *p = Vec3(s.parts.to_assembly * glm::dvec4(p->x * in, y, p->z * in, 1.0));
        }
    const auto hit =
        first_crossing(s.everything, Bvh(std::move(smaller)), TurnAboutY{},
                       [&](std::uint32_t part) { return s.parts.owns(part) || reported.contains(part); });
    if (hit)
        s.error(fmt::format("{} overlaps {}", content::in_quotes(fastener.name),
                            s.name_of(s.everything.triangles()[*hit].part)),
                "parts that do not overlap");
}

}  // namespace

bool check_fasteners_and_members(const content::AssemblyJoint& joint, std::size_t index,
                                 const JointParts& parts, const FlattenedModel& scene, const Bvh& everything,
                                 std::span<const content::Tool> tools, const Messages& messages) {
    const JointCheck s{joint, index, parts, scene, everything, messages};
    using joint::JointForm;
    const JointForm form = joint.design.form;
    const bool nut_turned = joint.design.turned == joint::TurnedPart::nut;
    check_presence(s, parts.bolt, true);
    check_presence(s, parts.washer_head, joint.design.washer_under_head);
    check_presence(s, parts.washer_nut, joint.design.washer_under_nut);
    if (form != JointForm::tapped_hole) check_presence(s, parts.nut, true);
    if (joint.design.is_tapped())
        check_tapped_members(s);
    else
        check_members(s);
    const std::set<std::uint32_t> tight = check_hole(s);
    if (parts.bolt.exists() && parts.turned.exists() && form == JointForm::tapped_hole) check_screw(s);
    if (parts.bolt.exists() && form == JointForm::through_bolt && nut_turned) check_bolt(s);
    const bool gripped = parts.turned.exists() && check_hexagon(s, tools);
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
    // The thread of a screw or a stud may overlap the part that it is screwed into.
    std::set<std::uint32_t> accepted = tight;
    accepted.merge(parts_around_end(s));
    check_overlaps(s, parts.bolt, accepted);
    for (const Fastener* fastener : {&parts.washer_head, &parts.washer_nut, &parts.nut})
        check_overlaps(s, *fastener, tight);
    return gripped;
}

}  // namespace bolt::geometry
