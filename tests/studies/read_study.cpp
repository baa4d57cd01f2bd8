// Reading of studies, the mistakes that the reader reports, and the shipped studies.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "content/format/folders.hpp"
#include "content/format/schema.hpp"
#include "content/studies/study.hpp"
#include "engine/base/file.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/replaced.hpp"

namespace read_study_test {

using namespace bolt;
using namespace bolt::content;
using test::replaced;

namespace {

const std::string everything = R"({
  "$schema": "study.schema.json",
  "format": "boltwright study 1",
  "id": "help",
  "title": { "en": "Help" },
  "information": { "en": "Purpose." },
  "consent": { "en": ["I agree.", "I can stop."] },
  "design": { "subjects": "within", "order": "random", "participants": 12, "lessons": 2, "seed": 5,
              "blind": true, "break_minutes": 1.5, "show_results": true },
  "lesson": { "assembly": "cover-m8", "variant": "dry", "tool": "click", "mode": "guided", "task": "loosen",
              "law": "published", "hand": "free", "devices": ["simulated-arm"], "force_scale": 0.5 },
  "training": { "minutes": 10, "lesson": { "mode": "practice", "guide": false } },
  "conditions": [
    { "id": "a", "title": { "en": "A" }, "lesson": { "guide": true }, "levels": { "force": "on", "view": "off" } },
    { "id": "b", "title": { "en": "B" }, "lesson": { "guide": false }, "levels": { "force": "off", "view": "off" } },
    { "id": "c", "title": { "en": "C" }, "lesson": { "view_help": false }, "levels": { "force": "on", "view": "off" } }
  ],
  "forms": [
    { "form": "tlx", "when": ["before", "after_training", "after_lesson"] },
    { "form": "paper", "when": ["after_condition", "after", "retention"] }
  ],
  "retention": { "after_days": 7, "lesson": { "mode": "assessment" } },
  "comparisons": [
    { "measure": "paper.stability" },
    { "measure": "bumps", "conditions": ["c", "a"] },
    { "measure": "tlx.workload", "factor": "force" }
  ],
  "published": [{ "measure": "paper.stability", "min": 6, "max": 9, "mean": "6.684", "n": 20, "source": "x" }]
}
)";

std::vector<Questionnaire> forms() {
    std::vector<Questionnaire> loaded;
    for (const char* id : {"tlx", "paper"})
        loaded.push_back(load_questionnaire(content_folder() / "questionnaires" / (std::string(id) + ".json"))
                             .questionnaire);
    return loaded;
}

std::vector<std::string> mistakes(const std::string& text) {
    const std::vector<Questionnaire> known = forms();
    std::vector<std::string> messages;
    for (const Error& error : parse_study(text, "study.json", &known).errors) {
        CHECK(error.code == ErrorCode::bad_content);
        messages.push_back(error.message());
    }
    return messages;
}

// The file has exactly one mistake if `to` replaces `from`: at the line and column where `at` stands then.
void check_mistake(const std::string& from, const std::string& to, const std::string& at,
                   const std::string& message) {
    const std::string text = replaced(everything, from, to);
    const std::size_t offset = text.find(at);
    REQUIRE(offset != std::string::npos);
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n') + 1;
    const std::size_t column = offset - (text.rfind('\n', offset) + 1) + 1;
    const std::vector<std::string> found = mistakes(text);
    CAPTURE(to);
    REQUIRE(found.size() == 1);
    CHECK(found[0].starts_with("study.json:" + std::to_string(line) + ":" + std::to_string(column) + ": "));
    CHECK_MESSAGE(found[0].find(message) != std::string::npos, found[0]);
}

}  // namespace

