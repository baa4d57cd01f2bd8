#include "game/session/resume.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::session {

namespace {

constexpr const char* expected_recording =
    "the recording of an interrupted lesson, with the program and the content that recorded it";

Error resume_error(const std::filesystem::path& file, std::string what) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = file.string();
    error.what = std::move(what);
    error.expected = expected_recording;
    return error;
}

// Calls `step(input, recorded)` for each tick of the lesson until one fails.
template <class Step>
Status for_each_tick(const InterruptedLesson& interrupted, Step step) {
    BOLT_TRY_ASSIGN(const auto reader, SessionReader::open(interrupted.file));
    if (reader.tick_count() < interrupted.ticks)
        return fail(resume_error(interrupted.file, fmt::format("has {} ticks, and had {}",
                                                               reader.tick_count(), interrupted.ticks)));
    std::uint64_t tick = 0;
    Status done;
    BOLT_TRY(reader.for_each_chunk([&](std::uint64_t, std::span<const TickRecord> chunk) {
        for (const TickRecord& recorded : chunk)
            if (done && tick++ < interrupted.ticks) done = step(input_of(recorded), recorded);
    }));
    return done;
}

Status check_output(const InterruptedLesson& interrupted, const SessionSetup& now,
                    const servo::TickInput& input, const servo::Output& output, const TickRecord& recorded) {
    if (same_output(make_record(input, output), recorded)) return {};
    return fail(
        resume_error(interrupted.file,
                     fmt::format("at {:.3f} s this program computes another result than the recorded one",
                                 static_cast<double>(now.state.tick) * now.setup.dt)));
}

void remove_session(const std::filesystem::path& file) {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm", ".lock"})
        std::filesystem::remove(file.string() + suffix, ignored);
}

}  // namespace

Result<InterruptedLesson> read_interrupted(const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(const auto reader, SessionReader::open(file));
    if (reader.complete()) {
        BOLT_TRY_ASSIGN(const auto result, reader.result());
        if (result.finished) return fail(resume_error(file, "the lesson was finished"));
    }
    std::uint64_t ticks = 0, free = 0;  // `free`: up to the last tick in which no nut was held
    BOLT_TRY(reader.for_each_chunk([&](std::uint64_t, std::span<const TickRecord> chunk) {
        for (const TickRecord& recorded : chunk) {
            ++ticks;
            if (recorded.joint < 0) free = ticks;
        }
    }));
    const bool judged_at_release = reader.header().mode == lesson::Mode::assessment;
    return InterruptedLesson{file, reader.header(), judged_at_release ? free : ticks};
}

Status check_same_lesson(const InterruptedLesson& interrupted, const SessionSetup& start,
                         const LessonOptions& options) {
    HeaderTexts recorded = texts_of(interrupted.header), wanted = texts_of(make_header(start, options));
    for (HeaderTexts* texts : {&recorded, &wanted})
        for (const char* other : {key::program, key::assembly_file, key::continued_after})
            texts->erase(other);
    for (HeaderTexts* texts : {&recorded, &wanted})
        for (const auto& [key, text] : *texts)
            if (recorded[key] != wanted[key])
                return fail(resume_error(interrupted.file, fmt::format("\"{}\" was {}, and is {} now", key,
                                                                       recorded[key], wanted[key])));
    return {};
}

Status repeat_ticks(const InterruptedLesson& interrupted, SessionSetup& start) {
    return for_each_tick(interrupted, [&](const servo::TickInput& input, const TickRecord& recorded) {
        servo::change_tool(start.setup, start.state, input);
        const servo::Output output = servo::tick(start.setup, start.state, input);
        return check_output(interrupted, start, input, output, recorded);
    });
}

Result<std::unique_ptr<LessonSession>> LessonSession::resume(SessionSetup start, const LessonOptions& options,
                                                             const std::filesystem::path& file,
                                                             const world::WriteHaptics& world) {
    const InterruptedLesson& interrupted = options.continues.value();
    BOLT_TRY(check_same_lesson(interrupted, start, options));
    BOLT_TRY_ASSIGN(auto session, begin(std::move(start), options, file));
    Status repeated =
        for_each_tick(interrupted, [&](const servo::TickInput& input, const TickRecord& recorded) -> Status {
            BOLT_TRY_ASSIGN(const auto output, session->compute_tick(world, input, {}));
            return check_output(interrupted, session->session_setup_, input, output, recorded);
        });
    if (repeated) repeated = session->writer_->synchronise();
    session->events_.clear();
    if (repeated) return session;
    session.reset();
    remove_session(file);
    return fail(repeated.error());
}

}  // namespace bolt::session
