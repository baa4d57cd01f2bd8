// Rings, ratchets and keys on nuts and screws: engagement, torque, play and forces without shocks.
#include <cmath>

#include "engine/assets/gltf.hpp"
#include "tests/support/folder.hpp"
#include "tests/tool_contact/support.hpp"

namespace bolt::servo::tool_heads {

namespace {

constexpr double leap = 0.09;  // of the greatest force; a tick changes it by less

content::WrenchDesign tool(content::ToolKind kind, content::ToolHeadKind head, double size, int teeth = 0) {
    content::WrenchDesign design;
    design.kind = kind;
    design.head = head;
    design.size = size;
    design.handle_length = 0.15;
    design.teeth = teeth;
    return design;
}

content::Assembly cover_with(const content::WrenchDesign& design) {
    content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    loaded.assembly.wrench = design;
    return std::move(loaded.assembly);
}

content::WrenchDesign ring() {
    return tool(content::ToolKind::ring_wrench, content::ToolHeadKind::ring, 0.013);
}
content::WrenchDesign ratchet() {
    return tool(content::ToolKind::ratchet, content::ToolHeadKind::socket, 0.013, 72);
}
content::WrenchDesign key() {
    return tool(content::ToolKind::hex_key, content::ToolHeadKind::hex_key, 0.006);
}

// One M8 socket screw in a tapped hole, tightened with a key of 6 mm.
content::Assembly screw_with(const content::WrenchDesign& design, const std::filesystem::path& model) {
    REQUIRE(assets::write_glb(model, test::plate_with({"B1_bolt", 6.5e-3, 8e-3, 24})));
    content::LoadedAssembly loaded = content::parse_assembly(
        R"({"title": {"en": "Screw"}, "lesson": {"en": "Tighten."},
            "tool": {"kind": "hex_key", "size_mm": 6, "handle_length_mm": 150},
            "joint_types": {"T": {"size": "M8", "class": "8.8", "form": "tapped_hole", "head": "socket",
                "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30, "start_gap_mm": 4,
                "members": [{"thickness_mm": 16, "material": "steel"}],
                "friction_thread": 0.12, "friction_bearing": 0.12, "spec": {"strategy": "torque", "target_torque_Nm": 20}}},
            "joints": [{"id": "B1", "type": "T", "position_mm": [0, 0, 0]}],
            "passes": [{"kind": "run_down"}, {"kind": "tighten", "percent": 100}]})",
        "screw.json");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    loaded.assembly.models.contact = model.string();
    loaded.assembly.wrench = design;
    return std::move(loaded.assembly);
}

struct Motion {
    double step = 0.0;  // N, greatest change of the force in a tick
    bool engaged = false;
    int slips = 0;
    Vec3 last{0.0};
    bool first = true;

    void operator()(const Output& o) {
        if (!first) step = std::max(step, glm::length(o.force - last));
        first = false;
        last = o.force;
        engaged = o.joint >= 0;
        if (o.slipped >= 0) ++slips;
    }
};

Pose turned(const Pose& pose, const Vec3& axis, double angle) {
    return {pose.position, glm::normalize(glm::angleAxis(angle, axis) * pose.orientation)};
}

// Holds the tool above, then lowers it onto the part.
Pose lower(test::Workbench& bench, Motion& motion, double misfit = 0.0, double to = 0.0) {
    const Pose high = bench.wrench(0, 0.04, misfit), low = bench.wrench(0, to, misfit);
    for (int i = 0; i < 600; ++i) bench.step(high);
    test::sweep(bench, high, low, 0.6, motion);
    for (int i = 0; i < 100; ++i) motion(bench.step(low));
    return low;
}

// Turns the handle by `angle` (rad, tightening positive) and returns the pose.
Pose pull(test::Workbench& bench, Motion& motion, const Pose& from, double angle) {
    const Vec3 axis = bench.setup.nuts[0].axis;
    const int ticks = std::max(1, static_cast<int>(std::abs(angle) / 1.5e-3));
    for (int i = 1; i <= ticks; ++i) motion(bench.step(turned(from, axis, -angle * i / ticks)));
    return turned(from, axis, -angle);
}

}  // namespace

TEST_CASE("Tool heads: ring, socket and key go on from above, turn the part and come off, without a shock") {
    const test::Folder folder;
    const content::Assembly lessons[] = {cover_with(ring()), cover_with(ratchet()),
                                         screw_with(key(), folder / "screw.glb")};
    for (const content::Assembly& lesson : lessons) {
        CAPTURE(static_cast<int>(lesson.wrench.head));
        test::Workbench bench(lesson);
        Motion motion;
        const Pose on = lower(bench, motion);
        CHECK(motion.engaged);
        // The tool is where it belongs, within the clearance above the seat.
        CHECK(glm::distance(bench.state.tool_contact->god_object.constrained_tool.position, on.position) <
              0.4e-3);
        const double before = bench.state.joints[0].nut.angle;
        const Pose pulled = pull(bench, motion, on, to_radians(60.0));
        CHECK(bench.state.joints[0].nut.angle - before > to_radians(55.0));
        CHECK(motion.engaged);
        test::sweep(bench, pulled, bench.wrench(0, 0.045, 0.0), 0.8, motion);
        CHECK_FALSE(motion.engaged);
        CHECK(motion.slips == 0);
        CHECK(motion.step < leap * bench.setup.limits.force);
    }
}

