// Reading of questionnaires, and the mistakes that the reader reports.
#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "tests/questionnaires/support.hpp"
#include "tests/support/replaced.hpp"

namespace read_questionnaire_test {

using namespace bolt;
using namespace bolt::content;
using namespace questionnaire_test;
using test::replaced;

namespace {

// A correct file with every member of the schema.
const std::string everything = R"({
  "$schema": "questionnaire.schema.json",
  "format": "boltwright questionnaire 1",
  "id": "comfort",
  "title": { "en": "Comfort", "fi": "Mukavuus" },
  "source": "these tests",
  "licence": "free",
  "texts_may_be_shipped": true,
  "answers": {
    "low": 1, "high": 4, "step": 0.5,
    "labels": { "en": ["never", "always"], "fi": ["a", "b", "c", "d", "e", "f", "g"] }
  },
  "items": [
    { "id": "seat", "text": { "en": "I sat well." } },
    { "id": "cold", "text": { "en": "I was cold." },
      "answers": { "low": 1, "high": 4, "step": 0.5 }, "labels": { "en": ["no", "yes"] } },
    { "id": "noise" }
  ],
  "scales": [
    { "id": "body", "title": { "en": "Body" }, "items": ["seat", "cold"],
      "reversed": ["cold"], "from_zero": true, "combine": "sum", "weight": 2.5 },
    { "id": "room", "title": { "en": "Room" }, "items": ["noise", "cold"], "combine": "mean" },
    { "id": "total", "title": { "en": "Total" }, "scales": ["body", "room"], "combine": "sum" }
  ]
}
)";

std::vector<std::string> mistakes(std::string_view text) {
    std::vector<std::string> messages;
    for (const Error& error : parse_questionnaire(text, "q.json").errors) {
        CHECK(error.code == ErrorCode::bad_content);
        messages.push_back(error.message());
    }
    return messages;
}

// "q.json:LINE:COLUMN: " of an offset in a text of ASCII characters.
std::string place_of(const std::string& text, std::size_t offset) {
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n') + 1;
    const std::size_t column = offset - (text.rfind('\n', offset) + 1) + 1;
    return "q.json:" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

// The file has exactly one mistake if `to` replaces `from`; its message begins with the line and column where
// `at` begins, and has `part`.
bool is_mistake(const std::string& from, const std::string& to, const std::string& at,
                const std::string& part) {
    const std::string text = replaced(everything, from, to);
    const std::size_t offset = text.find(at);
    REQUIRE_MESSAGE(offset != std::string::npos, at);
    const std::vector<std::string> found = mistakes(text);
    return found.size() == 1 && found.front().starts_with(place_of(text, offset)) && has(found.front(), part);
}

void check_mistake(const std::string& from, const std::string& to, const std::string& at,
                   const std::string& part) {
    std::string messages = to + ":\n";
    for (const std::string& message : mistakes(replaced(everything, from, to))) messages += message + "\n";
    CHECK_MESSAGE(is_mistake(from, to, at, part), messages);
}

}  // namespace

TEST_CASE("Questionnaires: all members are read") {
    const Questionnaire read = parsed(everything);
    CHECK(read.id == "comfort");
    CHECK(read.titles.at("fi") == "Mukavuus");
    CHECK(read.source == "these tests");
    CHECK(read.licence == "free");
    CHECK(read.texts_may_be_shipped);
    CHECK(read.answer_scale.low == 1.0);
    CHECK(read.answer_scale.high == 4.0);
    CHECK(read.answer_scale.step == 0.5);
    CHECK(answer_count(read.answer_scale) == 7);
    CHECK(read.answer_scale.labels.at("en") == std::vector<std::string>{"never", "always"});
    CHECK(read.answer_scale.labels.at("fi").size() == 7);
    REQUIRE(read.items.size() == 3);
    CHECK(read.items[0].texts.at("en") == "I sat well.");
    CHECK(read.items[1].labels.at("en").back() == "yes");
    CHECK(read.items[2].texts.empty());
    REQUIRE(read.scales.size() == 3);
    const QuestionnaireScale &body = read.scales[0], &room = read.scales[1], &total = read.scales[2];
    CHECK(body.titles.at("en") == "Body");
    REQUIRE(body.items.size() == 2);
    CHECK((body.items[0].item == 0 && !body.items[0].reversed));
    CHECK((body.items[1].item == 1 && body.items[1].reversed));
    CHECK(body.from_zero);
    CHECK(body.weight == 2.5);
    CHECK(room.combination == Combination::mean);
    CHECK((room.items[0].item == 2 && room.items[1].item == 1 && !room.items[1].reversed));
    CHECK_FALSE(room.from_zero);
    CHECK(room.weight == 1.0);
    CHECK(total.scales == std::vector<std::size_t>{0, 1});
    CHECK(total.combination == Combination::sum);
}

