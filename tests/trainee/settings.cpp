#include "content/trainee/settings.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>

#include "engine/base/file.hpp"
#include "engine/base/random.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/replaced.hpp"

using namespace bolt;
using namespace bolt::content;
namespace fs = std::filesystem;
using test::Folder;
using test::replaced;

namespace {

const SettingsVocabulary known{
    {"de", "en", "zh"}, {"hint", "pause", "tool"}, {"Escape", "F1", "H", "T"}, {{"Escape", "pause"}}};

TraineeSettings example(std::uint64_t seed) {
    Random random(seed);
    TraineeSettings s;
    s.trainee = "Ada Lovelace";
    s.language = seed % 2 == 0 ? "" : "zh";
    s.volume = random.uniform();
    s.captions = random.chance(0.5);
    s.palette = random.chance(0.5) ? PaletteKind::distinct : PaletteKind::usual;
    s.left_handed = random.chance(0.5);
    s.force_scale = random.uniform(min_force_scale, 1.0);
    if (random.chance(0.5))
        s.seated_eye_height = random.uniform(min_seated_eye_height, max_seated_eye_height);
    if (random.chance(0.7)) s.law = random.chance(0.5) ? "published" : "mechanistic";
    if (random.chance(0.7)) s.keys["tool"] = random.chance(0.5) ? "T" : "F1";
    if (random.chance(0.7)) s.keys["hint"] = "H";
    s.force_arrow = seed % 3 != 0;
    s.passthrough = seed % 5 == 0;
    s.vignette = seed % 7 != 0;
    s.arm_reach = seed % 5 == 3 ? 0.5 + 0.01 * static_cast<double>(seed % 30) : usual_arm_reach;
    if (seed % 4 == 1) s.vibration = random.uniform();
    return s;
}

}  // namespace

TEST_CASE("Settings: writing and reading round-trips to the last bit") {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const TraineeSettings s = example(seed);
        const std::string text = settings_text(s);
        const auto read = parse_settings(text, "a.json", known);
        REQUIRE_MESSAGE(read, (read ? "" : read.error().message()));
        CHECK(read->trainee == s.trainee);
        CHECK(read->language == s.language);
        CHECK(read->volume == s.volume);
        CHECK(read->vibration == s.vibration);
        CHECK(read->captions == s.captions);
        CHECK(read->palette == s.palette);
        CHECK(read->left_handed == s.left_handed);
        CHECK(read->force_scale == s.force_scale);
        CHECK(read->force_arrow == s.force_arrow);
        CHECK(read->passthrough == s.passthrough);
        CHECK(read->vignette == s.vignette);
        CHECK(read->arm_reach == s.arm_reach);
        CHECK(read->seated_eye_height == s.seated_eye_height);
        CHECK(read->law == s.law);
        CHECK(read->keys == s.keys);
        CHECK(settings_text(*read) == text);
    }
}

TEST_CASE("Settings: errors name file, line, column and what was expected") {
    TraineeSettings s = example(1);
    s.volume = 0.5;
    s.vibration = 1.0;
    s.captions = true;
    s.seated_eye_height = 1.2;
    s.force_scale = 0.5;
    s.palette = PaletteKind::usual;
    s.law.clear();
    s.keys = {{"tool", "T"}, {"hint", "H"}};
    const std::string good = settings_text(s);
    const auto message = [&](const std::string& from, const std::string& to) {
        const auto read = parse_settings(replaced(good, from, to), "ada.json", known);
        REQUIRE(!read);
        CHECK(read.error().code == ErrorCode::bad_content);
        return read.error().message();
    };
    CHECK(message("settings 1", "settings 2").find("ada.json:2:13: ") == 0);
    CHECK(message("\"keys\"", "\"law\": \"publishd\", \"keys\"")
              .find("/law: \"publishd\" is not a joint law; expected \"mechanistic\" or \"published\"") !=
          std::string::npos);
    CHECK(message("\"zh\"", "\"zz\"").find("ada.json:4:15: /language: \"zz\" is not a supported language") ==
          0);
    CHECK(message("0.5", "1.5").find("ada.json:5:13: ") == 0);
    CHECK(message("\"captions\": true", "\"captions\": 1").find("expected true or false") !=
          std::string::npos);
    CHECK(message("\"usual\"", "\"colourful\"").find("expected \"usual\" or \"distinct\"") !=
          std::string::npos);
    CHECK(message("scale\": 0.5", "scale\": 0.05").find("from 0.1 to 1") != std::string::npos);
    CHECK(message("1.2", "2.2").find("from 0.9 to 1.5") != std::string::npos);
    CHECK(message("1.2", "\"high\"").find("from 0.9 to 1.5") != std::string::npos);
    CHECK(message("\"palette\"", "\"pallete\"").find("did you mean \"palette\"") != std::string::npos);
    CHECK(message("\"tool\"", "\"tol\"").find("did you mean \"tool\"") != std::string::npos);
    CHECK(message("\"T\"", "\"Q\"").find("is not a usable key") != std::string::npos);
    CHECK(message("\"T\"", "\"H\"").find("ada.json:13:13: /keys/tool: \"H\" is the key of two actions") == 0);
    CHECK(message("\"T\"", "\"Escape\"").find("is always the key of \"pause\"") != std::string::npos);
    CHECK(message("\"T\"", "7").find("is not a text") != std::string::npos);
    CHECK(message("  \"captions\": true,\n", "").find("\"captions\" is missing") != std::string::npos);
    CHECK(parse_settings(replaced(good, "\"tool\": \"T\"", "\"pause\": \"Escape\""), "x", known));
    for (std::size_t cut = 0; cut + 3 < good.size(); cut += 5) {
        const auto read = parse_settings(good.substr(0, cut), "ada.json", known);
        REQUIRE(!read);
        CHECK(read.error().line >= 1);
    }
    CHECK(!parse_settings("[]", "x", known));
    CHECK(!parse_settings("{\"format\": 3}", "x", known));
}

