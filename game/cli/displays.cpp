// boltwright displays: makes, checks and imports the file that describes projection walls, and shows what the
// tracker of the head sends. The test pattern is in displays_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "content/displays/check_displays.hpp"
#include "content/displays/display_file.hpp"
#include "content/displays/example_displays.hpp"
#include "content/displays/import_pvx.hpp"
#include "content/displays/wall_geometry.hpp"
#include "content/displays/wall_summary.hpp"
#include "content/format/folders.hpp"
#include "engine/base/steady_seconds.hpp"
#include "engine/platform/window.hpp"
#include "engine/tracking/recorded_poses.hpp"
#include "game/cli/commands.hpp"
#include "game/head_tracking/head_source.hpp"
#include "game/view/walls.hpp"

namespace bolt::cli {

namespace {

struct DisplaysArguments {
    std::string file, pvx, kind = "cave", stereo = "mono", name;
    content::PvxOptions pvx_options;
    double seconds = 10.0;  // track
    int process = 0;
    bool force = false, without_monitors = false;
};

// Warnings and findings are for people at a terminal and for logs.
void print_to_stderr(const std::string& text) { (void)std::fputs(text.c_str(), stderr); }

std::vector<std::string> stereo_mode_names() {
    std::vector<std::string> names;
    for (const content::StereoMode mode : {content::StereoMode::mono, content::StereoMode::side_by_side,
                                           content::StereoMode::top_bottom, content::StereoMode::two_outputs})
        names.emplace_back(content::name(mode));
    return names;
}

// Fails if the file exists and may not be overwritten.
Status write_display_file(const DisplaysArguments& options, content::DisplayFile displays) {
    std::error_code ignored;
    if (!options.force && std::filesystem::exists(options.file, ignored))
        return fail(ErrorCode::usage, fmt::format("{} exists already", options.file),
                    "a new file, or --force to overwrite it");
    const std::filesystem::path schema = content::content_folder() / "schema" / "displays.schema.json";
    if (std::filesystem::exists(schema, ignored)) displays.schema = schema.string();
    if (!options.name.empty()) displays.name = options.name;
    return content::save_displays(options.file, displays);
}

Status make_displays(const DisplaysArguments& options) {
    const auto index_of = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) - names.begin();
    };
    const content::DisplayFile displays = content::example_displays(
        static_cast<content::DisplayKind>(index_of(content::display_kind_names(), options.kind)),
        static_cast<content::StereoMode>(index_of(stereo_mode_names(), options.stereo)));
    BOLT_TRY(write_display_file(options, displays));
    return print(options.file + ":\n" + content::list_walls(displays) +
                 "Enter the measured corners, the outputs and the tracker; an editor that reads its schema "
                 "explains every member. Then: boltwright displays check " +
                 options.file + "\n");
}

bool any_prevents_use(const std::vector<content::DisplayFinding>& findings) {
    return std::any_of(findings.begin(), findings.end(),
                       [](const content::DisplayFinding& finding) { return finding.prevents_use; });
}

// Prints all findings. Returns the exit code: bad_content if the file is wrong on any computer, failed if it
// does not fit this one.
int report_findings(const content::LoadedDisplays& loaded, const content::DisplayHost& host) {
    const auto findings = content::check_displays(loaded.displays, host);
    print_to_stderr(content::describe(findings, loaded));
    if (any_prevents_use(content::check_displays(loaded.displays)))
        return static_cast<int>(ErrorCode::bad_content);
    return any_prevents_use(findings) ? static_cast<int>(ErrorCode::failed) : 0;
}

int check_display_file(const DisplaysArguments& options) {
    const content::LoadedDisplays loaded = content::load_displays(options.file);
    if (!loaded.ok()) return print_error(loaded.errors);
    const content::HeadTracking& head = loaded.displays.head;
    if (head.tracker == content::HeadTracker::file) {
        const auto folder = std::filesystem::path(options.file).parent_path();
        const auto poses = tracking::load_recorded_poses(folder / head.recording);
        if (!poses) return print_error(poses.error());
    }
    content::DisplayHost host;
    host.process = options.process;
    std::string compared = "The outputs were not compared with monitors";
    if (!options.without_monitors) {
        const auto desktop = platform::Desktop::open();
        if (desktop) {
            host = view::this_host(*desktop);
            host.process = options.process;
            const std::size_t count = host.monitors.size();
            compared = fmt::format("The outputs were compared with {} of this computer",
                                   count == 1 ? "the monitor" : fmt::format("the {} monitors", count));
        } else {
            compared += ": " + desktop.error().message();
        }
    }
    const Status listed = print(content::list_walls(loaded.displays, host) + compared + "\n");
    if (!listed) return print_error(listed.error());
    const int exit_code = report_findings(loaded, host);
    const Status printed =
        print(exit_code == 0 ? "The file has no mistakes\n" : "The file has mistakes that prevent its use\n");
    return printed ? exit_code : print_error(printed.error());
}

