// The texts of the user interface in one language, their keys, and the insertion of arguments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "content/words/key_rows.hpp"
#include "engine/base/result.hpp"

namespace bolt::words {

// The key of a text. A key that is not in the table does not compile.
class TextKey {
  public:
    // Implicit conversion from the key's name.
    consteval TextKey(const char* name) : index_(find(name)) {}  // NOLINT(google-explicit-constructor)
    static constexpr TextKey at(std::size_t index) { return TextKey(static_cast<std::uint16_t>(index)); }

    [[nodiscard]] constexpr std::size_t index() const { return index_; }
    [[nodiscard]] constexpr const KeyRow& row() const { return key_rows[index_]; }
    friend constexpr bool operator==(const TextKey&, const TextKey&) = default;

  private:
    constexpr explicit TextKey(std::uint16_t index) : index_(index) {}
    static consteval std::uint16_t find(std::string_view name) {
        for (std::size_t i = 0; i < key_count; ++i)
            if (key_rows[i].name == name) return static_cast<std::uint16_t>(i);
        throw "there is no such key in content/words/key_rows.hpp";
    }
    std::uint16_t index_ = 0;
};

// A words file, content/words/LANGUAGE.json, has a text for every key:
//
//   {"format": "boltwright words 1", "language": "de", "name": "Deutsch", "decimal": ",",
//    "words": {"hint.next": "Als Nächstes {joint}.", ...}}

// {fastener: Mutter|Schraube} in a text is a choice (choice_rows): the program selects one of the texts.

// A number that is formatted by the rules of the language.
struct Number {
    double value = 0.0;
    int decimals = 0;
};

// Selects a text of a placeholder {name: text|text}.
struct Choice {
    std::size_t index = 0;
};

// The value of a placeholder {name} in a text.
struct TextArgument {
    std::string_view name;
    std::variant<std::string, Number, Choice> value;
};

struct Words {
    std::string language;  // ISO 639, as in assembly files: "de"
    std::string name;      // the language's name in itself
    std::string decimal = ".";
    std::array<std::string, key_count> texts;

    [[nodiscard]] const std::string& operator[](TextKey key) const { return texts[key.index()]; }
};

// The text with its placeholders replaced. A placeholder without an argument is kept; other arguments are
// ignored.
std::string format_text(const Words& words, TextKey key, std::span<const TextArgument> arguments);
std::string format_text(const Words& words, TextKey key, std::initializer_list<TextArgument> arguments = {});
// The same for a text that is not of the table, such as an argument that has placeholders of its own.
std::string replace_placeholders(const Words& words, std::string_view text,
                                 std::span<const TextArgument> arguments);
std::string format_number(const Words& words, const Number& number);

// A torque with the decimals that a torque wrench shows, for example 20 and 7.5.
Number torque_number(double newton_metres);

// The words without errors, or all errors of the file with line and column.
struct LoadedWords {
    Words words;
    std::vector<Error> errors;
    std::array<int, key_count> lines{};  // line of each text, by key
    [[nodiscard]] bool ok() const { return errors.empty(); }
};
LoadedWords parse_words(std::string_view text, std::string_view file);
LoadedWords read_words(const std::filesystem::path& file);  // the file must be named LANGUAGE.json

// `language`: a code for which `folder` has a file; otherwise the error lists the available codes.
LoadedWords load_words(const std::filesystem::path& folder, std::string_view language);

// The codes of the available languages, sorted, and the folder of their files (content/words).
std::vector<std::string> languages(const std::filesystem::path& folder);
std::filesystem::path words_folder();

// The language of the desktop by LC_ALL, LC_MESSAGES or LANG, for example "de" for "de_DE.UTF-8"; "en" if it
// is not in `available`.
std::string language_of_desktop(std::span<const std::string> available);

}  // namespace bolt::words