TEST_CASE("Studies: every member is read") {
    const std::vector<Questionnaire> known = forms();
    const LoadedStudy loaded = parse_study(everything, "study.json", &known);
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    const Study& study = loaded.study;
    CHECK(study.consent.at("en").size() == 2);
    CHECK(study.design.order == StudyOrder::random);
    CHECK(study.design.lessons == 2);
    CHECK(study.design.shortest_break == 90.0);
    CHECK((study.design.blind && study.design.show_results));
    const StudyLesson& b = study.conditions[1].lesson;
    CHECK(b.assembly == "cover-m8");
    CHECK(b.variant == "dry");
    CHECK(b.tool == "click");
    CHECK(b.task == "loosen");
    CHECK(b.law == "published");
    CHECK(b.hand == "free");
    CHECK(b.devices == std::vector<std::string>{"simulated-arm"});
    CHECK(b.force_scale == 0.5);
    CHECK((b.view_help && !b.guiding_force && study.conditions[0].lesson.guiding_force));
    CHECK_FALSE(study.conditions[2].lesson.view_help);
    CHECK(study.training->duration == 600.0);
    CHECK(study.training->lesson.mode == "practice");
    CHECK(study.retention->lesson.mode == "assessment");
    CHECK(study.forms[0].is_at(FormTime::after_lesson));
    CHECK_FALSE(study.forms[0].is_at(FormTime::after));
    CHECK(study.comparisons[0].groups.size() == 3);
    CHECK(study.comparisons[1].groups[0].conditions == std::vector<std::size_t>{2});
    CHECK(study.comparisons[2].groups[0].conditions == std::vector<std::size_t>{0, 2});
    CHECK(study.published[0].decimals == 3);
    CHECK(study.published[0].mean == 6.684);
}

TEST_CASE("Studies: every contradiction has its line and column") {
    check_mistake(R"("id": "b")", R"("id": "a")", R"("a", "title": { "en": "B")",
                  "there is another condition \"a\"");
    check_mistake(R"("guide": false }, "levels")", R"("guide": true }, "levels")", R"({ "id": "b")",
                  "the lessons are those of condition \"a\"; expected a setting that differs");
    check_mistake(R"("force": "off", "view": "off")", R"("force": "off")", R"({ "id": "b")",
                  "the factors are not those of condition \"a\"");
    check_mistake(R"("mode": "practice", "guide": false)", R"("mode": "practice", "guide": true)",
                  R"(true } },)", "there is no guiding force in mode practice");
    check_mistake(R"("after", "retention"] })",
                  R"("after", "retention"] }, { "form": "tlx", "when": ["after_lesson"] })",
                  R"("tlx", "when": ["after_lesson"])", "form \"tlx\" is listed twice");
    check_mistake(R"(["c", "a"])", R"(["c", "d"])", R"("d"])", "there is no condition \"d\"");
    check_mistake(R"(["c", "a"])", R"(["c", "c"])", R"("c"])", "\"c\" is listed twice");
    check_mistake(R"("factor": "force")", R"("factor": "fource")", R"("fource")",
                  "there is no factor \"fource\"; did you mean \"force\"?");
    check_mistake(R"("factor": "force")", R"("factor": "view")", R"("view" })",
                  "all conditions have the same level of \"view\"");
    check_mistake(R"({ "measure": "paper.stability" })", R"({ "measure": "paper.stabilty" })",
                  R"("paper.stabilty")",
                  "there is no measure \"paper.stabilty\"; did you mean \"paper.stability\"?");
    check_mistake(R"("after_training", "after_lesson")", R"("after_training")", R"("tlx.workload")",
                  "form \"tlx\" is not presented in the conditions");
    check_mistake(R"({ "measure": "paper.stability" })",
                  R"({ "measure": "paper.stability", "retention": true })",
                  "true },\n    { \"measure\": \"bumps\"", "the retention test cannot compare conditions");
    check_mistake(R"("mean": "6.684")", R"("mean": "6,684")", R"("6,684")", "no number");
    check_mistake(R"("min": 6, "max": 9)", R"("min": 9, "max": 6)", "6, \"mean\"",
                  "the maximum 6 is less than the minimum 9");
    check_mistake(R"("mean": "6.684")", R"("mean": "9.684")", R"("9.684")",
                  "the mean 9.684 is not between minimum and maximum");
    check_mistake(R"("min": 6, "max": 9, "mean": "6.684")", R"("mean": "18.263")", R"("18.263")",
                  "18.263 is not on the scale; expected 0 to 10, the scale of the form");
    check_mistake(R"("max": 9)", R"("max": 11)", "11, \"mean\"", "11 is not on the scale; expected 0 to 10");
    check_mistake(R"("id": "help")", R"("id": "he lp")", R"("he lp")", "characters that are not allowed");
    check_mistake(R"("participants": 12)", R"("participants": 0)", "0, \"lessons\"", "expected");
    check_mistake(R"("minutes": 10)", R"("minuets": 10)", R"("minuets")", "did you mean \"minutes\"?");
}

