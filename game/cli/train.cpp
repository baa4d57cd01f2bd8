// boltwright train: runs a lesson in a window, or headless with a simulated trainee, and writes its session,
// summary, report and pictures.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <memory>

#include "content/format/assembly.hpp"
#include "content/station/station_file.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/lesson/lesson.hpp"
#include "game/report/report.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/export.hpp"
#include "game/station/station_setup.hpp"
#include "game/trainees/trainee.hpp"
#include "game/trainer/app.hpp"
#include "game/view/camera.hpp"
#include "game/view/pictures.hpp"
#include "game/view/window.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::cli {

namespace {

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
    bool hmd = false;
    bool headless = false;
    bool start = false, full_screen = false, validate = false, silent = false;
    std::string trainee, language, settings;
    std::string size = "1280x720", gpu;
    bool quiet = false, no_pictures = false, no_guide = false, view_help = false;
    bool obstacles = false, no_obstacles = false;
    std::string trainee_profile = "expert";  // of a simulated trainee
    std::uint64_t seed = 1;
    std::string out = "out";
    bool folder_per_lesson = false;  // each lesson of a window gets a folder of its own in `out`
    bool first_start = false;        // the menu offers the tour first
};

// Prints the progress to stderr: one line that is overwritten on a terminal, otherwise one line a pass.
class TrainingProgressLine {
  public:
    explicit TrainingProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

    // Returns false if the program was requested to end.
    bool show(const content::Assembly& assembly, const trainees::TrainingProgress& progress) {
        if (quiet_) return !interrupted();
        if (progress.event != nullptr) add_event(assembly, progress);
        if (terminal_)
            (void)std::fputs(fmt::format("\r\033[K{:6.1f} s  step {:>3} of {}  {}", progress.time,
                                         progress.step, progress.steps, activity_)
                                 .c_str(),
                             stderr);
        return !interrupted();
    }
    void end() const {
        if (!quiet_ && terminal_) (void)std::fputs("\r\033[K", stderr);
    }

  private:
    void add_event(const content::Assembly& assembly, const trainees::TrainingProgress& progress) {
        const lesson::LessonEvent& event = *progress.event;
        if (event.kind == lesson::EventKind::pass_begin) {
            pass_ = event.text;
            activity_ = pass_;
            if (!terminal_) print_line(fmt::format("{:6.1f} s  {}", progress.time, pass_));
        } else if (event.kind == lesson::EventKind::step_begin) {
            activity_ = fmt::format("{}: {}", pass_,
                                    assembly.joints[static_cast<std::size_t>(event.joint)].design.id);
        } else if (event.kind == lesson::EventKind::mistake) {
            print_line(fmt::format("{:6.1f} s  {}", progress.time, event.text));
        }
    }
    void print_line(const std::string& text) const {
        (void)std::fputs(fmt::format("{}{}\n", terminal_ ? "\r\033[K" : "", text).c_str(), stderr);
    }

    bool quiet_;
    bool terminal_;
    std::string pass_, activity_;
};

bool is_keyword(const std::string& device) {
    return device == "auto" || device == "mouse" || device == "simulated" || device == "simulated-arm";
}

// Takes a station file over into the equipment; devices that the command line names have precedence.
Status add_station_file(const TrainArguments& options, trainer::Equipment& equipment) {
    BOLT_TRY_ASSIGN(const auto station, content::load_station(options.station_file));
    const bool keyword = !options.devices.empty() && is_keyword(options.devices.front());
    if (keyword && options.devices.front() != "auto")
        return fail(ErrorCode::usage,
                    fmt::format("--device {}: the station file names the devices", options.devices.front()),
                    "--station without --device, or with the id of one of its devices");
    BOLT_TRY(station_setup::add_devices_of(station, device::list_devices(true), equipment.devices));
    equipment.station = station;
    equipment.glove = station.glove_port;
    return {};
}

