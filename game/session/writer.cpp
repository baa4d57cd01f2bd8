#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "engine/base/result.hpp"
#include "game/session/database.hpp"
#include "game/session/recorded_tick.hpp"
#include "game/session/session_file.hpp"
#include "game/session/tables.hpp"

namespace bolt::session {

namespace {

constexpr const char* replaceable = "a file that may be replaced, in a folder with write permission";

Status create_empty(const std::filesystem::path& path, const std::string& file, const Header& header,
                    TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto database, Database::create(path, file));
    const std::string setup =
        fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id, format_version);
    BOLT_TRY(database.execute(setup.c_str()));
    BOLT_TRY(transaction(database, [&]() -> Status {
        BOLT_TRY(database.execute(schema));
        BOLT_TRY(put_header(database, header, checksums));
        return put_checksums(database, checksums);
    }));
    return database.execute("PRAGMA journal_mode = WAL");
}

// Merges the write-ahead log of the old session into its file, so that one rename moves all of it. If the
// merge fails, the rest stays in the log. Returns false if the session is open elsewhere.
bool merge_log(const std::filesystem::path& path, const std::string& file) {
    auto database = Database::open(path, file);
    if (!database) return true;
    if (!database->execute("PRAGMA busy_timeout = 0; PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE"))
        return !database->was_busy();
    (void)database->execute("ROLLBACK; PRAGMA journal_mode = MEMORY");
    return true;
}

// Ignores errors: a file may be missing, and one that cannot be removed makes the replacement fail too.
void remove_logs(const std::filesystem::path& path) {
    std::error_code ignored;
    for (const char* suffix : {"-wal", "-shm", "-journal"})
        std::filesystem::remove(path.string() + suffix, ignored);
}

void remove_with_logs(const std::filesystem::path& path) {
    remove_logs(path);
    (void)::unlink(path.c_str());  // never a folder, which std::filesystem::remove would delete
}

std::filesystem::path previous_path(const std::filesystem::path& path) {
    return path.parent_path() / (path.stem().string() + ".previous" + path.extension().string());
}

// True if the file has no ticks; keeping it would replace a session that was kept earlier.
bool has_no_ticks(const std::filesystem::path& path) {
    std::error_code unknown;
    if (std::filesystem::file_size(path, unknown) == 0 && !unknown) return true;
    const auto session = SessionReader::open(path);
    return session && !session->complete() && session->tick_count() == 0;
}

// Renames the old file and its remaining logs to the previous_path(). On file systems with hard links a crash
// in this function loses nothing: the next create() continues.
Status keep_old_file(const std::filesystem::path& path, const std::string& file) {
    const std::filesystem::path kept = previous_path(path);
    BOLT_TRY(FileLock::acquire(kept, kept.string()));
    std::error_code status;
    if (!std::filesystem::equivalent(path, kept, status)) {
        remove_with_logs(kept);
        // With a hard link `path` names a session at all times. Some file systems do not support hard links,
        // and some users may not link files of other users.
        std::filesystem::create_hard_link(path, kept, status);
        if (status) std::filesystem::rename(path, kept, status);
        if (status)
            return file_error(file,
                              fmt::format("cannot be replaced: the old file cannot be kept as {}: {}",
                                          kept.string(), status.message()),
                              replaceable);
    }
    for (const char* suffix : {"-wal", "-journal"}) {
        const std::filesystem::path log = path.string() + suffix;
        if (std::filesystem::exists(log, status))
            std::filesystem::rename(log, kept.string() + suffix, status);
        if (status)
            return file_error(
                file,
                fmt::format("cannot be replaced: {} cannot be moved: {}", log.string(), status.message()),
                replaceable);
    }
    return {};
}

// Creates the folder of `path` and locks `path` against other programs that record.
Result<FileLock> acquire_lock(const std::filesystem::path& path, const std::string& file) {
    std::error_code status;
    std::filesystem::create_directories(path.parent_path(), status);
    if (status)
        return file_error(file, "its folder cannot be created: " + status.message(),
                          "a path whose folder can be created");
    const auto existing = std::filesystem::status(path, status);
    if (std::filesystem::exists(existing) && !std::filesystem::is_regular_file(existing))
        return file_error(file, "is not a regular file", "a new file, or a session to replace");
    return FileLock::acquire(path, file);
}

