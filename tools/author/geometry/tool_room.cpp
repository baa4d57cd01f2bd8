#include "tools/author/geometry/tool_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tools/author/geometry/approach.hpp"
#include "tools/author/geometry/joint_tools.hpp"

namespace bolt::geometry {

namespace {

constexpr double least_turned_over = to_radians(30.0);  // for a 15° head that is turned over after a stroke
constexpr double min_arc = to_radians(5.0);             // narrower free arcs are ignored
constexpr double clearance = 0.2 * mm;                  // between an open end and the face under the nut
constexpr double exit_clearance = 1.0 * mm;             // between a head and the end of the bolt
constexpr double all_heights = std::numeric_limits<double>::infinity();
constexpr double far_enough = 3.0;  // radius of the obstacles / reach of the tool

// Appends the angles of the head in every free arc. Ignores arcs that are too narrow to bring a tool into.
void add_head_angles(const FreeSwing& swing, double head_angle,
                     std::vector<std::pair<double, double>>& angles) {
    for (const Arc& arc : swing.arcs)
        if (arc.width() > min_arc) angles.emplace_back(arc.from + head_angle, arc.to + head_angle);
}

// m, the lower end of a head that reaches over or into the part, in the tool's frame.
double lower_end(const collision::ToolHead& head) {
    if (const auto* key = std::get_if<collision::HexKey>(&head)) return key->tip;
    if (const auto* ring = std::get_if<collision::Ring>(&head)) return ring->low;
    return 0.0;
}

}  // namespace

SwingRule swing_rule(const ToolGeometry& tool) {
    const double period = collision::fitting_angle(tool.head);
    if (tool.is_open_end()) return {least_turned_over, period};
    return {collision::tooth_angle(tool.head) > 0.0 ? 2.0 * period : period, period};
}

bool can_turn_fully(const SwingPair& swings, const ToolGeometry& tool, bool one_way_up) {
    const double period = swing_rule(tool).period, head_angle = tool.head_angle;
    std::vector<std::pair<double, double>> plain, over;
    add_head_angles(swings.plain, head_angle, plain);
    add_head_angles(swings.turned_over, -head_angle, over);
    if (one_way_up) return covers_period(plain, period) || covers_period(over, period);
    plain.insert(plain.end(), over.begin(), over.end());
    return covers_period(plain, period);
}

bool is_enough(const SwingPair& swings, const ToolGeometry& tool) {
    return swings.most() >= swing_rule(tool).least && can_turn_fully(swings, tool, false);
}

double JointSurroundings::height_of(const ToolGeometry& tool) const {
    const double low = parts_.turned.box.low.y, high = parts_.turned.box.high.y;
    if (!tool.is_open_end()) return low + collision::grip_height(tool.head, shape_of(joint_.design));
    return std::max(0.5 * (low + high), low + tool.half_thickness + clearance);
}

std::uint32_t JointSurroundings::find_path(const ToolGeometry& tool, const ToolRoom& room, const Bvh& plain,
                                           const Bvh& over) const {
    const double low = room.height + (tool.is_open_end() ? std::min(plain.box().low.y, over.box().low.y)
                                                         : plain.box().low.y);
    const Obstacles around = obstacles_.near_axis(far_enough * tool.reach, low, all_heights);
    if (!tool.is_open_end()) {
        const double end = std::max(parts_.turned.box.high.y, parts_.bolt.box.high.y) + exit_clearance;
        const double lift = std::max(end - room.height - lower_end(tool.head), 0.0);
        return find_obstruction(around, plain, room.seated.plain, AxialExit{room.height, lift, tool.reach});
    }
    ExitPaths paths{room.height, tool.head_angle, tool.head_size, tool.reach};
    const std::uint32_t blocked = find_obstruction(around, plain, room.seated.plain, paths);
    paths.jaw_angle = -tool.head_angle;
    return blocked == no_part ? no_part : find_obstruction(around, over, room.seated.turned_over, paths);
}

ToolRoom JointSurroundings::room_for(const ToolGeometry& tool) const {
    const bool reversible = tool.is_open_end();
    const Bvh plain = place_on_joint(tool, false), over = reversible ? place_on_joint(tool, true) : Bvh();
    ToolRoom room;
    room.height = height_of(tool);
    const auto swings_at = [&](double height) {
        SwingPair swings{find_free_swing(obstacles_, plain, height), {}, reversible};
        if (reversible) swings.turned_over = find_free_swing(obstacles_, over, height);
        return swings;
    };
    const double gap = joint_.design.start_gap;
    room.seated = swings_at(room.height);
    if (gap > 1.0 * mm) room.at_start = swings_at(room.height + gap);
    if (room.seated.most() > 0.0) room.obstruction = find_path(tool, room, plain, over);
    room.is_sufficient = is_enough(room.seated, tool) &&
                         (!room.at_start || is_enough(*room.at_start, tool)) && room.obstruction == no_part;
    return room;
}

}  // namespace bolt::geometry
