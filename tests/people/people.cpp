// The inventory of people's files, their export and their erasure.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "content/trainee/settings.hpp"
#include "game/people/erasure.hpp"
#include "game/people/inventory.hpp"
#include "game/people/page_trainees.hpp"
#include "game/people/person_export.hpp"
#include "game/session/session_file.hpp"
#include "game/study_journal/known_studies.hpp"
#include "tests/people/support.hpp"

using namespace bolt;
using namespace bolt::people;
using namespace bolt::people::test;
namespace fs = std::filesystem;

namespace {

// Everything about Ada, also from an older program, and data of others beside it.
struct FullStation : Station {
    FullStation() {
        put_text(folders.own.settings / (ada + ".settings.json"), "{\"trainee\": \"" + ada + "\"}");
        put_text(folders.own.settings / (ada + ".settings.json.unread"), "{");
        put_text(folders.own.settings / (bea + ".settings.json"), "{}");
        put_text(folders.own.settings / "notes.txt", "Ada");
        put_text(folders.own.gloves / (ada + ".left.glove.json"), "{}");
        put_text(folders.own.gloves / "_41da.right.glove.json", "{\"trainee\": \"Ada\"}");  // older
        put_session(out("session.boltwright"), ada);
        put_text(out("summary.json"), summary_of(ada));
        put_text(out("report.html"), page_of({ada}));
        put_session(out("2025/old/session.boltwright"), "Ada");  // older
        put_text(out("2025/old/summary.json"), summary_of("Ada"));
        put_session(out("bea/session.boltwright"), bea);
        put_text(out("bea/summary.json"), summary_of(bea));
        put_text(out("bea/report.html"), page_of({bea}));
        put_session(out("sim/session.boltwright"), ada, "novice");  // simulated, although called so
        put_text(out("sim/summary.json"), summary_of(ada, "novice"));
        put_session(out("nameless/session.boltwright"), "");
        put_text(out("class.html"), page_of({ada, bea}));
        put_text(out("unknown.html"), page_of({ada, ""}));
        put_text(out("other.html"), "<html><head><title>Ada</title></head></html>");
    }
    [[nodiscard]] PersonData data(const std::string& who) const {
        const auto found = people::find(take_inventory(folders), who);
        REQUIRE(found);
        return *found;
    }
};

const std::set<std::string> others_in_out{"bea/session.boltwright",
                                          "bea/summary.json",
                                          "bea/report.html",
                                          "sim/session.boltwright",
                                          "sim/summary.json",
                                          "nameless/session.boltwright",
                                          "class.html",
                                          "unknown.html",
                                          "other.html"};

bool mentions(const std::vector<Error>& errors, const std::string& file, const std::string& what) {
    return std::any_of(errors.begin(), errors.end(), [&](const Error& e) {
        return e.file.ends_with(file) && e.message().find(what) != std::string::npos;
    });
}

}  // namespace

TEST_CASE("Inventory: each file belongs to the person whose code or typed name it has") {
    const FullStation station;
    const Inventory inventory = take_inventory(station.folders);
    CHECK_FALSE(inventory.names_error);
    CHECK(inventory.file_errors.empty());
    REQUIRE(inventory.people.size() == 2);
    const PersonData ada = inventory.people[0], bea = inventory.people[1];
    CHECK(ada.person == content::Person{station.ada, "Ada"});
    CHECK(bea.person == content::Person{station.bea, "Bea"});
    std::map<FileKind, int> kinds;
    for (const PersonFile& file : ada.files) ++kinds[file.kind];
    CHECK(kinds == std::map<FileKind, int>{{FileKind::settings, 2},
                                           {FileKind::calibration, 2},
                                           {FileKind::session, 2},
                                           {FileKind::summary, 2},
                                           {FileKind::page, 1}});
    CHECK(ada.shared_pages.size() == 2);
    CHECK(bea.files.size() == 4);
    CHECK(bea.shared_pages.size() == 1);
    CHECK(ada.last_lesson());
    for (const std::string& who : {station.ada, std::string(" Ada ")})
        CHECK(people::find(inventory, who).value().person == ada.person);
}

