#include "content/words/words.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/file.hpp"
#include "engine/text/fonts.hpp"
#include "engine/text/layout.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::words;

namespace {

std::string text_of(std::string_view language) {
    const auto file = words_folder() / (std::string(language) + ".json");
    const Result<std::string> text = read_file(file, 1U << 20U, ErrorCode::bad_content);
    REQUIRE(text.has_value());
    return *text;
}

Words english() {
    LoadedWords loaded = load_words(words_folder(), "en");
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

// Replaces one text in the English file and returns the error messages, one line each.
std::string mistakes(const std::string& from, const std::string& to) {
    std::string text = text_of("en");
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    std::string messages;
    for (const Error& error : parse_words(text, "en.json").errors) {
        CHECK(error.code == ErrorCode::bad_content);
        messages += error.message() + "\n";
    }
    return messages;
}

// Returns true for a text of several words, which a translation must change; single words and names may be
// the same.
bool is_sentence(std::string text) {
    const bool several = text.find(' ') != std::string::npos;
    for (std::size_t open = 0; (open = text.find('{')) != std::string::npos;)
        text.erase(open, text.find('}') + 1 - open);
    return several && std::any_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

bool has_all_letters(const text::Fonts& fonts, const std::string& value) {
    const std::u32string points = text::decode(value);
    return std::all_of(points.begin(), points.end(),
                       [&](char32_t point) { return find_glyph(fonts, point).glyph != 0; });
}

}  // namespace

TEST_CASE("Words: English, German and Chinese exist, and each has every text with its placeholders") {
    const std::vector<std::string> existing = languages(words_folder());
    for (const char* language : {"en", "de", "zh"})
        CHECK(std::find(existing.begin(), existing.end(), language) != existing.end());
    for (const std::string& language : existing) {
        CAPTURE(language);
        const LoadedWords loaded = load_words(words_folder(), language);
        for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
        CHECK(loaded.words.language == language);
        CHECK_FALSE(loaded.words.name.empty());
    }
}

TEST_CASE("Words: the fonts have every letter of every language") {
    const Result<text::Fonts> fonts = text::load_fonts();
    REQUIRE(fonts.has_value());
    for (const std::string& language : languages(words_folder())) {
        CAPTURE(language);
        const LoadedWords loaded = load_words(words_folder(), language);
        CHECK(has_all_letters(*fonts, loaded.words.name));
        for (const std::string& value : loaded.words.texts) {
            CAPTURE(value);
            CHECK(has_all_letters(*fonts, value));
        }
    }
    CHECK_FALSE(has_all_letters(*fonts, "a\U000E0001b"));  // the check can fail
}

TEST_CASE("Words: translations differ from English") {
    const Words en = english();
    for (const std::string& language : languages(words_folder())) {
        if (language == "en") continue;
        CAPTURE(language);
        const Words other = load_words(words_folder(), language).words;
        for (std::size_t i = 0; i < key_count; ++i) {
            const TextKey key = TextKey::at(i);
            CAPTURE(key.row().name);
            if (is_sentence(en[key])) CHECK(en[key] != other[key]);
        }
    }
}

TEST_CASE("Words: files follow the order of the table") {
    for (const std::string& language : languages(words_folder())) {
        const auto file = nlohmann::ordered_json::parse(text_of(language));
        std::size_t i = 0;
        for (const auto& [key, value] : file["words"].items()) CHECK(key == key_rows[i++].name);
    }
}

TEST_CASE("Words: placeholders are filled in, and numbers follow the language") {
    const Words en = english();
    const Words de = load_words(words_folder(), "de").words;
    CHECK(format_text(en, "hint.next", {{"joint", "B7"}}) == "B7 is next.");
    CHECK(format_text(de, "hint.next", {{"joint", "B7"}}) == "Als Nächstes kommt B7.");
    const TextArgument arguments[] = {
        {"joint", "B1"}, {"torque", torque_number(17.46)}, {"low", torque_number(18.0)}};
    CHECK(format_text(en, "reason.torque_low", arguments) == "B1 has 17.5 N·m; at least 18 N·m are needed.");
    CHECK(format_text(de, "reason.torque_low", arguments) ==
          "B1 hat 17,5 N·m; mindestens 18 N·m sind nötig.");
    // A placeholder without a value stays in the text.
    CHECK(format_text(en, "hint.next") == "{joint} is next.");
    // Placeholders in a value are not replaced.
    CHECK(format_text(en, "hint.next", {{"joint", "{joint}"}}) == "{joint} is next.");
    CHECK(format_text(en, "hint.set_back", {{"joint", "B7"}}) == en["hint.set_back"]);
    // A text that is not of the table.
    const TextArgument thread{"thread", Choice{1}};
    CHECK(replace_placeholders(en, "drag to the {thread: right|left} {control}", {&thread, 1}) ==
          "drag to the left {control}");
}

TEST_CASE("Words: a choice selects the text for a nut or a screw") {
    const Words en = english();
    const Words de = load_words(words_folder(), "de").words;
    const Words zh = load_words(words_folder(), "zh").words;
    const auto text = [](const Words& words, TextKey key, std::size_t index) {
        return format_text(words, key,
                           {{"joint", "B7"},
                            {"thread", Choice{0}},
                            {"fastener", Choice{index}},
                            {"fasteners", Choice{index}}});
    };
    CHECK(text(en, "hint.set_on", 0) ==
          "Slide the jaw fully onto the nut of B7, straight and square to the bolt.");
    CHECK(text(en, "hint.set_on", 1) ==
          "Slide the jaw fully onto the screw head of B7, straight and square to the screw.");
    CHECK(text(de, "hint.grip_nut", 0) == "Fassen Sie die Mutter von B7 mit den Fingern.");
    CHECK(text(de, "hint.grip_nut", 1) == "Fassen Sie den Schraubenkopf von B7 mit den Fingern.");
    CHECK(text(zh, "hint.run_down", 1) == "顺时针旋转 B7 的螺钉，直到贴合。");
    CHECK(text(en, "hint.all_done", 2) == "All nuts and screws are done. Put the wrench down.");
    const auto direction = [&](const Words& words, std::size_t index) {
        return format_text(words, "how.pull_on",
                           {{"control", "X"}, {"fastener", Choice{0}}, {"thread", Choice{index}}});
    };
    CHECK(direction(en, 0) == "Swing the handle clockwise about the bolt, seen from the nut's side: X.");
    CHECK(direction(en, 1) == "Swing the handle anticlockwise about the bolt, seen from the nut's side: X.");
    CHECK(direction(de, 1) ==
          "Schwenken Sie den Griff gegen den Uhrzeigersinn um die Schraube, mit Blick auf die Mutter: X.");
    // Without a value the choice stays in the text.
    CHECK(format_text(en, "hint.twist_back") == en["hint.twist_back"]);
    const std::string given = "{fastener: nut|screw} again";
    const auto error_of = [&](const char* to) {
        const std::string found = mistakes(given, to);
        return found.substr(std::min(found.find("/words/hint.twist_back"), found.size()));
    };
    CHECK(error_of("it again") == "");
    CHECK(error_of("{fastener: nut|screw|bolt} again") ==
          "/words/hint.twist_back: {fastener} has 3 texts to choose from; expected 2, as in {fastener: "
          "nut|screw}\n");
    CHECK(error_of("{fastener} again") ==
          "/words/hint.twist_back: {fastener} has 0 texts to choose from; expected 2, as in {fastener: "
          "nut|screw}\n");
    CHECK(error_of("{fasteners: a|b|c} again") ==
          "/words/hint.twist_back: unknown placeholder {fasteners}; did you mean \"fastener\"?\n");
    CHECK(mistakes("{joint} is next.", "{joint: a|b} is next.")
              .find("{joint} has 2 texts to choose from; expected none") != std::string::npos);
}

TEST_CASE("Words: torques have as many decimals as a torque wrench shows") {
    const Words en = english();
    for (const auto& [torque, expected] : {std::pair{20.0, "20"},
                                           {7.5, "7.5"},
                                           {21.98, "22"},
                                           {210.4, "210"},
                                           {0.04, "0"},
                                           {-0.04, "0"},
                                           {-3.5, "-3.5"}})
        CHECK(format_number(en, torque_number(torque)) == expected);
}

TEST_CASE("Words: errors of a file name their position") {
    const std::string text = text_of("en");
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<long>(text.find("\"hint.next\"")), '\n') + 1;
    const std::string at = "en.json:" + std::to_string(line), position = at + ":18: /words/hint.next: ";
    const std::string next = "{joint} is next.";
    CHECK(mistakes(next, "{joint} is next now.").empty());
    CHECK(mistakes(next, "The next is next.") == position + "{joint} is missing in the text\n");
    CHECK(mistakes(next, "{jont} is next.") == position +
                                                   "unknown placeholder {jont}; did you mean \"joint\"?\n" +
                                                   position + "{joint} is missing in the text\n");
    const std::string alone = position + "a brace is unmatched; expected placeholders of the form {name}\n";
    for (const char* to : {"{joint is next.", "joint} is next.", "{{joint}} is next.", "{joint} is next.{"})
        CHECK(mistakes(next, to) == alone);
    CHECK(mistakes("\"hint.next\"", "\"hint.nxt\"") ==
          "en.json:6:12: /words: \"hint.next\" is missing\n" + at +
              ":5: /words/hint.nxt: \"hint.nxt\" is not known here; did you mean \"hint.next\"?\n");
    for (const char* to : {"7", "\"\""})
        CHECK(mistakes("\"" + next + "\"", to) ==
              position + "\"hint.next\" is empty or not a text; expected a text of at most 1000 bytes\n");
    CHECK(mistakes("\"decimal\": \".\"", "\"decimal\": \";\"") ==
          "en.json:5:14: /decimal: \";\" is not a decimal sign; expected \".\" or \",\"\n");
    CHECK(mistakes("boltwright words 1", "boltwright words 9").find("en.json:2:13: /format") == 0);
    CHECK(mistakes("\"name\": \"English\",", "").find("\"name\" is missing") != std::string::npos);
    CHECK(mistakes("{\n  \"format\"", "{\n  \"forma\": 1,\n  \"format\"").find("en.json:2:3: /forma") == 0);
    CHECK(mistakes("\"words\": {", "\"words\": [{").find("en.json:") == 0);  // not JSON
    CHECK(parse_words("[]", "x").errors.size() == 1);
    CHECK(parse_words("{}", "x").errors.size() == 5);
    CHECK(parse_words(R"({"words": 3})", "x").errors.size() == 5);
}

TEST_CASE("Words: an unknown language lists those that exist") {
    const LoadedWords none = load_words(words_folder(), "ed");
    REQUIRE(none.errors.size() == 1);
    CHECK(none.errors[0].code == ErrorCode::usage);
    CHECK(none.errors[0].what == "there is no words file for the language \"ed\"");
    CHECK_FALSE(load_words(words_folder(), "../words/en").ok());
    const test::Folder kept;
    const auto folder = kept / "words";
    CHECK(languages(folder).empty());
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "fr.json") << text_of("en");
    REQUIRE(load_words(folder, "fr").errors.size() == 1);
    CHECK(load_words(folder, "fr").errors[0].pointer == "/language");
}
