#include "game/station/station_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "content/station/wheel_config_file.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/nearest.hpp"
#include "game/motion/path_planning.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "haptics/device/device.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::station_setup {

std::optional<Use> use_of(device::HidKind kind) {
    switch (kind) {
        case device::HidKind::puck:
            return Use::mover;
        case device::HidKind::board:
        case device::HidKind::wheel:
            return Use::wheel;
        case device::HidKind::other:
            break;
    }
    return std::nullopt;
}

const char* words(Use use) { return use == Use::mover ? "moves the tool" : "turns the wrench on its bolt"; }

Result<device::ListedDevice> find(std::span<const device::ListedDevice> there, const std::string& id) {
    std::vector<std::string> ids;
    for (const device::ListedDevice& l : there) {
        ids.push_back(l.id);
        if (l.id != id) continue;
        if (l.trouble) return fail(*l.trouble);
        return l;
    }
    const std::string near = nearest(id, ids);
    return fail(ErrorCode::no_device, fmt::format("there is no device {}", id),
                near.empty() ? "one that `boltwright devices` lists" : fmt::format("did you mean {}?", near));
}

Result<Choice> choose(std::span<const device::ListedDevice> there, std::span<const std::string> ids) {
    Choice choice;
    for (const std::string& id : ids) {
        BOLT_TRY_ASSIGN(const auto found, find(there, id));
        const std::optional<Use> use = use_of(found.kind);
        if (!use)
            return fail(ErrorCode::usage, fmt::format("{} ({}) is nothing to train with", id, found.name),
                        "a SpaceMouse, an OpenFFBoard or a wheel with force feedback");
        std::optional<device::ListedDevice>& place = *use == Use::mover ? choice.mover : choice.wheel;
        if (place)
            return fail(ErrorCode::usage,
                        fmt::format("both {} and {} are one that {}", place->id, id, words(*use)),
                        "one of them");
        place = found;
    }
    return choice;
}

Choice choose_any(std::span<const device::ListedDevice> there) {
    Choice choice;
    for (const device::ListedDevice& l : there) {
        const std::optional<Use> use = use_of(l.kind);
        if (!use || l.trouble) continue;
        std::optional<device::ListedDevice>& place = *use == Use::mover ? choice.mover : choice.wheel;
        if (!place) place = l;
    }
    return choice;
}

std::vector<std::string> ids_of(const Choice& choice) {
    std::vector<std::string> ids;
    for (const auto* one : {&choice.mover, &choice.wheel})
        if (one->has_value()) ids.push_back((*one)->id);
    return ids;
}

namespace {

namespace fs = std::filesystem;

constexpr int longest_latency_timer = 2;  // ms
constexpr double patience = 6.0;          // s; the handshake sends each query three times before it gives up

// For a right hand of average size: offset, m, and rotation of a flat bar along x, such as a handle, from the
// wrist when the fingers enclose it.
constexpr Vec3 handle_at(0.0, -0.028, -0.098);
constexpr double across = to_radians(-17.5);
constexpr std::array closed_so_far{0.7, 0.8, 0.9, 1.0};  // shares of a full closure; people do not clench

// Offsets to try, m, nearest first: a thin handle lies deeper in the fingers.
std::vector<Vec3> places() {
    std::vector<Vec3> all;
    for (int y = -3; y <= 3; ++y)
        for (int z = -4; z <= 4; ++z) all.emplace_back(0.0, 0.004 * y, 0.005 * z);
    std::stable_sort(all.begin(), all.end(),
                     [](const Vec3& a, const Vec3& b) { return glm::length(a) < glm::length(b); });
    return all;
}

Pose wrist_at(const hand::Hand& hand, const Vec3& off, double along) {
    Pose wrist = inverse(Pose{hand.scale * (handle_at + off), rotation({0.0, across, 0.0})});
    if (hand.side == hand::Side::left) {
        // Mirrored in the handle's length, and turned about its thickness so that the thumb points to the
        // jaw.
        const Quat& q = wrist.orientation;
        const Pose mirrored{wrist.position * Vec3(-1.0, 1.0, 1.0), Quat(q.w, q.x, -q.y, -q.z)};
        wrist = Pose{Vec3(0.0), rotation({0.0, pi, 0.0})} * mirrored;
    }
    // The thickness of the handle is the jaw's normal.
    return Pose{Vec3(along, 0.0, 0.0), rotation({0.5 * pi, 0.0, 0.0})} * wrist;
}

const char* name(hand::Side hand) { return hand == hand::Side::left ? "left" : "right"; }

}  // namespace

Result<fs::path> calibrations_folder() {
    BOLT_TRY_ASSIGN(const auto data, content::data_folder());
    return data / "gloves";
}

