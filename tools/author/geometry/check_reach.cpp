// The room for the tools of one joint.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/drawn_tool_room.hpp"
#include "tools/author/geometry/joint_tools.hpp"
#include "tools/author/geometry/other_tools.hpp"

namespace bolt::geometry {

namespace {

constexpr double hexagon_turn = to_radians(60.0);  // between two fitting angles of an open end
constexpr double small_swing = to_radians(30.0);   // below this a ratchet gets a note

std::string describe_limits(const JointSurroundings& space, const FreeSwing& swing) {
    const Arc* arc = swing.widest();
    if (arc == nullptr) return fmt::format("{} is in its way", space.name_of(swing.blocking));
    if (arc->before == arc->after) return fmt::format("{} is on both sides", space.name_of(arc->before));
    return fmt::format("between {} and {}", space.name_of(arc->before), space.name_of(arc->after));
}

std::string in_degrees(const SwingPair& swings) {
    std::string text = fmt::format("{:.1f} degrees", to_degrees(swings.most()));
    if (swings.reversible && to_degrees(swings.most() - swings.least()) > 0.1)
        text += fmt::format(" ({:.1f} the other way up)", to_degrees(swings.least()));
    return text;
}

// The checks of one tool on one joint.
struct ToolCheck {
    const JointSurroundings& space;
    JointRooms& rooms;
    std::size_t joint, tool;  // indices
    const ToolGeometry& shape;
    const Messages& messages;

    [[nodiscard]] const char* turned() const {
        return space.joint().design.turned == joint::TurnedPart::head ? "head" : "nut";
    }
    // `expected`: a remedy besides another tool, which is appended; may be empty.
    void error(const std::string& what, std::string expected) const {
        const std::string other = rooms.describe_fitting_tool(tool);
        const bool nothing_fits = expected.empty() && other.empty();
        if (nothing_fits) expected = "a free path";
        if (!expected.empty() && !other.empty()) expected += ", or ";
        if (other.empty() && has_other_hexagon())
            expected += fmt::format(", or the head turned instead (bolt-author import-step --turn-heads {})",
                                    space.joint().design.id);
        if (nothing_fits) expected += "; no other tool of this size fits";
        messages.error(joint_pointer(joint), what, expected + other);
    }
    // True if the nut is turned, but a hexagon head is at the bolt's other end.
    [[nodiscard]] bool has_other_hexagon() const {
        const joint::JointDesign& design = space.joint().design;
        return design.form == joint::JointForm::through_bolt && design.turned == joint::TurnedPart::nut &&
               design.head == joint::HeadShape::hexagon;
    }
    // Both return false after an error.
    bool check_swing(const SwingPair& swings, const std::string& start) const;
    bool check_path(const ToolRoom& room) const;

