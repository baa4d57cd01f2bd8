// The user's choice of a lesson, and what follows from it.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "content/format/assembly.hpp"
#include "content/station/station_file.hpp"
#include "content/trainee/identity.hpp"
#include "content/trainee/settings.hpp"
#include "game/lesson/lesson.hpp"
#include "game/trainer/equipment.hpp"

namespace bolt::trainer {

// The user's choice in the menu or on the command line.
struct LessonChoice {
    std::string assembly = "zq350";  // name, folder or file
    std::string variant;             // empty: the assembly's default
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    // In the menu a typed name or code; in a LessonRequest the person's code. Empty: no name.
    std::string trainee;
    std::string language;  // empty: the desktop's, if its texts exist
    std::string tool;      // empty: the assembly's first
    Equipment equipment;
    std::optional<joint::Law> law;  // from the command line; a choice in the menu resets it
};

// The text in the menu's name field, and the person that it identifies.
struct SelectedTrainee {
    std::string text;  // LessonChoice::trainee when the person was identified
    content::IdentifiedPerson identified;
};

// Returns the name of the tool that the station file names for its arm; empty if it names none, or the
// assembly's first. Fails if the tool is not among `tools`, those of an assembly.
Result<std::string> tool_of_station(const content::StationFile& station,
                                    std::span<const content::Tool> tools);

// The law of a lesson: the command line's, else the trainee's, else the assembly's.
joint::Law effective_law(const LessonChoice& choice, const content::TraineeSettings& settings,
                         joint::Law assembly_law);

}  // namespace bolt::trainer