Result<hand::GloveIdentity> await_glove(hand::GloveDriver& driver, const fs::path& port) {
    const device::Timer timer = device::steady_timer();
    const double until = timer.now() + patience;
    while (driver.sample().number == 0) {
        const hand::GloveReport& report = driver.report();
        const bool told = report.trouble[0] != '\0';
        // Fails at once if the port cannot be opened or another device answers; waits while there is no
        // answer.
        if ((told && report.state == hand::GloveState::rejected) ||
            (told && !report.open && report.openings == 0) || timer.now() > until)
            return fail(ErrorCode::no_device,
                        fmt::format("{}: {}", port.string(), told ? report.trouble.data() : "no answer"),
                        told ? "" : "a CyberGlove that is switched on");
        timer.wait(0.01);
    }
    return driver.report().identity;
}

std::string about_adapter(const fs::path& port) {
    const auto ms = hand::latency_timer_ms(port);
    if (!ms || *ms <= longest_latency_timer) return {};
    return fmt::format(
        "its adapter gathers bytes for {} ms: install the udev rule (60-boltwright.rules) and plug it in "
        "again",
        *ms);
}

Result<content::GloveCalibration> calibration_of(const std::string& trainee, const hand::GloveIdentity& glove,
                                                 const fs::path& folder) {
    BOLT_TRY_ASSIGN(const auto where, folder.empty() ? calibrations_folder() : folder);
    const fs::path path = content::glove_calibration_path(where, trainee, glove.hand);
    const std::string make = fmt::format("`boltwright glove calibrate --trainee \"{}\"` makes one", trainee);
    std::error_code failed;
    if (!fs::exists(path, failed))
        return fail(ErrorCode::bad_content,
                    fmt::format("no calibration of {}'s {} hand is kept in {}", trainee, name(glove.hand),
                                where.string()),
                    make);
    Result<content::GloveCalibration> kept = content::load_glove_calibration(path);
    if (kept && kept->sensors != glove.sensors)
        return fail(ErrorCode::bad_content,
                    fmt::format("{} is of a glove with {} sensors, and this one has {}", path.string(),
                                kept->sensors, glove.sensors),
                    make);
    return kept;
}

Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along) {
    Pose best;
    int most = -1;
    for (const Vec3& off : places()) {
        const Pose wrist = wrist_at(hand, off, along);
        int held = 0;
        for (const double share : closed_so_far) {
            hand::GraspState grip;
            hand::update_grasp(grip, {}, tool, hand, {true, hand::closed_hand_angles(share), wrist}, 0.01);
            held += grip.grasping ? 1 : 0;
        }
        if (held <= most) continue;
        most = held;
        best = wrist;
    }
    return best;
}

Result<station::HandSetup> hand_plan(const content::Assembly& assembly,
                                     const content::GloveCalibration& calibration) {
    BOLT_TRY_ASSIGN(auto tool, session::load_wrench(assembly));
    hand::GloveWearer wearer;
    wearer.calibration = calibration.calibration;
    wearer.hand = hand::make_hand(calibration.hand, calibration.hand_length);
    const Pose wrist = wrist_at_handle(wearer.hand, tool, assembly.wrench.handle_length);
    return station::HandSetup{std::move(wearer), std::move(tool), wrist, {}};
}

namespace {

constexpr double stroke = to_radians(30.0);  // rad of free swing that the handle needs
constexpr double clearance = 1e-3;           // m below the wrench

// The initial state of the servo. Built before a device is opened: it takes seconds, in which the device
// would time out.
struct Worked {
    content::Assembly assembly;
    std::uint64_t seed = 0;
    std::vector<joint::JointState> joints;
    std::optional<servo::ToolContact> touch;

    [[nodiscard]] servo::Setup setup(const force::OutputLimits& limits, double dt) const {
        return session::make_setup(assembly, assembly.law, limits, seed, dt);
    }
    // Call it once; it moves the obstacles out.
    servo::State begin(const servo::Setup& setup) {
        servo::State state = servo::initial_state(setup);
        state.joints = joints;
        if (touch) servo::set_coupling(setup, *touch);
        state.tool_contact = std::exchange(touch, std::nullopt);
        return state;
    }
};

Status open_glove(const content::Assembly& assembly, const Wanted& wanted, Planned& planned) {
    if (wanted.glove.empty()) return {};
    planned.glove = planned.plan.glove = wanted.glove;
    BOLT_TRY(hand::check_port_access(wanted.glove));
    hand::GloveDriver driver = hand::GloveDriver::start(wanted.glove);
    BOLT_TRY_ASSIGN(const auto glove, await_glove(driver, wanted.glove));
    if (wanted.trainee.empty()) return {};
    BOLT_TRY_ASSIGN(const auto worn, calibration_of(wanted.trainee, glove, wanted.calibrations));
    BOLT_TRY_ASSIGN(auto hand, hand_plan(assembly, worn));
    planned.worn = worn;
    planned.plan.hand = std::move(hand);
    return {};
}

Status choose_devices(const Wanted& wanted, Planned& planned) {
    device::WheelConfig rig;
    if (!wanted.rig.empty()) {
        BOLT_TRY_ASSIGN(const auto read, content::load_wheel_config(wanted.rig));
        rig = read;
    }
    const Result<Choice> choice = choose(device::list_devices(true), wanted.devices);
    if (!choice) return fail(choice.error());
    planned.choice = *choice;
    if (choice->mover) planned.plan.mover = device::factory_for(choice->mover->id, rig);
    if (choice->wheel) planned.plan.wheel = device::factory_for(choice->wheel->id, rig);
    if (!choice->mover) planned.plan.mover = wanted.otherwise;
    return {};
}

}  // namespace