int import_displays(const DisplaysArguments& options) {
    content::ImportedDisplays imported = content::load_pvx(options.pvx, options.pvx_options);
    for (Error& warning : imported.warnings) {
        warning.what = "warning: " + warning.what;
        print_to_stderr(warning.message() + "\n");
    }
    if (!imported.ok()) return print_error(imported.errors);
    const Status saved = write_display_file(options, imported.displays);
    if (!saved) return print_error(saved.error());
    const content::LoadedDisplays loaded = content::load_displays(options.file);
    const Status printed = print(options.file + ":\n" + content::list_walls(loaded.displays));
    if (!printed) return print_error(printed.error());
    return report_findings(loaded, {});
}

// Lists the walls that a head at this point sees from behind. If there are any, the axes or the position of
// the tracker are wrong in the file.
std::string describe_walls_behind(const content::DisplayFile& displays, const Vec3& head) {
    std::vector<std::string> names;
    for (const content::Wall& wall : displays.walls)
        if (content::distance_in_front(content::axes_of(wall), head) <= 0.0) names.push_back(wall.name);
    return names.empty() ? "" : fmt::format("   behind {}", fmt::join(names, ", "));
}

// The direction of −z of a pose. Whole degrees, without a negative zero.
struct LookDirection {
    double right = 0.0, up = 0.0;
};
LookDirection direction_of(const Pose& pose) {
    const Vec3 ahead = pose.orientation * Vec3(0.0, 0.0, -1.0);
    const auto degrees = [](double angle) { return std::round(to_degrees(angle)) + 0.0; };
    return {degrees(std::atan2(ahead.x, -ahead.z)), degrees(std::asin(std::clamp(ahead.y, -1.0, 1.0)))};
}

std::string describe_wand(const std::optional<head_tracking::Wand>& wand) {
    if (!wand) return "flystick sends nothing\n";
    std::vector<std::string_view> pressed;
    if (wand->select) pressed.emplace_back("select");
    if (wand->menu) pressed.emplace_back("menu");
    if (wand->tool) pressed.emplace_back("tool");
    std::string text = "flystick is not seen";
    if (wand->aim) {
        const Vec3& at = wand->aim->position;
        const LookDirection points = direction_of(*wand->aim);
        text = fmt::format(
            "flystick x {:6.3f}  y {:6.3f}  z {:6.3f} m   points {:4.0f} degrees to the right, {:3.0f} up",
            at.x, at.y, at.z, points.right, points.up);
    }
    return fmt::format("{}   pressed: {}\n", text,
                       pressed.empty() ? "none" : fmt::format("{}", fmt::join(pressed, ", ")));
}

std::string describe_shown_head(const content::DisplayFile& displays, const tracking::FilteredHead& head) {
    constexpr const char* states[] = {"tracked", "held", "lost"};
    const Vec3& at = head.pose.position;
    const LookDirection looks = direction_of(head.pose);
    return fmt::format(
        "{:<8} x {:6.3f}  y {:6.3f}  z {:6.3f} m   looks {:4.0f} degrees to the right, {:3.0f} up{}\n",
        states[static_cast<std::size_t>(head.status)], at.x, at.y, at.z, looks.right, looks.up,
        describe_walls_behind(displays, at));
}

std::string describe_tracker_counts(const head_tracking::TrackerCounts& counts,
                                    const content::HeadTracking& head) {
    std::string text = fmt::format("{} poses of the head", counts.samples);
    if (head.tracker != content::HeadTracker::dtrack) return text + "\n";
    const tracking::DtrackCounts& packets = counts.dtrack;
    text += fmt::format("; packets: {} good, {} damaged, {} late; {} bodies without a valid pose\n",
                        packets.good_packets, packets.malformed_packets, packets.late_packets,
                        packets.invalid_bodies);
    if (counts.samples > 0) return text;
    if (packets.good_packets + packets.malformed_packets == 0)
        return text + fmt::format(
                          "No packet has arrived at UDP port {}: is this computer's address an output of "
                          "DTrack, and does a firewall let them pass?\n",
                          head.port);
    return text + (counts.bodies.empty()
                       ? "DTrack sees no body: is the measurement on, and are the glasses in view?\n"
                       : fmt::format("Body {} is not seen; DTrack sees {}\n", head.body,
                                     fmt::join(counts.bodies, ", ")));
}