TEST_CASE("Studies: an interaction and a comparison of two times are read, and their mistakes have a place") {
    const std::vector<Questionnaire> known = forms();
    const auto with = [](const std::string& comparison) {
        std::string text = replaced(everything, R"("levels": { "force": "on", "view": "off" } }
  ])",
                                    R"("levels": { "force": "on", "view": "on" } },
    { "id": "d", "title": { "en": "D" }, "lesson": { "guide": false, "view_help": false }, "levels": { "force": "off", "view": "on" } }
  ])");
        return replaced(text, R"({ "measure": "paper.stability" })", comparison);
    };
    const LoadedStudy loaded =
        parse_study(with(R"({ "measure": "bumps", "factor": "force", "interaction": "view" },
             { "measure": "tlx.workload", "times": ["before", "after_training"] })"),
                    "study.json", &known);
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    const PlannedComparison& interaction = loaded.study.comparisons[0];
    CHECK(interaction.interaction == "view");
    REQUIRE(interaction.interaction_groups.size() == 2);
    CHECK(conditions_in_both(interaction.groups[0], interaction.interaction_groups[1]) ==
          std::vector<std::size_t>{2});
    CHECK(loaded.study.comparisons[1].times == std::vector{FormTime::before, FormTime::after_training});
    const auto mistake = [&](const std::string& comparison) {
        const std::vector<std::string> found = mistakes(with(comparison));
        REQUIRE_MESSAGE(found.size() == 1, comparison);
        CHECK(found[0].starts_with("study.json:"));
        return found[0];
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(mistake(R"({ "measure": "bumps", "interaction": "view" })"),
              "only one factor; expected \"factor\""));
    CHECK(has(mistake(R"({ "measure": "bumps", "factor": "force", "interaction": "force" })"),
              "no interaction with itself"));
    CHECK(has(mistake(R"({ "measure": "bumps", "factor": "force", "interaction": "veiw" })"),
              "did you mean \"view\""));
    CHECK(has(mistake(R"({ "measure": "paper.stability", "times": ["before", "after"] })"),
              "form \"paper\" is not presented at the time \"before\""));
    CHECK(has(mistake(R"({ "measure": "tlx.workload", "times": ["before", "before"] })"), "listed twice"));
    CHECK(has(
        mistake(R"({ "measure": "tlx.workload", "times": ["before", "after_training"], "factor": "force" })"),
        "both \"times\" and \"factor\" are given"));
    CHECK(has(mistake(R"({ "measure": "bumps", "times": ["before", "after"] })"),
              "there is no measure \"bumps\" of a form"));
}

TEST_CASE("Studies: contradictions of a valid plan have their line and column") {
    const test::Folder folder;
    const auto weaknesses = [&](const std::string& text) {
        REQUIRE(write_file(folder / study_file_name, text));
        const LoadedStudy loaded = parse_study(text, "study.json");
        std::vector<std::string> messages;
        for (const Error& error : plan_weaknesses(loaded.study, folder.path())) {
            CHECK(error.line > 0);
            CHECK_FALSE(error.expected.empty());
            messages.push_back(error.what);
        }
        return messages;
    };
    // The lessons of `everything` have a free hand and a device.
    CHECK(weaknesses(everything) ==
          std::vector<std::string>{"the devices move the hand, so \"hand\" has no effect"});
    const std::string plain = replaced(everything, R"("hand": "free", )", "");
    CHECK(weaknesses(plain).empty());
    const std::string repeated = replaced(plain, R"({ "measure": "bumps", "conditions": ["c", "a"] })",
                                          R"({ "measure": "paper.stability" })");
    CHECK(weaknesses(repeated).at(0).starts_with("comparison 2 repeats comparison 1"));
    std::string together = plain;
    for (const char* from : {R"("force": "on", "view": "off")", R"("force": "on", "view": "off")"})
        together = replaced(together, from, R"("force": "on", "view": "far")");
    CHECK(weaknesses(together).at(0).starts_with("the factors \"force\" and \"view\" change together"));
}

