// The judgement of the tool that a trainee chose.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "content/format/folders.hpp"
#include "game/lesson/tool_choice.hpp"
#include "game/tool_models/tool_model.hpp"
#include "tests/lesson/played_session.hpp"

namespace bolt::lesson::tool_choice_test {

namespace {

content::Assembly load(const char* name, const char* tool) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, tool));
    return std::move(loaded.assembly);
}

content::WrenchDesign tool_of_24(content::ToolKind kind, content::ToolHeadKind head) {
    content::WrenchDesign tool;
    tool.kind = kind;
    tool.head = head;
    tool.jaw = 24.2 * mm;
    tool.size = 24.0 * mm;
    tool.handle_length = 0.3;
    return tool;
}

bool has_reason(const LessonResult& result, DeductionKind kind) {
    return std::any_of(result.reasons.begin(), result.reasons.end(),
                       [&](const Deduction& reason) { return reason.kind == kind; });
}

}  // namespace

TEST_CASE("Tool choice: an M16 bolt of class 12.9 is too much for an open end, and not for a ring") {
    const content::WrenchDesign open =
        tool_of_24(content::ToolKind::open_end_wrench, content::ToolHeadKind::open_end);
    const content::WrenchDesign ring =
        tool_of_24(content::ToolKind::ring_wrench, content::ToolHeadKind::ring);
    CHECK(tool_models::bearable_torque(open) == doctest::Approx(359.0));  // ISO 1711-1
    CHECK(tool_models::bearable_torque(ring) == doctest::Approx(451.0));
    content::AssemblyJoint joint;
    joint.spec.torque = {358.0, 340.1, 375.9};  // 358 N·m ± 5 %
    for (const Task task : {Task::tighten, Task::loosen}) {
        CHECK(fault_of(open, joint, task) == ToolFault::too_weak);
        CHECK(fault_of(ring, joint, task) == ToolFault::none);
    }
    joint.spec.torque = {300.0, 285.0, 315.0};
    CHECK(fault_of(open, joint, Task::tighten) == ToolFault::none);
}

TEST_CASE("Tool choice: a key bears the torque at which its hexagon yields") {
    content::WrenchDesign key = tool_of_24(content::ToolKind::hex_key, content::ToolHeadKind::hex_key);
    key.size = 6.0 * mm;
    content::AssemblyJoint joint;
    joint.spec.torque.high = 54.0;
    CHECK(fault_of(key, joint, Task::tighten) == ToolFault::none);
    joint.spec.torque.high = 55.0;  // 0.857 · 0.2 · 1.47 GPa · (6 mm)³ = 54.4 N·m
    CHECK(fault_of(key, joint, Task::tighten) == ToolFault::too_weak);
    // A bit of this size on a ratchet bears no more, although its square drive does.
    content::WrenchDesign bit = tool_of_24(content::ToolKind::ratchet, content::ToolHeadKind::hex_bit);
    bit.size = 6.0 * mm;
    bit.teeth = 72;
    CHECK(fault_of(bit, joint, Task::tighten) == ToolFault::too_weak);
    joint.spec.torque.high = 54.0;
    CHECK(fault_of(bit, joint, Task::tighten) == ToolFault::none);
}

TEST_CASE("Tool choice: the trainee is responsible only if another choice has no fault") {
    content::Assembly assembly = load("cover-m8", "torque_wrench");
    const auto fault = [&](Task task) { return faults_of_choice(assembly, task).at(0); };
    CHECK(fault(Task::tighten) == ToolFault::none);
    CHECK(fault(Task::loosen) == ToolFault::torque_wrench_loosens);
    assembly.tools.front().wrench.jaw = 17.2 * mm;  // the other tool does not fit
    CHECK(fault(Task::loosen) == ToolFault::none);
    assembly.tools.front().wrench.jaw = 13.2 * mm;
    // The other tool is too weak for one joint, so each choice has a fault.
    const double torque = std::exchange(assembly.joints[3].spec.torque.high, 65.0);
    CHECK(fault(Task::loosen) == ToolFault::none);
    assembly.joints[3].spec.torque.high = torque;
    assembly.joints[0].tool = "torque_wrench";  // by the author
    CHECK(fault(Task::loosen) == ToolFault::none);
    CHECK(faults_of_choice(assembly, Task::loosen).at(1) == ToolFault::torque_wrench_loosens);
}

