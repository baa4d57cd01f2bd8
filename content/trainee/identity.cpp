#include "content/trainee/identity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "content/format/json_document.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace fs = std::filesystem;

namespace {

// The text of a file with another trainee; none if it is not a JSON object with a trainee.
std::optional<std::string> with_trainee(std::string_view text, const std::string& code) {
    std::vector<Error> errors;
    const auto document = JsonDocument::parse(text, "", errors);  // bounds the depth
    if (!errors.empty()) return std::nullopt;
    auto root = nlohmann::ordered_json::parse(text, nullptr, false);
    if (!root.is_object() || !root.contains("trainee")) return std::nullopt;
    root["trainee"] = code;
    return root.dump(2) + "\n";
}

fs::path unused_path(fs::path path) {
    std::error_code unknown;
    if (!fs::exists(path, unknown)) return path;
    path += ".older";
    fs::path free = path;
    for (int i = 2; fs::exists(free, unknown); ++i) free = path.string() + std::to_string(i);
    return free;
}

Status adopt_file(const fs::path& old, const fs::path& target, const std::string& code) {
    const auto text = read_file(old, max_trainee_file_size, ErrorCode::bad_content);
    const auto rewritten = text ? with_trainee(*text, code) : std::nullopt;
    std::error_code problem;
    if (rewritten) {
        BOLT_TRY(write_file(target, *rewritten));
        fs::remove(old, problem);
    } else {
        fs::rename(old, target, problem);  // whoever reads it reports what is wrong
    }
    if (!problem) return {};
    Error error;
    error.file = old.string();
    error.what = "cannot be renamed: " + problem.message();
    error.expected = "a folder with write permission";
    return fail(std::move(error));
}

// A known code that differs from this unknown one in one character.
std::string similar_code(const fs::path& folder, const std::string& code) {
    const auto people = list_people(folder);
    if (!people) return {};
    std::vector<std::string> similar;
    for (const Person& person : *people) {
        if (person.code == code) return {};
        if (code_distance(person.code, code) == 1) similar.push_back(person.code);
    }
    return similar.size() == 1 ? similar.front() : std::string();
}

}  // namespace

std::string trainee_of_file(const fs::path& path) {
    const std::string file_name = path.filename().string();
    const std::size_t end = std::min(file_name.find('.'), file_name.size());
    const std::string_view rest = std::string_view(file_name).substr(end);
    for (const std::string_view kind : {".settings.json", ".left.glove.json", ".right.glove.json"})
        if (rest.starts_with(kind)) return trainee_of_file_name(file_name.substr(0, end));
    return {};
}

std::vector<fs::path> files_of_trainee(const fs::path& folder, std::string_view trainee) {
    std::vector<fs::path> files;
    if (folder.empty() || trainee.empty()) return files;
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
         entry.increment(problem))
        if (trainee_of_file(entry->path()) == trainee &&
            entry->symlink_status(problem).type() == fs::file_type::regular)
            files.push_back(entry->path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<Error> adopt_files(const PersonFolders& folders, const Person& person) {
    std::vector<Error> errors;
    const std::size_t prefix = file_name_of(person.name).size();
    for (const fs::path& folder : {folders.settings, folders.gloves})
        for (const fs::path& old : files_of_trainee(folder, person.name)) {
            const std::string rest = old.filename().string().substr(prefix);
            const fs::path target = unused_path(folder / (file_name_of(person.code) + rest));
            if (Status adopted = adopt_file(old, target, person.code); !adopted)
                errors.push_back(adopted.error());
        }
    return errors;
}

IdentifiedPerson identify_person(const PersonFolders& folders, std::string_view typed) {
    if (trim_blanks(typed).empty()) return {};
    const auto nameless = [&](std::optional<Error> error) {
        return IdentifiedPerson{{typed_person_code(typed).value_or(make_person_code()), {}},
                                std::move(error)};
    };
    if (folders.people.empty()) return nameless({});
    auto found = find_or_add_person(folders.people, typed);
    if (!found) return nameless(found.error());
    IdentifiedPerson identified{std::move(*found)};
    if (identified.person.name.empty())
        identified.similar_code = similar_code(folders.people, identified.person.code);
    else
        identified.adoption_errors = adopt_files(folders, identified.person);
    return identified;
}

}  // namespace bolt::content