TEST_CASE("Studies: times of forms that the plan does not have are mistakes") {
    std::string text = everything;
    const auto cut = [&](const std::string& key) {
        const std::size_t from = text.find("  \"" + key + "\"");
        text.erase(from, text.find('\n', from) + 1 - from);
    };
    cut("training");
    cut("retention");
    const std::vector<std::string> found = mistakes(text);
    REQUIRE(found.size() == 2);
    CHECK(found[0].find("the study has no training") != std::string::npos);
    CHECK(found[1].find("the study has no retention test") != std::string::npos);
}

TEST_CASE("Studies: groups of different people are compared in pairs, and have no order") {
    const std::string text = replaced(everything, R"("subjects": "within")", R"("subjects": "between")");
    const std::vector<std::string> found = mistakes(text);
    REQUIRE(found.size() == 2);
    CHECK(found[0].find("so it has no order") != std::string::npos);
    CHECK(found[1].find("3 groups of different people are compared; expected two of them") !=
          std::string::npos);
}

TEST_CASE("Studies: the shipped studies have no mistakes and can be read in English and German") {
    const JsonSchema schema(study_schema_text());
    int shipped = 0;
    for (const auto& entry : std::filesystem::directory_iterator(content_folder() / "studies")) {
        if (!entry.is_directory()) continue;
        ++shipped;
        const LoadedStudy loaded = load_study(entry.path(), content_folder() / "questionnaires");
        for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
        CHECK(loaded.study.id == entry.path().filename());
        CHECK(complete_languages(loaded.study) == std::vector<std::string>{"de", "en"});
        for (const auto& [language, statements] : loaded.study.consent)
            CHECK(statements.size() == loaded.study.consent.at("en").size());
        const auto text = read_file(entry.path() / study_file_name, 1U << 20U, ErrorCode::failed);
        REQUIRE(text);
        CHECK(validator_errors(nlohmann::json::parse(*text), schema).empty());
    }
    CHECK(shipped == 2);
    const auto file =
        read_file(content_folder() / "schema" / "study.schema.json", 1U << 20U, ErrorCode::failed);
    REQUIRE(file);
    CHECK(*file == study_schema_text());
}

TEST_CASE("Studies: a change of the plan or of a form changes the checksum; a missing form is a mistake") {
    const test::Folder folder;
    std::filesystem::copy(content_folder() / "studies" / "paper-2018", folder.path(),
                          std::filesystem::copy_options::recursive);
    CHECK_FALSE(load_study(folder.path()).ok());
    std::filesystem::copy(content_folder() / "questionnaires", folder / forms_folder_name,
                          std::filesystem::copy_options::recursive);
    const LoadedStudy first = load_study(folder.path());
    REQUIRE(first.ok());
    CHECK(load_study(folder.path()).study.checksum == first.study.checksum);
    const auto form = folder / "questionnaires/sus.json";
    const auto text = read_file(form, 1U << 20U, ErrorCode::failed);
    REQUIRE(text);
    REQUIRE(write_file(form, *text + "\n"));
    CHECK(load_study(folder.path()).study.checksum != first.study.checksum);
    // A form whose texts the laboratory has to add first.
    REQUIRE(write_file(folder / study_file_name,
                       replaced(*read_file(folder / study_file_name, 1U << 20U, ErrorCode::failed),
                                R"({ "form": "sus", "when": ["after"] })",
                                R"({ "form": "ssq", "when": ["before", "after"] })")));
    const LoadedStudy with_ssq = load_study(folder.path());
    REQUIRE(with_ssq.ok());
    CHECK(complete_languages(with_ssq.study).empty());
    REQUIRE(write_file(form.parent_path() / "ssq.json", R"({"format": "boltwright questionnaire 2"})"));
    const LoadedStudy wrong = load_study(folder.path());
    REQUIRE_FALSE(wrong.ok());
    CHECK(wrong.errors.front().message().find("ssq.json:1:") != std::string::npos);
}

}  // namespace read_study_test