// The devices of the options. A missing device is an error; there is no silent fallback.
Result<trainer::Equipment> equipment_of(const TrainArguments& options) {
    if (options.hmd) return fail(ErrorCode::no_device, "this build has no headset output", "no --hmd");
    trainer::Equipment equipment;
    const bool station = !options.station_file.empty();
    const std::string first = options.devices.empty() ? "auto" : options.devices.front();
    if (options.devices.size() > 1 && std::any_of(options.devices.begin(), options.devices.end(), is_keyword))
        return fail(
            ErrorCode::usage,
            "--device: auto, mouse, simulated and simulated-arm cannot be combined with other devices",
            "only ids of devices");
    if (first == "auto" && !station)
        equipment = options.headless ? trainer::Equipment{} : trainer::default_equipment();
    else if (first == "simulated")
        equipment.hand = trainer::HandMode::keyboard;
    else if (first == "simulated-arm")
        equipment.hand = trainer::HandMode::simulated_arm;
    else if (first != "mouse" && first != "auto")
        equipment.devices = options.devices;
    if (station) BOLT_TRY(add_station_file(options, equipment));
    if (options.hand == "free") {
        const bool mouse = first == "mouse" || (first == "auto" && equipment.devices.empty());
        if (!mouse)
            return fail(ErrorCode::usage, "--hand free: a device moves the hand", "--device mouse with it");
        equipment.hand = trainer::HandMode::free;
    }
    equipment.wheel_config_file = options.wheel_config_file;
    if (options.glove == "auto") {
        const auto ports = hand::serial_ports();
        if (!ports.empty()) equipment.glove = ports.front();
    } else if (!options.glove.empty()) {
        equipment.glove = options.glove == "none" ? std::string() : options.glove;
    }
    // Checked before a window opens.
    const auto chosen = station_setup::select_devices(device::list_devices(true), equipment.devices);
    if (!chosen) return fail(chosen.error());
    if (!equipment.glove.empty())
        if (Status access = hand::check_port_access(equipment.glove); !access) return fail(access.error());
    return equipment;
}

Result<trainees::TrainOptions> train_options(const TrainArguments& options,
                                             const content::Assembly& assembly) {
    trainees::TrainOptions train;
    train.lesson.mode = options.mode == "guided"     ? lesson::Mode::guided
                        : options.mode == "practice" ? lesson::Mode::practice
                                                     : lesson::Mode::assessment;
    train.lesson.task = options.task == "loosen" ? lesson::Task::loosen : lesson::Task::tighten;
    train.lesson.law = options.law.empty()          ? assembly.law
                       : options.law == "published" ? joint::Law::published
                                                    : joint::Law::mechanistic;
    train.lesson.seed = options.seed;
    train.lesson.obstacles = options.no_obstacles ? session::Obstacles::none
                             : options.obstacles  ? session::Obstacles::required
                                                  : session::Obstacles::if_any;
    train.lesson.guide = !options.no_guide;
    if (options.view_help) train.view_help = view::view_help();
    Result<trainees::TraineeProfile> trainee = trainees::find_profile(options.trainee_profile);
    if (!trainee) return fail(trainee.error());
    train.trainee = *trainee;
    train.lesson.trainee_profile = train.trainee.name;
    train.lesson.trainee = options.trainee;
    return train;
}

Status write_report(const std::filesystem::path& session, const std::filesystem::path& page) {
    Result<session::SessionReader> reader = session::SessionReader::open(session);
    if (!reader) return fail(reader.error());
    const session::SessionReader* sessions[] = {&*reader};
    Result<std::string> html = report::make_report(sessions);
    if (!html) return fail(html.error());
    return write_file(page, *html);
}

// Writes the summary, the report and on request the pictures beside the session, and prints the results.
Status write_results(const content::Assembly& assembly, const session::LessonOptions& options,
                     const session::LessonOutcome& outcome, const std::filesystem::path& out, bool pictures) {
    if (Status written = write_file(out / "summary.json", session::summary_json(assembly, options, outcome));
        !written)
        return written;
    const std::filesystem::path session = out / "session.boltwright";
    if (Status written = write_report(session, out / "report.html"); !written) return written;
    std::string closing = session::summary_table(assembly, outcome.result);
    closing += fmt::format("{}, {}, {}\n", session.string(), (out / "summary.json").string(),
                           (out / "report.html").string());
    if (Status printed = print(closing); !printed) return printed;
    // A failure to draw does not affect the recording.
    if (pictures && !interrupted())
        if (Status drawn = view::draw_result(assembly, outcome.result, out, {1280, 720}); !drawn)
            (void)print_error(drawn.error());
    return {};
}

