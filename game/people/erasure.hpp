// Deletes what is stored about a person.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/base/result.hpp"
#include "game/people/inventory.hpp"

namespace bolt::people {

struct Erasure {
    std::vector<std::filesystem::path> deleted;  // files, and folders of lessons that are empty now
    bool name_deleted = false;                   // from names.json
    std::vector<Error> kept;                     // what could not or may not be deleted, and why
};

// Deletes the person's files and then the person's name. Keeps a session that another program is recording,
// one that belongs to another person by now, pages that show other people too, and the name while the folder
// of a study is missing, so that the erasure can be repeated by name.
Erasure erase_person(const DataFolders& folders, const PersonData& data);

// Deletes only the name: first renames settings and calibrations that older programs named after the person,
// then removes the name from names.json. `kept` has the files that still hold the name.
Erasure erase_name(const DataFolders& folders, const PersonData& data);

}  // namespace bolt::people
