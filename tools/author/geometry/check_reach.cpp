// The room for a wrench on the nut of one joint.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/scene.hpp"
#include "tools/author/geometry/wrench.hpp"
#include "tools/author/geometry/wrench_room.hpp"

namespace bolt::geometry {

namespace {

constexpr double hexagon_turn = to_radians(60.0);  // between two grips on the nut
constexpr double min_swing = to_radians(30.0);     // for a 15° head that is turned over after every stroke
constexpr double min_arc = to_radians(5.0);        // narrower free arcs are ignored
constexpr double clearance = 0.2 * mm;             // between the wrench and the face under the nut

// The swing of a wrench as it is and turned over.
struct SwingPair {
    FreeSwing plain, turned_over;

    [[nodiscard]] double width(const FreeSwing& swing) const {
        const Arc* arc = swing.widest();
        return arc != nullptr ? arc->width() : 0.0;
    }
    [[nodiscard]] double most() const { return std::max(width(plain), width(turned_over)); }
    [[nodiscard]] double least() const { return std::min(width(plain), width(turned_over)); }
    [[nodiscard]] bool is_wider_turned_over() const { return width(turned_over) > width(plain); }
    [[nodiscard]] const FreeSwing& wider() const { return is_wider_turned_over() ? turned_over : plain; }
};

// A wrench on the turned part of one joint, either way up, and what is around it, in the joint's frame.
struct WrenchOnJoint {
    double seated = 0.0;  // m, height of the wrench on the tightened joint
    Bvh plain, over, around;

