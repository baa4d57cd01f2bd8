// Passes that turn each nut by a share of its target angle, passes of a loosening lesson, and instructions.
#include <doctest/doctest.h>

#include "support.hpp"

namespace content_passes_test {

using namespace bolt;
using namespace content_test;
using content::PassKind;

namespace {

constexpr const char* torque_spec = R"("strategy": "torque",
        "target_torque_Nm": 20,
        "torque_tolerance_percent": 10)";
constexpr const char* angle_spec = R"("strategy": "torque_angle", "target_torque_Nm": 22,
        "min_torque_Nm": 15, "max_torque_Nm": 29, "min_angle_deg": 50, "max_angle_deg": 90, "target_angle_deg": 60)";

// The small file, tightened by an angle in `passes`.
std::string with_passes(const std::string& passes) {
    const std::string file = edited(cover(), torque_spec, angle_spec);
    const std::size_t begin = file.find("\"passes\": ["), end = file.find("],", begin);
    return file.substr(0, begin) + "\"passes\": [" + passes + file.substr(end);
}

std::string only_message(const std::string& file) {
    const std::vector<std::string> all = messages(file);
    REQUIRE(all.size() == 1);
    return all[0].substr(all[0].find("/passes"));
}

constexpr const char* run_down = R"({ "kind": "run_down" }, )";
constexpr const char* snug = R"({ "kind": "tighten", "percent": 30 }, )";

}  // namespace

TEST_CASE(
    "Passes: nuts are made snug and then turned by shares of the target angle, beyond yield if the file says "
    "so") {
    const content::LoadedAssembly loaded = content::parse_assembly(
        with_passes(std::string(run_down) + snug +
                    R"({ "kind": "turn", "percent": 50 }, { "kind": "turn", "percent": 100 })"),
        "f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    const std::vector<content::Pass>& passes = loaded.assembly.passes;
    REQUIRE(passes.size() == 4);
    CHECK(passes[1].kind == PassKind::tighten);
    CHECK(passes[1].fraction == doctest::Approx(0.3));  // it need not reach 100 percent
    CHECK(passes[2].kind == PassKind::turn);
    CHECK(passes[2].fraction == doctest::Approx(0.5));
    CHECK(passes[3].fraction == 1.0);
    CHECK(loaded.assembly.joints[0].spec.angle.target == doctest::Approx(to_radians(60.0)));
    CHECK(loaded.assembly.joints[0].spec.torque.high == 29.0);  // M8 of class 8.8 yields near 27.2 N·m
}

TEST_CASE("Passes: mistakes of a pass that turns are reported with their remedy") {
    const std::string begin = std::string(run_down) + snug;
    CHECK(only_message(with_passes(begin + R"({ "kind": "turn" })")) ==
          "/passes/2: a pass of kind \"turn\" without \"percent\"; expected a share of the target angle, "
          "100 in the last pass");
    CHECK(only_message(with_passes(begin + R"({ "kind": "turn", "percent": 90 })")) ==
          "/passes/2/percent: the last pass turns to 90 percent only; expected 100");
    CHECK(only_message(with_passes(
              begin + R"({ "kind": "turn", "percent": 100 }, { "kind": "turn", "percent": 50 })")) ==
          "/passes/3/percent: 50 percent after 100 percent; expected shares that do not fall, and 100 in "
          "the last pass");
    CHECK(only_message(with_passes(std::string(run_down) + R"({ "kind": "turn", "percent": 100 })")) ==
          "/passes/1/kind: this pass turns nuts that are not snug: no pass tightens them before; expected "
          "a pass of kind \"tighten\" to a small share of the target torque before it");
    CHECK(only_message(
              with_passes(begin +
                          R"({ "kind": "turn", "percent": 100 }, { "kind": "tighten", "percent": 100 })"))
              .find("/passes/3/kind: this pass tightens to a torque after the pass that turns by an angle, "
                    "in line ") == 0);
    CHECK(only_message(with_passes(begin + R"({ "kind": "recheck" }, { "kind": "turn", "percent": 100 })"))
              .find("/passes/2/kind: this pass rechecks before the last pass that turns, in line ") == 0);
    const std::vector<std::string> first =
        messages(with_passes(R"({ "kind": "turn", "percent": 100 }, { "kind": "run_down" })"));
    REQUIRE(first.size() == 2);
    CHECK(first[0].find("/passes/0/kind: this pass turns before the nuts are run down") != std::string::npos);
}

TEST_CASE("Passes: a variant has passes of its own, and its mistakes are found without choosing it") {
    const std::string turns = R"("variants": { "by angle": {
        "every_joint_type": { "spec": { "strategy": "torque_angle", "min_angle_deg": 50, "max_angle_deg": 90 } },
        "passes": [{ "kind": "run_down" }, { "kind": "tighten", "percent": 30 }, { "kind": "turn", "percent": 100 }] } },
        "passes")";
    const std::string file = edited(cover(), "\"passes\"", turns);
    const content::LoadedAssembly plain = content::parse_assembly(file, "f");
    for (const Error& error : plain.errors) FAIL_CHECK(error.message());
    CHECK(plain.assembly.passes.size() == 4);
    const content::LoadedAssembly variant = content::parse_assembly(file, "f", "by angle");
    REQUIRE(variant.ok());
    REQUIRE(variant.assembly.passes.size() == 3);
    CHECK(variant.assembly.passes[2].kind == PassKind::turn);
    CHECK(variant.assembly.joints[0].spec.angle.target == doctest::Approx(to_radians(70.0)));
    const std::vector<std::string> wrong =
        messages(edited(file, R"("strategy": "torque_angle", "min)", R"("min)"));
    REQUIRE(wrong.size() == 1);
    CHECK(wrong[0].find(
              "/variants/by angle/passes/2/kind: this pass turns by an angle, but \"M8x30\" has none") !=
          std::string::npos);
}

