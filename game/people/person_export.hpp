// The copy of everything about a person, for the person.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/people/inventory.hpp"

namespace bolt::people {

struct PersonExport {
    std::vector<std::filesystem::path> copies;  // in the folder, index.json last
    std::vector<Error> problems;                // files that could not be copied
};

// Copies the person's files into `out`, a new or empty folder that only the user may read: settings/,
// calibrations/, sessions/NUMBER with each lesson and its pages, and studies/NUMBER with the answers in a
// study. Writes index.json:
//
//   {"format": "boltwright export 1", "code": "T-7K3M9Q", "name": "Ada", "files":
//    [{"file": "sessions/001/session.boltwright", "kind": "session", "modified": "2026-11-28T15:10:00Z",
//      "assembly": "zq350", "mode": "guided", "task": "tighten", "law": "mechanistic", "complete": true,
//      "finished": true, "duration_s": 612.5, "score": 87.25}, …]}
//
// Fails, and copies nothing, if `out` is not empty, or is inside a folder of `folders`, where its copies
// would count as the person's data.
Result<PersonExport> export_person(const DataFolders& folders, const PersonData& data,
                                   const std::filesystem::path& out);

// The properties of a session for a table: "cover-m8, guided, tighten, 87 of 100 points"; or why it cannot be
// read.
std::string describe_session(const std::filesystem::path& path);

// "2026-11-28T15:10:00Z"
std::string utc_text(std::time_t time);

}  // namespace bolt::people
