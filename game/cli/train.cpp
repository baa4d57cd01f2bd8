#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <memory>

#include "content/format/assembly.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/cli/interruption.hpp"
#include "game/lesson/lesson.hpp"
#include "game/report/report.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/export.hpp"
#include "game/station/station_setup.hpp"
#include "game/trainees/trainee.hpp"
#include "game/trainer/window.hpp"
#include "game/view/camera.hpp"
#include "game/view/pictures.hpp"
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
    std::string glove = "none", rig;
    bool hmd = false;
    bool headless = false;
    bool start = false, full_screen = false, validate = false, silent = false;
    std::string name, language, settings;
    std::string size = "1280x720", gpu;
    bool quiet = false, no_pictures = false, no_guide = false, view_help = false;
    bool obstacles = false, no_obstacles = false;
    std::string trainee = "expert";
    std::uint64_t seed = 1;
    std::string out = "out";
};

// One line that is rewritten on a terminal, one line a pass elsewhere (a log does not want thousands).
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

    bool show(const content::Assembly& assembly, const trainees::Progress& progress) {
        if (quiet_) return !interrupted();
        if (progress.event != nullptr) note(assembly, progress);
        if (terminal_)
            (void)std::fputs(fmt::format("\r\033[K{:6.1f} s  step {:>3} of {}  {}", progress.time,
                                         progress.step, progress.steps, doing_)
                                 .c_str(),
                             stderr);
        return !interrupted();
    }
    void end() const {
        if (!quiet_ && terminal_) (void)std::fputs("\r\033[K", stderr);
    }

  private:
    void note(const content::Assembly& assembly, const trainees::Progress& progress) {
        const lesson::Event& event = *progress.event;
        if (event.kind == "pass_begin") {
            pass_ = event.text;
            doing_ = pass_;
            if (!terminal_) line(fmt::format("{:6.1f} s  {}", progress.time, pass_));
        } else if (event.kind == "step_begin") {
            doing_ = fmt::format("{}: {}", pass_,
                                 assembly.joints[static_cast<std::size_t>(event.joint)].design.id);
        } else if (event.kind == "mistake") {
            line(fmt::format("{:6.1f} s  {}", progress.time, event.text));
        }
    }
    void line(const std::string& text) const {
        (void)std::fputs(fmt::format("{}{}\n", terminal_ ? "\r\033[K" : "", text).c_str(), stderr);
    }

    bool quiet_;
    bool terminal_;
    std::string pass_, doing_;
};

bool is_word(const std::string& device) {
    return device == "auto" || device == "mouse" || device == "simulated";
}

// What was asked for and is not there is an error and not a silent fallback.
Result<trainer::Equipment> equipment_of(const TrainArguments& options) {
    if (options.hmd) return fail(ErrorCode::no_device, "this build has no headset output", "leave out --hmd");
    trainer::Equipment with;
    const std::string first = options.devices.empty() ? "auto" : options.devices.front();
    if (options.devices.size() > 1 && std::any_of(options.devices.begin(), options.devices.end(), is_word))
        return fail(ErrorCode::usage, "--device auto, mouse and simulated stand alone", "ids of devices");
    if (first == "auto")
        with = options.headless ? trainer::Equipment{} : trainer::usual_equipment();
    else if (first == "simulated")
        with.keyboard = true;
    else if (first != "mouse")
        with.devices = options.devices;
    with.rig = options.rig;
    if (options.glove == "auto") {
        const auto ports = hand::serial_ports();
        if (!ports.empty()) with.glove = ports.front();
    } else if (options.glove != "none") {
        with.glove = options.glove;
    }
    // Before a window opens: what is not there will not be there then.
    const auto chosen = station_setup::choose(device::list_devices(true), with.devices);
    if (!chosen) return fail(chosen.error());
    if (!with.glove.empty())
        if (Status may = hand::check_port_access(with.glove); !may) return fail(may.error());
    return with;
}

Result<trainees::TrainOptions> play_options(const TrainArguments& options,
                                            const content::Assembly& assembly) {
    trainees::TrainOptions play;
    play.course.mode = options.mode == "guided"     ? lesson::Mode::guided
                       : options.mode == "practice" ? lesson::Mode::practice
                                                    : lesson::Mode::assessment;
    play.course.task = options.task == "loosen" ? lesson::Task::loosen : lesson::Task::tighten;
    play.course.law = options.law.empty()          ? assembly.law
                      : options.law == "published" ? joint::Law::published
                                                   : joint::Law::mechanistic;
    play.course.seed = options.seed;
    play.course.obstacles = options.no_obstacles ? session::Obstacles::none
                            : options.obstacles  ? session::Obstacles::required
                                                 : session::Obstacles::if_any;
    play.course.guide = !options.no_guide;
    if (options.view_help) play.view_help = view::view_help();
    Result<trainees::Profile> trainee = trainees::find_profile(options.trainee);
    if (!trainee) return fail(trainee.error());
    play.trainee = *trainee;
    play.course.operator_name = play.trainee.name;
    play.course.trainee = options.name;
    return play;
}