TEST_CASE("Inventory: an unknown person is refused with a suggestion") {
    const FullStation station;
    const Inventory inventory = take_inventory(station.folders);
    CHECK(people::find(inventory, "Adda").error().message().find("did you mean \"Ada\"?") !=
          std::string::npos);
    std::string slip = station.bea;
    slip.back() = slip.back() == '7' ? '8' : '7';
    CHECK(people::find(inventory, slip).error().message().find("did you mean \"" + station.bea) !=
          std::string::npos);
    for (const char* who : {"", " ", "Zacharias"}) CHECK_FALSE(people::find(inventory, who));
}

TEST_CASE("Inventory: without the file of names, and with a damaged one, data is found under the code") {
    const FullStation station;
    fs::remove(content::names_path(station.folders.own.people));
    Inventory inventory = take_inventory(station.folders);
    CHECK_FALSE(inventory.names_error);
    CHECK(people::find(inventory, station.ada).value().files.size() == 6);
    CHECK(people::find(inventory, station.ada).value().person.name.empty());
    const PersonData older = people::find(inventory, "Ada").value();  // nothing links her older files
    CHECK(older.person == content::Person{"", "Ada"});
    CHECK(older.files.size() == 3);
    put_text(content::names_path(station.folders.own.people), "{");
    inventory = take_inventory(station.folders);
    REQUIRE(inventory.names_error);
    CHECK(inventory.names_error->line == 1);
    CHECK(people::find(inventory, station.ada).value().files.size() == 6);
}

TEST_CASE("Inventory: a file that cannot be read is reported, and links are not followed") {
    Station station;
    put_text(station.out("broken.boltwright"), "not a session");
    put_session(station.folder / "elsewhere/session.boltwright", station.ada);
    fs::create_directory_symlink(station.folder / "elsewhere", station.out("link"));
    fs::create_symlink(station.folder / "elsewhere/session.boltwright", station.out("one.boltwright"));
    put_session(station.out("damaged.boltwright"), station.ada);
    std::string bytes = session::test::bytes_of(station.out("damaged.boltwright"));
    const std::string checksum_of = "tick_chunk";
    const std::size_t checksum = bytes.rfind(checksum_of) + checksum_of.size();
    bytes[checksum + 4] = static_cast<char>(bytes[checksum + 4] ^ 0x55);
    session::test::put_bytes(station.out("damaged.boltwright"), bytes);
    REQUIRE_FALSE(session::SessionReader::open(station.out("damaged.boltwright")));
    station.folders.sessions.push_back(station.out(""));  // twice
    const Inventory inventory = take_inventory(station.folders);
    CHECK(inventory.file_errors.size() == 1);
    CHECK(mentions(inventory.file_errors, "broken.boltwright", "session"));
    CHECK(inventory.people[0].files.size() == 1);
}

TEST_CASE("Pages: the people of a report are read, also from pages of older programs") {
    using List = std::vector<std::string>;
    CHECK(page_trainees(page_of({"T-7K3M9Q", "A &amp; B", ""})) == List{"T-7K3M9Q", "A & B", ""});
    CHECK_FALSE(page_trainees("<html><head><title>Flange</title></head><dt>trainee</dt><dd>Ada</dd></html>"));
    const auto older = [](const std::string& trainee) {
        return page_trainees("<head><title>a – training report</title></head><dt>trainee</dt><dd>" + trainee +
                             "</dd>");
    };
    CHECK(older("Ada &lt;L&gt;") == List{"Ada <L>"});
    CHECK(older("person without a name") == List{""});
    CHECK(older("Bo (person or simulated: not recorded)") == List{""});
    CHECK(older("Ada (simulated novice)") == List{});
    CHECK(older("novice (simulated)") == List{});
    CHECK_FALSE(page_trainees(page_of({})));
    // A text without an end is no fact, and a fact inside another is not counted twice.
    CHECK(older("a<dt>trainee</dt><dd>b") == List{"a<dt>trainee</dt><dd>b"});
    const std::set<std::string> people{"", "<b> & 'c' \"d\"", "张伟"};
    const auto read = page_trainees("<title>a – training report</title>" + people_list(people));
    REQUIRE(read);
    CHECK(std::set<std::string>(read->begin(), read->end()) == people);
}

