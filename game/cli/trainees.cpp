// boltwright trainees: lists the people who trained here, and shows, exports and erases what is stored about
// one of them.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "content/trainee/identity.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/people/erasure.hpp"
#include "game/people/inventory.hpp"
#include "game/people/person_export.hpp"

namespace bolt::cli {

namespace {

namespace fs = std::filesystem;

struct TraineesArguments {
    std::string who, out;
    std::vector<fs::path> sessions;
    bool yes = false, name_only = false;
};

std::string local_text(std::time_t time) { return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(time)); }

// Prints why some files or names are not known. They do not count as errors of a command that only reads.
void print_problems(const people::Inventory& inventory) {
    if (inventory.names_error) (void)print_error(*inventory.names_error);
    for (const Error& error : inventory.file_errors) (void)print_error(error);
}

struct FoundTrainee {
    people::DataFolders folders;
    people::Inventory inventory;
    people::PersonData data;
};

Result<FoundTrainee> find_trainee(const TraineesArguments& options) {
    FoundTrainee found;
    BOLT_TRY_ASSIGN(found.folders, people::user_folders(options.sessions));
    found.inventory = people::take_inventory(found.folders);
    print_problems(found.inventory);
    BOLT_TRY_ASSIGN(found.data, people::find(found.inventory, options.who));
    return found;
}

// The width of a text on the terminal, if each character has one column.
std::size_t width_of(std::string_view text) {
    std::size_t width = 0;
    for (const char c : text)
        if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) ++width;
    return width;
}

int list_trainees(const TraineesArguments& options) {
    const auto folders = people::user_folders(options.sessions);
    if (!folders) return print_error(folders.error());
    const people::Inventory inventory = people::take_inventory(*folders);
    print_problems(inventory);
    if (inventory.people.empty()) {
        const Status printed = print("Nobody has trained here with a name or a code.\n");
        return printed ? 0 : print_error(printed.error());
    }
    std::size_t widest = 4;
    for (const people::PersonData& data : inventory.people)
        widest = std::max(widest, width_of(data.person.name));
    std::string text =
        fmt::format("{:<8}  {:<{}}  {:>5}  {}\n", "code", "name", widest, "files", "last lesson");
    bool older = false;
    for (const people::PersonData& data : inventory.people) {
        const content::Person& person = data.person;
        older = older || person.code.empty();
        const auto last = data.last_lesson();
        text += fmt::format("{:<8}  {}{}  {:>5}  {}\n", person.code.empty() ? "-" : person.code, person.name,
                            std::string(widest - width_of(person.name), ' '), data.files.size(),
                            last ? local_text(*last) : "-");
    }
    if (older)
        text +=
            "A person without a code is known from files of an older program; the next lesson with this name "
            "gives a code.\n";
    const Status printed = print(text);
    return printed ? 0 : print_error(printed.error());
}

int show_trainee(const TraineesArguments& options) {
    const auto found = find_trainee(options);
    if (!found) return print_error(found.error());
    std::string text = content::name_and_code(found->data.person) + "\n";
    for (const people::PersonFile& file : found->data.files) {
        text += fmt::format("  {:<11}  {}  {}\n", people::name(file.kind), local_text(file.modified),
                            file.path.string());
        if (file.kind == people::FileKind::session)
            text += fmt::format("  {:<11}  {}\n", "", people::describe_session(file.path));
    }
    for (const fs::path& page : found->data.shared_pages)
        text += fmt::format("  {:<11}  {} (shows other people too)\n", "page", page.string());
    if (found->data.files.empty()) text += "  no files\n";
    const Status printed = print(text);
    return printed ? 0 : print_error(printed.error());
}

int export_trainee(const TraineesArguments& options) {
    const auto found = find_trainee(options);
    if (!found) return print_error(found.error());
    const auto made = people::export_person(found->folders, found->data, options.out);
    if (!made) return print_error(made.error());
    std::string text;
    for (const fs::path& copy : made->copies) text += copy.string() + "\n";
    if (Status printed = print(text); !printed) return print_error(printed.error());
    for (const fs::path& page : found->data.shared_pages)
        fmt::print(stderr, "{}: shows other people too; it is not exported\n", page.string());
    return print_error(made->problems);
}

