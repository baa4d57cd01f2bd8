// The subcommands of boltwright, and what they share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "content/studies/study.hpp"
#include "content/trainee/people.hpp"
#include "engine/base/result.hpp"
#include "game/study/study_lesson.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/device/device_thread.hpp"
#include "haptics/device/preparation.hpp"

namespace CLI {
class App;
}
namespace bolt::station_setup {
struct StationRequest;
}

namespace bolt::cli {

// Each of these adds its subcommand to the command line; when the subcommand runs, it sets `exit_code`.
void add_train(CLI::App& app, int& exit_code);
void add_open(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_measure(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_glove(CLI::App& app, int& exit_code);
void add_devices(CLI::App& app, int& exit_code);
void add_station(CLI::App& app, int& exit_code);
void add_displays(CLI::App& app, int& exit_code);
void add_study(CLI::App& app, int& exit_code);
void add_trainees(CLI::App& app, int& exit_code);

// The treatment of an unknown name: `added` gives it a code, `unchanged` leaves it without one.
enum class NewPerson : std::uint8_t { unchanged, added };
// The person that --trainee names. Renames the person's calibrations in the folder `gloves` if older programs
// named them without the code. Prints what the user should know to stderr. Fails if a name cannot be added.
Result<content::Person> person_argument(const std::string& typed, const std::filesystem::path& gloves,
                                        NewPerson new_person);

// Adds the subcommand `register` to `station`.
void add_station_register(CLI::App& station, int& exit_code);

// Adds the subcommand `run` to `study`.
void add_study_run(CLI::App& study, int& exit_code);
// Loads the study of a folder. If its files have several mistakes, prints all but the last one and returns
// that one.
Result<content::Study> load_study_folder(const std::filesystem::path& folder);
// Checks that this computer has the devices and displays that lessons of a study need (study_equipment.cpp).
study::EquipmentCheck equipment_check();

// Adds the subcommand `test` to `displays`.
void add_displays_test(CLI::App& displays, int& exit_code);

// The trial of a station, for `doctor` and `station try`.
struct TrialOptions {
    std::string assembly = "zq350";  // that the servo simulates
    std::vector<std::string> devices;
    // `glove`: serial port, `trainee`: its wearer, `calibrations`: their folder, empty: the default one.
    std::string station_file, wheel_config_file, glove, trainee, calibrations;
    double seconds = 5.0;  // duration of the trial
    bool yes = false;      // answers yes to the questions before an arm moves or pushes

    [[nodiscard]] bool any() const { return !devices.empty() || !glove.empty() || !station_file.empty(); }
};

// Examines the devices, runs the trial, and prints messages and reports. Returns the exit code: 0 if the
// station is fit for training, 1 if it is not, or the code of the error that prevented the trial.
int try_station(const TrialOptions& options);

// True if a person sees the standard error output and can answer.
bool has_terminal();

// Asks `question`, which ends with a question mark, and waits for the answer. `yes` (the option --yes)
// answers with yes without waiting. False without a terminal and without --yes.
bool ask(std::string_view question, bool yes);

// Prompts on the terminal for what an arm needs before it can be opened; `yes` permits the arm to move.
// Without a terminal, opening an arm that needs a person, for example to put its handle into the inkwell,
// fails at once.
device::ArmDialog terminal_dialog(bool yes);

// Opens the menu in a window; the desktop entry runs this. Each lesson gets a folder in
// user_data_folder()/sessions.
Status train_from_desktop();

// Prints the error. Without a terminal it also shows it in a window, if the desktop has a program for that
// (zenity, kdialog or xmessage). Returns the exit code.
int report_error(const Error& error);

// From now on SIGINT (Ctrl+C) and SIGTERM only set the flag that interrupted() returns, so that a recording
// command can complete its session file.
void catch_interruption();

// True if the program was requested to end.
[[nodiscard]] bool interrupted();

// A device that a command has opened.
struct OpenDevice {
    device::DeviceThread thread;
    std::shared_ptr<const device::Description> description;
};

// Opens a device, and asks on the terminal for what an arm needs. `yes`: the arm may move by itself, without
// a question.
Result<OpenDevice> open_device(const std::string& id, device::OpenOptions opening, bool yes);

// Opens each device of the request, examines its samples for `seconds`, and prints a report; asks before an
// arm pushes the hand. `yes`: answers all questions with yes. Fails if a device cannot be used.
Status check_devices(const station_setup::StationRequest& request, double seconds, bool yes);

// One line for boltwright doctor: the number of USB devices, of those that cannot be used, and of serial
// ports.
std::string devices_line();

}  // namespace bolt::cli