TEST_CASE("Export: everything about a person is copied, with an index that a program can read") {
    const FullStation station;
    const fs::path out = station.folder / "copy";
    const auto made = export_person(station.folders, station.data("Ada"), out);
    REQUIRE(made);
    CHECK(made->problems.empty());
    CHECK(files_in(out) ==
          std::set<std::string>{"index.json", "settings/" + station.ada + ".settings.json",
                                "settings/" + station.ada + ".settings.json.unread",
                                "calibrations/" + station.ada + ".left.glove.json",
                                "calibrations/_41da.right.glove.json", "sessions/001/session.boltwright",
                                "sessions/001/summary.json", "sessions/002/session.boltwright",
                                "sessions/002/summary.json",
                                made->copies[made->copies.size() - 2].lexically_relative(out).string()});
    struct stat status {};
    REQUIRE(::stat(out.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777U) == 0700);
    const auto index =
        nlohmann::json::parse(read_file(out / "index.json", 1U << 20U, ErrorCode::failed).value());
    CHECK(index["format"] == "boltwright export 1");
    CHECK(index["code"] == station.ada);
    CHECK(index["name"] == "Ada");
    CHECK(index["files"].size() == 9);
    int sessions = 0;
    for (const auto& file : index["files"]) {
        CHECK(fs::exists(out / file["file"].get<std::string>()));
        CHECK(file["modified"].get<std::string>().size() == 20);
        if (file["kind"] != "session") continue;
        ++sessions;
        CHECK(file["score"] == 87.25);
        CHECK(file["complete"] == true);
        CHECK(file["assembly"] == "ZQ350");
        CHECK(session::SessionReader::open(out / file["file"].get<std::string>()));
    }
    CHECK(sessions == 2);
    CHECK(files_in(station.out("")).size() == others_in_out.size() + 5);  // nothing was moved
    CHECK(utc_text(0) == "1970-01-01T00:00:00Z");
}

TEST_CASE("Export: a folder that has files, or that is searched for sessions, is refused") {
    const FullStation station;
    const PersonData ada = station.data("Ada");
    for (const fs::path& out :
         {station.folder.path(), station.out("new"), station.folders.own.people / "copy"}) {
        CAPTURE(out);
        const auto made = export_person(station.folders, ada, out);
        REQUIRE_FALSE(made);
        CHECK(made.error().code == ErrorCode::usage);
    }
    CHECK_FALSE(fs::exists(station.out("new")));
}

TEST_CASE("Export: a session that was cut short is copied with its log") {
    const Station station;
    session::test::leave_cut_short(station.out("session.boltwright"), true);
    Inventory inventory = take_inventory(station.folders);
    // The script's header belongs to a simulated trainee; only the copy is tested.
    PersonData data{
        {station.ada, "Ada"}, {{station.out("session.boltwright"), FileKind::session, 0, {}}}, {}};
    const auto made = export_person(station.folders, data, station.folder / "copy");
    REQUIRE(made);
    CHECK(made->problems.empty());
    const auto copy = session::SessionReader::open(station.folder / "copy/sessions/001/session.boltwright");
    REQUIRE(copy);
    CHECK_FALSE(copy->complete());
    CHECK(session::test::script_mismatch(*copy).empty());
}

