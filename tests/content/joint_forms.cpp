// Screws in tapped holes, studs and locking nuts in an assembly file, and the messages about mistakes.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "content/format/schema.hpp"
#include "haptics/joint/design.hpp"
#include "support.hpp"

namespace content_joint_forms_test {

using namespace content_test;
using namespace bolt;

namespace {

// An M8 with a grip of 16 mm; `members` are added to its joint type.
std::string with_type(std::string_view added, std::string_view spec = R"("target_torque_Nm": 20)") {
    return R"({"title": {"en": "Pump"}, "lesson": {"en": "Tighten."}, "tool": {"kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140},
"joint_types": {"T": {"size": "M8", "class": "8.8", "members": [{"thickness_mm": 16, "material": "steel"}],
 "friction_thread": 0.12, "friction_bearing": 0.12,
 )" + std::string(added) +
           R"(,
 "spec": {"strategy": "torque", )" +
           std::string(spec) +
           R"(}}},
"joints": [{"id": "S1", "type": "T", "position_mm": [0, 0, 0]}],
"order": ["S1"], "passes": [{"kind": "run_down"}, {"kind": "tighten", "percent": 100}]})";
}

joint::JointDesign design_of(std::string_view added) {
    const content::LoadedAssembly loaded = content::parse_assembly(with_type(added), "f");
    for (const Error& error : loaded.errors) MESSAGE(error.message());
    REQUIRE(loaded.ok());
    return loaded.assembly.joints.at(0).design;
}

std::vector<std::string> mistakes_of(std::string_view added,
                                     std::string_view spec = R"("target_torque_Nm": 20)") {
    return messages(with_type(added, spec));
}

}  // namespace

TEST_CASE("Joint forms: a screw in a tapped hole is turned at its head and engages with its whole end") {
    const joint::JointDesign d = design_of(
        R"("form": "tapped_hole", "tapped_hole": {"material": "GJL-250"}, "bolt_length_mm": 30, "washer_under_head": true)");
    CHECK(d.form == joint::JointForm::tapped_hole);
    CHECK(d.turned == joint::TurnedPart::head);
    CHECK(d.hole.material.R_m == 250e6);
    CHECK(d.hole.material.shear_ratio == 1.15);
    CHECK(d.hole.engagement == doctest::Approx(0.0124));  // 30 − 16 − 1.6
    CHECK(d.seat.y == doctest::Approx(0.0016));           // on the washer
    CHECK(d.start_gap == doctest::Approx(0.0124 - 1.5 * 1.25e-3));
}

TEST_CASE(
    "Joint forms: a stud has an engagement of its own, a locking nut half of the torque that ISO 2320 "
    "allows") {
    const joint::JointDesign d = design_of(
        R"("form": "stud", "tapped_hole": {"material": "6082-T6", "tensile_strength_MPa": 310, "engagement_mm": 20}, "bolt_length_mm": 30, "locking_insert": true)");
    CHECK(d.form == joint::JointForm::stud);
    CHECK(d.turned == joint::TurnedPart::nut);
    CHECK(d.hole.material.R_m == 310e6);
    CHECK(d.hole.material.shear_ratio == 0.60);
    CHECK(d.hole.engagement == doctest::Approx(0.020));
    CHECK(d.locking_insert);
    CHECK(d.prevailing_torque == 3.0);
}

TEST_CASE("Joint forms: a file without a form is a through-bolt whose nut is turned") {
    const joint::JointDesign d = design_of(R"("bolt_length_mm": 30)");
    CHECK(d.form == joint::JointForm::through_bolt);
    CHECK(d.turned == joint::TurnedPart::nut);
    CHECK(d.prevailing_torque == 0.0);
}

TEST_CASE("Joint forms: a thread is right-handed unless its type, or the override of its joint, says left") {
    using joint::ThreadDirection;
    CHECK(design_of(R"("bolt_length_mm": 30)").thread_direction == ThreadDirection::right);
    CHECK(design_of(R"("bolt_length_mm": 30, "thread_direction": "right")").thread_direction ==
          ThreadDirection::right);
    const joint::JointDesign left = design_of(R"("bolt_length_mm": 30, "thread_direction": "left")");
    CHECK(left.thread_direction == ThreadDirection::left);
    CHECK(left.thread.thread.pitch == doctest::Approx(1.25e-3));
    for (const char* form :
         {R"("form": "stud", "tapped_hole": {"material": "C45", "engagement_mm": 8}, "bolt_length_mm": 30)",
          R"("form": "tapped_hole", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)",
          R"("turned": "head", "bolt_length_mm": 30)", R"("locking_insert": true, "bolt_length_mm": 30)"})
        CHECK(design_of(std::string(form) + R"(, "thread_direction": "left")").thread_direction ==
              ThreadDirection::left);
    std::string text = with_type(R"("bolt_length_mm": 30)");
    const std::string_view place = R"("position_mm": [0, 0, 0])";
    text.insert(text.find(place), R"("override": {"thread_direction": "left"}, )");
    const content::LoadedAssembly loaded = content::parse_assembly(text, "f");
    REQUIRE(loaded.ok());
    CHECK(loaded.assembly.joints[0].design.thread_direction == ThreadDirection::left);
}

