// boltwright train: runs a lesson in a window, or headless with a simulated trainee, and writes its session,
// summary, report and pictures.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/cli/opened_walls.hpp"
#include "game/cli/study_displays.hpp"
#include "game/cli/train_arguments.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/lesson.hpp"
#include "game/report/report.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/export.hpp"
#include "game/trainer/app.hpp"
#include "game/trainer/shared_lesson.hpp"
#include "game/view/pictures.hpp"

namespace bolt::cli {

namespace {

// Prints the progress to stderr: one line that is overwritten on a terminal, otherwise one line a pass.
class TrainingProgressLine {
  public:
    explicit TrainingProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

    // Returns false if the program was requested to end.
    bool show(const content::Assembly& assembly, const trainees::TrainingProgress& progress) {
        step_ = progress.step;
        steps_ = progress.steps;
        time_ = progress.time;
        if (progress.event != nullptr) add_event(assembly, progress);
        if (!quiet_ && terminal_)
            (void)std::fputs(fmt::format("\r\033[K{:6.1f} s  step {:>3} of {}  {}", progress.time,
                                         progress.step, progress.steps, activity_)
                                 .c_str(),
                             stderr);
        return !interrupted();
    }
    // The error of a trainee that did not finish in time. A lesson that no trainee finishes is often a
    // mistake of its author.
    [[nodiscard]] Error overdue(const trainees::TrainOptions& train) const {
        const bool whole = time_ > train.time_limit - 1.0;
        return {
            ErrorCode::failed,
            fmt::format(
                "the simulated trainee gave up after {:.0f} s of virtual time {}at step {} of {} ({})",
                whole ? train.time_limit : train.patience, whole ? "" : "without progress ", step_ + 1,
                steps_, activity_),
            "a step that this tool can finish; --tool selects another one, and --no-obstacles shows whether "
            "parts are in its way"};
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
        if (quiet_) return;
        (void)std::fputs(fmt::format("{}{}\n", terminal_ ? "\r\033[K" : "", text).c_str(), stderr);
    }