// Asks before files are deleted. Fails without a terminal.
Result<bool> confirm(const TraineesArguments& options, const people::PersonData& data) {
    const std::string person = content::name_and_code(data.person);
    const std::string question = options.name_only ? fmt::format("Delete the name of {}?", person)
                                                   : fmt::format("Delete {} file{} of {}?", data.files.size(),
                                                                 data.files.size() == 1 ? "" : "s", person);
    if (!options.yes && !has_terminal())
        return fail(ErrorCode::usage, "there is no terminal to ask: " + question, "--yes");
    return ask(question, options.yes);
}

int erase_trainee(const TraineesArguments& options) {
    const auto found = find_trainee(options);
    if (!found) return print_error(found.error());
    const people::PersonData& data = found->data;
    if (options.name_only && (data.person.code.empty() || data.person.name.empty()))
        return print_error(
            fail(ErrorCode::usage,
                 fmt::format("{} has no entry in the file of names", content::name_and_code(data.person)),
                 "a person with a name, or no --name-only")
                .value());
    const Result<bool> confirmed = confirm(options, data);
    if (!confirmed) return print_error(confirmed.error());
    if (!*confirmed) {
        (void)std::fputs("Nothing was deleted.\n", stderr);
        return static_cast<int>(ErrorCode::failed);
    }
    const people::Erasure erasure = options.name_only ? people::erase_name(found->folders, data)
                                                      : people::erase_person(found->folders, data);
    std::string text;
    for (const fs::path& path : erasure.deleted) text += fmt::format("deleted {}\n", path.string());
    if (erasure.name_deleted) text += fmt::format("deleted the name of {}\n", data.person.code);
    const Status printed = print(text);
    (void)print_error(erasure.kept);
    // A file whose person cannot be read may be this person's.
    const bool complete = erasure.kept.empty() && (options.name_only || found->inventory.file_errors.empty());
    if (!printed) return print_error(printed.error());
    return complete ? 0 : static_cast<int>(ErrorCode::failed);
}

}  // namespace

Result<content::Person> person_argument(const std::string& typed, const fs::path& gloves,
                                        NewPerson new_person) {
    const auto folder = content::people_folder();
    if (new_person == NewPerson::unchanged) {
        const auto code = content::typed_person_code(typed);
        const content::Person unknown = code ? content::Person{*code, {}} : content::Person{{}, typed};
        if (!folder) return unknown;
        const auto known = content::find_person(*folder, typed);
        if (!known) (void)print_error(known.error());
        if (!known || !*known) return unknown;
    }
    if (!folder) return fail(folder.error());
    const content::IdentifiedPerson identified = content::identify_person({*folder, {}, gloves}, typed);
    if (identified.names_error && !content::typed_person_code(typed)) return fail(*identified.names_error);
    if (identified.names_error) (void)print_error(*identified.names_error);
    if (!identified.similar_code.empty())
        fmt::print(stderr, "{} is new here; did you mean {}?\n", identified.person.code,
                   identified.similar_code);
    (void)print_error(identified.adoption_errors);
    return identified.person;
}

void add_trainees(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "trainees",
        "List the people who trained here; show, export or erase what is stored about one of them");
    command->require_subcommand(1);
    const auto options = std::make_shared<TraineesArguments>();
    const auto add = [&](const char* name, const char* about, int (*work)(const TraineesArguments&)) {
        CLI::App* sub = command->add_subcommand(name, about);
        sub->callback([&exit_code, options, work] { exit_code = work(*options); });
        return sub;
    };
    const auto add_who = [&](CLI::App* sub) {
        sub->add_option("WHO", options->who, "Code or name of the person")->required();
    };
    const auto add_folders = [&](CLI::App* sub) {
        sub->add_option(
            "SESSIONS_FOLDER", options->sessions,
            "Folders to search for sessions; default: out, and the folder of lessons that were "
            "started from the desktop. Studies that people took part in here are always searched");
    };
    add_folders(add("list", "List all people with their codes", list_trainees));

    CLI::App* shown = add("show", "List the files of a person", show_trainee);
    add_who(shown);
    add_folders(shown);

    CLI::App* exported = add("export", "Copy all files of a person, for the person", export_trainee);
    add_who(exported);
    exported->add_option("--out", options->out, "New folder for the copies and their index.json")->required();
    add_folders(exported);

    CLI::App* erased = add("erase", "Delete all files of a person, and the name", erase_trainee);
    add_who(erased);
    add_folders(erased);
    erased->add_flag("--name-only", options->name_only,
                     "Delete only the name; the data stays under the code");
    erased->add_flag("--yes", options->yes, "Do not ask");
}

}  // namespace bolt::cli
