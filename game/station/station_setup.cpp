#include "game/station/station_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "content/format/folders.hpp"
#include "content/station/wheel_config_file.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "engine/base/nearest.hpp"
#include "engine/base/serial_port.hpp"
#include "game/motion/path_planning.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "game/session/resume.hpp"
#include "haptics/device/device.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::station_setup {

std::optional<DeviceRole> role_of(device::DeviceKind kind) {
    switch (kind) {
        case device::DeviceKind::arm:
        case device::DeviceKind::puck:
            return DeviceRole::mover;
        case device::DeviceKind::open_ffboard:
        case device::DeviceKind::wheel:
            return DeviceRole::wheel;
        case device::DeviceKind::other:
            break;
    }
    return std::nullopt;
}

const char* describe(DeviceRole role) {
    return role == DeviceRole::mover ? "moves the tool" : "turns the wrench on its bolt";
}

Result<device::ListedDevice> find_device(std::span<const device::ListedDevice> connected,
                                         const std::string& id) {
    std::vector<std::string> ids;
    for (const device::ListedDevice& l : connected) {
        ids.push_back(l.id);
        if (l.id != id) continue;
        if (!l.usable()) return fail(*l.error);
        return l;
    }
    const std::string near = nearest(id, ids);
    return fail(ErrorCode::no_device, fmt::format("there is no device {}", id),
                near.empty() ? "one that `boltwright devices` lists" : fmt::format("did you mean {}?", near));
}

Result<DeviceSelection> select_devices(std::span<const device::ListedDevice> connected,
                                       std::span<const std::string> ids) {
    DeviceSelection selection;
    for (const std::string& id : ids) {
        BOLT_TRY_ASSIGN(const auto found, find_device(connected, id));
        const std::optional<DeviceRole> role = role_of(found.kind);
        if (!role)
            return fail(ErrorCode::usage, fmt::format("{} ({}) cannot be used for training", id, found.name),
                        "a force-feedback arm, a SpaceMouse, an OpenFFBoard or a wheel with force feedback");
        std::optional<device::ListedDevice>& slot =
            *role == DeviceRole::mover ? selection.mover : selection.wheel;
        if (slot)
            return fail(ErrorCode::usage,
                        fmt::format("{} and {} have the same role ({})", slot->id, id, describe(*role)),
                        "only one of them");
        slot = found;
    }
    return selection;
}

DeviceSelection select_any_devices(std::span<const device::ListedDevice> connected) {
    DeviceSelection selection;
    for (const device::ListedDevice& l : connected) {
        const std::optional<DeviceRole> role = role_of(l.kind);
        if (!role || !l.usable()) continue;
        std::optional<device::ListedDevice>& slot =
            *role == DeviceRole::mover ? selection.mover : selection.wheel;
        if (!slot) slot = l;
    }
    return selection;
}

std::vector<std::string> ids_of(const DeviceSelection& selection) {
    std::vector<std::string> ids;
    for (const auto* one : {&selection.mover, &selection.wheel})
        if (one->has_value()) ids.push_back((*one)->id);
    return ids;
}

namespace {

// `id`: the device that the station file names for this role; empty: it names none.
Status check_role(std::span<const device::ListedDevice> connected, const std::vector<std::string>& ids,
                  const std::string& id, DeviceRole role) {
    if (id.empty()) return {};
    for (const device::ListedDevice& l : connected) {
        const bool same_role = role_of(l.kind) == role;
        const char* member = role == DeviceRole::mover ? "arm" : "wheel";
        if (l.id == id && !same_role)
            return fail(
                ErrorCode::bad_content,
                fmt::format("{} is the \"{}\" of the station, but is another kind of device", id, member),
                fmt::format("one that {}", describe(role)));
        if (l.id != id && same_role && std::find(ids.begin(), ids.end(), l.id) != ids.end())
            return fail(
                ErrorCode::usage,
                fmt::format("--device {}: the settings of the station's \"{}\" are for {}", l.id, member, id),
                "that device, or no --station");
    }
    return {};
}

}  // namespace

Status add_devices_of(const content::StationFile& station, std::span<const device::ListedDevice> connected,
                      std::vector<std::string>& ids) {
    const std::string arm = station.arm ? station.arm->device : std::string();
    const std::string wheel = station.wheel ? station.wheel->device : std::string();
    BOLT_TRY(check_role(connected, ids, arm, DeviceRole::mover));
    BOLT_TRY(check_role(connected, ids, wheel, DeviceRole::wheel));
    if (!ids.empty()) return {};
    for (const std::string& id : {arm, wheel})
        if (!id.empty()) ids.push_back(id);
    return {};
}

