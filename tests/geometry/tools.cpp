// The tools of a joint: which ones it is checked with, where they stand, how far they have to swing, how they
// are brought onto it, and what they bear.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "game/tool_models/tool_model.hpp"
#include "support.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tools/author/geometry/joint_tools.hpp"

namespace geometry_tools_test {

using namespace bolt;
using namespace geometry_test;

namespace {

constexpr double inner = 40.0, outer = 250.0;  // mm, radii of the walls

constexpr const char* ring = R"("kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 140)";
constexpr const char* ratchet = R"("kind": "ratchet", "size_mm": 13, "handle_length_mm": 150)";
constexpr const char* key = R"("kind": "hex_key", "size_mm": 6, "handle_length_mm": 60)";

// Replaces the default tool.
Edit with_tool(const std::string& tool) {
    return [tool](std::string& text) {
        replace(text, R"("kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140)", tool);
    };
}

// Adds tools after the default one.
Edit with_more(const std::string& tools) {
    return [tools](std::string& text) {
        replace(text, "\"tool\"", R"("more_tools": { )" + tools + R"( }, "tool")");
    };
}

// An M8 bolt and walls from 0 to `high` mm, with an opening of `opening` degrees between them.
Machine walled(double opening, double high) {
    Machine machine;
    machine.add("wall_left", sector(inner, outer, 90.0 + 0.5 * opening, 270.0, 0.0, high));
    machine.add("wall_right", sector(inner, outer, 270.0, 450.0 - 0.5 * opening, 0.0, high));
    return machine;
}

double swing_of(const CheckOutput& output) {
    const geometry::Arc* arc = output.rooms->joints.front().swing.widest();
    return arc == nullptr ? 0.0 : to_degrees(arc->width());
}

// Walls that leave the generated tool of `edit` a swing of `swing` degrees. The width of its handle takes the
// same angle from every opening.
CheckOutput check_swing(double swing, const Edit& edit) {
    constexpr double high = 90.0, wide = 100.0;
    const double lost = wide - swing_of(check_generated(walled(wide, high), edit));
    CHECK(lost > 5.0);
    CHECK(lost < 50.0);
    CheckOutput output = check_generated(walled(swing + lost, high), edit);
    CHECK(std::abs(swing_of(output) - swing) < 0.05);
    return output;
}

bool contains(const std::vector<std::string>& messages, const std::string& text) {
    return all(messages).find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("Tools: a tool of another kind or size is an error that names a suitable tool") {
    const CheckOutput key_alone = check(Machine(), with_tool(key));
    CHECK(
        all(key_alone.errors) ==
        R"(16:5: /joints/0: the wrench is a hexagon key of 6 mm and does not fit the nut of "B1", a hexagon of 13 mm; expected a ring of 13 mm, or a socket of 13 mm, or an open end of 13 mm)");
    CHECK_FALSE(key_alone.rooms->joints.front().gripped);
    const CheckOutput two =
        check(Machine({{0, 0, 0}, {80, 0, 0}}), with_more(fmt::format("\"key\": {{ {} }}", key)));
    REQUIRE(two.errors.size() == 1);  // once for all joints of the type
    CHECK(two.errors.front().ends_with(
        R"(the tool "key" is a hexagon key of 6 mm and does not fit the nut of "B1", a hexagon of 13 mm; expected "wrench" as "tool" of its joint type)"));
}

TEST_CASE("Tools: a ring stands in the middle of the nut, a socket on its shoulder, a key in the socket") {
    const auto height_with = [](const char* tool) {
        return check(Machine(), with_tool(tool)).rooms->joints.front().height / mm;
    };
    // The nut is 6.8 mm high and stands 1.6 mm above the joint's origin.
    CHECK(height_with(R"("kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140)") ==
          doctest::Approx(1.6 + 3.4));
    // A ring is 0.72 times its size thick, which leaves 0.3 mm to the washer.
    CHECK(height_with(ring) == doctest::Approx(1.6 + 0.3 + 0.36 * 13.0));
    // The lower end of a socket is 1 mm below 0.4 times the size.
    CHECK(height_with(ratchet) == doctest::Approx(1.6 + 0.3 + 0.4 * 13.0 + 1.0));
}

TEST_CASE("Tools: a ring needs 30 degrees of swing, a ratchet two teeth") {
    const CheckOutput few = check_swing(29.7, with_tool(ring));
    CHECK(contains(few.errors,
                   R"(the wrench has 29.7 degrees of free swing on the nut: between "wall_right")"));
    CHECK(contains(few.errors, "expected 30 degrees, after which it fits again, or a socket of 13 mm"));
    const CheckOutput enough = check_swing(30.3, with_tool(ring));
    CHECK(all(enough.errors) == "");
    CHECK_FALSE(contains(enough.notes, "turned over"));
    const CheckOutput one_tooth = check_swing(9.7, with_tool(ratchet));
    CHECK(contains(one_tooth.errors, "has 9.7 degrees of free swing on the nut: between"));
    CHECK(contains(one_tooth.errors, "expected 10 degrees, two teeth of its ratchet"));
    const CheckOutput two_teeth = check_swing(10.3, with_tool(ratchet));
    CHECK(all(two_teeth.errors) == "");
    CHECK(contains(two_teeth.notes, R"(has 10.3 degrees of free swing on the nut, between "wall_right" and )"
                                    R"("wall_left": 2 teeth of its ratchet a stroke)"));
    CHECK_FALSE(contains(check_swing(30.3, with_tool(ratchet)).notes, "teeth of its ratchet"));
}

TEST_CASE("Tools: an extension bar lifts the handle of a ratchet over a wall") {
    const auto errors_with = [](double high, const char* tool) {
        Machine machine;
        machine.add("well", sector(16.0, outer, 0.0, 360.0, 0.0, high));
        return all(check(machine, with_tool(tool)).errors);
    };
    CHECK(errors_with(20.0, ratchet) == "");
    const std::string cannot =
        R"(16:5: /joints/0: the wrench cannot be brought onto "B1": "well" is in its way; expected )";
    CHECK(errors_with(60.0, ratchet) == cannot + R"(an extension bar of 75 mm ("extension_mm": 75))");
    CHECK(errors_with(130.0, ratchet) == cannot + R"(an extension bar of 125 mm ("extension_mm": 125))");
    CHECK(errors_with(60.0,
                      R"("kind": "ratchet", "size_mm": 13, "extension_mm": 75, "handle_length_mm": 150)") ==
          "");
    CHECK(errors_with(400.0, ratchet) == cannot +
                                             "a free path, or the head turned instead (bolt-author "
                                             "import-step --turn-heads B1); no other tool of this size fits");
}

TEST_CASE("Tools: a ring, a socket and a key leave along the bolt; an open end also from the side") {
    const auto covered = [](const char* tool, double clear) {
        Machine machine;
        machine.add("roof", sector(0.1, outer, 0.0, 360.0, clear, clear + 5.0));
        return all(check(machine, with_tool(tool)).errors);
    };
    constexpr const char* open_end = R"("kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140)";
    // The nut ends at 8.4 mm and the bolt at 12.4 mm; the nut starts 8.9 mm higher.
    CHECK(covered(open_end, 28.0) == "");
    CHECK(
        covered(ring, 28.0) ==
        R"(16:5: /joints/0: the wrench cannot be brought onto "B1" along the bolt: "roof" is in its way; expected an open end of 13 mm with a handle of 140 mm, which fits)");
    CHECK(covered(ring, 45.0) == "");
    CHECK(covered(ratchet, 60.0).find(R"(cannot be brought onto "B1")") != std::string::npos);
    CHECK(covered(ratchet, 120.0) == "");
}

TEST_CASE("Tools: the end of a long bolt keeps a socket from the nut, and a ring fits") {
    NutAndBolt sizes;
    sizes.bolt_length = 45.0;
    const CheckOutput output = check(Machine({Vec3{0.0}}, sizes), with_tool(ratchet));
    CHECK(contains(
        output.errors,
        R"(the wrench cannot be brought onto "B1": "B1_bolt" is in its way; expected a ring of 13 mm)"));
}

TEST_CASE("Tools: an error names the tools of the file that fit, as \"instead\" or as \"tool\"") {
    Machine machine;
    machine.add("roof", sector(0.1, outer, 0.0, 360.0, 28.0, 33.0));
    CHECK(contains(
        check(machine, with_more(fmt::format("\"ring\": {{ {} }}", ring))).errors,
        R"(the tool "ring" cannot be brought onto "B1" along the bolt: "roof" is in its way; expected )"
        R"("instead": { "B1": "wrench" }, which fits)"));
    const auto own = [](std::string& text) {
        with_more(fmt::format("\"ring\": {{ {} }}", ring))(text);
        replace(text, R"("size": "M8",)", R"("size": "M8", "tool": "ring",)");
    };
    CHECK(contains(check(machine, own).errors, R"(expected "tool": "wrench" in its joint type, which fits)"));
    const auto replaced = [](std::string& text) {
        with_more(fmt::format(R"("ring": {{ {}, "instead": {{ "B1": "wrench" }} }})", ring))(text);
    };
    CHECK(all(check(machine, replaced).errors) == "");
}

TEST_CASE("Tools: a target torque above the test torque is an error, above 80 % a note") {
    const auto with_torque = [](double torque, const char* tool) {
        return check(Machine(), [&](std::string& text) {
            with_tool(tool)(text);
            replace(text, "\"class\": \"8.8\"", "\"class\": \"12.9\"");
            replace(text, "\"friction_thread\": 0.12, \"friction_bearing\": 0.12",
                    "\"friction_thread\": 0.3, \"friction_bearing\": 0.3");
            replace(text, "\"target_torque_Nm\": 20",
                    fmt::format("\"target_torque_Nm\": {}, \"torque_tolerance_percent\": 5", torque));
        });
    };
    constexpr const char* open_end = R"("kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140)";
    const CheckOutput weak = with_torque(66.0, open_end);
    CHECK(
        all(weak.errors) ==
        R"(16:5: /joints/0: the wrench is an open end of 13 mm, which is tested with 64 N·m (ISO 1711-1, from a catalogue), and the target torque of "M8x30" reaches 69 N·m; expected a ring of 13 mm (107 N·m) or a socket of 13 mm (107 N·m))");
    CHECK(all(with_torque(66.0, ring).errors) == "");
    // A tool that a trainee may choose besides the default one may be a wrong choice.
    const CheckOutput optional = with_torque(
        66.0, (std::string(ring) + R"( }, "more_tools": { "open": { )" + open_end + " }").c_str());
    CHECK(all(optional.errors) == "");
    CHECK(contains(optional.notes, "reaches 69 N·m; a trainee who chooses it loses points"));
    CHECK(all(with_torque(66.0, ring).notes).find("tested") == std::string::npos);
    const CheckOutput much = with_torque(55.0, open_end);
    CHECK(all(much.errors) == "");
    CHECK(contains(much.notes, "reaches 58 N·m, 90 % of it"));
    CHECK_FALSE(contains(with_torque(48.0, open_end).notes, "tested"));
}