Pose wrench_on_nut(const servo::Setup& setup, const servo::ToolContact* touch, std::size_t joint,
                   double nut_angle) {
    const motion::GripAngle grip =
        motion::choose_grip(setup, touch, joint, nut_angle, nut_angle, 1.0, stroke);
    const servo::NutGeometry& nut = setup.nuts[joint];
    // Raises a head that is thicker than the nut, so that it does not penetrate the nut's seat.
    const double above = std::max(0.0, 0.5 * (setup.wrench.jaw.thickness - nut.height) + clearance);
    return {servo::nut_centre(nut, nut_angle) + above * nut.axis,
            motion::orientation_of(nut, grip.handle, grip.flipped)};
}

Result<Planned> make_plan(const content::Assembly& assembly, const Wanted& wanted) {
    Planned planned;
    BOLT_TRY(choose_devices(wanted, planned));
    BOLT_TRY(open_glove(assembly, wanted, planned));

    const auto worked = std::make_shared<Worked>();
    worked->assembly = assembly;
    worked->seed = wanted.seed;
    const servo::Setup setup = worked->setup({}, 1.0 / planned.plan.servo.rate);
    servo::State state = servo::initial_state(setup);
    if (wanted.tight) BOLT_TRY(session::pretighten(assembly, setup, state));
    worked->joints = state.joints;
    if (wanted.obstacles) {
        Result<std::optional<servo::ToolContact>> touch = session::load_tool_contact(assembly, setup);
        if (!touch) return fail(touch.error());
        worked->touch = std::move(*touch);
        if (worked->touch && wanted.tight) session::seat_nuts(setup, *worked->touch);
    }
    planned.obstacles = worked->touch.has_value();
    planned.plan.home = wrench_on_nut(setup, worked->touch ? &*worked->touch : nullptr, wanted.joint,
                                      state.joints[wanted.joint].nut.angle);
    planned.plan.setup = [worked](const force::OutputLimits& limits, double dt) {
        return worked->setup(limits, dt);
    };
    planned.plan.state = [worked](const servo::Setup& made) -> Result<servo::State> {
        return worked->begin(made);
    };
    return planned;
}

Result<Planned> plan_lesson(const content::Assembly& assembly, const session::CourseOptions& course,
                            const Wanted& wanted, const Pose& home) {
    struct Begins {
        session::CourseOptions options;
        session::Prepared at;
    };
    Planned planned;
    BOLT_TRY(choose_devices(wanted, planned));
    BOLT_TRY(open_glove(assembly, wanted, planned));
    BOLT_TRY_ASSIGN(auto prepared, session::prepare(assembly, course));
    const auto begins = std::make_shared<Begins>(Begins{course, std::move(prepared)});
    planned.obstacles = begins->at.state.tool_contact.has_value();
    planned.plan.home = home;
    planned.plan.servo.rate = 1.0 / course.dt;
    planned.plan.setup = [begins, scale = wanted.force_scale](const force::OutputLimits& limits, double) {
        begins->options.device = force::scaled(limits, scale);
        session::use_device(begins->options, begins->at);
        return begins->at.setup;
    };
    planned.plan.state = [begins](const servo::Setup&) -> Result<servo::State> {
        return std::move(begins->at.state);
    };
    return planned;
}

namespace {

class RunningStation final : public Bench {
  public:
    RunningStation(station::Station station, std::optional<device::VirtualPuck> puck)
        : puck_(std::move(puck)), station_(std::move(station)) {}

    void set_controls(const station::StationControls& controls) override { station_.set_controls(controls); }
    Status send(const station::StationCommand& command) override { return station_.send(command); }
    void push(const device::PuckInput& push) override {
        if (puck_) puck_->set_input(push);
    }
    bool next_tick(station::TickRecord& tick) override { return station_.next_tick(tick); }
    const station::TickRecord& latest_tick() override { return station_.latest_tick(); }
    [[nodiscard]] std::uint64_t lost_ticks() const override { return station_.lost_ticks(); }
    const station::DisplayedHand* hand() override { return station_.hand(); }
    std::vector<std::string> troubles() override { return station_.troubles(); }
    [[nodiscard]] const station::Layout& layout() const override { return station_.layout(); }
    [[nodiscard]] const servo::Setup& setup() const override { return station_.setup(); }
    const servo::Timing* stop() override {
        station_.stop();
        return &station_.servo().timing();
    }

  private:
    std::optional<device::VirtualPuck> puck_;
    station::Station station_;
};

}  // namespace

Result<std::unique_ptr<Bench>> start_bench(station::StationOptions options,
                                           std::optional<device::VirtualPuck> puck) {
    BOLT_TRY_ASSIGN(auto station, station::Station::start(std::move(options)));
    return std::make_unique<RunningStation>(std::move(station), std::move(puck));
}

}  // namespace bolt::station_setup
