#include "haptics/servo/setup.hpp"

#include <algorithm>
#include <cmath>

#include "haptics/joint/nut.hpp"

namespace bolt::servo {

namespace {

// N·m, the drag of a ratchet's pawl. Our estimate; it has no source.
constexpr double usual_drag = 0.25;
// m between a socket screw and its key: the middle of the tolerances of ISO 4762 and ISO 2936 at 6 mm.
constexpr double key_clearance = 0.1e-3;
constexpr std::uint64_t tool_stream = 6789;  // random stream of the wrench; the joints use the streams from 0

NutGeometry nut_geometry(const joint::JointDesign& design) {
    NutGeometry nut;
    nut.seat = design.seat;
    nut.axis = glm::normalize(design.axis);
    const Vec3 helper = std::abs(nut.axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    nut.e1 = glm::normalize(helper - nut.axis * glm::dot(helper, nut.axis));
    nut.e2 = glm::cross(nut.axis, nut.e1);
    const joint::TurnedPartSize part = joint::turned_part_size(design);
    nut.is_head = design.turned == joint::TurnedPart::head;
    nut.sense = design.thread_direction == joint::ThreadDirection::left ? -1.0 : 1.0;
    nut.height = part.height;
    nut.across_flats = part.across_flats;
    nut.bearing_diameter = part.bearing;
    nut.socket_depth = part.depth;
    nut.head_diameter = part.outside;
    const double hardness = joint::turned_part_hardness(design);
    nut.corner_pressure =
        part.depth > 0.0 ? joint::socket_pressure(hardness) : joint::corner_pressure(hardness);
    nut.start_gap = design.start_gap;
    nut.lead = design.thread.thread.pitch / (2.0 * pi);
    if (design.counter_hold == joint::CounterHold::second_wrench) {
        const joint::HeldPartSize held = joint::held_part_size(design);
        nut.held_across_flats = held.across_flats;
        nut.held_distance = design.grip_length() + 0.5 * held.height;
    }
    return nut;
}

}  // namespace

Vec3 direction_at(const NutGeometry& nut, double angle) {
    const double about_axis = -nut.sense * angle;
    return std::cos(about_axis) * nut.e1 + std::sin(about_axis) * nut.e2;
}

double angle_of(const NutGeometry& nut, const Vec3& direction) {
    return -nut.sense * std::atan2(glm::dot(direction, nut.e2), glm::dot(direction, nut.e1));
}

Pose nut_pose(const NutGeometry& nut, double nut_angle, double common_turn) {
    const double gap = std::max(0.0, nut.start_gap - nut.lead * nut_angle);
    const Quat seat = glm::normalize(glm::quat_cast(glm::dmat3(nut.e1, nut.e2, nut.axis)));
    return {nut.seat + gap * nut.axis,
            seat * glm::angleAxis(-nut.sense * (nut_angle + common_turn), Vec3(0, 0, 1))};
}

collision::TurnedShape shape_of(const NutGeometry& nut) {
    if (nut.socket_depth > 0.0)
        return collision::HexagonSocket{nut.across_flats + key_clearance, nut.socket_depth, nut.height,
                                        nut.head_diameter};
    return collision::HexagonPrism{nut.across_flats, nut.height, nut.bearing_diameter};
}

double half_play(const Wrench& wrench, double across_flats, double rounded) {
    if (const auto* key = std::get_if<collision::HexKey>(&wrench.head))
        return joint::rounded_half_play(across_flats + key_clearance, key->width, rounded);
    return joint::rounded_half_play(collision::width_across_flats(wrench.head), across_flats, rounded);
}

bool reversible(const Wrench& wrench) { return std::holds_alternative<collision::Jaw>(wrench.head); }

namespace {

// `number`: of the tool in the lesson, for its random stream. `across_flats`: m, the widest that it turns.
Wrench make_wrench(const SetupDescription& d, const ToolDescription& tool, std::size_t number,
                   double across_flats) {
    Wrench wrench;
    wrench.head_angle = tool.head_angle;
    wrench.handle_length = tool.handle_length;
    wrench.head = tool.head;
    wrench.ratchet.tooth_angle = collision::tooth_angle(tool.head);
    wrench.ratchet.drag = usual_drag;
    wrench.half_play = half_play(wrench, across_flats, 0.0);
    // Modelling assumption: wrench and wrists yield 2.5° at the largest torque.
    wrench.stiffness = std::max(d.max_torque, 1.0) / to_radians(2.5);
    if (tool.twist_stiffness > 0.0)  // in series
        wrench.stiffness = 1.0 / (1.0 / wrench.stiffness + 1.0 / tool.twist_stiffness);
    wrench.yield_torque = tool.yield_torque;
    wrench.click.swing = tool.click_swing;
    wrench.adaptor_ratio = tool.adaptor_ratio;
    Random random(d.seed, tool_stream + number);
    wrench.deviation = random.uniform(-tool.click_accuracy, tool.click_accuracy);
    return wrench;
}

void add_tool(const SetupDescription& d, const ToolDescription& tool, Setup& setup) {
    const std::size_t number = setup.tools.size();
    double across_flats = 0.0;
    ToolSetup added;
    for (const NutGeometry& nut : setup.nuts) {
        added.grip_heights.push_back(collision::grip_height(tool.head, shape_of(nut)));
        if (nut.tool == number) across_flats = std::max(across_flats, nut.across_flats);
    }
    added.wrench = make_wrench(d, tool, number, across_flats);
    added.torque_rendering = force::make_torque_rendering(d.limits, d.max_torque, tool.handle_length);
    // Without torque output the aligning torque is a force at the end of the handle.
    added.max_aligning_torque =
        d.limits.torque > 0.0 ? 0.1 * d.limits.torque : 0.2 * d.limits.force * tool.handle_length;
    setup.tools.push_back(std::move(added));
}

}  // namespace

void use_tool(Setup& setup, std::size_t tool) {
    setup.tool = tool;
    setup.wrench = setup.tools[tool].wrench;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i)
        setup.nuts[i].grip_height = setup.tools[tool].grip_heights[i];
    if (!setup.renders_tool_in_use) return;
    setup.torque_rendering = setup.tools[tool].torque_rendering;
    setup.guiding.max_torque = setup.tools[tool].max_aligning_torque;
}

void disable_tool_yield(Setup& setup) {
    setup.wrench.yield_torque = 0.0;
    for (ToolSetup& tool : setup.tools) tool.wrench.yield_torque = 0.0;
}

void set_ratchets(Setup& setup, bool loosen) {
    setup.wrench.ratchet.loosens = loosen;
    for (ToolSetup& tool : setup.tools) tool.wrench.ratchet.loosens = loosen;
}

Setup make_setup(const SetupDescription& d) {
    Setup setup;
    setup.dt = d.dt;
    setup.group = d.law == joint::Law::mechanistic ? joint::make_group(d.joints, d.flange, d.seed)
                                                   : joint::make_published_group(d.published);
    for (const joint::JointDesign& design : d.joints) {
        setup.nuts.push_back(nut_geometry(design));
        const std::size_t joint = setup.nuts.size() - 1;
        if (joint < d.tool_of_joint.size()) setup.nuts.back().tool = d.tool_of_joint[joint];
    }
    if (d.law == joint::Law::published)
        for (std::size_t i = 0; i < setup.nuts.size(); ++i)
            setup.nuts[i].start_gap =
                setup.nuts[i].lead * to_radians(joint::published_boundaries(d.published[i]).linearity);
    add_tool(d, d.tool, setup);
    for (const ToolDescription& tool : d.more_tools) add_tool(d, tool, setup);
    use_tool(setup, 0);

    setup.limits = d.limits;
    setup.hold_stiffness = std::min(setup.hold_stiffness, d.limits.stiffness);
    if (d.limits.torsion > 0.0) setup.hold_torsion = std::min(setup.hold_torsion, d.limits.torsion);
    // The energy of a spring that the device cannot render must not count as stored.
    if (d.limits.force <= 0.0) setup.hold_stiffness = 0.0;
    setup.guiding.max_force = std::min(setup.guiding.max_force, 0.2 * d.limits.force);
    setup.guiding.stiffness = std::min(setup.guiding.stiffness, d.limits.stiffness);
    return setup;
}

}  // namespace bolt::servo
