// Starts a lesson from the user's choice: loads the assembly, starts the station, loads the models and begins
// the session.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/trainee/settings.hpp"
#include "game/scene/workplace.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/station_client.hpp"

namespace bolt::trainer {

// The user's choice in the menu or on the command line.
struct LessonChoice {
    std::string assembly = "zq350";
    std::string variant;  // empty: the assembly's default
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    std::string trainee;   // empty: no name
    std::string language;  // empty: the desktop's, if its texts exist
    std::string tool;      // empty: the assembly's first
    Equipment equipment;
    std::optional<joint::Law> law;  // from the command line; a choice in the menu resets it
};

// The tool of the station's arm among those of an assembly, as LessonChoice::tool: empty if it is the first
// or the station has none. Fails if the assembly does not have it.
Result<std::string> tool_of_station(const content::StationFile& station,
                                    std::span<const content::Tool> tools);

// The law of a lesson: the command line's, else the trainee's, else the assembly's.
joint::Law effective_law(const LessonChoice& choice, const content::TraineeSettings& settings,
                         joint::Law assembly_law);

// trainer::start_station; tests replace it.
using StartStation = std::function<Result<std::unique_ptr<station_setup::LessonStation>>(
    const content::Assembly&, const session::LessonOptions&, const Equipment&, const std::string& trainee,
    const device::ArmDialog&)>;

struct LessonStart {
    LessonChoice choice;
    content::TraineeSettings settings;
    session::LessonOptions options;  // those that neither choice nor settings determine
    std::filesystem::path folder;    // receives session.boltwright
    StartStation start_station;
    device::ArmDialog arm_dialog{};
};

// The data that a lesson was started with. It outlives the lesson, because the result screen shows it.
struct LessonContext {
    LessonChoice choice;
    content::Assembly assembly;  // with the targets of the effective law, as the lesson uses it
    session::LessonOptions options;
    scene::LessonModels models;
    scene::Worker worker;
};

struct StartedLesson {
    LessonContext context;
    ActiveLesson active;  // with session and station; its workplace is made when the models are on the GPU
};

// Creates the folder of the next session: `out` itself, or with `folder_per_lesson` a folder in it that is
// named after the time and the assembly, such as "2026-11-25_15-40-12_zq350".
Result<std::filesystem::path> make_lesson_folder(const std::filesystem::path& out, bool folder_per_lesson,
                                                 const std::string& assembly);

// Fails if the assembly cannot be loaded, a chosen device cannot be used, a model is damaged, or the session
// file cannot be created. Close the station of an earlier lesson before, because it holds the devices.
Result<StartedLesson> start_lesson(const LessonStart& start);

// Places the hand, the wrench and the first view, once the workplace of `active` exists. `aspect`: width /
// height of the picture.
void place_trainee(ActiveLesson& active, const LessonContext& context, float aspect);

// Prepares the cues of the lesson's sounds and, if `audible`, opens the sound output. Fails if there is no
// output; the lesson then runs without sound.
Status start_sound(ActiveLesson& active, bool audible);

}  // namespace bolt::trainer
