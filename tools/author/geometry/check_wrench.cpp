#include "tools/author/geometry/check_wrench.hpp"

#include <algorithm>

#include "tools/author/geometry/reach.hpp"
#include "tools/author/geometry/swing.hpp"

namespace bolt::geometry {

namespace {

constexpr double hexagon_turn = to_radians(60.0);  // from one grip of the nut to the next
constexpr double least_swing = to_radians(30.0);   // with a head at 15°, turned over after every stroke
constexpr double least_gap = to_radians(5.0);
constexpr double clearance = 0.2 * mm;  // of a wrench that lies on what is under the nut

struct Swings {
    Swing plain, turned_over;

    [[nodiscard]] double width(const Swing& swing) const {
        const Arc* arc = swing.widest();
        return arc != nullptr ? arc->width() : 0.0;
    }
    [[nodiscard]] double most() const { return std::max(width(plain), width(turned_over)); }
    [[nodiscard]] double least() const { return std::min(width(plain), width(turned_over)); }
    [[nodiscard]] const Swing& wider() const {
        return width(turned_over) > width(plain) ? turned_over : plain;
    }
};

// Where the jaw points, for every angle of the handle that is free. Gaps that nobody threads a wrench into do
// not count.
void add_jaw_angles(const Swing& swing, double head_angle, std::vector<std::pair<double, double>>& angles) {
    for (const Arc& arc : swing.arcs)
        if (arc.width() > least_gap) angles.emplace_back(arc.from + head_angle, arc.to + head_angle);
}

// The nut can be turned on and on when some grip is free wherever it stands: jaw angles repeat every 60°.
bool turns_on(const Swings& swings, double head_angle, bool one_way_up) {
    std::vector<std::pair<double, double>> plain, over;
    add_jaw_angles(swings.plain, head_angle, plain);
    add_jaw_angles(swings.turned_over, -head_angle, over);
    if (one_way_up) return cover(plain, hexagon_turn) || cover(over, hexagon_turn);
    plain.insert(plain.end(), over.begin(), over.end());
    return cover(plain, hexagon_turn);
}

std::string name_of(const Scene& scene, std::uint32_t part) {
    return part < scene.parts.size() ? content::in_quotes(scene.parts[part].name) : "nothing";
}

std::string between(const Scene& scene, const Swing& swing) {
    const Arc* arc = swing.widest();
    if (arc == nullptr) return fmt::format("{} is in its way", name_of(scene, swing.blocking));
    if (arc->before == arc->after) return fmt::format("{} is on both sides", name_of(scene, arc->before));
    return fmt::format("between {} and {}", name_of(scene, arc->before), name_of(scene, arc->after));
}

std::string in_degrees(const Swings& swings) {
    std::string text = fmt::format("{:.1f} degrees", to_degrees(swings.most()));
    if (to_degrees(swings.most() - swings.least()) > 0.1)
        text += fmt::format(" ({:.1f} the other way up)", to_degrees(swings.least()));
    return text;
}

// `where`: " at the start, 21 mm above its seat", or nothing.
void judge(const Swings& swings, const Wrench& wrench, std::size_t index, const std::string& where,
           const Scene& scene, const Messages& messages) {
    const double head_angle = std::abs(wrench.head_angle);
    const std::string place = between(scene, swings.wider());
    if (swings.most() < least_swing || !turns_on(swings, head_angle, false)) {
        messages.error(joint_pointer(index),
                       fmt::format("{} has {} of free swing on the nut{}: {}", wrench.name,
                                   in_degrees(swings), where, place),
                       // With room both ways up it is the head that stops it, at the same angles of the jaw.
                       head_angle < to_radians(1.0) || swings.least() >= least_swing
                           ? "expected 60 degrees: the wrench gains nothing here by being turned over"
                           : "expected 30 degrees or more both ways up, or 60 one way up");
    } else if (!turns_on(swings, head_angle, true)) {
        messages.note(joint_pointer(index),
                      fmt::format("{} has {} of free swing on the nut{}, {}: it has to be turned over "
                                  "after every stroke",
                                  wrench.name, in_degrees(swings), where, place));
    }
}

}  // namespace

void check_wrench(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                  const Scene& scene, const Wrench& wrench, const Messages& messages) {
    const double low = parts.nut.box.low.y, high = parts.nut.box.high.y;
    const double seated = std::max(0.5 * (low + high), low + wrench.half_thickness + clearance);
    const Bvh plain = posed(wrench, false), over = posed(wrench, true);
    const double lowest = seated + std::min(plain.box().low.y, over.box().low.y);
    const Bvh around(surroundings(scene, parts.to_joint, 3.0 * wrench.reach, lowest, parts.nut.parts));
    const auto swings_at = [&](double height) {
        return Swings{free_swing(around, plain, height), free_swing(around, over, height)};
    };
    const Swings swings = swings_at(seated);
    judge(swings, wrench, index, "", scene, messages);
    if (joint.design.start_gap > 1.0 * mm)
        judge(swings_at(seated + joint.design.start_gap), wrench, index,
              fmt::format(" where it starts, {:.3g} mm above its seat", joint.design.start_gap / mm), scene,
              messages);
    if (swings.most() <= 0.0) return;  // said
    Approach approach{seated, wrench.head_angle, wrench.head_size, wrench.reach};
    std::uint32_t blocked = blocked_by(around, plain, swings.plain, approach);
    approach.jaw_angle = -wrench.head_angle;
    if (blocked != no_part) blocked = blocked_by(around, over, swings.turned_over, approach);
    if (blocked != no_part)
        messages.error(joint_pointer(index),
                       fmt::format("{} cannot be brought onto the nut, neither along the bolt nor from "
                                   "the side: {} is in its way",
                                   wrench.name, name_of(scene, blocked)),
                       "expected a free way for it");
}

}  // namespace bolt::geometry