TEST_CASE("Questionnaires: a scale of scales combines raw values") {
    const auto scores = score(parsed(everything), {{"seat", 4.0}, {"cold", 1.5}, {"noise", 2.0}});
    REQUIRE(scores);
    CHECK((*scores)[0].score == 2.5 * 5.5);  // (4 − 1) + (1 + 4 − 1.5 − 1)
    CHECK((*scores)[1].score == 1.75);
    CHECK((*scores)[2].score == 5.5 + 1.75);
}

TEST_CASE("Questionnaires: the file of these tests has every member of the schema") {
    const auto schema = nlohmann::json::parse(questionnaire_schema_text());
    std::vector<nlohmann::json> objects{schema};
    for (const auto& [name, definition] : schema["definitions"].items()) objects.push_back(definition);
    for (const nlohmann::json& object : objects) {
        if (!object.contains("properties")) continue;
        CHECK(object["additionalProperties"] == false);
        for (const auto& property : object["properties"].items())
            CHECK_MESSAGE(has(everything, "\"" + property.key() + "\":"), property.key());
    }
}

TEST_CASE("Questionnaires: every kind of mistake in the head has its line, column, and what is expected") {
    check_mistake("questionnaire 1\"", "questionnaire 2\"", "\"boltwright", "\"boltwright questionnaire 1\"");
    check_mistake("\"licence\"", "\"license\"", "\"license\"", "did you mean \"licence\"?");
    check_mistake("  \"source\": \"these tests\",\n", "", "{", "\"source\" is missing");
    check_mistake("\"id\": \"comfort\"", "\"id\": \"com fort\"", "\"com fort\"",
                  "not allowed; expected letters a to z and A to Z, digits, - and _");
    check_mistake("{ \"en\": \"Comfort\", \"fi\": \"Mukavuus\" }", "{}", "{}", "this is empty");
    check_mistake("\"texts_may_be_shipped\": true", "\"texts_may_be_shipped\": 1", "1,", "true or false");
    check_mistake("\"high\": 4", "\"high\": 1", "1, \"step\"",
                  "the highest answer 1 is not above the lowest; expected a number above 1");
    check_mistake("\"high\": 4", "\"high\": -4", "-4", "the highest answer -4 is not above the lowest");
    check_mistake("0.5", "0.7", "0.7",
                  "steps of 0.7 do not lead from 1 to 4; expected a number that divides 3");
    check_mistake("0.5", "9", "9,", "steps of 9 do not lead from 1 to 4");
    check_mistake("\"high\": 4", "\"high\": 1.0000000001", "0.5",
                  "steps of 0.5 do not lead from 1 to 1.0000000001");
    check_mistake("0.5", "0", "0,\n", "0 is too small");
    check_mistake("\"low\": 1", "\"low\": \"1\"", "\"1\"", "expected a number");
    check_mistake("\"f\", \"g\"]", "\"f\"]", "[\"a\"",
                  "6 labels; expected 2 labels, for the lowest and the highest answer, or 7, one for ");
    check_mistake("\"high\": 4", "\"high\": 1.5", "[\"a\"",
                  "7 labels; expected 2 labels, one for each answer");
    check_mistake("\"always\"", "7", "7]", "expected a text");
}