TEST_CASE(
    "Passes: a loosening lesson has the passes of the file, in the reverse order unless they say otherwise") {
    const std::string file = edited(cover(), "\"passes\"",
                                    R"("loosening": [{ "kind": "turn_back", "angle_deg": 60 },
                                       { "kind": "loosen", "order": ["B1", "B2", "B3", "B4"] }], "passes")");
    const content::LoadedAssembly loaded = content::parse_assembly(file, "f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    const std::vector<content::Pass>& passes = loaded.assembly.loosening;
    REQUIRE(passes.size() == 2);
    CHECK(passes[0].kind == PassKind::loosen);
    CHECK(passes[0].turn_back == doctest::Approx(to_radians(60.0)));
    std::vector<std::size_t> reverse = loaded.assembly.passes.back().order;
    std::reverse(reverse.begin(), reverse.end());
    CHECK(passes[0].order == reverse);
    CHECK(passes[1].turn_back == 0.0);
    CHECK(passes[1].order == std::vector<std::size_t>{0, 1, 2, 3});
    CHECK(content::parse_assembly(cover(), "f").assembly.loosening.empty());
}

TEST_CASE("Passes: an instruction has a text, a view of the file and a picture beside it") {
    const std::string file = edited(
        cover(), R"("kind": "recheck")",
        R"("kind": "recheck", "instruction": { "text": { "en": "Look.", "de": "Schauen Sie." }, "view": "top", "picture": "mark.png" })");
    const content::LoadedAssembly loaded = content::parse_assembly(file, "folder/f");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    const content::Instruction& instruction = loaded.assembly.passes.back().instruction;
    CHECK(instruction.text.at("de") == "Schauen Sie.");
    CHECK(instruction.view == "top");
    CHECK(instruction.picture == "folder/mark.png");
    CHECK(loaded.assembly.passes.front().instruction.text.empty());
}

}  // namespace content_passes_test