TEST_CASE("Joint forms: forms and shapes of heads have the names that the schema permits") {
    const auto& properties = content::assembly_schema().json().at(
        nlohmann::json::json_pointer("/definitions/joint_type/properties"));
    const auto permits = [&](const char* member, const auto& names) {
        return properties.at(member).at("enum") == nlohmann::json(names.names);
    };
    CHECK(permits("form", joint::joint_form_names));
    CHECK(permits("head", joint::head_shape_names));
    CHECK(permits("counter_hold", joint::counter_hold_names));
    CHECK(permits("thread_direction", joint::thread_direction_names));
    for (const std::string_view shape : joint::head_shape_names.names) {
        const std::string members = R"("bolt_length_mm": 30, "head": ")" + std::string(shape) + '"';
        CHECK(name(design_of(members).head) == shape);
    }
}

TEST_CASE("Joint forms: mistakes are reported with their place and what would fit") {
    struct Mistake {
        const char* added;
        const char* message;
    };
    const Mistake mistakes[] = {
        {R"("form": "tapped", "bolt_length_mm": 30)",
         R"(4:10: /joint_types/T/form: "tapped" is not known here; expected one of through_bolt, tapped_hole, stud)"},
        {R"("bolt_length_mm": 30, "thread_direction": "lefthand")",
         R"(4:44: /joint_types/T/thread_direction: "lefthand" is not known here; expected one of right, left)"},
        {R"("bolt_length_mm": 30, "thread_direction": true)", R"(4:44: /joint_types/T/thread_direction: )"},
        {R"("bolt_length_mm": 30, "thread_directon": "left")",
         R"(4:24: /joint_types/T/thread_directon: unknown property "thread_directon"; did you mean "thread_direction"?)"},
        {R"("form": "stud", "tapped_hole": {"material": "C45", "engagement_mm": 8}, "counter_hold": "second_wrench", "bolt_length_mm": 30)",
         R"(4:90: /joint_types/T/counter_hold: only a through-bolt has a part for a second wrench; expected no such value)"},
        {R"("head": "socket", "counter_hold": "second_wrench", "bolt_length_mm": 30)",
         R"(4:36: /joint_types/T/counter_hold: a second wrench cannot hold a socket head; expected "fixed", or a hexagon head)"},
        {R"("form": "tapped_hole", "bolt_length_mm": 30)",
         R"(4:10: /joint_types/T/form: a joint of this form needs its tapped hole; expected tapped_hole with its material)"},
        {R"("tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)",
         R"(4:17: /joint_types/T/tapped_hole: a through-bolt has no tapped hole; expected the form tapped_hole or stud, or no such value)"},
        {R"("form": "stud", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)",
         R"(4:33: /joint_types/T/tapped_hole: a stud needs its engagement; expected engagement_mm, of 1 d (DIN 938), 1.25 d (DIN 939) or 2 d (DIN 835))"},
        {R"("form": "tapped_hole", "tapped_hole": {"material": "C46"}, "bolt_length_mm": 30)",
         R"(4:53: /joint_types/T/tapped_hole/material: "C46" is not a known material of a tapped part; did you mean "C45"?)"},
        {R"("form": "tapped_hole", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 18)",
         R"(4:79: /joint_types/T/bolt_length_mm: a screw of 18 mm is too short for a grip of 16 mm and a tapped hole; expected more than 18.5 mm: 2 pitches of its thread carry nothing)"},
        {R"("form": "tapped_hole", "tapped_hole": {"material": "C45", "engagement_mm": 15}, "bolt_length_mm": 30)",
         R"(4:77: /joint_types/T/tapped_hole/engagement_mm: an engagement of 15 mm, but the screw reaches 14 mm into the hole; expected at most 14 mm)"},
        {R"("form": "tapped_hole", "tapped_hole": {"material": "C45", "depth_mm": 12}, "bolt_length_mm": 30)",
         R"(4:72: /joint_types/T/tapped_hole/depth_mm: the screw meets the bottom of the hole: it reaches 14 mm into a hole of 12 mm; expected a deeper hole, or a shorter screw)"},
        {R"("form": "tapped_hole", "turned": "nut", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)",
         R"(4:35: /joint_types/T/turned: a screw in a tapped hole has no nut; expected "head")"},
        {R"("form": "tapped_hole", "locking_insert": true, "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)",
         R"(4:43: /joint_types/T/locking_insert: a screw in a tapped hole has no nut; expected false)"},
        {R"("form": "stud", "turned": "head", "tapped_hole": {"material": "C45", "engagement_mm": 8}, "bolt_length_mm": 30)",
         R"(4:28: /joint_types/T/turned: a stud has no head; expected "nut")"},
        {R"("form": "tapped_hole", "tapped_hole": {"material": "AlSi9Cu3", "engagement_mm": 6}, "bolt_length_mm": 30)",
         R"(4:82: /joint_types/T/tapped_hole/engagement_mm: the thread in AlSi9Cu3 strips at)"},
        {R"("form": "tapped_hole", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 60)",
         R"(4:79: /joint_types/T/bolt_length_mm: the head cannot reach its seat: the thread ends 38 mm under the head, the grip is 16 mm; expected a shorter bolt, or bolt_thread_length_mm of at least 44)"},
    };
    for (const Mistake& mistake : mistakes) {
        CAPTURE(mistake.added);
        const std::vector<std::string> found = mistakes_of(mistake.added);
        CHECK(found.size() == 1);
        if (!found.empty())
            CHECK(found.front().substr(0, std::string_view(mistake.message).size()) == mistake.message);
    }
}

