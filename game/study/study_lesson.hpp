// Loads the assemblies of a study's lessons, converts their settings to session::LessonOptions, and checks a
// study beyond its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/studies/study.hpp"
#include "engine/base/result.hpp"
#include "game/session/lesson_session.hpp"
#include "game/study/progress.hpp"

namespace bolt::study {

// The assembly of the lesson: its path in the study's folder if it exists there, otherwise the text of the
// plan, a name or a path as on the command line.
std::string assembly_of(const content::StudyLesson& lesson, const std::filesystem::path& study_folder);

// The options that a session records, without the trainee. `assembly_law`: of the assembly.
session::LessonOptions lesson_options(const content::StudyLesson& lesson, joint::Law assembly_law);

// The assembly of a lesson with its variant, tool and law.
Result<content::Assembly> load_lesson_assembly(const content::StudyLesson& lesson,
                                               const std::filesystem::path& study_folder);

// The same seed for the same lesson of a participant on every machine.
std::uint64_t lesson_seed(const content::Study& study, std::size_t place, std::string_view step);

// Problems of a study whose files are valid.
struct StudyCheck {
    std::vector<Error> errors;            // assemblies, variants, tools and devices that do not exist
    std::vector<std::string> additions;   // texts that the laboratory has to add before the first person
    std::vector<std::string> weaknesses;  // the design can be run, but not as well as it could be
};
// Each function fails if this computer lacks what a lesson needs. An empty function: it is not checked.
struct EquipmentCheck {
    std::function<Status(const std::vector<std::string>& ids)> devices;  // that are used together
    std::function<Status()> headset;
    std::function<Status(const std::string& display_file)> walls;
    std::function<Status(const std::string& port)> glove;  // "auto", or a serial port
};
StudyCheck check_study(const content::Study& study, const std::filesystem::path& folder,
                       const EquipmentCheck& equipment = {});

// The errors of the equipment that all lessons of the study need, each with its place in the plan.
std::vector<Error> check_equipment(const content::Study& study, const std::filesystem::path& folder,
                                   const EquipmentCheck& equipment);
// The same for the lessons of these steps of a participant.
std::vector<Error> check_equipment(const content::Study& study, const std::filesystem::path& folder,
                                   std::span<const Step> steps, const EquipmentCheck& equipment);

// The display file of a lesson on walls: in the study's folder if it exists there.
std::string display_file_of(const content::StudyLesson& lesson, const std::filesystem::path& study_folder);

}  // namespace bolt::study
