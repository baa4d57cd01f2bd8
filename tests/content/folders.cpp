// Where content and the user's data are found.
#include "content/format/folders.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
namespace fs = std::filesystem;
using test::Folder;

TEST_CASE("Folders: BOLTWRIGHT_CONTENT names the content folder") {
    const fs::path found = content::content_folder();
    REQUIRE_FALSE(found.empty());
    {
        const test::EnvironmentVariable variable("BOLTWRIGHT_CONTENT", "/nowhere");
        CHECK(content::content_folder().empty());
        const Folder empty;
        const test::EnvironmentVariable data("XDG_DATA_HOME", empty.path().c_str());
        CHECK(content::load_assembly("zq350").errors.front().expected ==
              "a content folder; BOLTWRIGHT_CONTENT names it");
    }
    const test::EnvironmentVariable variable("BOLTWRIGHT_CONTENT", found.c_str());
    CHECK(content::content_folder() == found);
}

TEST_CASE("Folders: without BOLTWRIGHT_CONTENT the content folder is found from the program") {
    const test::EnvironmentVariable variable("BOLTWRIGHT_CONTENT", nullptr);
    CHECK(fs::exists(content::content_folder() / "schema" / "assembly.schema.json"));
}

TEST_CASE("Folders: the user's data follow the XDG base directory specification") {
    const test::EnvironmentVariable home("HOME", "/home/ada");
    {
        const test::EnvironmentVariable data("XDG_DATA_HOME", "/somewhere");
        CHECK(user_data_folder().value() == "/somewhere/boltwright");
    }
    {
        const test::EnvironmentVariable data("XDG_DATA_HOME",
                                             "not/absolute");  // the specification: ignore it
        CHECK(user_data_folder().value() == "/home/ada/.local/share/boltwright");
    }
    const test::EnvironmentVariable data("XDG_DATA_HOME", nullptr), no_home("HOME", nullptr);
    CHECK_FALSE(user_data_folder());
    CHECK(content::assembly_folders().size() == 1);  // those of the content remain
}

TEST_CASE("Folders: an assembly of the user is found by name and hides a shipped one of that name") {
    const Folder data;
    const test::EnvironmentVariable variable("XDG_DATA_HOME", data.path().c_str());
    const auto names = content::assembly_names();
    CHECK(std::is_sorted(names.begin(), names.end()));
    CHECK(std::count(names.begin(), names.end(), "cover-m8") == 1);
    CHECK(std::count(names.begin(), names.end(), "mine") == 0);
    CHECK_FALSE(content::load_assembly("mine").ok());

    const fs::path own = data / "boltwright" / "assemblies";
    fs::create_directories(own / "no-assembly");
    for (const char* name : {"mine", "cover-m8"})
        fs::copy(content::content_folder() / "assemblies" / "cover-m8", own / name);
    const auto more = content::assembly_names();
    CHECK(more.size() == names.size() + 1);
    CHECK(std::count(more.begin(), more.end(), "cover-m8") == 1);
    for (const char* name : {"mine", "cover-m8"}) {
        const content::LoadedAssembly loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        CHECK(loaded.assembly.name == name);
        CHECK(loaded.assembly.file == (own / name / "assembly.json").string());
        CHECK(fs::exists(loaded.assembly.models.model));
    }
}
