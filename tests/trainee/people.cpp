// The registry of people: codes, the file of names, and several programs at once.
#include "content/trainee/people.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "content/trainee/glove_calibration.hpp"
#include "content/trainee/identity.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "engine/base/random.hpp"
#include "tests/support/folder.hpp"

namespace people_test {

using namespace bolt;
using namespace bolt::content;
namespace fs = std::filesystem;
using test::Folder;

namespace {

std::string text_of(const fs::path& path) { return read_file(path, 1U << 20U, ErrorCode::failed).value(); }

std::string error_of(const std::string& text) {
    const auto read = parse_names(text, "names.json");
    REQUIRE_FALSE(read);
    return read.error().message();
}

std::string file_with(const std::string& entries) {
    return "{\"format\": \"boltwright names 1\", \"people\": [\n" + entries + "\n]}\n";
}

}  // namespace

TEST_CASE("Codes: made from the alphabet without look-alikes, all different, every character in use") {
    std::set<std::string> codes;
    std::set<char> characters;
    for (int i = 0; i < 2000; ++i) {
        const std::string code = make_person_code();
        CHECK(is_person_code(code));
        CHECK(codes.insert(code).second);
        for (const char c : code.substr(2)) characters.insert(c);
    }
    CHECK(characters.size() == 32);
    for (const char c : {'I', 'L', 'O', 'U', 'a', '-'}) CHECK(characters.count(c) == 0);
}

TEST_CASE("Codes: typed in small letters and with look-alikes they are the same code; names are not codes") {
    CHECK(typed_person_code(" t-7k3m9q\n") == "T-7K3M9Q");
    CHECK(typed_person_code("T-oil010") == "T-011010");
    for (const char* name : {"", "Ada", "T-", "T7K3M9Q", "T-7K3M9", "T-7K3M9QQ", "T-7K3M9U", "T-7K3 9Q"})
        CHECK_FALSE(typed_person_code(name));
    CHECK(is_person_code("T-7K3M9Q"));
    CHECK_FALSE(is_person_code("t-7k3m9q"));
    CHECK_FALSE(is_person_code("T-7K3M9O"));
    CHECK(code_distance("T-7K3M9Q", "T-7K3M9Q") == 0);
    CHECK(code_distance("T-7K3M9Q", "T-8K3M9R") == 2);
}

TEST_CASE("People: a name gets one code, which is found by name and by code, also by another program") {
    const Folder folder;
    const fs::path people = folder / "new";
    CHECK(list_people(people).value().empty());
    CHECK_FALSE(find_person(people, "Ada").value());
    CHECK_FALSE(fs::exists(people));  // looking writes nothing
    const Person ada = find_or_add_person(people, "  Ada Lovelace ").value();
    CHECK(ada.name == "Ada Lovelace");
    CHECK(is_person_code(ada.code));
    const Person bea = find_or_add_person(people, "Béa").value();
    CHECK(bea.code != ada.code);
    CHECK(find_or_add_person(people, "Ada Lovelace\t").value() == ada);
    CHECK(find_person(people, ada.code).value() == ada);
    std::string small = bea.code;
    for (char& c : small) c = static_cast<char>(std::tolower(c));
    CHECK(find_person(people, small).value() == bea);
    CHECK_FALSE(find_person(people, "ada lovelace").value());  // bytes are compared
    CHECK(list_people(people).value() == std::vector{ada, bea});
    struct stat status {};
    REQUIRE(::stat(names_path(people).c_str(), &status) == 0);
    CHECK((status.st_mode & 0777U) == 0600);
    CHECK(name_and_code(ada) == "Ada Lovelace (" + ada.code + ")");
}

TEST_CASE("People: an unknown code is a person without a name, and nothing is saved") {
    const Folder folder;
    const Person unknown = find_or_add_person(folder.path(), "t-7k3m9q").value();
    CHECK(unknown == Person{"T-7K3M9Q", ""});
    CHECK(name_and_code(unknown) == "T-7K3M9Q");
    CHECK(fs::is_empty(folder.path()));
    CHECK_FALSE(find_person(folder.path(), "T-7K3M9Q").value());
}

TEST_CASE("People: a text that cannot be a name is refused with the reason") {
    const Folder folder;
    const auto refused = [&](const std::string& name) {
        const auto added = find_or_add_person(folder.path(), name);
        REQUIRE_FALSE(added);
        CHECK(added.error().code == ErrorCode::usage);
        return added.error().message();
    };
    CHECK(refused(" \t") == "the trainee's name is empty; expected a name or a code");
    CHECK(refused(std::string(65, 'a')).find("has 65 bytes; expected at most 64 bytes") != std::string::npos);
    CHECK(refused("A\nB").find("control character") != std::string::npos);
    CHECK(refused("Ad\xe9").find("not in UTF-8") != std::string::npos);
    CHECK(fs::is_empty(folder.path()));
    CHECK(find_or_add_person(folder.path(), std::string(64, 'a')));
}

TEST_CASE("People: names survive a write and read, and equal lists give equal bytes") {
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        std::vector<Person> people;
        for (std::uint32_t n = random.bits() % 20; n > 0; --n)
            people.push_back({make_person_code(), "Ada \"" + std::to_string(n) + "\\ 张伟"});
        const std::string text = names_text(people);
        const auto read = parse_names(text, "names.json");
        REQUIRE(read);
        CHECK(*read == people);
        CHECK(names_text(*read) == text);
    }
}