TEST_CASE("Tools: 100 joints with five tools are checked; the processor time is printed") {
    if (test::sanitized) return test::skip_rest("under a sanitizer the time is that of the sanitizer");
    const auto four_more = with_more(fmt::format(
        R"("ring": {{ {} }}, "ratchet": {{ {} }}, "torque_wrench": {{ {} }}, "socket_wrench": {{ {} }})",
        ring, ratchet, R"("kind": "click_torque_wrench", "jaw_mm": 13.2, "handle_length_mm": 250)",
        R"("kind": "click_torque_wrench", "head": "socket", "size_mm": 13, "handle_length_mm": 250)"));
    NutAndBolt sizes;
    sizes.side = 60.0;
    // In one row all tools fit. In ten rows the handles meet the neighbours, so that other
    // tools are tried too.
    for (const int rows : {1, 10}) {
        const int columns = 100 / rows;
        std::vector<Vec3> positions;
        for (int i = 0; i < 100; ++i) positions.emplace_back(60.0 * (i % columns), 0.0, 60.0 * (i / columns));
        const Machine machine(positions, sizes);
        const std::clock_t begin = std::clock();
        const CheckOutput output = check_generated(machine, four_more);
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        CAPTURE(rows);
        CHECK(output.rooms->joints.size() == 100);
        // So many triangles are an error.
        CHECK(output.errors.front().find("expected at most 250000") != std::string::npos);
        CHECK((output.errors.size() == 1) == (rows == 1));
        MESSAGE("100 joints with five tools in " << seconds << " s of processor time");
    }
}

