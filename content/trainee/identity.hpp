// Finds the person that a typed name or code means, with the files that older programs stored under the typed
// name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "content/trainee/people.hpp"
#include "engine/base/result.hpp"

namespace bolt::content {

// Folders with files of people; an empty path: there is none.
struct PersonFolders {
    std::filesystem::path people;    // names.json
    std::filesystem::path settings;  // settings.hpp
    std::filesystem::path gloves;    // glove_calibration.hpp
};

struct IdentifiedPerson {
    Person person;  // has a code always, except for an empty text
    // Why the name cannot be found or saved. The person then has a code without a name: a lesson is possible,
    // but nothing connects it with the person's other lessons.
    std::optional<Error> names_error{};
    std::string similar_code{};  // the only known code that differs from the typed one in one character
    std::vector<Error> adoption_errors{};  // files of older programs that could not be renamed
};

// Finds or adds the person (find_or_add_person), and adopts files under the person's name.
IdentifiedPerson identify_person(const PersonFolders& folders, std::string_view typed);

// Renames and rewrites settings and calibrations that older programs stored under the person's name, so that
// they hold the code. If there is a file under the code already, the older one is kept beside it with the
// suffix ".older". Returns the errors; such a file is unchanged.
std::vector<Error> adopt_files(const PersonFolders& folders, const Person& person);

// The trainee of a file of settings or a calibration, by its name: "T-7K3M9Q.settings.json",
// "T-7K3M9Q.left.glove.json", or such a name with a suffix. Empty for other files.
std::string trainee_of_file(const std::filesystem::path& path);

// The regular files of a trainee in a folder of settings or calibrations, sorted.
std::vector<std::filesystem::path> files_of_trainee(const std::filesystem::path& folder,
                                                    std::string_view trainee);

}  // namespace bolt::content