TEST_CASE("Erasure: all files of the person and the name are deleted, and nothing of others") {
    const FullStation station;
    const auto settings_before = files_in(station.folders.own.settings);
    const Erasure erasure = erase_person(station.folders, station.data(station.ada));
    CHECK(erasure.name_deleted);
    CHECK(files_in(station.out("")) == others_in_out);
    CHECK_FALSE(fs::exists(station.out("2025")));  // empty now
    CHECK(fs::exists(station.out("")));
    CHECK(files_in(station.folders.own.settings) ==
          std::set<std::string>{station.bea + ".settings.json", "notes.txt"});
    CHECK(files_in(station.folders.own.gloves).empty());
    CHECK(erasure.deleted.size() == 9 + 2);
    CHECK(erasure.kept.size() == 2);
    CHECK(mentions(erasure.kept, "class.html", "shows other people too"));
    CHECK(mentions(erasure.kept, "unknown.html", "shows other people too"));
    CHECK(content::list_people(station.folders.own.people).value() ==
          std::vector{content::Person{station.bea, "Bea"}});
    for (const std::string& file : files_in(station.folder.path()))
        if (!file.ends_with(".html") && !file.ends_with("notes.txt") && !file.starts_with("out/sim")) {
            CAPTURE(file);
            const std::string text = session::test::bytes_of(station.folder / file);
            CHECK(text.find(station.ada) == std::string::npos);
            CHECK(text.find("\"Ada\"") == std::string::npos);
        }
}

TEST_CASE("Inventory: a study is remembered once, and its folder is searched without being named") {
    const session::test::Folder folder;
    REQUIRE(study::remember_study(folder / "data", folder / "lab/"));
    REQUIRE(study::remember_study(folder / "data", folder / "lab"));
    REQUIRE(study::remember_study(folder / "data", folder / "other"));
    const auto known = study::known_studies(folder / "data");
    REQUIRE(known);
    CHECK(*known == std::vector<fs::path>{folder / "lab", folder / "other"});
    CHECK(study::known_studies(folder / "nothing")->empty());
    CHECK_FALSE(study::remember_study(folder / "data", folder / "line\nbreak"));
    put_text(folder / "file", "");
    CHECK_FALSE(study::remember_study(folder / "file", folder / "lab"));
}

TEST_CASE("Erasure: the name stays while the folder of a study is missing") {
    FullStation station;
    Error missing;
    missing.file = "lab";
    missing.what = "is not there";
    station.folders.missing.push_back(missing);
    CHECK(mentions(take_inventory(station.folders).file_errors, "lab", "is not there"));
    const Erasure kept = erase_person(station.folders, station.data("Ada"));
    CHECK_FALSE(kept.name_deleted);
    CHECK(mentions(kept.kept, "people", "the name is kept"));
    station.folders.missing.clear();
    CHECK(erase_person(station.folders, station.data("Ada")).name_deleted);
}

TEST_CASE("Erasure: a session that is being recorded is kept and reported") {
    const FullStation station;
    const PersonData ada = station.data("Ada");
    session::Header header = session::test::sample_header(0.1);
    header.trainee_profile = "person";
    header.trainee = station.ada;
    auto writer = session::SessionWriter::create(station.out("session.boltwright"), header);
    REQUIRE(writer);
    REQUIRE(writer->append(session::test::random_ticks(1, 1).front()));
    const Erasure erasure = erase_person(station.folders, ada);
    CHECK(mentions(erasure.kept, "out/session.boltwright", "another program is recording"));
    CHECK(fs::exists(station.out("session.boltwright")));
    CHECK_FALSE(fs::exists(station.out("2025")));
    REQUIRE(writer->finish(session::test::sample_result()));
    const Erasure again = erase_person(station.folders, station.data(station.ada));
    CHECK(again.kept.size() == 2);  // the pages with others
    CHECK(files_in(station.out("")) == others_in_out);
}

