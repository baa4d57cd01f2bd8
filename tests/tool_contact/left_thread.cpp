// With contact simulation a pull on a left-hand thread is the mirror image of one on a right-hand thread.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/assets/gltf.hpp"
#include "tests/support/folder.hpp"
#include "tests/tool_contact/support.hpp"

namespace bolt::servo::left_thread_contact {

namespace {

// The reflection at the plane z = 0, which contains the bolt's axis. A plate with a hexagon on it is its own
// mirror image.
Vec3 mirrored(const Vec3& v) { return {v.x, v.y, -v.z}; }

// The mirror image of a tool: a wrench with an open end is turned over, the others are not.
Pose mirrored(const Pose& tool, bool turned_over) {
    const Quat& q = tool.orientation;
    const Quat image(q.w, -q.x, -q.y, q.z), half_turn(0.0, 1.0, 0.0, 0.0);
    return {mirrored(tool.position), turned_over ? image : image * half_turn};
}

struct Case {
    const char* name;
    const char* tool;   // in the assembly's file
    const char* joint;  // of the joint type
    test::PartOnPlate part;
};
constexpr const char* nut = R"("bolt_length_mm": 30)";
constexpr const char* stud =
    R"("form": "stud", "tapped_hole": {"material": "C45", "engagement_mm": 10}, "bolt_length_mm": 30)";
constexpr const char* screw =
    R"("form": "tapped_hole", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)";
constexpr const char* cap_screw =
    R"("form": "tapped_hole", "head": "socket", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)";
constexpr test::PartOnPlate nut_on_plate{"B1_nut", 7.5e-3, 6.8e-3}, head_on_plate{"B1_bolt", 7.5e-3, 5.3e-3},
    socket_on_plate{"B1_bolt", 6.5e-3, 8e-3, 24};
constexpr const char* open_end =
    R"({"kind": "open_end_wrench", "jaw_mm": 13.2, "head_angle_deg": 15, "handle_length_mm": 150})";
constexpr const char* ring = R"({"kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 150})";
constexpr const char* ratchet = R"({"kind": "ratchet", "size_mm": 13, "teeth": 72, "handle_length_mm": 150})";
constexpr const char* bit =
    R"({"kind": "ratchet", "head": "hex_bit", "size_mm": 6, "teeth": 24, "handle_length_mm": 150})";
constexpr const char* key = R"({"kind": "hex_key", "size_mm": 6, "handle_length_mm": 150})";
constexpr const char* torque_wrench =
    R"({"kind": "click_torque_wrench", "head": "socket", "size_mm": 13, "handle_length_mm": 150})";
constexpr Case cases[] = {
    {"open end on a nut", open_end, nut, nut_on_plate},
    {"ring on the nut of a stud", ring, stud, nut_on_plate},
    {"ratchet on a head", ratchet, screw, head_on_plate},
    {"key in a socket", key, cap_screw, socket_on_plate},
    {"bit on a ratchet", bit, cap_screw, socket_on_plate},
    {"torque wrench with a socket", torque_wrench, nut, nut_on_plate},
};

content::Assembly lesson_of(const Case& on, joint::ThreadDirection direction,
                            const std::filesystem::path& model) {
    content::LoadedAssembly loaded = content::parse_assembly(
        fmt::format(R"({{"title": {{"en": "One joint"}}, "lesson": {{"en": "Tighten."}}, "tool": {},
            "joint_types": {{"T": {{"size": "M8", "class": "8.8", "thread_direction": "{}", {},
                "start_gap_mm": 0.15, "members": [{{"thickness_mm": 16, "material": "steel"}}],
                "friction_thread": 0.12, "friction_bearing": 0.12,
                "spec": {{"strategy": "torque", "target_torque_Nm": 20}}}}}},
            "joints": [{{"id": "B1", "type": "T", "position_mm": [0, 0, 0]}}],
            "passes": [{{"kind": "run_down"}}, {{"kind": "tighten", "percent": 100}}]}})",
                    on.tool, name(direction), on.joint),
        "one.json");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    loaded.assembly.models.contact = model.string();
    return std::move(loaded.assembly);
}

// Steps both benches, the second with the mirror image of the command, and compares what the hands feel.
struct Pair {
    test::Workbench right, left;
    bool jaw = false;
    double angle_error = 0.0, joint_error = 0.0, position_error = 0.0, force_error = 0.0, torque_error = 0.0;
    double highest = 0.0, loosest = 0.0, most_force = 0.0;
    int held = 0, clicks = 0;