// Creates a closed session without ticks at `path`, in write-ahead mode, and sets `checksums`. The caller
// holds the lock of `path`. The file is created under another name first, so a failure leaves an old file at
// `path` untouched. The old file is kept as session_file.hpp describes. On file systems with hard links
// `path` always names a complete file, old or new.
Status create_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                   TableChecksums& checksums) {
    std::error_code status;
    const bool exists = std::filesystem::exists(path, status);
    if (status) return file_error(file, "cannot be replaced: " + status.message(), replaceable);
    if (exists && !merge_log(path, file))
        return file_error(file, "cannot be replaced while it is open elsewhere",
                          "a file that nobody has open");

    const std::filesystem::path part = path.string() + ".part";
    remove_with_logs(part);
    Status made = create_empty(part, file, header, checksums);
    if (made && exists && !has_no_ticks(path)) made = keep_old_file(path, file);
    if (!made) {
        remove_with_logs(part);
        return made;
    }
    // SQLite would apply a remaining log to the new file.
    remove_logs(path);
    std::filesystem::rename(part, path, status);
    if (!status) return {};
    remove_with_logs(part);
    return file_error(file, "cannot be replaced: " + status.message(), replaceable);
}

}  // namespace

struct SessionWriter::State {
    State(FileLock acquired, Database opened, std::string name)
        : lock(std::move(acquired)), database(std::move(opened)), file(std::move(name)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    // Without finish(), commits the pending data. A destructor cannot report a failure.
    ~State() {
        if (!stop_error) (void)commit(nullptr);
    }

    Status commit(const lesson::LessonResult* result);
    Status write_pending();
    Status merge_wal();
    void update(const lesson::JointResult& result);

    std::optional<FileLock> lock;  // destroyed last; lock and database are empty after finish()
    std::optional<Database> database;
    std::string file;
    double dt = 0.0;
    std::size_t chunk_ticks = 0;
    TableChecksums checksums;
    ChunkEncoder encoder;
    std::vector<TickRecord> ticks;  // ticks and events that are not yet committed
    std::vector<lesson::LessonEvent> events;
    std::optional<servo::Timing> timing;
    std::vector<JointRow> joints;  // in the order of their first update()
    std::uint64_t committed_ticks = 0;
    std::uint64_t committed_events = 0;
    std::optional<Error> stop_error;  // set once recording has stopped; all later calls return it
};

Status SessionWriter::State::write_pending() {
    if (!ticks.empty()) {
        BOLT_TRY_ASSIGN(auto data, encoder.encode(committed_ticks, ticks));
        BOLT_TRY(put_chunk(*database, committed_ticks, ticks.size(), data, checksums));
    }
    BOLT_TRY(put_events(*database, committed_events, events, checksums));
    if (timing) {
        BOLT_TRY(put_timing(*database, *timing, checksums));
    }
    return put_changed(*database, joints, checksums);
}

// Commits the pending data, and the result if given. There is no retry after a failure, so the recorded ticks
// have no gap if a full disk gets space again.
Status SessionWriter::State::commit(const lesson::LessonResult* result) {
    const Status done = transaction(*database, [&]() -> Status {
        BOLT_TRY(write_pending());
        if (result != nullptr) {
            BOLT_TRY(put_result(*database, *result, checksums));
        }
        return put_checksums(*database, checksums);
    });
    if (!done) {
        const double kept = static_cast<double>(committed_ticks) * dt;
        stop_error =
            file_error(file, fmt::format("cannot be written: {}; the recording up to {:.3f} s is kept",
                                         done.error().what, kept))
                .value();
        return fail(*stop_error);
    }
    committed_ticks += ticks.size();
    committed_events += events.size();
    ticks.clear();
    events.clear();
    timing.reset();
    return {};
}

// Moves everything from the -wal file into the session file. The journal is in memory because a crash would
// leave an on-disk journal with which only a writer could open the file.
Status SessionWriter::State::merge_wal() {
    const Status moved = database->execute("PRAGMA journal_mode = MEMORY");
    // If a reader has the file open, the session is complete in both files, and readers use both.
    if (moved || database->was_busy()) return {};
    return file_error(file,
                      "the recording is complete, but part of it is in " + file +
                          "-wal, which must stay beside it: " + moved.error().what,
                      "a file system with free space");
}

void SessionWriter::State::update(const lesson::JointResult& result) {
    const auto existing =
        std::ranges::find_if(joints, [&](const JointRow& joint) { return joint.result.id == result.id; });
    if (existing == joints.end()) {
        joints.push_back({result, std::nullopt, true});
    } else {
        existing->result = result;
        existing->changed = true;
    }
}

SessionWriter::SessionWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
SessionWriter::SessionWriter(SessionWriter&& other) noexcept = default;
SessionWriter& SessionWriter::operator=(SessionWriter&& other) noexcept = default;
SessionWriter::~SessionWriter() = default;

Result<SessionWriter> SessionWriter::create(const std::filesystem::path& path, const Header& header) {
    const std::string file = path.string();
    const auto chunk_ticks = ticks_per_commit(header.dt);
    if (!chunk_ticks)
        return file_error(file, fmt::format("a tick of {} s cannot be recorded", header.dt),
                          fmt::format("at most {} ticks in a second", max_chunk_ticks));
    // SQLite puts its -wal file beside the target of a symbolic link; the other files go there too.
    std::error_code status;
    const std::filesystem::path real =
        std::filesystem::weakly_canonical(std::filesystem::absolute(path), status);
    if (status) return file_error(file, "is not a valid path: " + status.message());

    TableChecksums checksums;
    BOLT_TRY_ASSIGN(auto lock, acquire_lock(real, file));
    BOLT_TRY(create_file(real, file, header, checksums));
    BOLT_TRY_ASSIGN(auto database, Database::open(real, file));
    // NORMAL: commits do not wait for the disk. A commit survives the death of the process, and after
    // SQLite's next checkpoint also a power failure. A checkpoint at each megabyte keeps the longest commit
    // short. The update changes no value, but creates the -wal file by which a reader detects a writer.
    BOLT_TRY(
        database.execute("PRAGMA synchronous = NORMAL; PRAGMA wal_autocheckpoint = 256;"
                         "UPDATE meta SET value = value WHERE key = 'state'"));

    auto state = std::make_unique<State>(std::move(lock), std::move(database), file);
    state->dt = header.dt;
    state->chunk_ticks = *chunk_ticks;
    state->checksums = checksums;
    state->ticks.reserve(*chunk_ticks);
    return SessionWriter(std::move(state));
}

Status SessionWriter::append(const TickRecord& tick) {
    State& state = *state_;
    if (state.stop_error) return fail(*state.stop_error);
    if (!is_valid(tick))
        return file_error(state.file, "was given a tick with a value out of range",
                          "enumerations and indices in their ranges");
    state.ticks.push_back(tick);
    // Not `return {}`, which would first fill the space of an Error with zeros, in each tick.
    Status written;
    if (state.ticks.size() >= state.chunk_ticks) written = state.commit(nullptr);
    return written;
}

Status SessionWriter::add(const lesson::LessonEvent& event) {
    if (state_->stop_error) return fail(*state_->stop_error);
    state_->events.push_back(event);
    return {};
}

Status SessionWriter::update(const lesson::JointResult& result) {
    if (state_->stop_error) return fail(*state_->stop_error);
    state_->update(result);
    return {};
}

Status SessionWriter::record_timing(const servo::Timing& timing) {
    if (state_->stop_error) return fail(*state_->stop_error);
    state_->timing = timing;
    return {};
}

Status SessionWriter::synchronise() {
    if (state_->stop_error) return fail(*state_->stop_error);
    BOLT_TRY(state_->commit(nullptr));
    // While another program reads the file, SQLite copies only a part of the log; a later checkpoint copies
    // the rest.
    return state_->database->execute("PRAGMA wal_checkpoint(FULL)");
}

Status SessionWriter::finish(const lesson::LessonResult& result) {
    State& state = *state_;
    if (state.stop_error) return fail(*state.stop_error);
    for (const lesson::JointResult& joint : result.joints) state.update(joint);
    BOLT_TRY(state.commit(&result));
    Status single = state.merge_wal();
    state.database.reset();
    state.lock.reset();
    state.stop_error = single ? file_error(state.file, "is complete; no more ticks can be recorded").value()
                              : single.error();
    return single;
}

}  // namespace bolt::session
