#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "game/record/chunk.hpp"
#include "game/record/database.hpp"
#include "game/record/file_lock.hpp"
#include "game/record/format.hpp"
#include "game/record/new_file.hpp"
#include "game/record/session.hpp"
#include "game/record/tables.hpp"

namespace bolt::record {

struct Writer::State {
    State(FileLock taken, Database opened, std::string name)
        : lock(std::move(taken)), database(std::move(opened)), file(std::move(name)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    // Left without finish(): what was collected is kept, and there is nobody left to tell if it cannot be.
    ~State() {
        if (!refusal) (void)commit(nullptr);
    }

    Status commit(const lesson::LessonResult* result);
    Status put_collected();
    Status leave_single_file();
    void update(const lesson::JointResult& result);

    std::optional<FileLock> lock;  // goes last; neither is there after finish()
    std::optional<Database> database;
    std::string file;
    double dt = 0.0;
    std::size_t chunk_ticks = 0;
    Seals seals;
    ChunkEncoder encoder;
    std::vector<TickRecord> ticks;  // collected and not yet committed, as are the events
    std::vector<lesson::Event> events;
    std::optional<servo::Timing> timing;
    std::vector<JointRow> joints;  // all of them, in the order in which they were first seen
    std::uint64_t committed_ticks = 0;
    std::uint64_t committed_events = 0;
    std::optional<Error> refusal;  // why nothing more is recorded
};

Status Writer::State::put_collected() {
    if (!ticks.empty()) {
        auto data = encoder.encode(committed_ticks, ticks);
        if (!data) return fail(data.error());
        if (auto put = put_chunk(*database, committed_ticks, ticks.size(), *data, seals); !put) return put;
    }
    if (auto put = put_events(*database, committed_events, events, seals); !put) return put;
    if (timing)
        if (auto put = put_timing(*database, *timing, seals); !put) return put;
    return put_changed(*database, joints, seals);
}

// Commits what was collected, and the whole result if there is one. The first failure is the last attempt:
// what the file holds is then known, and a disk that gains some room again leaves no gap in the ticks.
Status Writer::State::commit(const lesson::LessonResult* result) {
    const Status done = transaction(*database, [&]() -> Status {
        if (auto put = put_collected(); !put) return put;
        if (result != nullptr)
            if (auto put = put_result(*database, *result, seals); !put) return put;
        return put_seals(*database, seals);
    });
    if (!done) {
        const double kept = static_cast<double>(committed_ticks) * dt;
        refusal =
            file_error(file, fmt::format("cannot be written: {}, what was recorded up to {:.3f} s is kept",
                                         done.error().what, kept))
                .value();
        return fail(*refusal);
    }
    committed_ticks += ticks.size();
    committed_events += events.size();
    ticks.clear();
    events.clear();
    timing.reset();
    return {};
}

// Moves everything from the -wal file into the session file. The journal in memory keeps SQLite from making
// one on disk for the one page that this changes: dying in that moment would leave a file that only a writer
// could open.
Status Writer::State::leave_single_file() {
    const Status moved = database->execute("PRAGMA journal_mode = MEMORY");
    // Somebody is reading: the session is complete in both files, and readers look at both.
    if (moved || database->was_busy()) return {};
    return file_error(file, "everything is recorded, but some of it is still in " + file +
                                "-wal, which has to stay with it: " + moved.error().what);
}

void Writer::State::update(const lesson::JointResult& result) {
    const auto known =
        std::ranges::find_if(joints, [&](const JointRow& joint) { return joint.result.id == result.id; });
    if (known == joints.end()) {
        joints.push_back({result, std::nullopt, true});
    } else {
        known->result = result;
        known->changed = true;
    }
}

Writer::Writer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Writer::Writer(Writer&& other) noexcept = default;
Writer& Writer::operator=(Writer&& other) noexcept = default;
Writer::~Writer() = default;

Result<Writer> Writer::create(const std::filesystem::path& path, const Header& header) {
    const std::string file = path.string();
    const auto chunk_ticks = ticks_per_commit(header.dt);
    if (!chunk_ticks) return file_error(file, fmt::format("a tick of {} s cannot be recorded", header.dt));
    // SQLite puts its -wal file beside what a link points to; so do we.
    std::error_code status;
    const std::filesystem::path real =
        std::filesystem::weakly_canonical(std::filesystem::absolute(path), status);
    if (status) return file_error(file, "is no place for a file: " + status.message());

    Seals seals;
    auto lock = claim_place(real, file);
    if (!lock) return fail(lock.error());
    if (auto replaced = make_new_file(real, file, header, seals); !replaced) return fail(replaced.error());
    auto database = Database::open(real, file);
    if (!database) return fail(database.error());
    // NORMAL: a commit is safe from the process dying, a checkpoint from the power failing; no wait for the
    // disk between. A checkpoint every megabyte keeps the longest commit short. The update changes nothing,
    // but makes the -wal file by which a reader sees that somebody writes.
    if (auto done = database->execute("PRAGMA synchronous = NORMAL; PRAGMA wal_autocheckpoint = 256;"
                                      "UPDATE meta SET value = value WHERE key = 'state'");
        !done)
        return fail(done.error());

    auto state = std::make_unique<State>(std::move(*lock), std::move(*database), file);
    state->dt = header.dt;
    state->chunk_ticks = *chunk_ticks;
    state->seals = seals;
    state->ticks.reserve(*chunk_ticks);
    return Writer(std::move(state));
}

Status Writer::append(const TickRecord& tick) {
    State& state = *state_;
    if (state.refusal) return fail(*state.refusal);
    if (!is_valid(tick)) return file_error(state.file, "was given a tick with a value that cannot be");
    state.ticks.push_back(tick);
    if (state.ticks.size() < state.chunk_ticks) return {};
    return state.commit(nullptr);
}

Status Writer::add(const lesson::Event& event) {
    if (state_->refusal) return fail(*state_->refusal);
    state_->events.push_back(event);
    return {};
}

Status Writer::update(const lesson::JointResult& result) {
    if (state_->refusal) return fail(*state_->refusal);
    state_->update(result);
    return {};
}

Status Writer::keep(const servo::Timing& timing) {
    if (state_->refusal) return fail(*state_->refusal);
    state_->timing = timing;
    return {};
}

Status Writer::finish(const lesson::LessonResult& result) {
    State& state = *state_;
    if (state.refusal) return fail(*state.refusal);
    for (const lesson::JointResult& joint : result.joints) state.update(joint);
    if (auto done = state.commit(&result); !done) return done;
    Status single = state.leave_single_file();
    state.database.reset();
    state.lock.reset();
    state.refusal =
        single ? file_error(state.file, "is complete, nothing more can be recorded").value() : single.error();
    return single;
}

}  // namespace bolt::record