TEST_CASE("Tool heads: a ring that is turned by 15 degrees stays on top, a ratchet's socket finds its fit") {
    test::Workbench with_ring(cover_with(ring()));
    Motion motion;
    lower(with_ring, motion, to_radians(15.0));
    CHECK_FALSE(motion.engaged);
    const double above = with_ring.state.tool_contact->god_object.constrained_tool.position.y -
                         nut_centre(with_ring.setup.nuts[0], with_ring.state.joints[0].nut.angle).y;
    CHECK(above > 4e-3);

    test::Workbench with_ratchet(cover_with(ratchet()));
    Motion other;
    lower(with_ratchet, other, to_radians(11.0));
    CHECK(other.engaged);
    CHECK(other.step < leap * with_ratchet.setup.limits.force);
}

TEST_CASE("Tool heads: a ratchet tightens by strokes of a few degrees without leaving the nut") {
    test::Workbench bench(cover_with(ratchet()));
    Motion motion;
    const Pose on = lower(bench, motion);
    REQUIRE(motion.engaged);
    double least_between = 1e9;
    for (int stroke = 0; stroke < 12; ++stroke) {
        const Pose far = pull(bench, motion, on, to_radians(25.0));
        const double gained = bench.state.joints[0].nut.angle;
        const Vec3 axis = bench.setup.nuts[0].axis;
        for (int i = 0; i <= 300; ++i) motion(bench.step(turned(far, axis, to_radians(25.0) * i / 300.0)));
        CHECK(motion.engaged);
        least_between = std::min(least_between, bench.state.joints[0].nut.angle - gained);
    }
    // The nut does not turn back by more than the elastic part.
    CHECK(least_between > -to_radians(26.0));
    CHECK(bench.state.joints[0].torque < 60.0);
    CHECK(motion.step < leap * bench.setup.limits.force);
}

TEST_CASE(
    "Tool heads: the work at the corner torque equals that of the material that the loaded corners lose") {
    for (const bool all : {true, false}) {
        CAPTURE(all);
        test::Workbench bench(cover_with(ring()));
        bench.setup.rounds_all_loaded_corners = all;
        REQUIRE(session::pretighten(bench.assembly, bench.setup, bench.state));
        Motion motion;
        lower(bench, motion, 0.0, 0.0);
        REQUIRE(motion.engaged);
        const NutGeometry& nut = bench.setup.nuts[0];
        Engagement& e = bench.state.engagement;
        joint::JointState& joint = bench.state.joints[0];
        const double limit =
            contact_drive(bench.setup, nut, 0.0, e).torque_limit;  // with whole corners: the corner torque
        const double play = half_play(bench.setup.wrench, nut.across_flats, 0.0);
        const double turned = to_radians(0.02);
        joint.torque = limit;
        e.hand_angle = joint.rotation() + play + limit / bench.setup.wrench.stiffness + turned;
        double rounded = 0.0;
        CHECK_FALSE(round_corners(bench.setup, nut, joint, rounded, e));
        const double lost =
            (all ? 6.0 : 2.0) * 0.25 * std::sqrt(3.0) * square(rounded) * e.fit.overlap;  // m³
        CHECK(rounded > 0.0);
        CHECK(nut.corner_pressure * lost == doctest::Approx(limit * turned).epsilon(1e-6));
    }
}

TEST_CASE("Tool heads: a ring bears more torque than an open end, and little overlap rounds the corners") {
    const double s = 0.013, half = 0.5 * s / std::sqrt(3.0);
    test::Workbench bench(cover_with(ring()));
    const double pressure = bench.setup.nuts[0].corner_pressure;
    const double jaw = joint::corner_torque(pressure, {5e-3, half, half, 0.0, 1e-4, 0.0});
    const double twelve = joint::ring_torque(pressure, {5e-3, s, 12, 0.0, 1e-4, 0.0});
    const double six = joint::ring_torque(pressure, {5e-3, s, 6, 0.0, 1e-4, 0.0});
    CHECK(six == doctest::Approx(3.0 * jaw).epsilon(1e-9));
    CHECK(twelve / jaw ==
          doctest::Approx(3.0 * (1.0 - square(std::tan(pi / 12) * std::sqrt(3.0)))).epsilon(1e-9));

    REQUIRE(session::pretighten(bench.assembly, bench.setup, bench.state));
    Motion motion;
    // Onto the top of the corners only.
    const auto& on_nut = std::get<collision::HexagonPrism>(shape_of(bench.setup.nuts[0]));
    const auto& head = std::get<collision::Ring>(bench.setup.wrench.head);
    const double corner_top = on_nut.height - on_nut.corner_drop(), flat_low = head.low + head.lead_in;
    const double above = corner_top - flat_low - 0.6e-3 - bench.setup.nuts[0].grip_height;
    const Pose on = lower(bench, motion, 0.0, above);
    REQUIRE(motion.engaged);
    CHECK(bench.state.engagement.fit.overlap == doctest::Approx(0.6e-3).epsilon(0.15));
    pull(bench, motion, on, to_radians(30.0));
    CHECK(motion.slips > 0);
    CHECK(bench.state.rounded[0] > 0.0);
}

}  // namespace bolt::servo::tool_heads