TEST_CASE("Settings: vibration is 0 to 1, and full in a file without it") {
    TraineeSettings s = example(2);
    s.vibration = 1.0;
    const std::string full = settings_text(s);
    CHECK(full.find("vibration") == std::string::npos);
    CHECK(parse_settings(full, "a.json", known)->vibration == 1.0);
    for (const double value : {0.0, 0.25}) {
        s.vibration = value;
        CHECK(parse_settings(settings_text(s), "a.json", known)->vibration == value);
    }
    for (const char* wrong : {"1.5", "-0.1", "true", "null"}) {
        const auto read = parse_settings(
            replaced(settings_text(s), "\"vibration\": 0.25", std::string("\"vibration\": ") + wrong),
            "a.json", known);
        REQUIRE(!read);
        CHECK(read.error().message().find("a.json:6:16: /vibration: ") == 0);
        CHECK(read.error().expected == "a number from 0 to 1");
    }
}

TEST_CASE("Settings: one file per trainee, and a failed write keeps the old one") {
    const Folder folder;
    const fs::path path = settings_path(folder.path() / "made" / "for it", "Ada");
    CHECK(path != settings_path(path.parent_path(), "ada"));
    CHECK(settings_path(folder.path(), "../../etc/x").parent_path() == folder.path());
    TraineeSettings first = example(1);
    REQUIRE(save_settings(path, first, known));
    CHECK(settings_text(load_settings(path, known).value()) == settings_text(first));

    // Simulates a full disk with a limit on the file size.
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    rlimit little = before;
    little.rlim_cur = 60;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &little) == 0);
    const Status failed = save_settings(path, example(2), known);
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    REQUIRE(!failed);
    CHECK(failed.error().message().find(path.string()) == 0);
    CHECK(settings_text(load_settings(path, known).value()) == settings_text(first));

    // Settings that could not be read back are not written.
    first.volume = 7.0;
    CHECK(!save_settings(path, first, known));
    CHECK(load_settings(path, known));
}

TEST_CASE(
    "Settings: an unreadable file is set aside, never overwritten; a path that is not a folder is an error") {
    const Folder folder;
    const fs::path path = settings_path(folder.path(), "Ada");
    REQUIRE(write_file(path, "{ \"format\": \"boltwright settings 9\" }"));
    REQUIRE(!load_settings(path, known));
    REQUIRE(save_settings(path, example(3), known));
    CHECK(load_settings(path, known));
    const auto aside = read_file(path.string() + ".unread", 1000, ErrorCode::failed);
    REQUIRE(aside);
    CHECK(aside->find("settings 9") != std::string::npos);

    REQUIRE(write_file(folder / "taken", "a file, no folder"));
    const Status failed = save_settings(settings_path(folder / "taken", "Ada"), example(4), known);
    REQUIRE(!failed);
    CHECK(failed.error().message().find("taken") != std::string::npos);
    CHECK(read_file(folder / "taken", 1000, ErrorCode::failed).value() == "a file, no folder");
}
