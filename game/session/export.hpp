// Exports of a lesson: summary.json, the result table, and the ticks of a session as CSV.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "game/lesson/result.hpp"
#include "game/session/lesson_session.hpp"
#include "game/session/session_file.hpp"

namespace bolt::session {

// {assembly, variant, tool, law, mode, task, guide, obstacles, operator, trainee, seed, duration_s, score,
//  finished, joints: [{id, torque_Nm, target_torque_Nm, angle_deg, clamp_N, verdict}]}
// `assembly`: with the lesson's law applied (lesson::apply_law), as for the table.
std::string summary_json(const content::Assembly& assembly, const LessonOptions& options,
                         const LessonOutcome& outcome);

// Columns for a terminal: joint, size, torque, clamp force, target torque, angle, verdict.
std::string summary_table(const content::Assembly& assembly, const lesson::LessonResult& result);

struct CsvOptions {
    std::uint64_t every_n = 1;                     // one row every n ticks, starting with the first
    std::string out_name = "the standard output";  // name of `out` in errors
};

// Writes a session's ticks to `out` as comma-separated values (RFC 4180) and flushes it; the caller closes
// it. A header row with units in the names comes first, then one row for each exported tick. Times have six
// decimals; other numbers are the shortest that read back as the same single-precision value. If `out` may be
// a pipe, ignore SIGPIPE to get the error instead of the signal.
Status export_csv(const SessionReader& session, std::FILE* out, const CsvOptions& options = {});

}  // namespace bolt::session
