// Variants that work on some joints of a file: what the lesson has, and the mistakes of their authors.
#include <doctest/doctest.h>

#include <algorithm>

#include "support.hpp"

namespace content_variants_test {

using namespace bolt;
using namespace content_test;
using content::Assembly;

namespace {

Assembly zq350(const char* variant) {
    content::LoadedAssembly loaded = content::load_assembly("zq350", variant);
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

std::vector<std::string> tool_names(const Assembly& assembly) {
    std::vector<std::string> names;
    for (const content::Tool& tool : assembly.tools) names.push_back(tool.name);
    return names;
}

std::vector<std::string> ids(const Assembly& assembly, const std::vector<std::size_t>& order) {
    std::vector<std::string> names;
    for (const std::size_t joint : order) names.push_back(assembly.joints[joint].design.id);
    return names;
}

// The small file with this variant.
std::string with_variant(const std::string& members) {
    return edited(cover(), "\"views\": [",
                  "\"variants\": { \"half\": { " + members + " } },\n  \"views\": [");
}

// The only message about the small file with this variant, from its JSON pointer on.
std::string only_message(const std::string& members) {
    const std::vector<std::string> all = messages(with_variant(members));
    for (const std::string& line : all) CAPTURE(line);
    REQUIRE(all.size() == 1);
    return all[0].substr(all[0].find("/variants"));
}

}  // namespace

TEST_CASE("Variants: zq350 has lessons about its covers and its feet, and the casing bolts as before") {
    const Assembly casing = zq350(""), covers = zq350("bearing_covers"), feet = zq350("foot_bolts");
    CHECK(casing.variant == "carbon_steel");
    CHECK(casing.joints.size() == 12);
    CHECK(casing.flange.joints_interact);
    CHECK(tool_names(casing) == std::vector<std::string>{"wrench", "torque_wrench"});
    CHECK(casing.added_models.model.empty());

    CHECK(covers.joints.size() == 28);
    CHECK_FALSE(covers.flange.joints_interact);
    CHECK(tool_names(covers) == std::vector<std::string>{"hex_key_6"});
    CHECK(covers.tool == "hex_key_6");
    CHECK(covers.models.contact == casing.models.contact);
    CHECK(covers.added_models.contact.empty());

    CHECK(feet.joints.size() == 8);
    CHECK_FALSE(feet.flange.joints_interact);
    CHECK(tool_names(feet) == std::vector<std::string>{"ratchet_30", "ring_30"});
    CHECK(content::model_paths(feet, &content::ModelFiles::contact).size() == 2);
    for (const Assembly* lesson : {&covers, &feet}) {
        for (const char* language : {"en", "de", "zh"}) {
            REQUIRE(lesson->lesson_texts.contains(language));
            CHECK(lesson->lesson_texts.at(language) != casing.lesson_texts.at(language));
        }
        // Every joint is tightened once in every pass.
        for (const content::Pass& pass : lesson->passes) {
            std::vector<std::size_t> order = pass.order;
            std::sort(order.begin(), order.end());
            CHECK(std::adjacent_find(order.begin(), order.end()) == order.end());
            CHECK(order.size() == lesson->joints.size());
        }
    }
}

TEST_CASE("Variants: the screws of a cover of zq350 are tightened crosswise, one cover after the other") {
    const Assembly covers = zq350("bearing_covers");
    const std::vector<std::size_t>& order = covers.passes[1].order;
    std::size_t first = 0;
    for (const std::size_t count : {4U, 4U, 6U, 4U, 4U, 6U}) {
        Vec3 middle(0.0);
        for (std::size_t i = first; i < first + count; ++i)
            middle += covers.joints[order[i]].design.seat / static_cast<double>(count);
        CHECK(std::abs(middle.y) < 1e-6);  // one whole cover, whose middle is on the axis of its shaft
        for (std::size_t i = first; i + 1 < first + count; ++i) {
            const Vec3 from = covers.joints[order[i]].design.seat - middle,
                       to = covers.joints[order[i + 1]].design.seat - middle;
            // The next screw is never the neighbour, except on the way to the second pair of four.
            if (count == 6 || (i - first) % 2 == 0) CHECK(glm::dot(from, to) < 0.0);
        }
        first += count;
    }
    CHECK(first == order.size());
}

TEST_CASE("Variants: the joints of a variant keep the order of the file, and its list is their order") {
    const auto loaded = content::parse_assembly(
        with_variant(R"("joints": ["B4", "B1", "B2"], "lesson": { "en": "Three of them." })"), "f", "half");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    const Assembly& a = loaded.assembly;
    REQUIRE(a.joints.size() == 3);
    CHECK(a.joints[2].design.id == "B4");
    CHECK(a.joints[2].index_in_file == 3);
    CHECK(ids(a, a.passes[1].order) == std::vector<std::string>{"B4", "B1", "B2"});
    CHECK(a.lesson_texts.at("en") == "Three of them.");
    const auto whole = content::parse_assembly(with_variant(R"("joints": ["B4"])"), "f");
    CHECK(whole.assembly.joints.size() == 4);  // without a default variant the plain file is a lesson too
}

TEST_CASE("Variants: changes to the joint types do not concern the types of other joints") {
    // A2-70 with 72 N·m is right for the casing bolts; it would break the cover screws, which have their own.
    const Assembly stainless = zq350("stainless");
    CHECK(stainless.joints.size() == 12);
    CHECK(stainless.joints[0].design.bolt_class.name == "A2-70");
    CHECK(stainless.joints[0].spec.torque.target == 72.0);
}

TEST_CASE("Variants: mistakes in the list of joints are reported with their remedy") {
    CHECK(only_message(R"("joints": ["B1", "B33"])") ==
          "/variants/half/joints/1: \"B33\" is not a joint of this file; did you mean \"B3\"?");
    CHECK(
        only_message(R"("joints": ["B1", "B2", "B1"])") ==
        "/variants/half/joints/2: \"B1\" appears twice in this order; expected every joint once; it appears "
        "first in line 58");
    CHECK(
        only_message(R"("joints": ["B1", "B2"], "passes": [{ "kind": "run_down" },
        { "kind": "tighten", "percent": 100, "order": ["B2", "B1", "B4"] }])") ==
        "/variants/half/passes/1/order/2: \"B4\" is not a joint of this variant; expected every joint once, "
        "and nothing else");
    CHECK(only_message(R"("joint": ["B1"])") ==
          "/variants/half/joint: unknown property \"joint\"; did you mean \"joints\"?");
}

TEST_CASE("Variants: a tool that the file lacks, and one that does not fit, are reported") {
    CHECK(only_message(R"("joints": ["B1"], "tool": "wrenhc")") ==
          "/variants/half/tool: there is no tool \"wrenhc\"; did you mean \"wrench\"?");
    const std::string other = edited(
        with_variant(R"("joints": ["B1"])"), "\"joint_types\":",
        R"("more_tools": { "big": { "kind": "ring_wrench", "size_mm": 24, "handle_length_mm": 230 } }, "joint_types":)");
    const std::vector<std::string> all = messages(other);
    REQUIRE(all.size() == 1);
    CHECK(all[0].find("a ring of 24 mm does not fit M8, 13 mm across flats; expected 13 mm") !=
          std::string::npos);
}

TEST_CASE("Variants: added models must name a file for each model of the assembly") {
    CHECK(only_message(R"("added_models": { "model": "stand.glb" })") ==
          "/variants/half/added_models/model: the file names no \"model\" to add to; expected no \"model\" "
          "here");
    const std::string file =
        edited(with_variant(R"("added_models": { "model": "stand.glb" })"), "\"tool\": {",
               R"("model": "a.glb", "contact_model": "a.contact.glb", "tool": {)");
    const std::vector<std::string> all = messages(file);
    REQUIRE(all.size() == 1);
    CHECK(all[0].substr(all[0].find("/variants")) ==
          "/variants/half/added_models: the added models lack \"contact_model\", which the file names; "
          "expected \"contact_model\" of the added parts");
}

TEST_CASE("Variants: a flange couples all joints of a variant or none") {
    std::string file = with_variant(R"("joints": ["B1", "B2"])");
    file = edited(std::move(file), "\"joint_types\": {",
                  R"("flange": { "thickness_mm": 10, "E_GPa": 70, "interface_stiffness_GPa_per_m": 500,
                       "joint_types": ["M8x30"] }, "joint_types": {)");
    CHECK(messages(file).empty());
    CHECK(content::parse_assembly(file, "f", "half").assembly.flange.joints_interact);
    // B2 becomes of a type that the flange does not couple.
    std::string mixed = edited(file, R"("id": "B2", "type": "M8x30")", R"("id": "B2", "type": "other")");
    const std::size_t type = mixed.find("\"M8x30\": {"), end = mixed.find("\"joints\": [");
    const std::string body = mixed.substr(type, mixed.rfind('}', end) - type);
    mixed =
        edited(mixed, "\"M8x30\": {", "\"other\": {" + body.substr(body.find('{') + 1) + ", \"M8x30\": {");
    const std::vector<std::string> all = messages(mixed);
    REQUIRE_FALSE(all.empty());
    CHECK(std::any_of(all.begin(), all.end(), [](const std::string& line) {
        return line.find("the flange couples 1 of the 2 joints; expected all of them, or none") !=
               std::string::npos;
    }));
}

}  // namespace content_variants_test
