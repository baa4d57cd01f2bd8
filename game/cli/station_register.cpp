// boltwright station register: measures where one frame of a station is in another, and stores or checks it.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <ctime>
#include <memory>

#include "content/station/point_table.hpp"
#include "content/station/station_file.hpp"
#include "engine/xr/pose_tracker.hpp"
#include "game/cli/commands.hpp"
#include "game/station/controller_tip.hpp"
#include "game/station/frame_registration.hpp"
#include "game/station/point_source.hpp"
#include "game/station/station_setup.hpp"
#include "game/station/worn_glove.hpp"

namespace bolt::cli {

namespace {

struct RegisterArguments {
    std::string file, points, device, targets, controller, hand, trainee, tracker, from, to = "room";
    std::vector<double> tip{};  // empty: with --check the stored tip, else the handle's origin
    std::vector<double> controller_tip{0.0, 0.0, 0.0};
    std::size_t count = 7;
    bool find_tip = false, check = false, force = false, yes = false;
};

struct FramePair {
    content::CoordinateFrame from, to;
};

// The role of the Vive tracker that is fixed to the gloved hand; none: a controller is.
std::optional<TrackerRole> wrist_tracker_of(const RegisterArguments& options,
                                            const content::StationFile& station) {
    return options.tracker.empty() ? station.wrist_tracker : parse_tracker_role(options.tracker);
}

Result<FramePair> frames_of(const RegisterArguments& options, const content::StationFile& station) {
    if (!options.hand.empty())
        return FramePair{content::CoordinateFrame::hand,
                         station_setup::wrist_frame(wrist_tracker_of(options, station))};
    const std::string from = !options.from.empty()    ? options.from
                             : options.points.empty() ? "arm"
                                                      : "tracker";
    const auto frame = [](const char* option, const std::string& text) -> Result<content::CoordinateFrame> {
        const auto parsed = content::parse_coordinate_frame(text);
        if (!parsed)
            return fail(ErrorCode::usage, fmt::format("{}: {}", option, parsed.error().what),
                        parsed.error().expected);
        return *parsed;
    };
    BOLT_TRY_ASSIGN(const auto first, frame("--from", from));
    BOLT_TRY_ASSIGN(const auto second, frame("--to", options.to));
    if (first == second)
        return fail(ErrorCode::usage, fmt::format("--from and --to are both \"{}\"", from), "two frames");
    if (const auto unused = station_setup::unused_registration(first, second)) return fail(*unused);
    if (options.points.empty() && first != content::CoordinateFrame::arm)
        return fail(ErrorCode::usage, fmt::format("--from {}: an arm touches the points", from),
                    "--from arm, or --points FILE");
    if (!options.controller.empty() && second != content::CoordinateFrame::room)
        return fail(ErrorCode::usage,
                    fmt::format("--to {}: a controller measures points in the room", options.to),
                    "--to room, or --targets FILE");
    return FramePair{first, second};
}

// pressed() is true if a line has arrived on the standard input since the last call; never after its end.
class EnterKey {
  public:
    bool pressed() {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        bool line = false;
        while (!ended_ && ::poll(&input, 1, 0) == 1) {
            std::array<char, 256> bytes{};
            const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
            ended_ = count <= 0;
            for (ssize_t i = 0; i < count; ++i) line = line || bytes[static_cast<std::size_t>(i)] == '\n';
        }
        return line;
    }

