#include "game/people/erasure.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/file.hpp"
#include "game/plot/html.hpp"
#include "game/session/database.hpp"
#include "game/session/session_file.hpp"
#include "game/study_journal/journal.hpp"

namespace bolt::people {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_page_size = 256U << 20U;  // bytes

Error kept_file(const fs::path& path, std::string what, std::string expected = {}) {
    Error error;
    error.file = path.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

// Never follows a link and never removes a folder.
void unlink_file(const fs::path& path, Erasure& erasure) {
    if (::unlink(path.c_str()) == 0)
        erasure.deleted.push_back(path);
    else if (errno != ENOENT)
        erasure.kept.push_back(kept_file(path, std::string("cannot be deleted: ") + std::strerror(errno)));
}

// Deletes a session with its logs. Holds the file's lock meanwhile, so that no program can record into it.
void erase_session(const fs::path& path, const PersonData& data, Erasure& erasure) {
    const auto lock = session::FileLock::acquire(path, path.string());
    if (!lock) {
        erasure.kept.push_back(lock.error());
        return;
    }
    // The lesson of another person may have replaced it since it was found.
    const auto header = session::read_header(path);
    const content::Person person[] = {data.person};
    if (!header || people::person_of(*header, person) != data.person) {
        erasure.kept.push_back(header ? kept_file(path, "has another person's lesson by now")
                                      : header.error());
        return;
    }
    for (const char* suffix : {"-wal", "-journal", "-shm"}) {
        std::error_code unknown;
        const fs::path log = path.string() + suffix;
        if (fs::exists(fs::symlink_status(log, unknown))) unlink_file(log, erasure);
    }
    unlink_file(path, erasure);
}

// Deletes the journal of a participant. Holds its lock meanwhile, so that no program leads the participant.
// Marks the folder as that of a participant who withdrew.
void erase_answers(const fs::path& path, Erasure& erasure) {
    const auto lock = session::FileLock::acquire(path, path.string());
    if (!lock) {
        erasure.kept.push_back(lock.error());
        return;
    }
    if (const Status marked = study::mark_withdrawn(path.parent_path(), std::time(nullptr)); !marked) {
        erasure.kept.push_back(marked.error());
        return;
    }
    unlink_file(path, erasure);
    for (const fs::path& file : study::delete_derived_files(path.parent_path()))
        erasure.kept.push_back(kept_file(file, "cannot be deleted"));
}

// Removes the folder of a lesson and folders around it while they are empty, but never `root`.
void remove_empty_folders(fs::path folder, const fs::path& root, Erasure& erasure) {
    std::error_code problem;
    while (!fs::equivalent(folder, root, problem) && !problem && ::rmdir(folder.c_str()) == 0) {
        erasure.deleted.push_back(folder);
        folder = folder.parent_path();
    }
}

void forget(const DataFolders& folders, const content::Person& person, Erasure& erasure) {
    if (folders.own.people.empty() || person.code.empty()) return;
    const auto forgotten = content::forget_name(folders.own.people, person.code);
    if (forgotten)
        erasure.name_deleted = *forgotten;
    else
        erasure.kept.push_back(forgotten.error());
}

// True if the file has the name, for example in a session of an older program.
bool holds_name(const PersonFile& file, const std::string& name) {
    if (file.kind == FileKind::session) {
        const auto header = session::read_header(file.path);
        return header && content::trim_blanks(session::trainee_name(*header)) == name;
    }
    const auto text = read_file(file.path, max_page_size, ErrorCode::failed);
    if (!text) return false;
    const auto has = [&](const std::string& part) { return text->find(part) != std::string::npos; };
    if (file.kind == FileKind::summary) return has('"' + name + '"');
    const std::string shown = '>' + plot::escape(name);
    return has(shown + '<') || has(shown + " (");
}

}  // namespace

Erasure erase_person(const DataFolders& folders, const PersonData& data) {
    Erasure erasure;
    for (const PersonFile& file : data.files)
        if (file.kind == FileKind::session)
            erase_session(file.path, data, erasure);
        else if (file.kind == FileKind::answers)
            erase_answers(file.path, erasure);
        else
            unlink_file(file.path, erasure);
    for (const fs::path& page : data.shared_pages)
        erasure.kept.push_back(kept_file(page, "shows other people too", "that you delete it by hand"));
    for (const PersonFile& file : data.files)
        if (file.kind != FileKind::settings && file.kind != FileKind::calibration)
            remove_empty_folders(file.path.parent_path(), file.root, erasure);
    // The name is the last, so that an erasure that was interrupted can be repeated by name.
    if (folders.missing.empty())
        forget(folders, data.person, erasure);
    else if (!data.person.name.empty())
        erasure.kept.push_back(kept_file(folders.own.people, "the name is kept",
                                         "the folders of all studies, and the same command again"));
    return erasure;
}

Erasure erase_name(const DataFolders& folders, const PersonData& data) {
    Erasure erasure;
    const content::Person& person = data.person;
    if (person.name.empty() || person.code.empty()) return erasure;
    erasure.kept = content::adopt_files(folders.own, person);
    for (const PersonFile& file : data.files) {
        const bool adopted = file.kind == FileKind::settings || file.kind == FileKind::calibration;
        if (!adopted && holds_name(file, person.name))
            erasure.kept.push_back(kept_file(file.path, "holds the name, because an older program wrote it",
                                             "`boltwright trainees erase` without --name-only to delete it"));
    }
    for (const fs::path& page : data.shared_pages)
        if (holds_name({page, FileKind::page, 0, {}}, person.name))
            erasure.kept.push_back(kept_file(page, "shows the name", "that you delete it by hand"));
    forget(folders, person, erasure);
    return erasure;
}

}  // namespace bolt::people