namespace {

namespace fs = std::filesystem;

constexpr int max_latency_timer = 2;   // ms
constexpr double glove_timeout = 6.0;  // s; the handshake sends each query up to three times

// A flat bar along x that an average right hand encloses: its offset, m, and its rotation about y, rad, from
// the wrist.
constexpr Vec3 handle_offset(0.0, -0.028, -0.098);
constexpr double handle_angle = to_radians(-17.5);
// Fractions of a full closure at which grasps of the handle are tested; a grasp is not a clenched fist.
constexpr std::array closures{0.7, 0.8, 0.9, 1.0};

// Offsets to try, m, nearest first, because a thin handle lies deeper in the fingers.
std::vector<Vec3> candidate_offsets() {
    std::vector<Vec3> all;
    for (int y = -3; y <= 3; ++y)
        for (int z = -4; z <= 4; ++z) all.emplace_back(0.0, 0.004 * y, 0.005 * z);
    std::stable_sort(all.begin(), all.end(),
                     [](const Vec3& a, const Vec3& b) { return glm::length(a) < glm::length(b); });
    return all;
}

Pose wrist_at(const hand::Hand& hand, const Vec3& offset, double along) {
    Pose wrist = inverse(Pose{hand.scale * (handle_offset + offset), rotation({0.0, handle_angle, 0.0})});
    if (hand.side == hand::Side::left) {
        // Mirrored along the handle, then rotated about its thickness so that the thumb points to the jaw.
        wrist = Pose{Vec3(0.0), rotation({0.0, pi, 0.0})} * hand::mirrored(wrist);
    }
    // The handle's thickness is along the jaw's normal.
    return Pose{Vec3(along, 0.0, 0.0), rotation({0.5 * pi, 0.0, 0.0})} * wrist;
}

const char* name(hand::Side hand) { return hand == hand::Side::left ? "left" : "right"; }

}  // namespace

Result<fs::path> calibrations_folder() {
    BOLT_TRY_ASSIGN(const auto data, user_data_folder());
    return data / "gloves";
}

Result<hand::GloveIdentity> wait_for_glove(hand::GloveDriver& driver, const fs::path& port) {
    const device::Timer timer = device::steady_timer();
    const double deadline = timer.now() + glove_timeout;
    while (driver.sample().number == 0) {
        const hand::GloveReport& report = driver.report();
        const bool has_message = report.fault_message[0] != '\0';
        // Fails at once if the port cannot be opened or another device answers; otherwise waits for an
        // answer.
        if ((has_message && report.state == hand::GloveState::rejected) ||
            (has_message && !report.open && report.openings == 0) || timer.now() > deadline)
            return fail(
                ErrorCode::no_device,
                fmt::format("{}: {}", port.string(), has_message ? report.fault_message.data() : "no answer"),
                has_message ? "" : "a CyberGlove that is switched on");
        timer.wait(0.01);
    }
    return driver.report().identity;
}

Result<hand::GloveIdentity> find_glove(const fs::path& port) {
    BOLT_TRY(check_port_access(port));
    hand::GloveDriver driver = hand::GloveDriver::start(port);
    return wait_for_glove(driver, port);
}

std::string adapter_warning(const fs::path& port) {
    const auto ms = latency_timer_ms(port);
    if (!ms || *ms <= max_latency_timer) return {};
    return fmt::format(
        "its adapter delays bytes by {} ms: install the udev rule (60-boltwright.rules) and reconnect it",
        *ms);
}

Result<content::GloveCalibration> find_calibration(const std::string& trainee,
                                                   const hand::GloveIdentity& glove, const fs::path& folder) {
    BOLT_TRY_ASSIGN(const auto where, folder.empty() ? calibrations_folder() : folder);
    const fs::path path = content::glove_calibration_path(where, trainee, glove.side);
    const std::string remedy =
        fmt::format("one made with `boltwright glove calibrate --trainee \"{}\"`", trainee);
    std::error_code failed;
    if (!fs::exists(path, failed))
        return fail(
            ErrorCode::bad_content,
            fmt::format("no calibration of {}'s {} hand in {}", trainee, name(glove.side), where.string()),
            remedy);
    Result<content::GloveCalibration> stored = content::load_glove_calibration(path);
    if (stored && stored->sensors != glove.sensors)
        return fail(ErrorCode::bad_content,
                    fmt::format("{} is for a glove with {} sensors, and this one has {}", path.string(),
                                stored->sensors, glove.sensors),
                    remedy);
    return stored;
}

Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along) {
    Pose best;
    int most = -1;
    for (const Vec3& offset : candidate_offsets()) {
        const Pose wrist = wrist_at(hand, offset, along);
        int held = 0;
        for (const double share : closures) {
            hand::GraspState grasp;
            hand::update_grasp(grasp, {}, tool, hand, {true, hand::closed_hand_angles(share), wrist}, 0.01);
            held += grasp.grasping ? 1 : 0;
        }
        if (held <= most) continue;
        most = held;
        best = wrist;
    }
    return best;
}

