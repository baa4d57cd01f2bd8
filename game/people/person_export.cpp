#include "game/people/person_export.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/base/file.hpp"
#include "game/session/session_file.hpp"
#include "game/study_journal/journal.hpp"

namespace bolt::people {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr const char* export_format = "boltwright export 1";

bool is_inside(const fs::path& path, const fs::path& folder) {
    std::error_code unknown;
    const fs::path inner = fs::weakly_canonical(path, unknown), outer = fs::weakly_canonical(folder, unknown);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

Status check_out(const DataFolders& folders, const fs::path& out) {
    std::vector<fs::path> searched{folders.own.people, folders.own.settings, folders.own.gloves};
    searched.insert(searched.end(), folders.sessions.begin(), folders.sessions.end());
    for (const fs::path& folder : searched)
        if (!folder.empty() && is_inside(out, folder))
            return fail(
                ErrorCode::usage,
                fmt::format("{} is inside {}, which is searched for sessions", out.string(), folder.string()),
                "a folder elsewhere");
    std::error_code problem;
    if (fs::exists(out, problem) && !(fs::is_directory(out, problem) && fs::is_empty(out, problem)))
        return fail(ErrorCode::usage, out.string() + " is not empty", "a new or empty folder");
    return {};
}

// Where the copies of a person's files go, relative to the export.
class Layout {
  public:
    fs::path place_of(const PersonFile& file) {
        switch (file.kind) {
            case FileKind::settings:
                return fs::path("settings") / file.path.filename();
            case FileKind::calibration:
                return fs::path("calibrations") / file.path.filename();
            case FileKind::session:
            case FileKind::summary:
            case FileKind::page:
            case FileKind::answers:
                break;
        }
        const auto [folder, is_new] =
            folders_.emplace(file.path.parent_path(), fmt::format("{:03}", folders_.size() + 1));
        const char* kind = file.kind == FileKind::answers ? "studies" : "sessions";
        return fs::path(kind) / folder->second / file.path.filename();
    }

  private:
    std::map<fs::path, std::string> folders_;  // by the folder of the lesson or of the participant
};

Status copy_one(const fs::path& from, const fs::path& to) {
    std::error_code problem;
    fs::create_directories(to.parent_path(), problem);
    if (!problem) fs::copy_file(from, to, problem);
    if (!problem) return {};
    Error error;
    error.file = from.string();
    error.what = fmt::format("cannot be copied to {}: {}", to.string(), problem.message());
    error.expected = "a readable file, a writable folder and free space";
    return fail(std::move(error));
}

// Copies a file, and the part of a session that is not yet merged into it.
Status copy_with_log(const PersonFile& file, const fs::path& to) {
    BOLT_TRY(copy_one(file.path, to));
    if (file.kind != FileKind::session) return {};
    for (const char* suffix : {"-wal", "-journal"}) {
        std::error_code unknown;
        const fs::path log = file.path.string() + suffix;
        if (fs::is_regular_file(log, unknown)) BOLT_TRY(copy_one(log, to.string() + suffix));
    }
    if (!session::SessionReader::open(file.path)) return {};  // damaged before
    const auto copied = session::SessionReader::open(to);
    return copied ? Status() : fail(copied.error());
}

// The entries of a participant's journal, readable without a program.
void add_answers(const fs::path& file, ordered_json& entry) {
    const auto journal = study::read_journal(file);
    if (!journal) return;
    for (const study::JournalEntry& one : journal->entries) {
        ordered_json row{{"time", study::time_text(one.time)}, {"kind", study::name(one.kind)}};
        for (const auto& [key, text] :
             {std::pair("step", &one.step), std::pair("item", &one.item), std::pair("text", &one.text)})
            if (!text->empty()) row[key] = *text;
        if (one.value) row["value"] = *one.value;
        entry["entries"].push_back(std::move(row));
    }
}

ordered_json entry_of(const PersonFile& file, const fs::path& place) {
    ordered_json entry{
        {"file", place.generic_string()}, {"kind", name(file.kind)}, {"modified", utc_text(file.modified)}};
    if (file.kind == FileKind::answers) add_answers(file.path, entry);
    if (file.kind != FileKind::session) return entry;
    const auto reader = session::SessionReader::open(file.path);
    if (!reader) return entry;
    const session::Header& header = reader->header();
    entry["assembly"] = header.assembly;
    entry["mode"] = lesson::name(header.mode);
    entry["task"] = lesson::name(header.task);
    entry["law"] = joint::name(header.law);
    entry["complete"] = reader->complete();
    const auto result = reader->result();
    if (!result) return entry;
    entry["finished"] = result->finished;
    entry["duration_s"] = std::round(1e3 * result->duration) / 1e3;
    if (reader->complete()) entry["score"] = std::round(1e2 * result->score) / 1e2;
    return entry;
}

}  // namespace

std::string utc_text(std::time_t time) { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(time)); }

std::string describe_session(const fs::path& path) {
    const auto reader = session::SessionReader::open(path);
    if (!reader) return reader.error().what;
    const session::Header& header = reader->header();
    std::string text =
        fmt::format("{}, {}, {}", header.assembly, lesson::name(header.mode), lesson::name(header.task));
    if (!reader->complete()) return text + ", cut short";
    if (const auto result = reader->result()) text += fmt::format(", {:.0f} of 100 points", result->score);
    return text;
}

Result<PersonExport> export_person(const DataFolders& folders, const PersonData& data, const fs::path& out) {
    BOLT_TRY(check_out(folders, out));
    std::error_code problem;
    fs::create_directories(out, problem);
    if (problem) {
        Error error;
        error.file = out.string();
        error.what = "this folder cannot be created: " + problem.message();
        error.expected = "a folder that this user may write to";
        return fail(std::move(error));
    }
    fs::permissions(out, fs::perms::owner_all, problem);  // a failure leaves the user's own umask
    PersonExport made;
    Layout layout;
    ordered_json index{{"format", export_format},
                       {"code", data.person.code},
                       {"name", data.person.name},
                       {"files", ordered_json::array()}};
    for (const PersonFile& file : data.files) {
        const fs::path place = layout.place_of(file);
        if (Status copied = copy_with_log(file, out / place); !copied) {
            made.problems.push_back(copied.error());
            continue;
        }
        made.copies.push_back(out / place);
        index["files"].push_back(entry_of(file, place));
    }
    BOLT_TRY(write_private_file(out / "index.json",
                                index.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n"));
    made.copies.push_back(out / "index.json");
    return made;
}

}  // namespace bolt::people