// Prints where the tracker sees the head. Succeeds if the tracker has seen the head at least once.
int track_head(const DisplaysArguments& options) {
    const content::LoadedDisplays loaded = content::load_displays(options.file);
    if (!loaded.ok()) return print_error(loaded.errors);
    const content::HeadTracking& head = loaded.displays.head;
    if (head.tracker == content::HeadTracker::fixed)
        return print_error(
            {ErrorCode::usage,
             fmt::format("the tracker of {} is \"{}\"", options.file, content::name(head.tracker)),
             "\"dtrack\", \"openxr\" or \"file\""});
    auto source = head_tracking::HeadSource::open(head, std::filesystem::path(options.file).parent_path());
    if (!source) return print_error(source.error());
    catch_interruption();
    const double start = steady_seconds();
    double next_line = start;
    for (double now = start; now < start + options.seconds && !interrupted(); now = steady_seconds()) {
        const tracking::FilteredHead shown = source->at(now);
        if (now >= next_line) {
            next_line += 0.5;
            std::string lines = describe_shown_head(loaded.displays, shown);
            if (head.flystick) lines += describe_wand(source->wand());
            if (const Status printed = print(lines); !printed) return print_error(printed.error());
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const Status printed = print(describe_tracker_counts(source->counts(), head));
    if (!printed) return print_error(printed.error());
    return source->counts().samples > 0 ? 0 : static_cast<int>(ErrorCode::failed);
}

CLI::App* add_displays_command(CLI::App& displays, DisplaysArguments& options, const char* name,
                               const char* description) {
    CLI::App* command = displays.add_subcommand(name, description);
    command->add_option("FILE", options.file, "The display file")->required();
    return command;
}

void add_writing_options(CLI::App& command, DisplaysArguments& options) {
    command.add_option("--name", options.name, "Name of the walls, such as the room");
    command.add_flag("--force", options.force, "Overwrite an existing file");
}

void add_displays_new(CLI::App& displays, const std::shared_ptr<DisplaysArguments>& options, int& exit_code) {
    CLI::App* made = add_displays_command(displays, *options, "new",
                                          "Write an example, to be changed to the walls of a room");
    made->add_option("--kind", options->kind,
                     "cave: five walls of a box; wall: one large wall; desk: a screen above a table")
        ->check(CLI::IsMember(content::display_kind_names()))
        ->capture_default_str();
    made->add_option("--stereo", options->stereo, "How the walls show the pictures for two eyes")
        ->check(CLI::IsMember(stereo_mode_names()))
        ->capture_default_str();
    add_writing_options(*made, *options);
    made->callback([options, &exit_code] {
        const Status done = make_displays(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

void add_displays_check(CLI::App& displays, const std::shared_ptr<DisplaysArguments>& options,
                        int& exit_code) {
    CLI::App* checked =
        add_displays_command(displays, *options, "check",
                             "List the walls and report every mistake: exit code 0 if there is none, 1 if "
                             "the walls do not fit the monitors of this computer, 3 if the file is wrong");
    checked
        ->add_option(
            "--rank", options->process,
            "Number of the process that shows the walls of this computer, as the file's outputs have it")
        ->check(CLI::Range(0, 63))
        ->capture_default_str();
    checked->add_flag(
        "--without-monitors", options->without_monitors,
        "Do not compare the outputs with the monitors, because the walls belong to another computer");
    checked->callback([options, &exit_code] { exit_code = check_display_file(*options); });
}

void add_displays_import(CLI::App& displays, const std::shared_ptr<DisplaysArguments>& options,
                         int& exit_code) {
    CLI::App* imported =
        displays.add_subcommand("import",
                                "Make a file from ParaView's description of a cave; exit code 3 if one "
                                "of the two is wrong");
    imported->add_option("PVX", options->pvx, "ParaView's file, .pvx")->required();
    imported->add_option("FILE", options->file, "The display file to write")->required();
    imported
        ->add_option(
            "--eye-height", options->pvx_options.eye_height,
            "Height of ParaView's origin above the floor, m, if it is between the viewer's eyes: all "
            "walls are raised by it")
        ->check(CLI::Range(0.3, 3.0));
    imported
        ->add_option("--scale", options->pvx_options.scale,
                     "Metres per unit of ParaView's file, such as 0.01")
        ->check(CLI::Range(1e-4, 1e4))
        ->capture_default_str();
    add_writing_options(*imported, *options);
    imported->callback([options, &exit_code] { exit_code = import_displays(*options); });
}

void add_displays_track(CLI::App& displays, const std::shared_ptr<DisplaysArguments>& options,
                        int& exit_code) {
    CLI::App* tracked =
        add_displays_command(displays, *options, "track",
                             "Show where the tracker sees the head, in the room: exit code 0 if it was "
                             "seen, 1 if not");
    tracked->add_option("--seconds", options->seconds, "Duration")
        ->check(CLI::Range(0.0, 86400.0))
        ->capture_default_str();
    tracked->callback([options, &exit_code] { exit_code = track_head(*options); });
}

}  // namespace

void add_displays(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<DisplaysArguments>();
    CLI::App* displays = app.add_subcommand(
        "displays",
        "Make, check, import or try the file that describes projection walls and the tracker of the head");
    displays->require_subcommand(1);
    add_displays_new(*displays, options, exit_code);
    add_displays_check(*displays, options, exit_code);
    add_displays_import(*displays, options, exit_code);
    add_displays_test(*displays, exit_code);
    add_displays_track(*displays, options, exit_code);
}

}  // namespace bolt::cli