hand::GloveWearer wearer_of(const content::GloveCalibration& calibration) {
    hand::GloveWearer wearer;
    wearer.calibration = calibration.calibration;
    wearer.hand = hand::make_hand(calibration.hand, calibration.hand_length);
    return wearer;
}

Result<station::HandSetup> make_hand_setup(const content::Assembly& assembly,
                                           const content::GloveCalibration& calibration) {
    BOLT_TRY_ASSIGN(auto tool, session::load_wrench(assembly));
    hand::GloveWearer wearer = wearer_of(calibration);
    const Pose wrist = wrist_at_handle(wearer.hand, tool, assembly.wrench.handle_length);
    return station::HandSetup{std::move(wearer), std::move(tool), wrist, {}};
}

namespace {

constexpr double stroke = to_radians(30.0);  // rad, free swing of the handle
constexpr double clearance = 1e-3;           // m below the wrench

// The initial state of the servo. It is built before a device is opened, because this takes seconds and the
// device would time out.
struct InitialState {
    content::Assembly assembly;
    std::uint64_t seed = 0;
    bool tightened = false;  // the lesson loosens
    std::vector<joint::JointState> joints;
    std::optional<servo::ToolContact> contact;

    [[nodiscard]] servo::Setup setup(const force::OutputLimits& limits, double dt) const {
        servo::Setup setup = session::make_setup(assembly, assembly.law, limits, seed, dt);
        servo::set_ratchets(setup, tightened);
        return setup;
    }
    // Moves the obstacles out, so call it only once.
    servo::State take_state(const servo::Setup& setup) {
        servo::State state = servo::initial_state(setup);
        state.joints = joints;
        if (contact) servo::set_coupling(setup, *contact);
        state.tool_contact = std::exchange(contact, std::nullopt);
        return state;
    }
};

Status open_glove(const content::Assembly& assembly, const StationRequest& request, PlannedStation& planned) {
    if (request.glove.empty()) return {};
    planned.glove = planned.options.glove = request.glove;
    BOLT_TRY_ASSIGN(const auto glove, find_glove(request.glove));
    if (request.trainee.empty()) return {};
    BOLT_TRY_ASSIGN(const auto calibration, find_calibration(request.trainee, glove, request.calibrations));
    BOLT_TRY_ASSIGN(auto hand, make_hand_setup(assembly, calibration));
    planned.calibration = calibration;
    planned.options.hand = std::move(hand);
    return {};
}

// True if the settings of the station file are for the device that moves the tool.
bool is_mover_of(const content::StationFile& station, const DeviceSelection& selection) {
    return station.arm && selection.mover && selection.mover->id == station.arm->device;
}

Status choose_devices(const StationRequest& request, PlannedStation& planned) {
    std::optional<device::WheelConfig> given;
    if (!request.wheel_config_file.empty()) {
        BOLT_TRY_ASSIGN(const auto read, content::load_wheel_config(request.wheel_config_file));
        given = read;
    }
    const Result<DeviceSelection> selection = select_devices(device::list_devices(true), request.devices);
    if (!selection) return fail(selection.error());
    planned.devices = *selection;
    const device::WheelConfig of_station = apply_station(request.station, planned);
    const device::WheelConfig wheel_config = given.value_or(of_station);
    planned.options.on_preparation = request.arm_dialog.on_preparation;
    device::OpenOptions of_mover{wheel_config};
    if (is_mover_of(request.station, *selection)) of_mover.effector_mass = request.station.arm->effector_mass;
    of_mover.permission = request.arm_dialog.permission;
    if (selection->mover) planned.options.mover = device::factory_for(selection->mover->id, of_mover);
    if (selection->wheel) planned.options.wheel = device::factory_for(selection->wheel->id, {wheel_config});
    if (!selection->mover) planned.options.mover = request.fallback_mover;
    return {};
}

// m. The scale of an arm is fitted to it (force::fitted_scale()), so that every tool of the lesson can swing.
double longest_handle(const servo::Setup& setup) {
    double longest = setup.wrench.handle_length;
    for (const servo::ToolSetup& tool : setup.tools) longest = std::max(longest, tool.wrench.handle_length);
    return longest;
}

}  // namespace