TEST_CASE("People: mistakes in the file of names are reported with line and column") {
    CHECK(error_of("{").find("names.json:1:") == 0);
    CHECK(error_of("[]").find("names.json:1:1: the file of names is not an object") == 0);
    CHECK(error_of("{\"format\": \"boltwright names 2\", \"people\": []}").find("names.json:1:12: ") == 0);
    CHECK(error_of("{\"format\": \"boltwright names 1\"}").find("\"people\" is missing") !=
          std::string::npos);
    CHECK(error_of("{\"format\": \"boltwright names 1\", \"people\": 7}").find("is not a list") !=
          std::string::npos);
    const auto line2 = [](const std::string& entries, const char* what) {
        const std::string message = error_of(file_with(entries));
        CAPTURE(message);
        CHECK(message.find("names.json:2:") == 0);
        CHECK(message.find(what) != std::string::npos);
    };
    const std::string ada = "{\"code\": \"T-7K3M9Q\", \"name\": \"Ada\"}";
    line2("7", "the entry is not an object");
    line2("{\"code\": \"T-7K3M9Q\"}", "\"name\" is missing");
    line2("{\"code\": \"t-7k3m9q\", \"name\": \"Ada\"}", "is not a code");
    line2("{\"code\": \"T-7K3M9Q\", \"name\": \" Ada\"}", "is not a name");
    line2("{\"code\": \"T-7K3M9Q\", \"name\": \"\"}", "is not a name");
    line2("{\"code\": \"T-7K3M9Q\", \"name\": \"t-abcdef\"}", "is a code");
    line2("{\"code\": \"T-7K3M9Q\", \"nmae\": \"Ada\"}", "did you mean \"name\"");
    line2(ada + ", " + ada, "is the code of two people");
    line2(ada + ", {\"code\": \"T-7K3M9R\", \"name\": \"Ada\"}", "is the name of two people");
}

