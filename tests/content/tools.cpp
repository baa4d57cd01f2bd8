// The default tool of an assembly and the further tools to choose from.
#include <doctest/doctest.h>

#include "support.hpp"

namespace content_tools_test {

using namespace bolt;
using namespace content_test;

namespace {

// The small file with `more` as "more_tools".
std::string with(const std::string& more) {
    return edited(cover(), "\"joint_types\"", "\"more_tools\": {" + more + "}, \"joint_types\"");
}

constexpr const char* clicker =
    R"("clicker": { "kind": "click_torque_wrench", "jaw_mm": 13.2, "handle_length_mm": 300 })";

content::Tool tool_named(const char* name) { return {name, {}, {}, {}}; }

content::AssemblyJoint joint_named(const char* id, const char* tool = "") {
    content::AssemblyJoint joint;
    joint.design.id = id;
    joint.tool = tool;
    return joint;
}

}  // namespace

TEST_CASE("Tools: a second tool is used when it is chosen") {
    content::LoadedAssembly loaded = content::parse_assembly(with(clicker), "f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    content::Assembly& a = loaded.assembly;
    REQUIRE(a.tools.size() == 2);
    CHECK(a.tool == "wrench");
    CHECK(a.wrench.click_swing == 0.0);
    REQUIRE(content::choose_tool(a, "clicker"));
    CHECK(a.tool == "clicker");
    CHECK(a.wrench.handle_length == doctest::Approx(0.3));
    CHECK(a.wrench.click_swing == doctest::Approx(to_radians(4.0)));
    CHECK(a.wrench.click_accuracy == doctest::Approx(0.04));
    REQUIRE(content::choose_tool(a, ""));
    CHECK(a.tool == "wrench");
    CHECK(a.wrench.click_swing == 0.0);
}

TEST_CASE("Tools: an adaptor is a part of the handle, and the scale of its wrench shows less torque") {
    content::LoadedAssembly loaded =
        content::parse_assembly(with(edited(clicker, "300", R"(300, "adaptor_mm": 60)")), "f");
    REQUIRE(loaded.ok());
    CHECK(content::adaptor_ratio(loaded.assembly.wrench) == 1.0);
    REQUIRE(content::choose_tool(loaded.assembly, "clicker"));
    CHECK(loaded.assembly.wrench.adaptor_length == doctest::Approx(0.06));
    CHECK(content::adaptor_ratio(loaded.assembly.wrench) == doctest::Approx(1.25));  // 300 / 240
}

TEST_CASE("Tools: an unknown tool gives the nearest name") {
    content::LoadedAssembly loaded = content::parse_assembly(with(clicker), "f");
    REQUIRE(loaded.ok());
    const Status chosen = content::choose_tool(loaded.assembly, "cliker");
    REQUIRE_FALSE(chosen);
    CHECK(chosen.error().code == ErrorCode::bad_content);
    CHECK(chosen.error().message().find("did you mean \"clicker\"?") != std::string::npos);
    CHECK(loaded.assembly.tool == "wrench");
}

TEST_CASE("Tools: mistakes of a tool are reported at their position") {
    const auto one = [](const std::string& text) {
        const std::vector<std::string> all = messages(text);
        REQUIRE(all.size() == 1);
        return all[0].substr(all[0].find("/more_tools"));
    };
    CHECK(
        one(with(edited(clicker, "13.2", "10"))) ==
        "/more_tools/clicker/jaw_mm: a jaw of 10 mm does not fit M8, 13 mm across flats; expected 13 to 13.6 "
        "mm");
    CHECK(
        one(with(edited(clicker, "300", R"(300, "accuracy_percent": 30)"))) ==
        "/more_tools/clicker/accuracy_percent: 30 is too large; expected a number >= 0 and <= 20 (percent)");
    CHECK(one(with(edited(edited(clicker, "click_torque_wrench", "open_end_wrench"), "300",
                          R"(300, "click_swing_deg": 3)"))) ==
          "/more_tools/clicker/click_swing_deg: only a torque wrench clicks; expected the kind "
          "\"click_torque_wrench\", or no such value");
    CHECK(one(with(edited(clicker, "300", R"(300, "adaptor_mm": 220)"))) ==
          "/more_tools/clicker/adaptor_mm: an adaptor of 220 mm leaves a lever of 80 mm; expected at most "
          "200 mm, the handle length less 100 mm");
    CHECK(one(with(R"("s": { "kind": "click_torque_wrench", "head": "socket", "size_mm": 13,
                             "handle_length_mm": 300, "adaptor_mm": 60 })")) ==
          "/more_tools/s/adaptor_mm: the adaptor lengthens only a torque wrench with an open end; expected "
          "the head \"open_end\", or no \"adaptor_mm\"");
    CHECK(one(with(edited(clicker, "clicker", "wrench"))) ==
          "/more_tools/wrench: \"wrench\" is the name of \"tool\"; expected another name");
}

TEST_CASE("Tools: rings, ratchets and torque wrenches with sockets have a size instead of a jaw") {
    content::LoadedAssembly loaded = content::parse_assembly(
        with(R"("ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 150 },
                "ratchet": { "kind": "ratchet", "size_mm": 13, "handle_length_mm": 200, "teeth": 24,
                             "extension_mm": 75 },
                "bit": { "kind": "ratchet", "head": "hex_bit", "size_mm": 6, "handle_length_mm": 200 },
                "key": { "kind": "hex_key", "size_mm": 6, "handle_length_mm": 90 },
                "set": { "kind": "click_torque_wrench", "head": "socket", "size_mm": 13, "handle_length_mm": 300 })"),
        "f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    content::Assembly& a = loaded.assembly;
    REQUIRE(content::choose_tool(a, "ring"));
    CHECK(a.wrench.head == content::ToolHeadKind::ring);
    CHECK(a.wrench.size == doctest::Approx(0.013));
    CHECK(a.wrench.teeth == 0);
    REQUIRE(content::choose_tool(a, "ratchet"));
    CHECK(a.wrench.head == content::ToolHeadKind::socket);
    CHECK(a.wrench.teeth == 24);
    CHECK(a.wrench.extension == doctest::Approx(0.075));
    REQUIRE(content::choose_tool(a, "bit"));
    CHECK(a.wrench.head == content::ToolHeadKind::hex_bit);
    CHECK(a.wrench.teeth == 72);
    REQUIRE(content::choose_tool(a, "key"));
    CHECK(a.wrench.head == content::ToolHeadKind::hex_key);
    REQUIRE(content::choose_tool(a, "set"));
    CHECK(a.wrench.head == content::ToolHeadKind::socket);
    CHECK(a.wrench.click_swing > 0.0);
}

TEST_CASE("Tools: a socket of another size and an open end on a ratchet are refused") {
    const auto refused = [](const std::string& tool, const std::string& message) {
        const std::vector<std::string> all = messages(with(tool));
        REQUIRE(all.size() == 1);
        CHECK(all[0].substr(all[0].find("/more_tools")) == message);
    };
    refused(R"("r": { "kind": "ratchet", "size_mm": 14, "handle_length_mm": 200 })",
            "/more_tools/r/size_mm: a socket of 14 mm does not fit M8, 13 mm across flats; expected 13 mm");
    refused(R"("r": { "kind": "ratchet", "head": "open_end", "jaw_mm": 13.2, "handle_length_mm": 200 })",
            "/more_tools/r/head: a ratchet does not turn an open end; expected \"socket\" or \"hex_bit\"");
    refused(R"("r": { "kind": "ratchet", "size_mm": 13, "handle_length_mm": 200, "teeth": 60 })",
            "/more_tools/r/teeth: a ratchet of 60 teeth is unknown; expected 24, 72 or 90");
}

TEST_CASE("Tools: a joint type names the only tool that turns it") {
    const std::string ring = R"("ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 150 })";
    content::LoadedAssembly loaded = content::parse_assembly(
        edited(with(ring + ", " + clicker), "\"size\": \"M8\"", "\"tool\": \"ring\", \"size\": \"M8\""), "f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    content::Assembly& a = loaded.assembly;
    REQUIRE(!a.joints.empty());
    for (const content::AssemblyJoint& joint : a.joints) {
        CHECK(joint.tool == "ring");
        CHECK(content::tool_of(a, joint).head == content::ToolHeadKind::ring);
    }
    const content::LessonTools lesson = content::lesson_tools(a);
    REQUIRE(lesson.tools.size() == 1);
    CHECK(a.tools[lesson.tools[0]].name == "ring");
    // The ring is not a tool to choose, because it belongs to its joints.
    REQUIRE(content::choosable_tools(a).size() == 2);
    CHECK(content::choosable_tools(a)[1]->name == "clicker");
    const Status own = content::choose_tool(a, "ring");
    REQUIRE_FALSE(own);
    CHECK(own.error().message() ==
          "f: the tool \"ring\" turns only the joints that name it; expected one of wrench, clicker");
    // One joint without it: the chosen tool turns this one.
    a.joints.back().tool.clear();
    REQUIRE(content::choose_tool(a, "clicker"));
    const content::LessonTools mixed = content::lesson_tools(a);
    REQUIRE(mixed.tools.size() == 2);
    CHECK(mixed.of_joint.back() != mixed.of_joint.front());
    CHECK(content::designs_of(a, mixed)[mixed.of_joint.back()]->click_swing > 0.0);
    CHECK(content::tool_of(a, a.joints.back()).click_swing > 0.0);

    const std::vector<std::string> wrong =
        messages(edited(with(ring), "\"size\": \"M8\"", "\"tool\": \"rign\", \"size\": \"M8\""));
    REQUIRE(wrong.size() == 1);
    CHECK(wrong[0].find("/tool: there is no tool \"rign\"; did you mean \"ring\"?") != std::string::npos);
}

TEST_CASE("Tools: a tool can name another one for joints that it does not reach") {
    const std::string ring = R"("ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 150 })";
    const std::string ratchet =
        R"("ratchet": { "kind": "ratchet", "size_mm": 13, "handle_length_mm": 150, "instead": { "B2": "ring" } })";
    content::LoadedAssembly loaded = content::parse_assembly(with(ring + ", " + ratchet), "f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    content::Assembly& a = loaded.assembly;
    CHECK(content::lesson_tools(a).tools.size() == 1);
    REQUIRE(content::choose_tool(a, "ratchet"));
    for (const content::AssemblyJoint& joint : a.joints)
        CHECK(content::tool_of(a, joint).head ==
              (joint.design.id == "B2" ? content::ToolHeadKind::ring : content::ToolHeadKind::socket));
    CHECK(content::lesson_tools(a).tools.size() == 2);

    const auto refused = [&](const char* instead, const char* message) {
        const std::vector<std::string> all =
            messages(with(ring + ", " + edited(ratchet, R"({ "B2": "ring" })", instead)));
        REQUIRE(all.size() == 1);
        CHECK(all[0].find(message) != std::string::npos);
    };
    refused(R"({ "B2": "rang" })", R"(/instead/B2: there is no tool "rang"; did you mean "ring"?)");
    refused(R"({ "C2": "ring" })", R"(/instead/C2: there is no joint "C2"; did you mean "B2"?)");
}