  private:
    [[nodiscard]] std::string expected_swing(const SwingPair& swings) const;
};

std::string ToolCheck::expected_swing(const SwingPair& swings) const {
    const SwingRule rule = swing_rule(shape);
    if (collision::tooth_angle(shape.head) > 0.0)
        return fmt::format("{:.3g} degrees, two teeth of its ratchet", to_degrees(rule.least));
    if (!shape.is_open_end())
        return fmt::format("{:.3g} degrees, after which it fits again", to_degrees(rule.least));
    // If each way up has enough swing, both cover the same angles of the jaw, so that turning the wrench over
    // gains nothing.
    const bool gains_nothing = std::abs(shape.head_angle) < to_radians(1.0) || swings.least() >= rule.least;
    return gains_nothing ? "60 degrees: turning the wrench over gains nothing here"
                         : "30 degrees or more both ways up, or 60 one way up";
}

// `start`: empty, or " where it starts, 21 mm above its seat".
bool ToolCheck::check_swing(const SwingPair& swings, const std::string& start) const {
    const std::string place = describe_limits(space, swings.wider()), where = turned() + start;
    if (!shape.is_open_end() && swings.most() <= 0.0) {
        error(fmt::format("{} cannot be brought onto {}{}: {}", shape.name,
                          content::in_quotes(space.joint().design.id), start, place),
              "");
        return false;
    }
    const std::string swing =
        fmt::format("{} has {} of free swing on the {}", shape.name, in_degrees(swings), where);
    if (!is_enough(swings, shape)) {
        error(fmt::format("{}: {}", swing, place), expected_swing(swings));
        return false;
    }
    const auto note = [&](const std::string& what) {
        messages.note(joint_pointer(joint), fmt::format("{}, {}: {}", swing, place, what));
    };
    const double tooth = collision::tooth_angle(shape.head);
    if (shape.is_open_end() && !can_turn_fully(swings, shape, true))
        note("it has to be turned over after every stroke");
    else if (tooth > 0.0 && swings.most() < small_swing)
        note(fmt::format("{:.0f} teeth of its ratchet a stroke", std::floor(swings.most() / tooth)));
    return true;
}

bool ToolCheck::check_path(const ToolRoom& room) const {
    if (room.obstruction == no_part) return true;
    const std::string part = space.name_of(room.obstruction);
    if (shape.is_open_end())
        error(fmt::format("{} cannot be brought onto the {}, neither along the bolt nor from "
                          "the side: {} is in its way",
                          shape.name, turned(), part),
              "a free path");
    else
        error(fmt::format("{} cannot be brought onto {} along the bolt: {} is in its way", shape.name,
                          content::in_quotes(space.joint().design.id), part),
              "");
    return false;
}

// rad, of a flat of the hexagon or of the hexagonal socket that is turned.
std::optional<double> flat_angle(const JointSurroundings& space) {
    const Fastener& part = space.parts().turned;
    const joint::TurnedPartSize size = joint::turned_part_size(space.joint().design);
    std::vector<Triangle> triangles = part.triangles;
    if (size.depth > 0.0) {
        const double mouth = part.box.high.y, outside = 0.62 * size.across_flats;
        const auto is_outside = [&](const Vec3& p) {
            return p.y < mouth - 1.1 * size.depth || std::hypot(p.x, p.z) > outside;
        };
        std::erase_if(triangles, [&](const Triangle& t) {
            return is_outside(t.a) || is_outside(t.b) || is_outside(t.c);
        });
    }
    const auto hexagon = measure_hexagon(triangles);
    return hexagon ? std::optional(hexagon->flat_angle) : std::nullopt;
}

void fill_in(DrawnToolRoom& out, const JointSurroundings& space, const ToolGeometry& tool,
             const ToolRoom& room) {
    out.gripped = true;
    out.height = room.height;
    out.obstruction = room.obstruction;
    out.turned_over = room.seated.is_wider_turned_over();
    out.swing = room.seated.wider();
    out.handle = 0.0;  // `out` may be a copy of another tool's
    if (const Arc* arc = out.swing.widest()) out.handle = 0.5 * (arc->from + arc->to);
    // Angles about +Y run from +X towards -Z. The head's direction lies along a corner of the hexagon.
    const double head = out.handle + (out.turned_over ? -1.0 : 1.0) * tool.head_angle;
    const auto* ring = std::get_if<collision::Ring>(&tool.head);
    const double period = ring != nullptr && ring->points == 12 ? 0.5 * hexagon_turn : hexagon_turn;
    if (const auto flat = flat_angle(space)) out.turn = wrap(head + 0.5 * pi + *flat, period);
}

}  // namespace

void check_tool_room(const JointSurroundings& space, std::size_t joint, const std::vector<std::size_t>& tools,
                     ToolSet& set, const Messages& messages, DrawnToolRoom& room,
                     std::vector<DrawnToolRoom>& failing) {
    JointRooms rooms(space, set);
    const content::AssemblyJoint& checked = space.joint();
    const double gap = checked.design.start_gap;
    for (const std::size_t tool : tools) {
        const ToolGeometry& shape = set.shapes()[tool];
        if (!collision::grips(shape.head, shape_of(checked.design))) continue;  // reported by check_tools()
        const ToolRoom& found = rooms.room_of(shape);
        if (tool == tools.front()) fill_in(room, space, shape, found);
        const ToolCheck check{space, rooms, joint, tool, shape, messages};
        const std::size_t errors = messages.findings.errors.size();
        const std::string start = fmt::format(" where it starts, {:.3g} mm above its seat", gap / mm);
        if (shape.is_open_end()) {
            check.check_swing(found.seated, "");
            if (found.at_start) check.check_swing(*found.at_start, start);
            check.check_path(found);
        } else if (check.check_swing(found.seated, "") && check.check_path(found) && found.at_start) {
            // One mistake is enough, because the path leads past the start of the thread.
            check.check_swing(*found.at_start, start);
        }
        if (messages.findings.errors.size() == errors) continue;
        failing.push_back(room);
        failing.back().tool = tool;
        fill_in(failing.back(), space, shape, found);
    }
}

}  // namespace bolt::geometry