TEST_CASE("People: a damaged file of names is never overwritten, and a lesson is possible with a new code") {
    const Folder folder;
    const std::string broken = "{\n  \"format\": \"boltwright names 1\",\n  \"people\": [{\"code\": 7}]\n}\n";
    REQUIRE(write_file(names_path(folder.path()), broken));
    const std::string place = names_path(folder.path()).string() + ":3:";
    CHECK(find_or_add_person(folder.path(), "Ada").error().message().find(place) == 0);
    CHECK(find_or_add_person(folder.path(), "T-7K3M9Q").error().message().find(place) == 0);
    CHECK(find_person(folder.path(), "Ada").error().message().find(place) == 0);
    CHECK(forget_name(folder.path(), "T-7K3M9Q").error().message().find(place) == 0);
    const IdentifiedPerson ada = identify_person({folder.path(), {}, {}}, "Ada");
    CHECK(is_person_code(ada.person.code));
    CHECK(ada.person.name.empty());
    REQUIRE(ada.names_error);
    CHECK(ada.names_error->message().find(place) == 0);
    CHECK(identify_person({folder.path(), {}, {}}, "t-7k3m9q").person.code == "T-7K3M9Q");
    CHECK(text_of(names_path(folder.path())) == broken);
}

TEST_CASE("People: without the file of names the codes stay usable") {
    const Folder folder;
    const Person ada = find_or_add_person(folder.path(), "Ada").value();
    REQUIRE(fs::remove(names_path(folder.path())));
    CHECK(find_or_add_person(folder.path(), ada.code).value() == Person{ada.code, ""});
    CHECK(find_or_add_person(folder.path(), "Ada").value().code != ada.code);
}

TEST_CASE("People: a name is forgotten, the others stay, and no temporary file holds it") {
    const Folder folder;
    const Person ada = find_or_add_person(folder.path(), "Ada").value();
    const Person bea = find_or_add_person(folder.path(), "Bea").value();
    REQUIRE(write_file(names_path(folder.path()).string() + ".part", "Ada"));
    CHECK(forget_name(folder.path(), ada.code).value());
    CHECK_FALSE(forget_name(folder.path(), ada.code).value());
    CHECK(list_people(folder.path()).value() == std::vector{bea});
    for (const auto& entry : fs::directory_iterator(folder.path()))
        CHECK(text_of(entry.path()).find("Ada") == std::string::npos);
    CHECK_FALSE(forget_name(folder / "none", ada.code).value());
}

TEST_CASE("People: programs that add names at the same time lose none, and agree on the code of a name") {
    const Folder folder;
    constexpr int programs = 8, names = 12;
    std::vector<pid_t> children;
    for (int program = 0; program < programs; ++program) {
        const pid_t child = ::fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            std::ofstream out(folder / ("codes" + std::to_string(program)));
            for (int i = 0; i < names; ++i) {
                const int n = (i + program) % names;
                const auto own = find_or_add_person(
                    folder.path(), "person " + std::to_string(program) + "." + std::to_string(n));
                const auto common = find_or_add_person(folder.path(), "common " + std::to_string(n));
                if (!own || !common) ::_exit(1);
                out << common->name << " " << common->code << "\n" << own->name << " " << own->code << "\n";
            }
            out.close();
            ::_exit(0);
        }
        children.push_back(child);
    }
    for (const pid_t child : children) {
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        CHECK(status == 0);
    }
    std::set<std::string> reported, saved;
    for (int program = 0; program < programs; ++program) {
        std::ifstream in(folder / ("codes" + std::to_string(program)));
        for (std::string line; std::getline(in, line);) reported.insert(line);
    }
    const std::vector<Person> people = list_people(folder.path()).value();
    for (const Person& person : people) saved.insert(person.name + " " + person.code);
    CHECK(saved.size() == names + programs * names);
    CHECK(saved == reported);
}