TEST_CASE("Tools: a tool has to fit only the joints that name it") {
    // The key turns no hexagon, and no joint names it, so its size is not checked against these nuts.
    const std::string key = R"("key": { "kind": "hex_key", "size_mm": 5, "handle_length_mm": 90 })";
    CHECK(messages(with(key)).empty());
}

TEST_CASE("Tools: a joint has its own tool, or those that no joint names, with their replacements") {
    content::Assembly assembly;
    for (const char* name : {"wrench", "ring", "key", "ratchet"}) assembly.tools.push_back(tool_named(name));
    for (const char* id : {"A", "B"}) assembly.joints.push_back(joint_named(id));
    assembly.joints.push_back(joint_named("C", "key"));
    assembly.tools[3].instead["B"] = "ring";
    using Tools = std::vector<std::size_t>;
    CHECK(content::tools_of_joint(assembly, 0) == Tools{0, 1, 3});
    CHECK(content::tools_of_joint(assembly, 1) == Tools{0, 1});
    CHECK(content::tools_of_joint(assembly, 2) == Tools{2});
    // The default tool is checked on all joints that name none, even if one names it.
    assembly.joints[2].tool = "wrench";
    CHECK(content::tools_of_joint(assembly, 0) == Tools{0, 1, 2, 3});
    assembly.tools[0].instead["A"] = "ratchet";
    CHECK(content::tools_of_joint(assembly, 0) == Tools{3, 1, 2});
}

TEST_CASE("Tools: every shipped assembly has a torque wrench, and a name for each tool in each language") {
    for (const char* name : {"zq350", "dn200-pn16", "cover-m8"}) {
        CAPTURE(name);
        content::LoadedAssembly loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        for (const content::Tool& tool : loaded.assembly.tools) CHECK(tool.title.size() == 3);
        REQUIRE(content::choose_tool(loaded.assembly, "torque_wrench"));
        CHECK(loaded.assembly.wrench.click_swing > 0.0);
        CHECK_FALSE(loaded.assembly.wrench.model.empty());
    }
}

}  // namespace content_tools_test