Status write_report(const std::filesystem::path& session, const std::filesystem::path& page) {
    Result<session::Reader> reader = session::Reader::open(session);
    if (!reader) return fail(reader.error());
    const session::Reader* sessions[] = {&*reader};
    Result<std::string> html = report::make_report(sessions);
    if (!html) return fail(html.error());
    return write_file(page, *html);
}

// Everything that a lesson leaves beside its session.
Status leave(const content::Assembly& assembly, const session::CourseOptions& course,
             const session::Played& played, const std::filesystem::path& out, bool pictures) {
    if (Status kept = write_file(out / "summary.json", session::summary_json(assembly, course, played));
        !kept)
        return kept;
    const std::filesystem::path session = out / "session.boltwright";
    if (Status kept = write_report(session, out / "report.html"); !kept) return kept;
    std::string closing = session::summary_table(assembly, played.result);
    closing += fmt::format("{}, {}, {}\n", session.string(), (out / "summary.json").string(),
                           (out / "report.html").string());
    if (Status said = print(closing); !said) return said;
    // What cannot be drawn takes nothing from what was recorded.
    if (pictures && !interrupted())
        if (Status drawn = view::draw_result(assembly, played.result, out, {1280, 720}); !drawn)
            (void)print_error(drawn.error());
    return {};
}

Status make_room(const std::filesystem::path& out) {
    std::error_code made;
    std::filesystem::create_directories(out, made);
    if (made) {
        Error error;
        error.file = out.string();
        error.what = "this folder cannot be made: " + made.message();
        return fail(error);
    }
    return {};
}

// The page and the summary of an earlier lesson would speak of another session.
void remove_stale(const std::filesystem::path& out) {
    std::error_code gone;
    for (const char* stale : {"summary.json", "report.html"}) std::filesystem::remove(out / stale, gone);
}

int run_headless(const TrainArguments& options, const content::Assembly& assembly,
                 const trainees::TrainOptions& play) {
    const std::filesystem::path out(options.out);
    if (Status room = make_room(out); !room) return print_error(room.error());
    if (!options.quiet)
        (void)std::fputs(
            fmt::format("{} ({}), law {}, {}, trainee {}, seed {}\n", assembly.name, assembly.variant,
                        joint::name(play.course.law), options.mode, options.trainee, options.seed)
                .c_str(),
            stderr);
    remove_stale(out);
    catch_interruption();
    ProgressLine line(options.quiet);
    const Result<session::Played> played =
        trainees::train(assembly, play, out / "session.boltwright",
                        [&](const trainees::Progress& progress) { return line.show(assembly, progress); });
    line.end();
    if (!played) return print_error(played.error());
    if (!options.quiet && !played->obstacles && !options.no_obstacles)
        if (const auto missing = session::missing_contact_model(assembly))
            (void)std::fputs(
                fmt::format("The wrench goes through everything: {}\n", missing->message()).c_str(), stderr);
    if (Status left = leave(assembly, play.course, *played, out, !options.no_pictures); !left)
        return print_error(left.error());
    return interrupted() || !played->result.finished ? static_cast<int>(ErrorCode::failed) : 0;
}

// In a window, with whatever the hand has.
Status run_window(const TrainArguments& options, const trainees::TrainOptions& play,
                  const trainer::Equipment& with, platform::Desktop& desktop) {
    const std::filesystem::path out(options.out);
    if (Status room = make_room(out); !room) return room;
    trainer::AppOptions app_options;
    app_options.choice = {options.assembly, options.variant,  play.course.mode, play.course.task,
                          options.name,     options.language, options.tool,     with};
    app_options.sound = !options.silent;
    app_options.menu = !options.start;
    app_options.course = play.course;
    app_options.course.operator_name = "person";
    if (!options.law.empty()) app_options.law = play.course.law;
    app_options.out = out;
    app_options.settings_file = options.settings;
    // Without a home nothing is kept, and a lesson is one all the same.
    if (const auto data = content::data_folder()) app_options.settings_folder = *data / "settings";
    app_options.begins = [out] { remove_stale(out); };
    app_options.ended = [&](const content::Assembly& assembly, const session::CourseOptions& course,
                            const session::Played& played) {
        return leave(assembly, course, played, out, false);
    };
    if (!options.quiet)
        app_options.tell = [](const std::string& line) { (void)std::fprintf(stderr, "%s\n", line.c_str()); };
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
    const trainer::WindowChoice choice{options.gpu, [] { return interrupted(); }};
    if (Status run = trainer::run_in_window(app, *window, *instance, choice); !run) return run;
    if (!instance->log().messages.empty()) return fail(ErrorCode::failed, instance->log().messages.front());
    return {};
}