Status make_folder(const std::filesystem::path& out) {
    std::error_code problem;
    std::filesystem::create_directories(out, problem);
    if (problem) {
        Error error;
        error.file = out.string();
        error.what = "this folder cannot be created: " + problem.message();
        return fail(error);
    }
    return {};
}

// Removes the report and the summary of an earlier lesson, which would describe another session.
void remove_stale_files(const std::filesystem::path& out) {
    std::error_code ignored;
    for (const char* stale : {"summary.json", "report.html"}) std::filesystem::remove(out / stale, ignored);
}

int run_headless(const TrainArguments& options, const content::Assembly& assembly,
                 const trainees::TrainOptions& train) {
    const std::filesystem::path out(options.out);
    if (Status made = make_folder(out); !made) return print_error(made.error());
    if (!options.quiet)
        (void)std::fputs(
            fmt::format("{} ({}), law {}, {}, trainee {}, seed {}\n", assembly.name, assembly.variant,
                        joint::name(train.lesson.law), options.mode, options.trainee_profile, options.seed)
                .c_str(),
            stderr);
    remove_stale_files(out);
    catch_interruption();
    TrainingProgressLine line(options.quiet);
    const Result<session::LessonOutcome> outcome = trainees::train(
        assembly, train, out / "session.boltwright",
        [&](const trainees::TrainingProgress& progress) { return line.show(assembly, progress); });
    line.end();
    if (!outcome) return print_error(outcome.error());
    if (!options.quiet && !outcome->obstacles && !options.no_obstacles)
        if (const auto missing = session::missing_contact_model(assembly))
            (void)std::fputs(
                fmt::format("The wrench passes through everything: {}\n", missing->message()).c_str(),
                stderr);
    if (Status written = write_results(assembly, train.lesson, *outcome, out, !options.no_pictures); !written)
        return print_error(written.error());
    return interrupted() || !outcome->result.finished ? static_cast<int>(ErrorCode::failed) : 0;
}

Status run_window(const TrainArguments& options, const trainees::TrainOptions& train,
                  const trainer::Equipment& equipment, platform::Desktop& desktop) {
    const std::filesystem::path out(options.out);
    if (Status made = make_folder(out); !made) return made;
    trainer::AppOptions app_options;
    app_options.choice = {options.assembly, options.variant,  train.lesson.mode, train.lesson.task,
                          options.trainee,  options.language, options.tool,      equipment};
    app_options.sound = !options.silent;
    app_options.menu = !options.start;
    app_options.lesson = train.lesson;
    app_options.lesson.trainee_profile = "person";
    if (!options.law.empty()) app_options.choice.law = train.lesson.law;
    app_options.out = out;
    app_options.folder_per_lesson = options.folder_per_lesson;
    app_options.first_start = options.first_start;
    app_options.settings_file = options.settings;
    // Without a home folder no settings are kept.
    if (const auto data = user_data_folder()) app_options.settings_folder = *data / "settings";
    app_options.on_start = remove_stale_files;
    app_options.on_end = [](const content::Assembly& assembly, const session::LessonOptions& lesson,
                            const session::LessonOutcome& outcome, const std::filesystem::path& folder) {
        return write_results(assembly, lesson, outcome, folder, false);
    };
    if (!options.quiet)
        app_options.log = [](const std::string& line) { (void)std::fprintf(stderr, "%s\n", line.c_str()); };
    const auto extensions = desktop.vulkan_extensions();
    if (!extensions) return fail(extensions.error());
    const Result<VkExtent2D> size = view::parse_size(options.size);
    if (!size) return fail(size.error());
    Result<platform::Window> window =
        platform::Window::open(desktop, {"Boltwright", size->width, size->height, options.full_screen});
    if (!window) return fail(window.error());
    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    instance_options.extensions = *extensions;
    const Result<gpu::Instance> instance = gpu::Instance::create(instance_options);
    if (!instance) return fail(instance.error());
    trainer::App app(std::move(app_options));
    catch_interruption();
    const view::WindowChoice window_choice{options.gpu, [] { return interrupted(); }};
    if (Status run = view::run_in_window(app, *window, *instance, window_choice); !run) return run;
    if (!instance->log().messages.empty()) return fail(ErrorCode::failed, instance->log().messages.front());
    return {};
}