TEST_CASE("Erasure: a session that another person's lesson replaced by now is kept") {
    const FullStation station;
    const PersonData ada = station.data("Ada");
    fs::remove(station.out("session.boltwright"));
    put_session(station.out("session.boltwright"), station.bea);
    const Erasure erasure = erase_person(station.folders, ada);
    CHECK(mentions(erasure.kept, "out/session.boltwright", "another person's lesson"));
    CHECK(session::read_header(station.out("session.boltwright"))->trainee == station.bea);
}

TEST_CASE("Erasure: a link in place of a file is deleted itself, and not what it names") {
    const FullStation station;
    const PersonData ada = station.data("Ada");
    put_text(station.folder / "elsewhere", "kept");
    fs::remove(station.out("summary.json"));
    fs::create_symlink(station.folder / "elsewhere", station.out("summary.json"));
    (void)erase_person(station.folders, ada);
    CHECK(session::test::bytes_of(station.folder / "elsewhere") == "kept");
}

TEST_CASE("Erasure: the given folder stays, however it is written, also if it is empty now") {
    for (const char* form : {"", "/", "/.", "/lesson/.."}) {
        CAPTURE(form);
        Station station;
        put_session(station.out("lesson/session.boltwright"), station.ada);
        station.folders.sessions = {station.folder.path().string() + "/out" + form};
        const Erasure erasure =
            erase_person(station.folders, people::find(take_inventory(station.folders), "Ada").value());
        CHECK(erasure.kept.empty());
        CHECK_FALSE(fs::exists(station.out("lesson")));
        CHECK(fs::is_directory(station.out("")));
    }
}

TEST_CASE("Erasure: files of a person whom only an older program knew are found by name") {
    Station station;
    put_session(station.out("session.boltwright"), "Cy");
    put_session(station.out("nameless.boltwright"), "");
    put_text(station.folders.own.settings / "_43y.settings.json", "{}");
    const PersonData cy = people::find(take_inventory(station.folders), "Cy").value();
    CHECK(cy.person == content::Person{"", "Cy"});
    const Erasure erasure = erase_person(station.folders, cy);
    CHECK(erasure.kept.empty());
    CHECK_FALSE(erasure.name_deleted);
    CHECK(files_in(station.folders.own.settings).empty());
    CHECK(files_in(station.out("")) == std::set<std::string>{"nameless.boltwright"});
}

TEST_CASE("Erasure: a damaged file of names is kept and reported, and the files are deleted") {
    const FullStation station;
    put_text(content::names_path(station.folders.own.people), "{");
    const Erasure erasure = erase_person(station.folders, station.data(station.ada));
    CHECK(mentions(erasure.kept, "names.json", ":1:"));
    CHECK_FALSE(fs::exists(station.out("session.boltwright")));
    CHECK(session::test::bytes_of(content::names_path(station.folders.own.people)) == "{");
}

TEST_CASE("Erasure of the name alone: data stays under the code, and files with the name are reported") {
    const FullStation station;
    put_text(station.out("named.html"), page_of({station.ada}) + "<dd>Ada (" + station.ada + ")</dd>");
    const Erasure erasure = erase_name(station.folders, station.data("Ada"));
    CHECK(erasure.name_deleted);
    CHECK(erasure.deleted.empty());
    CHECK(erasure.kept.size() == 3);
    CHECK(mentions(erasure.kept, "out/2025/old/session.boltwright", "holds the name"));
    CHECK(mentions(erasure.kept, "out/2025/old/summary.json", "holds the name"));
    CHECK(mentions(erasure.kept, "out/named.html", "holds the name"));
    CHECK(files_in(station.folders.own.gloves) ==
          std::set<std::string>{station.ada + ".left.glove.json", station.ada + ".right.glove.json"});
    CHECK_FALSE(content::find_person(station.folders.own.people, "Ada").value());
    CHECK(people::find(take_inventory(station.folders), station.ada).value().files.size() == 8);
}