  private:
    bool ended_ = false;
};

// The id of the arm that touches the points.
Result<std::string> arm_of(const RegisterArguments& options, const content::StationFile& station) {
    if (!station.arm)
        return fail(ErrorCode::bad_content, fmt::format("{}: the station has no \"arm\"", options.file),
                    "an arm, or --points FILE");
    if (!options.device.empty() && options.device != station.arm->device)
        return fail(
            ErrorCode::usage,
            fmt::format("--device {}: the station's \"arm\" is {}", options.device, station.arm->device),
            "that device");
    return station.arm->device;
}

void show_line(std::string_view line) { fmt::print(stderr, "{}\n", line); }

Vec3 point_of(const std::vector<double>& option) {
    return option.empty() ? Vec3(0.0) : Vec3(option[0], option[1], option[2]);
}

// Opens the station's arm, whose tip touches points.
Result<OpenDevice> open_arm(const RegisterArguments& options, const content::StationFile& station) {
    BOLT_TRY_ASSIGN(const std::string id, arm_of(options, station));
    device::OpenOptions opening;
    opening.effector_mass = station.arm->effector_mass;
    BOLT_TRY_ASSIGN(OpenDevice device, open_device(id, opening, options.yes));
    if (device.description->sensing != device::Sensing::pose)
        return fail(ErrorCode::no_device, fmt::format("{} senses no position", id), "a force-feedback arm");
    if (!device.description->senses_rotation && point_of(options.tip) != Vec3(0.0))
        return fail(ErrorCode::usage, fmt::format("--tip: {} senses no rotation of its handle", id),
                    "its own point, without --tip");
    return device;
}

// The functions with which ArmTip reads the arm and the Enter key; the arguments must outlive them.
station_setup::TouchIo arm_io(OpenDevice& device, EnterKey& enter) {
    return {[&device] { return device.thread.snapshot(); }, [&enter] { return enter.pressed(); },
            [] { return interrupted(); }, show_line, device::steady_timer()};
}

// Measures the targets with the tip of the station's arm.
Result<std::vector<PointPair>> touch(const RegisterArguments& options, const content::StationFile& station,
                                     std::span<const Vec3> targets) {
    BOLT_TRY_ASSIGN(OpenDevice device, open_arm(options, station));
    catch_interruption();
    EnterKey enter;
    station_setup::ArmTip source(arm_io(device, enter), point_of(options.tip));
    return station_setup::measure_points(source, targets);
}

// The glove of the station on its wearer's hand.
Result<station_setup::WornGlove> open_glove(const RegisterArguments& options,
                                            const content::StationFile& station) {
    if (station.glove_port.empty())
        return fail(ErrorCode::bad_content, fmt::format("{}: the station has no \"glove\"", options.file),
                    "a glove, or --points FILE --from hand --to controller");
    BOLT_TRY_ASSIGN(const auto folder, station_setup::calibrations_folder());
    BOLT_TRY_ASSIGN(const auto person, person_argument(options.trainee, folder, NewPerson::unchanged));
    BOLT_TRY_ASSIGN(const auto glove, station_setup::find_glove(station.glove_port));
    const std::string_view side = glove.side == hand::Side::left ? "left" : "right";
    if (side != options.hand)
        return fail(ErrorCode::usage, fmt::format("--hand {}: the glove is a {} one", options.hand, side),
                    fmt::format("--hand {}", side));
    BOLT_TRY_ASSIGN(
        const auto calibration,
        station_setup::find_calibration(person.code.empty() ? person.name : person.code, glove, folder));
    return station_setup::WornGlove::start(station.glove_port, station_setup::wearer_of(calibration));
}

// Opens the PoseTracker of the controller, or of the Vive tracker with `role`. Fails without a stage, because
// only the stage is fixed in the room.
Result<std::unique_ptr<xr::PoseTracker>> open_controller(const std::string& side,
                                                         const std::optional<TrackerRole>& role = {}) {
    BOLT_TRY_ASSIGN(auto tracker, role ? xr::PoseTracker::open(*role)
                                  : side == "left"
                                      ? xr::PoseTracker::open(xr::TrackedDevice::left_controller)
                                      : xr::PoseTracker::open(xr::TrackedDevice::right_controller));
    if (!tracker->in_stage())
        return fail(ErrorCode::no_device, "the headset has no stage, so its poses are not fixed in the room",
                    "a headset whose room is set up");
    return tracker;
}

// The functions with which ControllerTip reads the controller and the Enter key; the arguments must outlive
// them.
station_setup::ControllerIo controller_io(xr::PoseTracker& tracker, EnterKey& enter) {
    const auto read = [&tracker]() -> Result<station_setup::ControllerSample> {
        BOLT_TRY_ASSIGN(const std::optional<Pose> pose, tracker.read());
        return station_setup::ControllerSample{pose, tracker.pressed(), tracker.origin_moves(),
                                               tracker.fault()};
    };
    return {read, [&enter] { return enter.pressed(); }, [] { return interrupted(); }, show_line,
            device::steady_timer()};
}

// Measures `count` points with the controller and with the tip of the station's arm.
Result<std::vector<PointPair>> touch_with_both(const RegisterArguments& options,
                                               const content::StationFile& station, std::size_t count) {
    BOLT_TRY(arm_of(options, station));  // a mistake in the file is reported before any device is opened
    BOLT_TRY_ASSIGN(const auto tracker, open_controller(options.controller));
    BOLT_TRY_ASSIGN(OpenDevice device, open_arm(options, station));
    catch_interruption();
    EnterKey enter;
    station_setup::ArmTip arm(arm_io(device, enter), point_of(options.tip));
    station_setup::ControllerTip controller(controller_io(*tracker, enter), point_of(options.controller_tip));
    if (options.find_tip) BOLT_TRY(controller.find_tip());
    return station_setup::measure_pairs(arm, controller, count);
}

// Measures the fingertips of a gloved hand in the frame of the controller or tracker that is fixed to it.
Result<std::vector<PointPair>> turn_about_fingertips(const RegisterArguments& options,
                                                     const content::StationFile& station) {
    BOLT_TRY_ASSIGN(auto glove, open_glove(options, station));
    const std::optional<TrackerRole> role = wrist_tracker_of(options, station);
    BOLT_TRY_ASSIGN(const auto tracker, open_controller(options.hand, role));
    catch_interruption();
    EnterKey enter;
    station_setup::ControllerIo io = controller_io(*tracker, enter);
    if (role) io.device = station_setup::vive_tracker_words;
    station_setup::ControllerTip controller(std::move(io), Vec3(0.0));
    return station_setup::measure_fingertips(controller, [&]() -> Result<hand::Skeleton> {
        glove.update();
        const station_setup::WornFingers& fingers = glove.fingers();
        if (!fingers.measured || fingers.lost)
            return fail(ErrorCode::no_device, "the glove sends no samples", "a glove that stays connected");
        return fingers.joints;
    });
}

Result<std::vector<PointPair>> measured_pairs(const RegisterArguments& options,
                                              const content::StationFile& station) {
    if (!options.points.empty()) return content::load_point_pairs(options.points);
    if (!options.hand.empty()) return turn_about_fingertips(options, station);
    if (!options.controller.empty()) return touch_with_both(options, station, options.count);
    if (options.targets.empty())
        return fail(
            ErrorCode::usage, "the points to touch are not given",
            "--targets FILE, --controller SIDE, --hand SIDE, or --points FILE with points that a tracker has "
            "measured");
    BOLT_TRY_ASSIGN(const std::vector<Vec3> targets, content::load_points(options.targets));
    if (targets.size() < 4)
        return fail(ErrorCode::bad_content,
                    fmt::format("{}: {} points are too few", options.targets, targets.size()),
                    "at least 4, of which the last is the check point");
    return touch(options, station, targets);
}

// Reads the file again before it stores the registration, because the user may have edited it meanwhile.
Status store(const RegisterArguments& options, const content::Registration& registration) {
    BOLT_TRY_ASSIGN(content::StationFile station, content::load_station(options.file));
    content::set_registration(station.registrations, registration);
    if (!options.tracker.empty()) station.wrist_tracker = wrist_tracker_of(options, station);
    return content::save_station(options.file, station);
}

Status register_station(const RegisterArguments& options) {
    BOLT_TRY_ASSIGN(const content::StationFile station, content::load_station(options.file));
    BOLT_TRY_ASSIGN(const FramePair frames, frames_of(options, station));
    BOLT_TRY_ASSIGN(const std::vector<PointPair> pairs, measured_pairs(options, station));
    const std::string date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    BOLT_TRY_ASSIGN(auto measured, station_setup::register_frames(frames.from, frames.to, pairs, date));
    measured.registration.tip = point_of(options.tip);
    std::string text = station_setup::describe(measured);
    for (const std::string& warning : station_setup::warnings_of(measured))
        text += fmt::format("  warning: {}\n", warning);
    BOLT_TRY(print(text));
    if (Status good = station_setup::check_quality(measured); !good) {
        if (!options.force) {
            good.error().expected += ", or --force to store it";
            return good;
        }
        BOLT_TRY(print(fmt::format("  warning: {}\n", good.error().message())));
    }
    BOLT_TRY(store(options, measured.registration));
    return print(fmt::format("{}: stored\n", options.file));
}

// Compares the stored registration with a touch of its check point, with a point that the arm and a
// controller touch, with the fingertips of a gloved hand, or with the points of a file. Fails if a point is
// off by more than the limit.
Status check_registration(RegisterArguments options) {
    BOLT_TRY_ASSIGN(const content::StationFile station, content::load_station(options.file));
    BOLT_TRY_ASSIGN(const FramePair frames, frames_of(options, station));
    auto found = station_setup::registration_from(station.registrations, frames.from, frames.to);
    if (!found) {
        found.error().file = options.file;
        return fail(found.error());
    }
    if (options.tip.empty()) options.tip = {found->tip.x, found->tip.y, found->tip.z};
    std::vector<PointPair> pairs;
    if (!options.points.empty()) {
        BOLT_TRY_ASSIGN(pairs, content::load_point_pairs(options.points));
    } else if (!options.hand.empty()) {
        BOLT_TRY_ASSIGN(pairs, turn_about_fingertips(options, station));
    } else if (!options.controller.empty()) {
        BOLT_TRY_ASSIGN(pairs, touch_with_both(options, station, 1));
    } else if (found->check_point) {
        BOLT_TRY_ASSIGN(pairs, touch(options, station, std::array{found->check_point->to}));
    }
    if (pairs.empty())
        return fail(ErrorCode::bad_content, "there is no point to check",
                    "a check point, --controller SIDE, or --points FILE");
    double most = 0.0;
    for (const PointPair& pair : pairs) most = std::max(most, glm::length(found->pose * pair.from - pair.to));
    const std::string text = fmt::format("{} -> {} of {}: off by {:.1f} mm", content::name(frames.from),
                                         content::name(frames.to), found->date, most / mm);
    const double limit = station_setup::limits_between(frames.from, frames.to).check_error;
    if (!(most <= limit))
        return fail(ErrorCode::failed, text, fmt::format("at most {:.0f} mm; register it again", limit / mm));
    return print(text + "\n");
}

}  // namespace

// Adds the options of the arm and of the controller, which touch the points.
void add_touch_options(CLI::App& command, RegisterArguments& options, CLI::Option* points) {
    command
        .add_option("--device", options.device,
                    "Id of the arm whose tip touches the points; default: that of the station file")
        ->excludes(points);
    CLI::Option* targets = command.add_option(
        "--targets", options.targets,
        "CSV file with the title x,y,z: the points to touch, m, in the second frame; the last is "
        "the check point");
    targets->excludes(points);
    const auto add_tip = [&](const char* name, std::vector<double>& tip, const char* text) {
        return command.add_option(name, tip, text)->delimiter(',')->expected(3)->check(CLI::Range(-1.0, 1.0));
    };
    add_tip("--tip", options.tip,
            "Position x,y,z of the tip in the frame of the handle, m; default: 0,0,0, with --check that of "
            "the registration")
        ->excludes(points);
    CLI::Option* controller = command.add_option(
        "--controller", options.controller,
        "left or right: the headset's controller that touches each point of the user's choice before the arm "
        "does; no file of points is needed");
    controller->check(CLI::IsMember({"left", "right"}))->excludes(points)->excludes(targets);
    CLI::Option* hand = command.add_option("--hand", options.hand,
                                           "left or right: the gloved hand with the headset's controller or "
                                           "a Vive tracker fixed to it, which the wearer turns about each "
                                           "fingertip; measures where the wrist is at that device");
    hand->check(CLI::IsMember({"left", "right"}))->excludes(points)->excludes(targets)->excludes(controller);
    CLI::Option* trainee =
        command.add_option("--trainee", options.trainee, "Name or code of the wearer of the glove");
    trainee->needs(hand);
    hand->needs(trainee);
    command
        .add_option(
            "--tracker", options.tracker,
            "Role of the Vive tracker that is fixed to the gloved hand, such as right_wrist; stored as "
            "the glove's wrist_tracker. Default: that of the station file, else a controller")
        ->check(CLI::IsMember(std::vector<std::string>(tracker_role_names.begin(), tracker_role_names.end())))
        ->needs(hand);
    CLI::Option* controller_tip =
        add_tip("--controller-tip", options.controller_tip,
                "Position x,y,z of the controller's tip in the frame of its grip, m");
    controller_tip->needs(controller);
    command
        .add_flag("--find-tip", options.find_tip,
                  "Measure the controller's tip first: the user turns the controller about it")
        ->needs(controller)
        ->excludes(controller_tip);
    command
        .add_option("--count", options.count,
                    "Number of points to touch with the controller and the arm; the last is the check point")
        ->capture_default_str()
        ->check(CLI::Range(4, 100))
        ->needs(controller);
}

void add_station_register(CLI::App& station, int& exit_code) {
    auto options = std::make_shared<RegisterArguments>();
    CLI::App* command = station.add_subcommand(
        "register",
        "Measure where the arm, or a frame whose points are in a file, is in the room, and store it");
    command->add_option("FILE", options->file, "The station file")->required();
    CLI::Option* points = command->add_option(
        "--points", options->points,
        "CSV file with the title ax,ay,az,bx,by,bz: points in the first frame and in the second, m; the last "
        "is the check point");
    add_touch_options(*command, *options, points);
    command->add_option(
        "--from", options->from,
        "The first frame: arm, tracker, wall, workpiece, room, hand, controller or wrist_tracker; "
        "default: arm, with --points tracker");
    command->add_option("--to", options->to, "The second frame")->capture_default_str();
    command->add_flag(
        "--check", options->check,
        "Store nothing; touch the check point, with --controller a point of the user's choice, or "
        "compare --points: exit code 0 if the stored registration is right to 5 mm "
        "(a hand: 15 mm), 1 if it is not");
    command->add_flag(
        "--force", options->force,
        "Store it even if its rms or its check point exceeds the limit (4 and 5 mm; of a hand 12 and 15 mm)");
    command->add_flag("--yes", options->yes,
                      "Permit an arm to move by itself; without this option the terminal asks");
    command->callback([options, &exit_code] {
        const Status done = options->check ? check_registration(*options) : register_station(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

}  // namespace bolt::cli