TEST_CASE("Questionnaires: every kind of mistake in items and scales has its line and column") {
    check_mistake("{ \"id\": \"noise\" }", "{ \"id\": \"cold\" }", "\"cold\" }",
                  "there is another item \"cold\"; expected an id of its own; the first is in line 15");
    check_mistake("{ \"id\": \"noise\" }", "{ \"id\": \"noise\", \"txt\": {} }", "\"txt\"",
                  "did you mean \"text\"?");
    check_mistake("[\"no\", \"yes\"]", "[\"no\", \"-\", \"yes\"]", "[\"no\"", "3 labels");
    check_mistake("\"id\": \"room\"", "\"id\": \"total\"", "\"total\", \"title\": { \"en\": \"Total\"",
                  "there is another scale \"total\"");
    check_mistake("[\"noise\", \"cold\"]", "[\"noise\", \"clod\"]", "\"clod\"",
                  "there is no item \"clod\"; did you mean \"cold\"?");
    check_mistake("[\"noise\", \"cold\"]", "[\"noise\", \"noise\"]", "\"noise\"], \"combine\"",
                  "\"noise\" is listed twice; expected each id once");
    check_mistake("[\"noise\", \"cold\"]", "[]", "[]", "this is empty; expected at least 1");
    check_mistake("\"reversed\": [\"cold\"]", "\"reversed\": [\"noise\"]", "\"noise\"],",
                  "there is no item \"noise\" in this scale; expected one of seat, cold");
    check_mistake("[\"body\", \"room\"]", "[\"body\", \"total\"]", "\"total\"], \"combine\"",
                  "there is no scale \"total\" above this one; expected one of body, room");
    check_mistake("\"items\": [\"seat\", \"cold\"],\n      \"reversed\": [\"cold\"], \"from_zero\": true",
                  "\"scales\": [\"room\"]", "\"room\"], \"combine\"",
                  "there is no scale \"room\" above this one; expected a scale above this one");
    check_mistake("\"mean\"", "\"median\"", "\"median\"", "did you mean \"mean\"?");
    check_mistake("\"weight\": 2.5", "\"weight\": 0", "0 }", "0 is too small");
    check_mistake("\"scales\": [\"body\", \"room\"]", "\"items\": [\"seat\"], \"scales\": [\"body\"]",
                  "{ \"id\": \"total\"", "the scale has both \"items\" and \"scales\"");
    check_mistake("\"scales\": [\"body\", \"room\"], ", "", "{ \"id\": \"total\"",
                  "the scale has neither \"items\" nor \"scales\"; expected one of them");
    check_mistake("[\"body\", \"room\"],", "[\"body\", \"room\"], \"from_zero\": true,",
                  "\"from_zero\": true, \"combine\": \"sum\" }",
                  "\"from_zero\" has no meaning without \"items\"");
}

TEST_CASE("Questionnaires: the check of mistakes fails for a wrong place, a wrong text, and a correct file") {
    CHECK_FALSE(is_mistake("0.5", "0.7", "\"high\"", "steps of 0.7"));
    CHECK_FALSE(is_mistake("0.5", "0.7", "0.7", "steps of 0.8"));
    CHECK_FALSE(is_mistake("0.5", "1.5", "1.5", ""));
}

TEST_CASE("Questionnaires: several mistakes are reported at once, in the order of the file") {
    std::string text = replaced(everything, "0.5", "0.7");
    text = replaced(text, "\"id\": \"seat\"", "\"id\": \"cold\"");
    text = replaced(text, "\"mean\"", "\"maen\"");
    const std::vector<std::string> found = mistakes(text);
    REQUIRE(found.size() == 3);
    CHECK(has(found[0], "q.json:10:"));
    CHECK(has(found[1], "q.json:15:"));
    CHECK(has(found[2], "q.json:22:"));
}

TEST_CASE("Questionnaires: the labels of an item with its own answers are counted against these") {
    const std::string own = R"("answers": { "low": 1, "high": 4, "step": 0.5 })";
    check_mistake(own, R"("answers": { "low": 1, "high": 4, "step": 2 })", "2 }", "steps of 2 do not lead");
    check_mistake(R"({ "en": ["no", "yes"] })", R"({ "en": ["no", "so", "yes"] })", R"(["no", "so")",
                  "3 labels; expected 2 labels, for the lowest and the highest answer, or 7");
    const std::string three =
        test::replaced(replaced(everything, own, R"("answers": { "low": 0, "high": 2, "step": 1 })"),
                       R"({ "en": ["no", "yes"] })", R"({ "en": ["no", "so", "yes"] })");
    CHECK(parsed(three).items[1].labels.at("en").size() == 3);
}

TEST_CASE("Questionnaires: a wrong id is one mistake, without unknown ids as its consequence") {
    check_mistake("{ \"id\": \"noise\" }", "{ \"id\": 3 }", "3 }", "expected a text");
    check_mistake("{ \"id\": \"noise\" }", "{ \"di\": \"noise\" }", "\"di\"", "did you mean \"id\"?");
    check_mistake("[\"seat\", \"cold\"]", "[\"seat\", \"clod\"]", "\"clod\"", "did you mean \"cold\"?");
    check_mistake("\"id\": \"body\"", "\"id\": \"\"", "\"\"", "this text is empty");
}

TEST_CASE("Questionnaires: bytes that are no questionnaire are errors with a position") {
    for (const char* text : {"", "[", "{", "null", "{}", "[1]", "\xff",
                             R"({"format": "boltwright questionnaire 1", "items": {}, "scales": 3})"}) {
        CAPTURE(text);
        const LoadedQuestionnaire loaded = parse_questionnaire(text, "q.json");
        REQUIRE_FALSE(loaded.ok());
        CHECK(loaded.errors.front().line == 1);
    }
    const LoadedQuestionnaire missing = load_questionnaire("/nonexistent/q.json");
    REQUIRE(missing.errors.size() == 1);
    CHECK(has(missing.errors.front().message(), "/nonexistent/q.json"));
}

}  // namespace read_questionnaire_test
