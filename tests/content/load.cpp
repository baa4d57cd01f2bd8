#include "content/format/assembly.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <optional>

#include "engine/base/file.hpp"
#include "support.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/folder.hpp"

namespace content_load_test {

using namespace bolt;
namespace fs = std::filesystem;
using test::Folder;

namespace {

// Limits the size of written files during its lifetime.
struct FileSizeLimit {
    explicit FileSizeLimit(rlim_t size) {
        ::getrlimit(RLIMIT_FSIZE, &before);
        const rlimit limit{size, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before);
        (void)std::signal(SIGXFSZ, handler);
    }
    rlimit before{};
    void (*handler)(int) = std::signal(SIGXFSZ, SIG_IGN);  // lets write() fail instead of ending the program
};

Error only_error(const fs::path& where, std::string_view variant = {}) {
    const auto loaded = content::load_assembly(where, variant);
    REQUIRE(loaded.errors.size() == 1);
    CHECK(loaded.errors[0].code == ErrorCode::bad_content);
    return loaded.errors[0];
}

}  // namespace

TEST_CASE("Load: an assembly is loaded by its name, its folder or its file") {
    const fs::path folder = content::content_folder() / "assemblies" / "cover-m8";
    for (const fs::path& where : {fs::path("cover-m8"), folder, folder / "", folder / "assembly.json"}) {
        CAPTURE(where.string());
        const auto loaded = content::load_assembly(where);
        CHECK(loaded.ok());
        CHECK(loaded.assembly.name == "cover-m8");
        CHECK(loaded.assembly.joints.size() == 4);
        CHECK(fs::equivalent(loaded.assembly.file, folder / "assembly.json"));
    }
}

TEST_CASE("Load: an unknown assembly gives the nearest name and the list of assemblies") {
    const std::string near = only_error("zq530").message(), far = only_error("gearbox").message();
    CHECK(near.starts_with(
        "zq530: there is no such folder, file or assembly; did you mean \"zq350\"? expected one of "));
    CHECK(far.starts_with("gearbox: there is no such folder, file or assembly; expected one of "));
    CHECK(far.find("cover-m8, ") != std::string::npos);
    CHECK(far.find("zq350") != std::string::npos);
    CHECK(only_error("").what == "there is no such folder, file or assembly");
}

TEST_CASE("Load: a folder without assembly.json and an unreadable file are errors") {
    const Folder folder;
    CHECK(only_error(folder.path()).message() ==
          folder.path().string() + ": this folder has no assembly.json; expected a folder of an assembly");
    fs::create_directories(folder.path() / "sub" / "assembly.json");
    CHECK(only_error(folder / "sub").what == "is a folder");
    fs::create_symlink("nowhere", folder / "assembly.json");
    CHECK(content::load_assembly(folder.path()).errors.size() == 1);
}

TEST_CASE("Load: a session file of any size is recognised as such") {
    const Folder folder;
    std::string session("SQLite format 3", 16);
    for (const std::size_t size : {std::size_t{16}, std::size_t{5U << 20U}}) {
        session.resize(size);
        REQUIRE(write_file(folder / "session.boltwright", session));
        CHECK(only_error(folder / "session.boltwright").message() ==
              (folder / "session.boltwright").string() +
                  ": this is a session, not an assembly; expected the folder of an assembly, or its "
                  "assembly.json");
    }
    REQUIRE(write_file(folder / "text", "SQLite"));
    CHECK(only_error(folder / "text").what == "unknown word \"SQLite\"");
}

TEST_CASE("Load: an unknown variant gives the nearest name or the list") {
    CHECK(only_error("zq350", "stainles").expected == "did you mean \"stainless\"?");
    CHECK(only_error("zq350", "wood").expected ==
          "one of carbon_steel, stainless, bearing_covers, foot_bolts");
    CHECK(only_error("cover-m8", "wood").expected == "none: the file has no variants");
}

TEST_CASE("Load: a new assembly loads without errors and has its name") {
    const Folder folder;
    for (const char* name : {"pump", "a \"quoted\" pump", "Pumpe für Öl", "broken \xFF name"}) {
        CAPTURE(name);
        const fs::path made = folder / "new";
        fs::remove_all(made);
        REQUIRE(content::create_assembly(made, name));
        const auto loaded = content::load_assembly(made);
        for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
        if (std::string_view(name).find('\xFF') == std::string_view::npos)
            CHECK(loaded.assembly.title.at("en") == name);
        CHECK(loaded.assembly.joints.size() == 4);
        CHECK(fs::exists(made / "assembly.schema.json"));  // the file that "$schema" names
        CHECK(loaded.assembly.text.find("\"$schema\": \"assembly.schema.json\"") != std::string::npos);
    }
}

TEST_CASE("Load: a new assembly never overwrites anything") {
    const Folder folder;
    REQUIRE(write_file(folder / "kept", "x"));
    const Status over_folder = content::create_assembly(folder.path(), "pump");
    REQUIRE_FALSE(over_folder);
    CHECK(over_folder.error().message() ==
          folder.path().string() + ": this folder is not empty; expected a folder that is new or empty");
    const Status over_file = content::create_assembly(folder / "kept", "pump");
    REQUIRE_FALSE(over_file);
    CHECK(over_file.error().what == "this is a file");
    CHECK_FALSE(content::create_assembly({}, "pump"));
    CHECK_FALSE(content::create_assembly(folder / "new", ""));
    CHECK_FALSE(content::create_assembly(folder.path() / "kept" / "below", "pump"));
    fs::create_directories(folder / "empty");
    CHECK(content::create_assembly(folder.path() / "empty" / "", "pump"));
    CHECK(fs::exists(folder.path() / "empty" / "assembly.json"));
}

TEST_CASE("Load: a new assembly that cannot be written leaves nothing behind") {
    const Folder folder;
    fs::create_directories(folder / "empty");
    // The size limit simulates a full disk: the small file fits, the schema does not.
    for (const rlim_t size : {rlim_t{100}, rlim_t{10'000}}) {
        CAPTURE(size);
        const FileSizeLimit limit(size);
        CHECK_FALSE(content::create_assembly(folder.path() / "new" / "below", "pump"));
        CHECK_FALSE(fs::exists(folder / "new"));
        CHECK_FALSE(content::create_assembly(folder / "empty", "pump"));
        CHECK(fs::is_empty(folder / "empty"));  // an existing folder is kept
    }
    CHECK(content::create_assembly(folder.path() / "new" / "below", "pump"));
}

TEST_CASE("Load: a new assembly in the content folder uses the common schema") {
    const Folder folder;
    fs::create_directories(folder / "schema");
    fs::create_directories(folder / "assemblies");
    fs::copy_file(content::content_folder() / "schema" / "assembly.schema.json",
                  folder.path() / "schema" / "assembly.schema.json");
    const test::EnvironmentVariable variable("BOLTWRIGHT_CONTENT", folder.path().c_str());
    REQUIRE(content::create_assembly(folder.path() / "assemblies" / "pump", "pump"));
    const auto loaded = content::load_assembly("pump");
    CHECK(loaded.ok());
    CHECK(loaded.assembly.text.find("\"../../schema/assembly.schema.json\"") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path() / "assemblies" / "pump" / "assembly.schema.json"));
}

}  // namespace content_load_test