    WrenchOnJoint(const JointParts& parts, const FlattenedModel& scene, const WrenchShape& wrench)
        : plain(place_on_nut(wrench, false)), over(place_on_nut(wrench, true)) {
        const double low = parts.turned.box.low.y, high = parts.turned.box.high.y;
        seated = std::max(0.5 * (low + high), low + wrench.half_thickness + clearance);
        const double lowest = seated + std::min(plain.box().low.y, over.box().low.y);
        around = Bvh(nearby_triangles(scene, parts.to_joint, 3.0 * wrench.reach, lowest, parts.turned.parts));
    }
    [[nodiscard]] SwingPair swings_at(double height) const {
        return {find_free_swing(around, plain, height), find_free_swing(around, over, height)};
    }
};

// Appends the jaw angles of every free arc. Ignores arcs that are too narrow to bring a wrench into.
void add_jaw_angles(const FreeSwing& swing, double head_angle,
                    std::vector<std::pair<double, double>>& angles) {
    for (const Arc& arc : swing.arcs)
        if (arc.width() > min_arc) angles.emplace_back(arc.from + head_angle, arc.to + head_angle);
}

// Returns true if the wrench can grip the nut in every orientation of the nut, and can therefore turn it
// without limit. Jaw angles repeat every 60°. `one_way_up`: without turning the wrench over.
bool can_turn_fully(const SwingPair& swings, double head_angle, bool one_way_up) {
    std::vector<std::pair<double, double>> plain, over;
    add_jaw_angles(swings.plain, head_angle, plain);
    add_jaw_angles(swings.turned_over, -head_angle, over);
    if (one_way_up) return covers_period(plain, hexagon_turn) || covers_period(over, hexagon_turn);
    plain.insert(plain.end(), over.begin(), over.end());
    return covers_period(plain, hexagon_turn);
}

std::string name_of(const FlattenedModel& scene, std::uint32_t part) {
    return part < scene.parts.size() ? content::in_quotes(scene.parts[part].name) : "no part";
}

std::string describe_limits(const FlattenedModel& scene, const FreeSwing& swing) {
    const Arc* arc = swing.widest();
    if (arc == nullptr) return fmt::format("{} is in its way", name_of(scene, swing.blocking));
    if (arc->before == arc->after) return fmt::format("{} is on both sides", name_of(scene, arc->before));
    return fmt::format("between {} and {}", name_of(scene, arc->before), name_of(scene, arc->after));
}

std::string in_degrees(const SwingPair& swings) {
    std::string text = fmt::format("{:.1f} degrees", to_degrees(swings.most()));
    if (to_degrees(swings.most() - swings.least()) > 0.1)
        text += fmt::format(" ({:.1f} the other way up)", to_degrees(swings.least()));
    return text;
}

// Reports too little swing. `where`: "nut" or "head", with " where it starts, 21 mm above its seat".
void check_swing(const SwingPair& swings, const WrenchShape& wrench, std::size_t index,
                 const std::string& where, const FlattenedModel& scene, const Messages& messages) {
    const double head_angle = std::abs(wrench.head_angle);
    const std::string place = describe_limits(scene, swings.wider());
    if (swings.most() < min_swing || !can_turn_fully(swings, head_angle, false)) {
        messages.error(joint_pointer(index),
                       fmt::format("{} has {} of free swing on the {}: {}", wrench.name, in_degrees(swings),
                                   where, place),
                       // If the swing is enough either way up, the head limits the wrench, at the same jaw
                       // angles either way up, so that turning it over gains nothing.
                       head_angle < to_radians(1.0) || swings.least() >= min_swing
                           ? "60 degrees: turning the wrench over gains nothing here"
                           : "30 degrees or more both ways up, or 60 one way up");
    } else if (!can_turn_fully(swings, head_angle, true)) {
        messages.note(joint_pointer(index),
                      fmt::format("{} has {} of free swing on the {}, {}: it has to be turned over "
                                  "after every stroke",
                                  wrench.name, in_degrees(swings), where, place));
    }
}

// Requires a turned part with a hexagon.
void fill_in(WrenchRoom& room, const JointParts& parts, const WrenchShape& wrench, double height,
             const SwingPair& swings) {
    room.gripped = true;
    room.height = height;
    room.turned_over = swings.is_wider_turned_over();
    room.swing = swings.wider();
    if (const Arc* arc = room.swing.widest()) room.handle = 0.5 * (arc->from + arc->to);
    // Angles about +Y run from +X towards -Z. The flats of the jaw are parallel to the jaw.
    const double jaw = room.handle + (room.turned_over ? -1.0 : 1.0) * wrench.head_angle;
    if (const auto hexagon = measure_hexagon(parts.turned.triangles))
        room.turn = wrap(jaw + 0.5 * pi + hexagon->flat_angle, hexagon_turn);
}

}  // namespace

void check_wrench(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                  const FlattenedModel& scene, const WrenchShape& wrench, const Messages& messages,
                  WrenchRoom* room) {
    const WrenchOnJoint placed(parts, scene, wrench);
    const SwingPair swings = placed.swings_at(placed.seated);
    if (room != nullptr) fill_in(*room, parts, wrench, placed.seated, swings);
    const std::string turned = joint.design.turned == joint::TurnedPart::head ? "head" : "nut";
    check_swing(swings, wrench, index, turned, scene, messages);
    if (joint.design.start_gap > 1.0 * mm)
        check_swing(
            placed.swings_at(placed.seated + joint.design.start_gap), wrench, index,
            fmt::format("{} where it starts, {:.3g} mm above its seat", turned, joint.design.start_gap / mm),
            scene, messages);
    if (swings.most() <= 0.0) return;  // already reported
    ExitPaths paths{placed.seated, wrench.head_angle, wrench.head_size, wrench.reach};
    std::uint32_t blocked = find_obstruction(placed.around, placed.plain, swings.plain, paths);
    paths.jaw_angle = -wrench.head_angle;
    if (blocked != no_part) blocked = find_obstruction(placed.around, placed.over, swings.turned_over, paths);
    if (blocked != no_part)
        messages.error(joint_pointer(index),
                       fmt::format("{} cannot be brought onto the {}, neither along the bolt nor from "
                                   "the side: {} is in its way",
                                   wrench.name, turned, name_of(scene, blocked)),
                       "a free path");
}

}  // namespace bolt::geometry
