// summary.json and the result table of a lesson.
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
// `assembly`: under the law of the lesson (lesson::under_law), as for the table.
std::string summary_json(const content::Assembly& assembly, const CourseOptions& options,
                         const Played& played);

// Joint, torque, clamp force, angle, verdict, in columns for a terminal.
std::string summary_table(const content::Assembly& assembly, const lesson::LessonResult& result);

// Exports a session's ticks as comma-separated values (RFC 4180): a header row with units in the names, then
// one row for each tick.

struct CsvOptions {
    std::uint64_t every_n = 1;                     // one row every n ticks, starting with the first
    std::string out_name = "the standard output";  // name of `out` in errors
};

// Writes everything to `out` and flushes it; the caller closes it. Numbers are the shortest that read back as
// the same single-precision value. A caller whose `out` may be a pipe ignores SIGPIPE to get the error
// instead of the signal.
Status export_csv(const Reader& session, std::FILE* out, const CsvOptions& options = {});

}  // namespace bolt::session
