// summary.json and the result table of a lesson.
#pragma once

#include <string>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"
#include "game/session/lesson_session.hpp"

namespace bolt::session {

// {assembly, variant, tool, law, mode, task, guide, obstacles, operator, trainee, seed, duration_s, score,
//  finished, joints: [{id, torque_Nm, target_torque_Nm, angle_deg, clamp_N, verdict}]}
// `assembly`: under the law of the lesson (lesson::under_law), as for the table.
std::string summary_json(const content::Assembly& assembly, const CourseOptions& options,
                         const Played& played);

// Joint, torque, clamp force, angle, verdict, in columns for a terminal.
std::string summary_table(const content::Assembly& assembly, const lesson::LessonResult& result);

}  // namespace bolt::session
