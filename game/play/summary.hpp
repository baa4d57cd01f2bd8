// summary.json and the closing table of a lesson.
#pragma once

#include <string>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"
#include "game/play/course.hpp"

namespace bolt::play {

// {assembly, variant, law, mode, task, guide, obstacles, operator, seed, duration_s, score, finished,
//  joints: [{id, torque_Nm, angle_deg, clamp_N, verdict}]}
std::string summary_json(const content::Assembly& assembly, const CourseOptions& options,
                         const Played& played);

// Joint, torque, clamp force, angle, verdict, in columns for a terminal.
std::string summary_table(const content::Assembly& assembly, const lesson::LessonResult& result);

}  // namespace bolt::play
