// The options of boltwright train, and the devices and the lesson that they select.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/trainees/trainee.hpp"
#include "game/trainer/equipment.hpp"

namespace CLI {
class App;
}
namespace bolt::trainer {
struct StudyRun;
}

namespace bolt::cli {

struct TrainArguments {
    std::string assembly = "zq350";
    std::string variant, tool;
    std::string mode = "guided";
    std::string task = "tighten";
    std::string law;
    std::vector<std::string> devices;
    std::string hand = "helped";
    std::string glove;  // empty: the station file's, or none
    std::string station_file, wheel_config_file;
    // The word after --hmd: "required" (or nothing), "optional", or the assembly; none: no headset is used.
    std::optional<std::string> hmd;
    std::string mirror = "left";   // one of view::mirror_names
    std::string displays;          // display file of projection walls; empty: there are none
    bool full_resolution = false;  // of headset and window, also if the GPU is too slow for it
    bool headless = false;         // no window: a simulated trainee performs the lesson
    // `start`: without the menu. `validate`: under Vulkan's validation layers, where any message is an error.
    // `silent`: without sound.
    bool start = false, full_screen = false, validate = false, silent = false;
    std::string trainee, language, settings;  // settings: a file to use instead of the trainee's
    std::string size = "1280x720", gpu;       // WIDTHxHEIGHT of the window; part of the name of the GPU
    // `quiet`: prints no progress. `no_pictures`: draws no pictures of the result. `no_guide`: a guided
    // lesson has no guiding force. `view_help`: a simulated trainee requests views of the nut.
    bool quiet = false, no_pictures = false, no_guide = false, view_help = false;
    // `obstacles`: fails if the assembly has no contact models. `no_obstacles`: simulates no contacts.
    // Neither: simulates them if there are models.
    bool obstacles = false, no_obstacles = false;
    std::string trainee_profile = "expert";  // of a simulated trainee
    std::uint64_t seed = 1;
    std::string out = "out";
    bool folder_per_lesson = false;  // each lesson of a window gets a folder of its own in `out`
    bool first_start = false;        // the menu offers the tour first
};

void add_train_options(CLI::App& train, TrainArguments& options);

// The options of a window and its devices, without those of a lesson, which the plan of a study has.
void add_study_options(CLI::App& run, TrainArguments& options);

// Leads a participant through a study in a window (train.cpp).
Status run_study(const TrainArguments& options, trainer::StudyRun study);

enum class HeadsetUse : std::uint8_t {
    none,
    optional,  // used when there is one
    required,  // without one the program does not start
};
// If the word after --hmd is the assembly, stores it in `options`. Fails with ErrorCode::usage for a wrong
// value.
Result<HeadsetUse> headset_use(TrainArguments& options);

// The devices that the options select. A missing device is an error; there is no silent fallback.
Result<trainer::Equipment> equipment_of(const TrainArguments& options);

// The lesson and the simulated trainee that the options select.
Result<trainees::TrainOptions> train_options(const TrainArguments& options,
                                             const content::Assembly& assembly);

}  // namespace bolt::cli