    void step(const Pose& hand) {
        TickInput input;
        input.dead_man = true;
        input.grip = Grip::wrench;
        input.guided_joint = 0;
        input.set_torque = 15.0F;
        input.commanded_tool = to_commanded_tool(hand);
        TickInput image = input;
        image.commanded_tool = to_commanded_tool(mirrored(hand, jaw));
        const Output a = tick(right.setup, right.state, input), b = tick(left.setup, left.state, image);
        REQUIRE(a.joint == b.joint);
        REQUIRE(a.clicked == b.clicked);
        angle_error = std::max(angle_error, std::abs(a.nut_angle - b.nut_angle));
        joint_error = std::max(joint_error, std::abs(a.wrench_torque - b.wrench_torque));
        held += a.joint == 0 ? 1 : 0;
        clicks += a.clicked ? 1 : 0;
        highest = std::max(highest, a.wrench_torque);
        loosest = std::min(loosest, a.wrench_torque);
        most_force = std::max(most_force, glm::length(a.force));
        position_error = std::max(position_error, glm::distance(b.constrained_tool.position,
                                                                mirrored(a.constrained_tool.position)));
        force_error = std::max(force_error, glm::length(b.force - mirrored(a.force)));
        torque_error = std::max(torque_error, glm::length(b.torque + mirrored(a.torque)));
    }
    void move(const Pose& from, const Pose& to, int ticks) {
        for (int i = 1; i <= ticks; ++i) {
            const double s = minimum_jerk(static_cast<double>(i) / ticks);
            step({glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)});
        }
    }
    // Turns by `angle` rad, tightening positive, and pushes sideways meanwhile.
    Pose turn(const Pose& from, double angle, const Vec3& push) {
        const int ticks = static_cast<int>(std::abs(angle) / 1.5e-3);
        Pose pose = from;
        for (int i = 1; i <= ticks; ++i) {
            const double share = static_cast<double>(i) / ticks;
            pose.orientation =
                glm::normalize(glm::angleAxis(-angle * share, right.setup.nuts[0].axis) * from.orientation);
            pose.position = from.position + std::sin(pi * share) * push;
            step(pose);
        }
        pose.position = from.position;
        return pose;
    }
};

}  // namespace

TEST_CASE("Left-hand thread: with contacts too, a pull is the mirror image for each head of a tool") {
    const test::Folder folder;
    for (const Case& one : cases)
        for (const bool renders_torque : {true, false}) {
            CAPTURE(one.name);
            CAPTURE(renders_torque);
            const auto model = folder / "one.glb";
            REQUIRE(assets::write_glb(model, test::plate_with(one.part)));
            force::OutputLimits limits;
            if (!renders_torque) limits.torque = 0.0;
            using joint::ThreadDirection;
            Pair pair{test::Workbench(lesson_of(one, ThreadDirection::right, model), limits),
                      test::Workbench(lesson_of(one, ThreadDirection::left, model), limits)};
            pair.jaw = std::holds_alternative<collision::Jaw>(pair.right.setup.wrench.head);
            REQUIRE(pair.left.setup.nuts[0].sense == -1.0);
            REQUIRE(pair.right.setup.nuts[0].sense == 1.0);
            // From above, beside the axis and slightly turned, down onto the part.
            const Vec3 beside(0.4e-3, -0.3e-3, 0.0);
            const double misfit = to_radians(0.3);
            // A jaw that is thicker than the nut stands above the plate.
            const NutGeometry& geometry = pair.right.setup.nuts[0];
            const double thickness = collision::thickness(pair.right.setup.wrench.head);
            const double above = pair.jaw ? std::max(0.0, 0.5 * (thickness - geometry.height) + 0.2e-3) : 0.0;
            const Pose high = pair.right.wrench(0, 0.04, misfit, beside, {0.6, 0.0, 0.8}),
                       low = pair.right.wrench(0, above, misfit, {}, {0.6, 0.0, 0.8});
            for (int i = 0; i < 300; ++i) pair.step(high);
            pair.move(high, low, 700);
            REQUIRE(pair.held > 0);
            Pose at = low;
            for (const double angle : {1.4, -0.5, 0.7, -2.4}) at = pair.turn(at, angle, {1e-3, 5e-4, -8e-4});
            pair.move(at, {at.position + Vec3(0.0, 0.04, 0.0), at.orientation}, 400);
            CHECK(pair.right.state.engagement.joint == -1);
            CHECK(pair.highest > 10.0);
            CHECK((pair.loosest < -1.0 || pair.right.setup.wrench.ratchet.tooth_angle > 0.0));
            CHECK(pair.most_force > 1.0);
            CHECK((pair.clicks > 0) == (pair.right.setup.wrench.click.swing > 0.0));
            // The solver of the contacts stops within a micrometre. In the jaw of a wrench it does so at two
            // different poses, since it meets the two flanks in the opposite order.
            CHECK(pair.position_error < 1e-6);
            CHECK(pair.angle_error < 2e-5);
            CHECK(pair.joint_error < 0.01);
            CHECK(pair.force_error < 5e-3);
            CHECK(pair.torque_error < 5e-3);
        }
}

}  // namespace bolt::servo::left_thread_contact