    bool quiet_;
    bool terminal_;
    std::string pass_, activity_;
    std::size_t step_ = 0, steps_ = 0;
    double time_ = 0.0;  // s, virtual time
};

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
                     const session::LessonOutcome& outcome, const std::filesystem::path& out, bool pictures,
                     bool prints = true) {
    if (Status written = write_file(out / "summary.json", session::summary_json(assembly, options, outcome));
        !written)
        return written;
    const std::filesystem::path session = out / "session.boltwright";
    if (Status written = write_report(session, out / "report.html"); !written) return written;
    if (!prints) return {};
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
        error.expected = "a folder that this user may write to";
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
    if (interrupted()) return static_cast<int>(ErrorCode::failed);
    return outcome->result.finished ? 0 : print_error(line.overdue(train));
}

// A headset for the lesson; null: none is used. Fails if a headset is required and none is found.
Result<std::unique_ptr<xr::Headset>> open_headset(HeadsetUse use, bool quiet) {
    if (use == HeadsetUse::none) return std::unique_ptr<xr::Headset>();
    xr::HeadsetOptions options;
    if (!quiet)
        options.log = [](const std::string& line) { (void)std::fprintf(stderr, "%s\n", line.c_str()); };
    auto headset = std::make_unique<xr::Headset>(std::move(options));
    const bool found = headset->find(0.0);
    if (!found && use == HeadsetUse::required) return fail(*headset->absence());
    return headset;
}

// The display that surrounds the user; at most one is set.
struct Surroundings {
    xr::Headset* headset = nullptr;
    bool needs_headset = false;
    view::Walls* walls = nullptr;
};

// The content of a window: a lesson, the menu, or a study.
struct WindowRequest {
    const TrainArguments& options;
    const trainees::TrainOptions& train;
    const trainer::Equipment& equipment;
    std::optional<trainer::StudyRun> study{};
};

Status run_window(WindowRequest request, const Surroundings& surroundings, platform::Desktop& desktop) {
    const TrainArguments& options = request.options;
    const trainees::TrainOptions& train = request.train;
    xr::Headset* headset = surroundings.headset;
    const std::filesystem::path out(options.out);
    if (Status made = make_folder(out); !made) return made;
    trainer::AppOptions app_options;
    app_options.choice = {options.assembly, options.variant,  train.lesson.mode, train.lesson.task,
                          options.trainee,  options.language, options.tool,      request.equipment};
    app_options.sound = !options.silent;
    app_options.menu = !options.start;
    app_options.lesson = train.lesson;
    app_options.lesson.trainee_profile = "person";
    if (!options.law.empty()) app_options.choice.law = train.lesson.law;
    app_options.out = out;
    app_options.folder_per_lesson = options.folder_per_lesson;
    app_options.first_start = options.first_start;
    const auto* const mirror =
        std::find(view::mirror_names.begin(), view::mirror_names.end(), options.mirror);
    app_options.mirror = static_cast<view::Mirror>(mirror - view::mirror_names.begin());
    app_options.settings_file = options.settings;
    // Without a home folder no settings are kept.
    if (const auto data = user_data_folder()) {
        app_options.settings_folder = *data / "settings";
        app_options.people_folder = *data / "people";
        app_options.gloves_folder = *data / "gloves";
    }
    app_options.on_start = remove_stale_files;
    const bool prints = !request.study;  // the results of a study are not for the experimenter's terminal
    app_options.on_end = [prints](const content::Assembly& assembly, const session::LessonOptions& lesson,
                                  const session::LessonOutcome& outcome,
                                  const std::filesystem::path& folder) {
        return write_results(assembly, lesson, outcome, folder, false, prints);
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
    instance_options.log = std::make_shared<gpu::ValidationLog>();
    const view::WindowRunOptions run_options{.gpu = options.gpu,
                                             .stop = [] { return interrupted(); },
                                             .headset = headset,
                                             .needs_headset = surroundings.needs_headset,
                                             .walls = surroundings.walls,
                                             .adapts_resolution = !options.full_resolution,
                                             .instance = instance_options};
    BOLT_TRY_ASSIGN(auto instance,
                    view::make_instance(instance_options, headset, surroundings.needs_headset));
    trainer::App app(std::move(app_options), std::move(request.study));
    catch_interruption();
    StudyDisplay display(desktop, options.quiet);
    BOLT_TRY(run_on_displays(app, *window, instance, run_options, display));
    if (!instance.log().messages.empty())
        return fail(ErrorCode::failed, instance.log().messages.front(), "no message of the validation layer");
    return {};
}

// Headset, walls and simulated trainee exclude each other.
Status check_displays(const TrainArguments& options, HeadsetUse headset) {
    if (headset != HeadsetUse::none && options.headless)
        return fail(ErrorCode::usage, "a simulated trainee wears no headset", "--headless without --hmd");
    if (!options.displays.empty() && (options.headless || headset != HeadsetUse::none))
        return fail(ErrorCode::usage, "walls are shown in windows, to a viewer without a headset",
                    "--displays without --headless and --hmd");
    return {};
}

Status check_hands(const TrainArguments& options, const trainer::Equipment& equipment) {
    const bool devices =
        !equipment.devices.empty() || !equipment.glove.empty() || !options.station_file.empty();
    if (options.headless && (devices || equipment.hand == trainer::HandMode::free))
        return fail(ErrorCode::usage, "a simulated trainee does not use devices or the mouse",
                    "--headless without --device ID, --station FILE, --hand free and --glove PORT");
    return {};
}

// Shows the lesson; a process that follows another one shows the lesson of that one.
Status show(WindowRequest request, Surroundings surroundings, platform::Desktop& desktop) {
    const TrainArguments& options = request.options;
    OpenedWalls opened;
    if (!options.displays.empty()) {
        BOLT_TRY_ASSIGN(auto walls, open_walls(options.displays, desktop, options.quiet));
        opened = std::move(walls);
    }
    if (opened.follower) {
        trainer::FollowedLesson lesson;
        return follow_first_process(lesson, opened, desktop, {options.gpu, options.validate});
    }
    view::Walls* walls = surroundings.walls = opened.walls.get();
    const Status done = run_window(std::move(request), surroundings, desktop);
    if (!done && walls != nullptr && walls->leader() != nullptr) walls->leader()->end(done.error());
    return done;
}

int run_train(TrainArguments options) {
    const Result<HeadsetUse> headset_use = cli::headset_use(options);
    if (!headset_use) return print_error(headset_use.error());
    if (Status checked = check_displays(options, *headset_use); !checked) return print_error(checked.error());
    Result<trainer::Equipment> equipment = equipment_of(options);
    if (!equipment) return print_error(equipment.error());
    if (Status checked = check_hands(options, *equipment); !checked) return print_error(checked.error());

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
    const auto headset = open_headset(*headset_use, options.quiet);
    if (!headset) return print_error(headset.error());
    Result<platform::Desktop> desktop = platform::Desktop::open();
    if (!desktop && (*headset_use == HeadsetUse::required || !options.displays.empty()))
        return print_error(desktop.error());
    if (!desktop) {
        if (!options.quiet)
            (void)std::fputs((desktop.error().what + ": a simulated trainee plays.\n").c_str(), stderr);
        return run_headless(options, loaded.assembly, *train);
    }
    // The headset's hands move the tool unless a device does.
    const bool found = *headset && (*headset)->creator() != nullptr;
    if (found && equipment->hand_unassigned()) equipment->hand = trainer::HandMode::tracked;
    // The absolute path distinguishes a folder here from an assembly of the same name in the menu.
    TrainArguments named = options;
    named.tool = *tool;
    std::error_code ignored;
    if (std::filesystem::exists(options.assembly, ignored))
        named.assembly = std::filesystem::absolute(options.assembly).lexically_normal().string();
    const Status done =
        show({named, *train, *equipment}, {headset->get(), *headset_use == HeadsetUse::required}, *desktop);
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
    return run_window({options, train, equipment}, {}, desktop);
}

Status run_study(const TrainArguments& options, trainer::StudyRun study) {
    TrainArguments used = options;
    BOLT_TRY_ASSIGN(const auto headset_use, cli::headset_use(used));
    BOLT_TRY(check_displays(used, headset_use));
    BOLT_TRY_ASSIGN(auto equipment, equipment_of(used));
    BOLT_TRY_ASSIGN(const auto headset, open_headset(headset_use, used.quiet));
    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    if (headset && headset->creator() != nullptr && equipment.hand_unassigned())
        equipment.hand = trainer::HandMode::tracked;
    const trainees::TrainOptions unused{};  // the plan has the settings of the lessons
    return show({used, unused, equipment, std::move(study)},
                {headset.get(), headset_use == HeadsetUse::required}, desktop);
}

void add_train(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<TrainArguments>();
    CLI::App* train = app.add_subcommand(
        "train", "Run a lesson in a window; without a display a simulated trainee performs it");
    add_train_options(*train, *options);
    train->callback([options, &exit_code] { exit_code = run_train(*options); });
}

}  // namespace bolt::cli