device::WheelConfig apply_station(const content::StationFile& station, PlannedStation& planned) {
    const DeviceSelection& selection = planned.devices;
    station::StationOptions& options = planned.options;
    if (is_mover_of(station, selection)) {
        const content::StationMover& arm = *station.arm;
        options.workspace = {content::orientation_of(arm.mounting), arm.scale, arm.power_ratio};
        options.mover_limit_bounds = arm.limits;
        options.mover_buttons = arm.buttons.value_or(options.mover_buttons);
    }
    if (!station.wheel || !selection.wheel || selection.wheel->id != station.wheel->device) return {};
    options.wheel_buttons = station.wheel->buttons.value_or(options.wheel_buttons);
    return station.wheel->config;
}

Pose initial_wrench_pose(const servo::Setup& setup, const servo::ToolContact* contact, std::size_t joint,
                         const joint::JointState& state) {
    const motion::HandleAngle handle =
        motion::choose_handle_angle(setup, contact, joint, state, state.rotation(), 1.0, stroke);
    const servo::NutGeometry& nut = setup.nuts[joint];
    // Raises a head that is thicker than the nut, so that it does not penetrate the nut's seat.
    const double above =
        std::max(0.0, 0.5 * (collision::thickness(setup.wrench.head) - nut.height) + clearance);
    return {servo::nut_centre(nut, state.nut.angle) + above * nut.axis,
            motion::tool_orientation(nut, handle.angle, handle.flipped)};
}

Result<PlannedStation> plan_station(const content::Assembly& assembly, const StationRequest& request) {
    PlannedStation planned;
    BOLT_TRY(choose_devices(request, planned));
    BOLT_TRY(open_glove(assembly, request, planned));

    const auto initial = std::make_shared<InitialState>();
    initial->assembly = assembly;
    initial->tightened = request.tightened;
    initial->seed = request.seed;
    const servo::Setup setup = initial->setup({}, 1.0 / planned.options.servo.rate);
    servo::State state = servo::initial_state(setup);
    if (request.tightened) BOLT_TRY(session::pretighten(assembly, setup, state));
    initial->joints = state.joints;
    if (request.obstacles) {
        Result<std::optional<servo::ToolContact>> contact = session::load_tool_contact(assembly, setup);
        if (!contact) return fail(contact.error());
        initial->contact = std::move(*contact);
        if (initial->contact && request.tightened) session::seat_nuts(setup, *initial->contact);
    }
    planned.obstacles = initial->contact.has_value();
    planned.options.handle_length = longest_handle(setup);
    planned.options.home = initial_wrench_pose(setup, initial->contact ? &*initial->contact : nullptr,
                                               request.joint, state.joints[request.joint]);
    planned.options.make_setup = [initial](const force::OutputLimits& limits, double dt) {
        return initial->setup(limits, dt);
    };
    planned.options.make_state = [initial](const servo::Setup& made) -> Result<servo::State> {
        return initial->take_state(made);
    };
    return planned;
}

Result<PlannedStation> plan_lesson_station(const content::Assembly& assembly,
                                           const session::LessonOptions& lesson,
                                           const StationRequest& request, const Pose& home) {
    struct PreparedLesson {
        session::LessonOptions options;
        session::SessionSetup setup;
        Status repeated;  // the ticks of an interrupted lesson
    };
    PlannedStation planned;
    BOLT_TRY(choose_devices(request, planned));
    BOLT_TRY(open_glove(assembly, request, planned));
    BOLT_TRY_ASSIGN(auto prepared, session::prepare_session(assembly, lesson));
    const auto start = std::make_shared<PreparedLesson>(PreparedLesson{lesson, std::move(prepared), {}});
    planned.obstacles = start->setup.state.tool_contact.has_value();
    planned.options.home = home;
    planned.options.handle_length = longest_handle(start->setup.setup);
    planned.options.servo.rate = 1.0 / lesson.dt;
    planned.options.make_setup = [start, scale = request.force_scale](const force::OutputLimits& limits,
                                                                      double) {
        start->options.device_limits = force::scaled(limits, scale);
        session::set_device_limits(start->options, start->setup);
        // With other limits the lesson begins again (trainer::start_lesson).
        const std::optional<session::InterruptedLesson>& interrupted = start->options.continues;
        if (interrupted && session::check_same_lesson(*interrupted, start->setup, start->options))
            start->repeated = session::repeat_ticks(*interrupted, start->setup);
        return start->setup.setup;
    };
    planned.options.make_state = [start](const servo::Setup&) -> Result<servo::State> {
        BOLT_TRY(start->repeated);
        return std::move(start->setup.state);
    };
    return planned;
}

}  // namespace bolt::station_setup
