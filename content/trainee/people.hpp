// The people who train on this computer. Data about a person holds a code; the real name is in one file,
// names.json, and deleting that file leaves all data usable under the codes.
//
//   {"format": "boltwright names 1", "people": [{"code": "T-7K3M9Q", "name": "Ada"}]}
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

struct Person {
    std::string code;  // such as T-7K3M9Q (make_person_code())
    std::string name;  // empty: unknown
    friend bool operator==(const Person&, const Person&) = default;
};

// "Ada (T-7K3M9Q)", or the code or the name alone.
std::string name_and_code(const Person& person);

// A new code, such as T-7K3M9Q: "T-" and six random characters of Crockford's base 32, which has no I, L, O
// and U. It is not derived from the name.
std::string make_person_code();
// True for a text of the form that make_person_code() returns.
bool is_person_code(std::string_view text);
// The code that a person typed: small letters, an O for 0, and an I or L for 1 are accepted. None: the text
// is not a code.
std::optional<std::string> typed_person_code(std::string_view typed);
// The number of characters in which two codes differ.
std::size_t code_distance(std::string_view a, std::string_view b);

// The text without the blanks, tabs and line ends around it. Names are compared as bytes after this.
std::string_view trim_blanks(std::string_view text);

// Errors name `file`, line and column.
Result<std::vector<Person>> parse_names(std::string_view text, const std::string& file);
// Deterministic: equal lists give equal bytes.
std::string names_text(std::span<const Person> people);

// The folder of names.json: people/ in user_data_folder().
Result<std::filesystem::path> people_folder();
std::filesystem::path names_path(const std::filesystem::path& folder);

// The functions below use names.json in `folder`. Without the file there are no people. They fail if it is
// damaged, and never overwrite a damaged file.

// All people with a name, in the order in which they were added.
Result<std::vector<Person>> list_people(const std::filesystem::path& folder);

// The person with a typed name or code; none if it is unknown.
Result<std::optional<Person>> find_person(const std::filesystem::path& folder, std::string_view typed);

// As find_person, but gives an unknown name a new code and saves it at once. A new code differs from every
// code in the file in at least two characters. An unknown code gives a person without a name, and nothing is
// saved. Fails for a text that cannot be a name. Several programs may call it at the same time.
Result<Person> find_or_add_person(const std::filesystem::path& folder, std::string_view typed);

// Removes the name of a code; its other data stays. Returns false if the code has no name.
Result<bool> forget_name(const std::filesystem::path& folder, std::string_view code);

}  // namespace bolt::content