TEST_CASE("Identity: settings and calibrations of older programs are renamed and rewritten with the code") {
    const Folder folder;
    const PersonFolders folders{folder / "people", folder / "settings", folder / "gloves"};
    for (const fs::path& made : {folders.settings, folders.gloves}) fs::create_directories(made);
    const SettingsVocabulary known{{"en"}, {"tool"}, {"T", "G"}, {}};
    TraineeSettings settings;
    settings.trainee = "Ada L.";
    settings.volume = 0.25;
    settings.keys = {{"tool", "G"}};
    const fs::path old = folders.settings / "_41da_20_4c_2e.settings.json";
    CHECK(settings_path(folders.settings, "Ada L.") == old);
    REQUIRE(save_settings(old, settings, known));
    REQUIRE(write_file(old.string() + ".unread", "{ Ada"));
    GloveCalibration calibration;
    calibration.trainee = "Ada L.";
    calibration.date = "2026-11-22";
    calibration.calibration.fits[0] = hand::LinearFit{0.01, 40.0};
    REQUIRE(save_glove_calibration(glove_calibration_path(folders.gloves, "Ada L.", hand::Side::left),
                                   calibration));
    settings.trainee = "Ada";
    REQUIRE(save_settings(settings_path(folders.settings, "Ada"), settings, known));

    const IdentifiedPerson ada = identify_person(folders, "Ada L.");
    CHECK_FALSE(ada.names_error);
    CHECK(ada.adoption_errors.empty());
    const fs::path now = settings_path(folders.settings, ada.person.code);
    CHECK(now.filename() == ada.person.code + ".settings.json");
    const auto read = load_settings(now, known);
    REQUIRE(read);
    CHECK(read->trainee == ada.person.code);
    CHECK(read->volume == 0.25);
    CHECK(read->keys == std::map<std::string, std::string>{{"tool", "G"}});
    CHECK(text_of(now.string() + ".unread") == "{ Ada");
    const auto glove =
        load_glove_calibration(glove_calibration_path(folders.gloves, ada.person.code, hand::Side::left));
    REQUIRE(glove);
    CHECK(glove->trainee == ada.person.code);
    CHECK(glove->calibration.fits[0]->offset == 40.0);
    CHECK(files_of_trainee(folders.settings, "Ada L.").empty());
    CHECK(files_of_trainee(folders.gloves, "Ada L.").empty());
    CHECK(files_of_trainee(folders.settings, "Ada").size() == 1);  // of another person
    CHECK(files_of_trainee(folders.settings, ada.person.code).size() == 2);

    // An older program that ran again does not replace the settings under the code.
    settings.trainee = "Ada L.";
    settings.volume = 0.75;
    REQUIRE(save_settings(old, settings, known));
    (void)identify_person(folders, ada.person.code);
    CHECK(load_settings(now, known)->volume == 0.25);
    CHECK(load_settings(now.string() + ".older", known)->volume == 0.75);
    CHECK(load_settings(now.string() + ".older", known)->trainee == ada.person.code);
    CHECK_FALSE(fs::exists(old));
}

TEST_CASE("Identity: a mistyped code is a new person, and the similar code is reported") {
    const Folder folder;
    const Person ada = find_or_add_person(folder.path(), "Ada").value();
    std::string mistyped = ada.code;
    mistyped.back() = mistyped.back() == '7' ? '8' : '7';
    const IdentifiedPerson other = identify_person({folder.path(), {}, {}}, mistyped);
    CHECK(other.person == Person{mistyped, ""});
    CHECK(other.similar_code == ada.code);
    CHECK(identify_person({folder.path(), {}, {}}, ada.code).similar_code.empty());
    CHECK(identify_person({folder.path(), {}, {}}, " ").person.code.empty());
    CHECK(is_person_code(identify_person({}, "Ada").person.code));  // no folder for names
}

TEST_CASE("File names: the code names its own files, and the file name of a typed name can be read back") {
    CHECK(file_name_of("T-7K3M9Q") == "T-7K3M9Q");
    for (const char* name : {"Ada L.", "张伟", "t-7k3m9q", "a_b", "-"}) {
        CHECK(trainee_of_file_name(file_name_of(name)) == name);
        CHECK(file_name_of(name).find_first_of("T.") == std::string::npos);
    }
    CHECK(trainee_of_file_name("T-7K3M9Q") == "T-7K3M9Q");
    for (const char* other : {"Ada", "_4", "_zz", "_61"}) CHECK(trainee_of_file_name(other).empty());
}

}  // namespace people_test
