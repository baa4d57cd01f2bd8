// Names a text that the program says to people. Code that names one that is not in the table does not
// compile.
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

class Key {
  public:
    // Implicit: a key is written as its name.
    consteval Key(const char* name) : index_(find(name)) {}  // NOLINT(google-explicit-constructor)
    static constexpr Key at(std::size_t index) { return Key(static_cast<std::uint16_t>(index)); }

    [[nodiscard]] constexpr std::size_t index() const { return index_; }
    [[nodiscard]] constexpr const KeyRow& row() const { return key_rows[index_]; }
    friend constexpr bool operator==(const Key&, const Key&) = default;

  private:
    constexpr explicit Key(std::uint16_t index) : index_(index) {}
    static consteval std::uint16_t find(std::string_view name) {
        for (std::size_t i = 0; i < key_count; ++i)
            if (key_rows[i].name == name) return static_cast<std::uint16_t>(i);
        throw "there is no such key in content/words/key_rows.hpp";
    }
    std::uint16_t index_ = 0;
};

// One language: a text for every key, read from content/words/LANGUAGE.json:
//
//   {"format": "boltwright words 1", "language": "de", "name": "Deutsch", "decimal": ",",
//    "words": {"hint.next": "Als Nächstes {joint}.", ...}}

// A number that is written as the language writes it.
struct Number {
    double value = 0.0;
    int decimals = 0;
};

// What stands in a text where it says {name}.
struct Place {
    std::string_view name;
    std::variant<std::string, Number> value;
};

struct Words {
    std::string language;  // ISO 639, as in assembly files: "de"
    std::string name;      // what the language calls itself
    std::string decimal = ".";
    std::array<std::string, key_count> texts;

    [[nodiscard]] const std::string& operator[](Key key) const { return texts[key.index()]; }
};

std::string say(const Words& words, Key key, std::span<const Place> places);
std::string say(const Words& words, Key key, std::initializer_list<Place> places = {});
std::string say(const Words& words, const Number& number);

// 20 and 7.5: no more decimals than a torque wrench shows.
Number torque_number(double newton_metres);

// Either words and no errors, or all mistakes of the file, each with its line and column.
struct Loaded {
    Words words;
    std::vector<Error> errors;
    std::array<int, key_count> lines{};  // where each text stands
    [[nodiscard]] bool ok() const { return errors.empty(); }
};
Loaded parse_words(std::string_view text, std::string_view file);
Loaded read_words(const std::filesystem::path& file);  // named after its language

// `language`: a code for which `folder` has a file; the error of another one names those.
Loaded load_words(const std::filesystem::path& folder, std::string_view language);

// The codes for which there are files, in order; and where they lie (content/words).
std::vector<std::string> languages(const std::filesystem::path& folder);
std::filesystem::path words_folder();

// "de" where the desktop speaks "de_DE.UTF-8", by LC_ALL, LC_MESSAGES or LANG; "en" where none of `there` is
// it.
std::string language_of_desktop(std::span<const std::string> there);

}  // namespace bolt::words
