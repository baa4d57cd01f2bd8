// The data of people in a temporary folder: names, settings, and sessions with their pages.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "engine/base/file.hpp"
#include "game/people/inventory.hpp"
#include "tests/session/support.hpp"

namespace bolt::people::test {

struct Station {
    session::test::Folder folder;
    DataFolders folders{{folder / "people", folder / "settings", folder / "gloves"}, {folder / "out"}};
    std::string ada = content::find_or_add_person(folders.own.people, "Ada").value().code;
    std::string bea = content::find_or_add_person(folders.own.people, "Bea").value().code;

    Station() {
        for (const auto& made : {folders.own.settings, folders.own.gloves, folder / "out"})
            std::filesystem::create_directories(made);
    }
    [[nodiscard]] std::filesystem::path out(const std::string& path) const {
        return folder / ("out/" + path);
    }
};

// A finished session of the person, or of an expert if `profile` is set.
std::filesystem::path put_session(const std::filesystem::path& path, const std::string& trainee,
                                  const std::string& profile = "person");
void put_text(const std::filesystem::path& path, const std::string& text);
// A summary.json, and a page of `boltwright report` that shows these people.
std::string summary_of(const std::string& trainee, const std::string& profile = "person");
std::string page_of(const std::vector<std::string>& people);

std::set<std::string> files_in(const std::filesystem::path& folder);  // paths relative to it

}  // namespace bolt::people::test