int run_train(const TrainArguments& options) {
    const Result<trainer::Equipment> equipment = equipment_of(options);
    if (!equipment) return print_error(equipment.error());
    const bool free_hand = equipment->hand == trainer::HandMode::free;
    const bool devices =
        !equipment->devices.empty() || !equipment->glove.empty() || !options.station_file.empty();
    if (options.headless && (devices || free_hand)) {
        Error error;
        error.code = ErrorCode::usage;
        error.what = "a simulated trainee does not use devices or the mouse";
        error.expected = "--headless without --device ID, --station FILE, --hand free and --glove PORT";
        return print_error(error);
    }

    content::LoadedAssembly loaded = content::load_assembly(options.assembly, options.variant);
    if (!loaded.ok()) return print_error(loaded.errors);
    const Result<std::string> tool = options.tool.empty()
                                         ? trainer::tool_of_station(equipment->station, loaded.assembly.tools)
                                         : options.tool;
    if (!tool) return print_error(tool.error());
    if (Status chosen = content::choose_tool(loaded.assembly, *tool); !chosen)
        return print_error(chosen.error());
    Result<trainees::TrainOptions> train = train_options(options, loaded.assembly);
    if (!train) return print_error(train.error());
    loaded.assembly = lesson::apply_law(std::move(loaded.assembly), train->lesson.law);
    if (options.headless) return run_headless(options, loaded.assembly, *train);
    Result<platform::Desktop> desktop = platform::Desktop::open();
    if (!desktop) {
        if (!options.quiet)
            (void)std::fputs((desktop.error().what + ": a simulated trainee plays.\n").c_str(), stderr);
        return run_headless(options, loaded.assembly, *train);
    }
    // A folder here is not the assembly of the same name in the menu.
    TrainArguments named = options;
    named.tool = *tool;
    std::error_code ignored;
    if (std::filesystem::exists(options.assembly, ignored))
        named.assembly = std::filesystem::absolute(options.assembly).lexically_normal().string();
    const Status done = run_window(named, *train, *equipment, *desktop);
    return done ? 0 : print_error(done.error());
}

}  // namespace

Status train_from_desktop() {
    TrainArguments options;
    BOLT_TRY_ASSIGN(const auto data, user_data_folder());
    options.out = (data / "sessions").string();
    options.folder_per_lesson = true;
    options.first_start = !std::filesystem::exists(options.out);
    BOLT_TRY_ASSIGN(const auto equipment, equipment_of(options));
    const content::LoadedAssembly loaded = content::load_assembly(content::assembly_folder(options.assembly));
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY_ASSIGN(const auto train, train_options(options, loaded.assembly));
    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    return run_window(options, train, equipment, desktop);
}

namespace {

// CLI11 itself would accept "-1" and convert it to the largest unsigned number.
const CLI::Validator whole_number(
    [](const std::string& text) {
        std::uint64_t value = 0;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = problem == std::errc{} && end == text.data() + text.size();
        return whole ? std::string()
                     : "a whole number from 0 to 18446744073709551615 is expected, not " + text;
    },
    "WHOLE NUMBER");

}  // namespace