TEST_CASE("Tools: the strength of a ratchet is that of its weaker part") {
    content::WrenchDesign design{.kind = content::ToolKind::ratchet, .head = content::ToolHeadKind::socket};
    design.size = 32.0 * mm;
    design.handle_length = 300.0 * mm;
    const tool_models::ToolStrength socket = tool_models::strength_of(design);
    CHECK(socket.of_drive);
    CHECK(socket.limit.torque == 340.0);
    CHECK(socket.drive == 12.5 * mm);
    design.size = 13.0 * mm;
    CHECK_FALSE(tool_models::strength_of(design).of_drive);
    CHECK(tool_models::strength_of(design).limit.torque == 107.0);
    // No test torque of keys is known; that of a bit is the drive's.
    design = {.kind = content::ToolKind::hex_key, .head = content::ToolHeadKind::hex_key};
    design.size = 6.0 * mm;
    CHECK(tool_models::strength_of(design).limit.source == tool_models::TorqueSource::none);
    CHECK(tool_models::yield_torque(design) == doctest::Approx(0.857 * 0.2 * 1.47e9 * 6e-3 * 6e-3 * 6e-3));
    design = {.kind = content::ToolKind::ratchet, .head = content::ToolHeadKind::hex_bit};
    design.size = 6.0 * mm;
    design.handle_length = 300.0 * mm;
    CHECK(tool_models::strength_of(design).of_drive);
}

}  // namespace geometry_tools_test
