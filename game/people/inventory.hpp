// The files of each person: settings, calibrations of gloves, sessions, the pages beside them, and answers in
// studies.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "content/trainee/identity.hpp"
#include "engine/base/result.hpp"
#include "game/session/header.hpp"

namespace bolt::people {

struct DataFolders {
    content::PersonFolders own;  // the user's folders of names.json, settings and calibrations
    std::vector<std::filesystem::path> sessions;  // searched with their subfolders
    std::vector<Error> missing;  // studies that people took part in here, and whose folders are not there now
};

// The user's own folders. Searches `sessions` for sessions. If it is empty, searches out/ and
// user_data_folder()/sessions, where lessons from the desktop go, if they exist. Always searches the folders
// of the studies that people took part in on this computer (study::known_studies).
Result<DataFolders> user_folders(std::vector<std::filesystem::path> sessions = {});

enum class FileKind : std::uint8_t {
    settings,
    calibration,
    session,
    summary,  // summary.json of a lesson
    page,     // report of sessions
    answers,  // journal of a participant of a study
};
const char* name(FileKind kind);

struct PersonFile {
    std::filesystem::path path;
    FileKind kind = FileKind::settings;
    std::time_t modified = 0;
    std::filesystem::path root;  // the folder in which it was found
};

struct PersonData {
    content::Person person;         // without a code if only files of older programs name the person
    std::vector<PersonFile> files;  // by kind, then oldest first
    std::vector<std::filesystem::path> shared_pages;  // reports that show other people too

    [[nodiscard]] std::optional<std::time_t> last_lesson() const;  // when a session last changed
};

struct Inventory {
    std::vector<PersonData> people;    // those with a name first, in the order of names.json; then by code
    std::optional<Error> names_error;  // names.json is damaged: nobody has a name
    // Files whose owner cannot be determined, folders that cannot be searched, and studies that are missing.
    std::vector<Error> file_errors;
};

// Symbolic links inside the folders are not followed. A file that an older program stored under a typed name
// belongs to the person with that name in names.json.
Inventory take_inventory(const DataFolders& folders);

// The person with this code or name. Fails with a suggestion if nothing is known about the person.
Result<PersonData> find(const Inventory& inventory, std::string_view who);

// The person of a session; empty texts if it has none (a simulated trainee, or a person without a name).
// `registered`: the people in names.json.
content::Person person_of(const session::Header& header, std::span<const content::Person> registered);

// The person whose code or typed name is recorded. A person who is not registered has only that code or name.
content::Person person_of(std::string_view recorded, std::span<const content::Person> registered);

}  // namespace bolt::people