void add_train(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<TrainArguments>();
    CLI::App* train = app.add_subcommand(
        "train", "Run a lesson in a window; without a display a simulated trainee performs it");
    train->add_option("assembly", options->assembly, "Assembly: folder, file, or name in content/assemblies")
        ->capture_default_str();
    train->add_option("--variant", options->variant,
                      "Material variant of the assembly; default: the assembly's own");
    train->add_option("--tool", options->tool, "One of the assembly's tools; default: the first");
    train
        ->add_option(
            "--mode", options->mode,
            "guided: a force guides the hand to the nut, and a step lasts until it is done; practice: no "
            "guidance; assessment: a joint is judged as it is when the tool leaves it")
        ->check(CLI::IsMember({"guided", "practice", "assessment"}))
        ->capture_default_str();
    train->add_option("--task", options->task, "Tighten loose joints, or loosen tightened joints")
        ->check(CLI::IsMember({"tighten", "loosen"}))
        ->capture_default_str();
    train->add_option("--law", options->law, "Torque law; default: the assembly's own")
        ->check(CLI::IsMember({"published", "mechanistic"}));
    train->add_option(
        "--device", options->devices,
        "auto (a connected device, else the mouse), mouse, simulated-arm (the mouse moves the hand "
        "that holds a simulated arm), simulated (keys move the tool of a station without a device), "
        "or an id listed by boltwright devices; may be given twice, for a device that moves the "
        "tool and for a wheel");
    train
        ->add_option(
            "--hand", options->hand,
            "The hand of the mouse: helped (it finds the nut by itself) or free (the mouse moves and "
            "turns the wrench)")
        ->check(CLI::IsMember({"helped", "free"}))
        ->capture_default_str();
    train->add_option("--station", options->station_file,
                      "Station file: devices, glove and their settings; other options have precedence. "
                      "`boltwright station new` makes one");
    train->add_option("--rig", options->wheel_config_file,
                      "Configuration file of the wheel: its motor, its encoder");
    train->add_option("--glove", options->glove,
                      "Port of a CyberGlove calibrated for --trainee, auto, or none; default: the station "
                      "file's, else none");
    train->add_flag("--hmd", options->hmd, "Display in a headset");
    train->add_flag("--headless", options->headless,
                    "No window: a simulated trainee performs the lesson in virtual time");
    train->add_flag("--start", options->start, "Start the lesson immediately, without the menu");
    train->add_option("--size", options->size, "WIDTHxHEIGHT of the window")->capture_default_str();
    train->add_flag("--full-screen", options->full_screen, "Use the full screen");
    train->add_option("--trainee", options->trainee,
                      "Name of the trainee; recorded in the session and selects the settings: keys, hand, "
                      "captions, colours");
    train->add_option("--settings", options->settings,
                      "Settings file to use instead of the trainee's; created if it does not exist");
    train->add_option(
        "--language", options->language,
        "Code of a language in content/words, such as en; default: the trainee's or the desktop's");
    train->add_flag("--silent", options->silent, "No sound");
    train->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    train->add_flag("--validate", options->validate,
                    "Run under the Vulkan validation layers; any message is an error");
    train
        ->add_option("--operator", options->trainee_profile,
                     fmt::format("Simulated trainee: {}", fmt::join(trainees::profile_names(), ", ")))
        ->capture_default_str();
    train->add_option("--seed", options->seed, "Seed of the trainee and of the joints' scatter")
        ->check(whole_number)
        ->capture_default_str();
    train->add_option("--out", options->out, "Folder for session, summary and report")->capture_default_str();
    auto* obstacles =
        train->add_flag("--obstacles", options->obstacles,
                        "Fail if the assembly has no contact model; if it has one, contacts with "
                        "casing, bolts and nuts are simulated by default");
    train
        ->add_flag("--no-obstacles", options->no_obstacles,
                   "Do not simulate contacts: the wrench passes through everything")
        ->excludes(obstacles);
    train->add_flag("--no-guide", options->no_guide, "No guiding force in a guided lesson");
    train->add_flag(
        "--view-help", options->view_help,
        "A simulated trainee requests views, like key V in the window; otherwise it only moves its head");
    train->add_flag("--no-pictures", options->no_pictures, "Do not draw pictures of the result");
    train->add_flag("--quiet", options->quiet, "Do not print the progress");
    train->callback([options, &exit_code] { exit_code = run_train(*options); });
}

}  // namespace bolt::cli
