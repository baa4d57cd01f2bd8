#include "game/people/inventory.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "content/format/json_document.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "engine/base/nearest.hpp"
#include "game/people/page_trainees.hpp"
#include "game/session/session_file.hpp"
#include "game/study_journal/journal.hpp"
#include "game/study_journal/known_studies.hpp"

namespace bolt::people {

namespace fs = std::filesystem;
using content::Person;

namespace {

constexpr std::size_t max_summary_size = 1U << 20U;  // bytes
constexpr std::size_t max_html_size = 256U << 20U;   // bytes

std::time_t modified_at(const fs::path& path) {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0 ? status.st_mtime : 0;
}

bool is_regular(const fs::path& path) {
    std::error_code unknown;
    return fs::symlink_status(path, unknown).type() == fs::file_type::regular;
}

bool is_session(const std::string& file_name) {
    // A killed program may leave a ".part" with the header.
    return file_name.ends_with(".boltwright") || file_name.ends_with(".boltwright.part");
}

// The person of a summary.json; empty texts if it has none.
Person person_of_summary(const std::string& text, std::span<const Person> registered) {
    std::vector<Error> errors;
    const auto document = content::JsonDocument::parse(text, "", errors);
    if (!errors.empty() || !document->root().is_object()) return {};
    const nlohmann::json& root = document->root();
    const auto text_of = [&](const char* key) {
        const auto found = root.find(key);
        return found != root.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    return text_of("operator") == "person" ? person_of(text_of("trainee"), registered) : Person{};
}

// Collects the files of each person.
class Collector {
  public:
    explicit Collector(const DataFolders& folders) : folders_(folders) {
        inventory_.file_errors = folders.missing;
        if (folders.own.people.empty()) return;
        auto people = content::list_people(folders.own.people);
        if (!people) {
            inventory_.names_error = people.error();
            return;
        }
        registered_ = std::move(*people);
        for (const Person& person : registered_) inventory_.people.push_back({person, {}, {}});
    }

    Inventory collect() {
        collect_own(folders_.own.settings, FileKind::settings);
        collect_own(folders_.own.gloves, FileKind::calibration);
        for (const fs::path& root : folders_.sessions) search(root);
        const auto first_unregistered =
            inventory_.people.begin() + static_cast<std::ptrdiff_t>(registered_.size());
        std::sort(first_unregistered, inventory_.people.end(), [](const PersonData& a, const PersonData& b) {
            return std::tie(a.person.code, a.person.name) < std::tie(b.person.code, b.person.name);
        });
        for (PersonData& data : inventory_.people)
            std::sort(data.files.begin(), data.files.end(), [](const PersonFile& a, const PersonFile& b) {
                return std::tie(a.kind, a.modified, a.path) < std::tie(b.kind, b.modified, b.path);
            });
        return std::move(inventory_);
    }

  private:
    PersonData& data_of(const Person& person) {
        for (PersonData& data : inventory_.people)
            if (data.person == person) return data;
        inventory_.people.push_back({person, {}, {}});
        return inventory_.people.back();
    }
    void add(const Person& person, const fs::path& path, FileKind kind, const fs::path& root) {
        if (person == Person{}) return;
        data_of(person).files.push_back({path, kind, modified_at(path), root});
    }
    void collect_own(const fs::path& folder, FileKind kind) {
        std::error_code problem;
        if (folder.empty() || !fs::is_directory(folder, problem)) return;
        for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
             entry.increment(problem)) {
            const std::string trainee = content::trainee_of_file(entry->path());
            if (!trainee.empty() && is_regular(entry->path()))
                add(person_of(trainee, registered_), entry->path(), kind, folder);
        }
        report_search(folder, problem);
    }
    void search(const fs::path& root) {
        std::error_code problem;
        fs::recursive_directory_iterator entry(root, problem), end;
        for (; !problem && entry != end; entry.increment(problem)) {
            std::error_code unknown;
            // A folder that cannot be opened would end the search of all others.
            if (entry->symlink_status(unknown).type() == fs::file_type::directory) {
                fs::directory_iterator opened(entry->path(), unknown);
                if (unknown) entry.disable_recursion_pending();
                report_search(entry->path(), unknown);
            } else if (is_regular(entry->path()) &&
                       seen_.insert(fs::canonical(entry->path(), unknown)).second) {
                examine(entry->path(), root);
            }
        }
        report_search(root, problem);
    }
    void examine(const fs::path& path, const fs::path& root) {
        const std::string file_name = path.filename().string();
        if (is_session(file_name))
            add_session(path, root);
        else if (file_name == "summary.json")
            add_summary(path, root);
        else if (path.extension() == ".html")
            add_page(path, root);
        else if (file_name == study::journal_file_name)
            add_journal(path, root);
    }
    void add_session(const fs::path& path, const fs::path& root) {
        const auto header = session::read_header(path);
        if (header) return add(person_of(*header, registered_), path, FileKind::session, root);
        inventory_.file_errors.push_back(header.error());
    }
    void add_summary(const fs::path& path, const fs::path& root) {
        if (const auto text = read_file(path, max_summary_size, ErrorCode::failed))
            add(person_of_summary(*text, registered_), path, FileKind::summary, root);
    }
    void add_journal(const fs::path& path, const fs::path& root) {
        const auto journal = study::read_journal(path);
        if (journal)
            return add(person_of(study::person_of(*journal), registered_), path, FileKind::answers, root);
        inventory_.file_errors.push_back(journal.error());
    }
    void add_page(const fs::path& path, const fs::path& root) {
        const auto text = read_file(path, max_html_size, ErrorCode::failed);
        const auto trainees = text ? page_trainees(*text) : std::nullopt;
        if (!trainees) return;
        std::vector<Person> shown_people;
        for (const std::string& trainee : *trainees) {
            const Person person = person_of(trainee, registered_);
            if (std::find(shown_people.begin(), shown_people.end(), person) == shown_people.end())
                shown_people.push_back(person);
        }
        if (shown_people.size() == 1) return add(shown_people.front(), path, FileKind::page, root);
        for (const Person& person : shown_people)
            if (person != Person{}) data_of(person).shared_pages.push_back(path);
    }
    void report_search(const fs::path& folder, const std::error_code& problem) {
        if (!problem) return;
        Error error;
        error.file = folder.string();
        error.what = "this folder cannot be searched: " + problem.message();
        error.expected = "a folder that this user may read";
        inventory_.file_errors.push_back(error);
    }

    const DataFolders& folders_;
    std::vector<Person> registered_;
    std::set<fs::path> seen_;  // the folders may overlap
    Inventory inventory_;
};

}  // namespace

Result<DataFolders> user_folders(std::vector<fs::path> sessions) {
    BOLT_TRY_ASSIGN(const auto data, user_data_folder());
    DataFolders folders{{data / "people", data / "settings", data / "gloves"}, std::move(sessions), {}};
    std::error_code unknown;
    for (const fs::path& given : folders.sessions)
        if (!fs::is_directory(given, unknown))
            return fail(ErrorCode::usage, given.string() + ": there is no such folder",
                        "a folder with sessions");
    if (folders.sessions.empty())
        for (const fs::path& usual : {fs::path("out"), data / "sessions"})
            if (fs::is_directory(usual, unknown)) folders.sessions.push_back(usual);
    BOLT_TRY_ASSIGN(const auto studies, study::known_studies(data));
    for (const fs::path& one : studies) {
        if (fs::is_directory(one, unknown)) {
            folders.sessions.push_back(one);
            continue;
        }
        Error error;
        error.file = one.string();
        error.what = "the folder of this study is not there, so it was not searched";
        error.expected = fmt::format(
            "the folder at its place, its new place in {}, or no line there if the study was deleted",
            (data / study::known_studies_file_name).string());
        folders.missing.push_back(std::move(error));
    }
    return folders;
}

const char* name(FileKind kind) {
    switch (kind) {
        case FileKind::settings:
            return "settings";
        case FileKind::calibration:
            return "calibration";
        case FileKind::session:
            return "session";
        case FileKind::summary:
            return "summary";
        case FileKind::answers:
            return "answers";
        case FileKind::page:
            break;
    }
    return "page";
}

std::optional<std::time_t> PersonData::last_lesson() const {
    std::optional<std::time_t> last;
    for (const PersonFile& file : files)
        if (file.kind == FileKind::session) last = std::max(last.value_or(file.modified), file.modified);
    return last;
}

Inventory take_inventory(const DataFolders& folders) { return Collector(folders).collect(); }

Result<PersonData> find(const Inventory& inventory, std::string_view who) {
    const std::string text(content::trim_blanks(who));
    const std::string code = content::typed_person_code(who).value_or("");
    std::vector<std::string> known;
    for (const PersonData& data : inventory.people) {
        const Person& person = data.person;
        if (!text.empty() && (code.empty() ? person.name == text : person.code == code)) return data;
        for (const std::string& one : {person.code, person.name})
            if (!one.empty()) known.push_back(one);
    }
    const std::string near = nearest(text, known);
    return fail(ErrorCode::usage,
                fmt::format("there is nothing about a trainee {}", content::in_quotes(text)),
                near.empty() ? "a code or a name that `boltwright trainees list` shows"
                             : fmt::format("did you mean {}?", content::in_quotes(near)));
}

Person person_of(std::string_view recorded, std::span<const Person> registered) {
    const std::string_view text = content::trim_blanks(recorded);
    if (text.empty()) return {};
    for (const Person& person : registered)
        if (person.code == text || person.name == text) return person;
    return content::is_person_code(text) ? Person{std::string(text), {}} : Person{{}, std::string(text)};
}

Person person_of(const session::Header& header, std::span<const Person> registered) {
    if (session::trainee_kind(header) != session::TraineeKind::person) return {};
    return person_of(session::trainee_name(header), registered);
}

}  // namespace bolt::people
