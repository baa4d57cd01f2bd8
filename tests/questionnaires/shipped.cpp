// The files in content/questionnaires.
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/embedded.hpp"
#include "content/format/schema.hpp"
#include "tests/questionnaires/support.hpp"
#include "tests/support/replaced.hpp"

namespace questionnaire_shipped_test {

using namespace bolt;
using namespace bolt::content;
using namespace questionnaire_test;
using nlohmann::json;

namespace {

std::vector<std::string> ids_of(const Questionnaire& questionnaire) {
    std::vector<std::string> ids;
    for (const QuestionnaireItem& item : questionnaire.items) ids.push_back(item.id);
    return ids;
}

// Returns the ids of items, or "labels", that contradict `texts_may_be_shipped`: a text or label although
// only the key may be shipped, or a missing one, in a language that we ship, although it may be.
std::vector<std::string> text_mistakes(const Questionnaire& questionnaire) {
    std::vector<std::string> found;
    const AnswerLabels& labels = questionnaire.answer_scale.labels;
    if (!questionnaire.texts_may_be_shipped && !labels.empty()) found.emplace_back("labels");
    for (const char* language : {"en", "de"})
        if (questionnaire.texts_may_be_shipped) {
            for (const std::string& id : missing_texts(questionnaire, language)) found.push_back(id);
            if (!labels.contains(language)) found.emplace_back("labels");
        }
    for (const QuestionnaireItem& item : questionnaire.items)
        if (!questionnaire.texts_may_be_shipped && !(item.texts.empty() && item.labels.empty()))
            found.push_back(item.id);
    return found;
}

// prefix1, prefix2, ... up to `last`.
std::vector<std::string> numbers_to(int last, const std::string& prefix = {}) {
    std::vector<std::string> ids;
    for (int i = 1; i <= last; ++i) ids.push_back(prefix + std::to_string(i));
    return ids;
}

}  // namespace

TEST_CASE("Questionnaires: the folder has exactly the files that these tests load, each with its own id") {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(content_folder() / "questionnaires"))
        if (entry.path().extension() == ".json") found.insert(entry.path().stem().string());
    CHECK(found == std::set<std::string>(std::begin(shipped_ids), std::end(shipped_ids)));
    for (const std::string& id : found) {
        const LoadedQuestionnaire loaded = load_questionnaire(shipped_file(id));
        for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
        CHECK(loaded.questionnaire.id == id);
        for (const auto& titles : {loaded.questionnaire.titles, loaded.questionnaire.scales.back().titles})
            CHECK((titles.contains("en") && titles.contains("de")));
    }
}

TEST_CASE("Questionnaires: the shipped files satisfy the schema, and a wrong file does not") {
    const JsonSchema schema(questionnaire_schema_text());
    for (const char* id : shipped_ids) {
        json document = json::parse(shipped_text(id));
        CAPTURE(id);
        CHECK(document["$schema"] == "../schema/questionnaire.schema.json");
        CHECK(validator_errors(document, schema).empty());
        document["answers"]["step"] = 0;
        CHECK_FALSE(validator_errors(document, schema).empty());
    }
    const auto file =
        read_file(content_folder() / "schema" / "questionnaire.schema.json", 1U << 20U, ErrorCode::failed);
    REQUIRE(file);
    CHECK(*file == questionnaire_schema_text());
}

TEST_CASE("Questionnaires: items and their numbers are those of the publications") {
    CHECK(ids_of(shipped("sus")) == numbers_to(10));
    CHECK(ids_of(shipped("tlx")).size() == 6);
    CHECK(ids_of(shipped("ssq")) == numbers_to(16));
    std::vector<std::string> ipq{"G1"};
    for (const auto& [prefix, count] : {std::pair("SP", 5), std::pair("INV", 4), std::pair("REAL", 4)})
        for (const std::string& id : numbers_to(count, prefix)) ipq.push_back(id);
    CHECK(ids_of(shipped("ipq")) == ipq);
    CHECK(ids_of(shipped("paper")).size() == 4);
}

TEST_CASE("Questionnaires: files without texts report every item as missing, others none") {
    for (const char* language : {"en", "de"}) {
        for (const char* id : {"ssq", "ipq"})
            CHECK(missing_texts(shipped(id), language) == ids_of(shipped(id)));
        for (const char* id : {"sus", "tlx", "paper", "background"})
            CHECK(missing_texts(shipped(id), language).empty());
    }
    CHECK(missing_texts(shipped("sus"), "fi") == numbers_to(10));
    // A laboratory's copy with one text.
    const Questionnaire copy = parsed(
        test::replaced(shipped_text("ssq"), R"({ "id": "2" })", R"({"id": "2", "text": {"en": "x"}})"));
    CHECK(missing_texts(copy, "en").size() == 15);
    CHECK(missing_texts(copy, "de").size() == 16);
}

TEST_CASE("Questionnaires: only texts that may be shipped are shipped, and those are complete") {
    for (const char* id : shipped_ids) CHECK_MESSAGE(text_mistakes(shipped(id)).empty(), id);
    // The check can fail.
    Questionnaire ssq = shipped("ssq"), sus = shipped("sus");
    ssq.items[3].texts["en"] = "a text";
    CHECK(text_mistakes(ssq) == std::vector<std::string>{"4"});
    sus.items[9].texts.erase("de");
    sus.answer_scale.labels.erase("en");
    CHECK(text_mistakes(sus) == std::vector<std::string>{"labels", "10"});
    for (const char* id : {"tlx", "ssq", "ipq"}) CHECK_MESSAGE(has(shipped(id).licence, "unconfirmed"), id);
}

}  // namespace questionnaire_shipped_test