TEST_CASE("Joint forms: the engagement that a message demands is accepted, and a little less is not") {
    const std::string hole =
        R"("form": "tapped_hole", "bolt_length_mm": 40, "bolt_thread_length_mm": 30, "tapped_hole": {"material": "AlSi9Cu3", "engagement_mm": )";
    for (const int target : {6, 9, 12, 15, 18, 20, 22, 24}) {
        CAPTURE(target);
        const std::string spec = R"("target_torque_Nm": )" + std::to_string(target);
        const std::vector<std::string> found = mistakes_of(hole + "2.6}", spec);
        REQUIRE(found.size() == 1);
        const std::size_t at = found.front().find("at least ");
        REQUIRE(at != std::string::npos);
        const double least = std::stod(found.front().substr(at + 9));
        CHECK(mistakes_of(hole + std::to_string(least) + "}", spec).empty());
        CHECK_FALSE(mistakes_of(hole + std::to_string(least - 0.2) + "}", spec).empty());
    }
}

TEST_CASE("Joint forms: a locking nut does not load the thread of its stud with its own torque") {
    const std::string stud =
        R"("form": "stud", "bolt_length_mm": 30, "locking_insert": true, "tapped_hole": {"material": "AlSi9Cu3", "engagement_mm": )";
    CHECK(mistakes_of(stud + "7.8}").empty());
    CHECK_FALSE(mistakes_of(stud + "7.3}").empty());
}

TEST_CASE("Joint forms: a variant that names another material does not keep the values of the first") {
    std::string text = with_type(
        R"("form": "tapped_hole", "tapped_hole": {"material": "ours", "E_GPa": 45, "tensile_strength_MPa": 200, "shear_ratio": 0.6}, "bolt_length_mm": 40, "bolt_thread_length_mm": 30)");
    text = edited(
        text, R"("order")",
        R"("variants": {"steel": {"joint_types": {"T": {"tapped_hole": {"material": "C45"}}}}}, "order")");
    const auto design = [&](const char* variant) {
        const content::LoadedAssembly loaded = content::parse_assembly(text, "f", variant);
        for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
        return loaded.assembly.joints.at(0).design;
    };
    CHECK(design("").hole.material.R_m == 200e6);
    CHECK(design("steel").hole.material.R_m == 650e6);
    CHECK(design("steel").hole.material.shear_ratio == 0.65);
}

TEST_CASE("Joint forms: a nut that is too high, a gap beyond the screw and heads that overlap are mistakes") {
    CHECK(mistakes_of(R"("bolt_length_mm": 25.6, "locking_insert": true)").size() == 1);
    CHECK(mistakes_of(R"("bolt_length_mm": 27, "locking_insert": true)").empty());
    CHECK(
        mistakes_of(
            R"("form": "tapped_hole", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30, "start_gap_mm": 100)")
            .size() == 1);
    std::string two = with_type(
        R"("form": "tapped_hole", "head": "socket", "tapped_hole": {"material": "C45"}, "bolt_length_mm": 30)");
    two = edited(two, R"("position_mm": [0, 0, 0]})",
                 R"("position_mm": [0, 0, 0]}, {"id": "S2", "type": "T", "position_mm": [12.5, 0, 0]})");
    two = edited(two, R"("order": ["S1"])", R"("order": ["S1", "S2"])");
    const std::vector<std::string> found = messages(two);
    REQUIRE(found.size() == 1);
    CHECK(found.front().find("their heads overlap; expected 13 mm or more") != std::string::npos);
}

}  // namespace content_joint_forms_test