TEST_CASE("Tool choice: under the published law no tool is too weak") {
    content::Assembly assembly = load("cover-m8", "");
    assembly.tools.at(1).wrench.kind = content::ToolKind::ring_wrench;
    assembly.tools.at(1).wrench.head = content::ToolHeadKind::ring;
    assembly.tools.at(1).wrench.size = 13.0 * mm;
    for (content::AssemblyJoint& joint : assembly.joints) joint.spec.torque.high = 80.0;
    CHECK(faults_of_choice(assembly, Task::tighten).at(0) == ToolFault::too_weak);
    assembly.law = joint::Law::published;
    CHECK(faults_of_choice(assembly, Task::tighten).at(0) == ToolFault::none);
}

TEST_CASE("Tool choice: no tool of a shipped lesson is too weak, in any variant") {
    int checked = 0;
    for (const std::string& name : content::assembly_names()) {
        content::LoadedAssembly loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        std::vector<std::string> variants;
        for (const content::AssemblyVariant& variant : loaded.assembly.variants)
            variants.push_back(variant.name);
        if (variants.empty()) variants.emplace_back();
        for (const std::string& variant : variants) {
            CAPTURE(name);
            CAPTURE(variant);
            loaded = content::load_assembly(name, variant);
            REQUIRE(loaded.ok());
            for (std::size_t i = 0; i < loaded.assembly.joints.size(); ++i)
                for (const std::size_t tool : content::tools_of_joint(loaded.assembly, i)) {
                    const content::WrenchDesign& design = loaded.assembly.tools[tool].wrench;
                    if (!content::suits(design, loaded.assembly.joints[i].design)) continue;
                    CHECK(fault_of(design, loaded.assembly.joints[i], Task::tighten) == ToolFault::none);
                    ++checked;
                }
        }
    }
    CHECK(checked > 100);
}

TEST_CASE(
    "Tool choice: loosening with a torque wrench costs 5 points once, and the trainee is told at once") {
    for (const char* tool : {"wrench", "torque_wrench"}) {
        CAPTURE(tool);
        const content::Assembly assembly = load("cover-m8", tool);
        session::LessonOptions options;
        options.task = Task::loosen;
        int reported = 0;
        double first_torque = 0.0;  // N·m, on the nut when the mistake was reported
        const test::PlayedSession played = test::play_and_replay(
            assembly, options, "expert", session::restore_setup, [&](const session::ReplayTick& tick) {
                for (const LessonEvent& event : tick.lesson.events)
                    if (event.mistake == MistakeKind::torque_wrench_loosens && reported++ == 0)
                        first_torque = std::abs(tick.output.wrench_torque);
            });
        const bool wrong = std::string_view(tool) == "torque_wrench";
        CHECK(played.mismatches == 0);
        CHECK(played.result.finished);
        CHECK(reported == (wrong ? 1 : 0));
        CHECK(played.result.score == doctest::Approx(wrong ? 95.0 : 100.0));
        CHECK(has_reason(played.result, DeductionKind::torque_wrench_loosens) == wrong);
        if (wrong) CHECK(first_torque < 2.0);
    }
}

TEST_CASE("Tool choice: a weak tool costs 5 points before it bends") {
    content::Assembly assembly = load("cover-m8", "torque_wrench");
    // Another choosable wrench bears the torque; this one is tested with 64.5 N·m.
    assembly.tools.front().wrench = assembly.wrench;
    assembly.tools.front().wrench.kind = content::ToolKind::ring_wrench;
    assembly.tools.front().wrench.head = content::ToolHeadKind::ring;
    assembly.tools.front().wrench.size = 13.0 * mm;
    for (content::AssemblyJoint& joint : assembly.joints) joint.spec.torque.high = 65.0;
    const session::LessonOptions options;
    const test::PlayedSession played =
        test::play_and_replay(assembly, options, "expert", test::setup_from_memory(assembly, options));
    CHECK(has_reason(played.result, DeductionKind::weak_tool));
    CHECK_FALSE(has_reason(played.result, DeductionKind::tool_bent));
    CHECK(played.result.score == doctest::Approx(95.0));
}

}  // namespace bolt::lesson::tool_choice_test