int run_train(const TrainArguments& options) {
    const Result<trainer::Equipment> with = equipment_of(options);
    if (!with) return print_error(with.error());
    if (options.headless && (!with->glove.empty() || !with->devices.empty())) {
        Error error;
        error.code = ErrorCode::usage;
        error.what = "a simulated trainee has no use for devices";
        error.expected = "--headless without --device ID and --glove PORT";
        return print_error(error);
    }

    content::Loaded loaded = content::load_assembly(options.assembly, options.variant);
    if (!loaded.ok()) return print_error(loaded.errors);
    if (Status chosen = content::choose_tool(loaded.assembly, options.tool); !chosen)
        return print_error(chosen.error());
    Result<trainees::TrainOptions> play = play_options(options, loaded.assembly);
    if (!play) return print_error(play.error());
    loaded.assembly = lesson::under_law(std::move(loaded.assembly), play->course.law);
    if (options.headless) return run_headless(options, loaded.assembly, *play);
    Result<platform::Desktop> desktop = platform::Desktop::open();
    if (!desktop) {
        if (!options.quiet)
            (void)std::fputs((desktop.error().what + ": a simulated trainee plays.\n").c_str(), stderr);
        return run_headless(options, loaded.assembly, *play);
    }
    const Status done = run_window(options, *play, *with, *desktop);
    return done ? 0 : print_error(done.error());
}

}  // namespace

namespace {

// CLI11 reads "-1" as the largest number there is.
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
    CLI::App* train =
        app.add_subcommand("train", "Play a lesson in a window; without a display a simulated trainee does");
    train->add_option("assembly", options->assembly, "Folder, file, or name under content/assemblies")
        ->capture_default_str();
    train->add_option("--variant", options->variant,
                      "Material variant of the assembly; its default if not given");
    train->add_option("--tool", options->tool, "One of the assembly's tools; the first if not given");
    train
        ->add_option("--mode", options->mode,
                     "guided: the hand is led to the nut, a step stays until it is done; practice: not led; "
                     "assessment: a joint that is left counts as it was left")
        ->check(CLI::IsMember({"guided", "practice", "assessment"}))
        ->capture_default_str();
    train->add_option("--task", options->task, "Tighten the joints, or loosen joints that are tight")
        ->check(CLI::IsMember({"tighten", "loosen"}))
        ->capture_default_str();
    train->add_option("--law", options->law, "Torque law; the assembly's own if not given")
        ->check(CLI::IsMember({"published", "mechanistic"}));
    train->add_option("--device", options->devices,
                      "auto (what is plugged in, else the mouse), mouse, simulated (keys move the tool of a "
                      "station without a device), or the id of one that boltwright devices shows; one that "
                      "moves the tool and a wheel can be asked for together");
    train->add_option("--rig", options->rig, "What is known of the wheel: its rig file");
    train
        ->add_option("--glove", options->glove,
                     "The port of a CyberGlove that --trainee has calibrated, auto, or none")
        ->capture_default_str();
    train->add_flag("--hmd", options->hmd, "Show in a headset");
    train->add_flag("--headless", options->headless, "No window: a simulated trainee in virtual time");
    train->add_flag("--start", options->start, "Begin the lesson at once, without the menu");
    train->add_option("--size", options->size, "WIDTHxHEIGHT of the window")->capture_default_str();
    train->add_flag("--full-screen", options->full_screen, "All of the display");
    train->add_option(
        "--trainee", options->name,
        "Who plays; kept in the session, and whose settings hold: keys, hand, captions, colours");
    train->add_option("--settings", options->settings,
                      "A file with settings, for whoever plays; it is made if it is not there");
    train->add_option("--language", options->language,
                      "en, de, zh; the trainee's or the desktop's if not given");
    train->add_flag("--silent", options->silent, "Without sound");
    train->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    train->add_flag("--validate", options->validate,
                    "Run under the Vulkan validation layers; any message is an error");
    train->add_option("--operator", options->trainee, "Simulated trainee: expert, novice or clumsy")
        ->capture_default_str();
    train->add_option("--seed", options->seed, "Seed of the trainee and of the joints' scatter")
        ->check(whole_number)
        ->capture_default_str();
    train->add_option("--out", options->out, "Folder for session, summary and report")->capture_default_str();
    auto* solid = train->add_flag("--obstacles", options->obstacles,
                                  "Fail if the assembly has no contact model; where it has one, the wrench "
                                  "meets casing, bolts and nuts anyway");
    train->add_flag("--no-obstacles", options->no_obstacles, "The wrench goes through everything")
        ->excludes(solid);
    train->add_flag("--no-guide", options->no_guide, "A guided lesson without the force that leads the hand");
    train->add_flag(
        "--view-help", options->view_help,
        "A simulated trainee asks for views, as V does in the window; else it looks round by itself");
    train->add_flag("--no-pictures", options->no_pictures, "Without pictures of how the lesson ended");
    train->add_flag("--quiet", options->quiet, "No progress");
    train->callback([options, &exit_code] { exit_code = run_train(*options); });
}

}  // namespace bolt::cli
