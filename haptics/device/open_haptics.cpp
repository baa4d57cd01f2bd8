#include "haptics/device/open_haptics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "haptics/device/open_haptics_frame.hpp"
#include "haptics/device/vendor_library.hpp"

namespace bolt::device {

namespace open_haptics {

namespace {

// hdDefines.h. Lengths are in mm, stiffness in N/mm.
constexpr unsigned no_arm = 0xffffffff;
constexpr unsigned get_model = 0x2501, get_serial = 0x2504, get_usable_box = 0x2551, get_senses = 0x2553,
                   get_renders = 0x2554, get_calibration_style = 0x2555, get_max_stiffness = 0x2602,
                   get_max_force = 0x2603, get_lasting_force = 0x2604;
constexpr unsigned style_inkwell = 4;
constexpr unsigned short highest_priority = 0xffff;

constexpr double poll_time = 0.2e-3;      // s between two polls for a new sample
constexpr double start_timeout = 1.0;     // s until the scheduler runs and the arm is calibrated
constexpr double release_timeout = 0.02;  // s until a frame has ended the force
constexpr const char* arm_name = "OpenHaptics arm";

// Force, stiffness and half the workspace of CHAI3D (CPhantomDevices). Damping is not published; these are
// low values of ours, not measured on arms. An arm of an unknown model gets the last row.
struct ModelLimits {
    std::string_view mark;  // in the model's name
    double force, stiffness, damping, reach;
};
constexpr std::array models{
    ModelLimits{"Premium 3.0", 22.0, 1000.0, 5.0, 0.25},
    ModelLimits{"Premium", 8.5, 800.0, 5.0, 0.12},
    ModelLimits{"", 3.3, 400.0, 3.0, 0.075},
};

// Empties the stack of errors. Returns the gravest one, which has the highest code; 0: none.
unsigned gravest_error(const OpenHapticsApi& api) {
    unsigned gravest = 0;
    take_errors(api, [&](unsigned code) { gravest = std::max(gravest, code); });
    return gravest;
}

bool is_lost(unsigned code) { return code >= first_fault && code < no_licence && code != already_initiated; }

Error arm_error(const OpenHapticsApi& api, const std::string& name, const char* problem, unsigned code) {
    const char* text = code != 0 ? api.get_error_text(code) : nullptr;
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("{}: {}: {}", name, problem, text != nullptr ? text : "no reason given");
    error.expected =
        code == no_licence ? "a licence of OpenHaptics for this computer"
        : code == already_initiated
            ? "an arm that no other program uses"
            : "an arm that is switched on, connected, and set up with the vendor's program Touch_Setup";
    error.lost = is_lost(code);
    return error;
}

// The reported limit, at most the model's; the model's if none is reported.
double limit(double reported, double max) { return reported > 0.0 ? std::min(reported, max) : max; }

std::string reported_text(const OpenHapticsApi& api, unsigned what) {
    const char* reported = api.get_string(what);
    std::string name = reported != nullptr ? std::string(std::string_view(reported).substr(0, 60)) : "";
    std::erase_if(name, [](char c) { return c < ' ' || c > '~'; });  // names are printed on terminals
    return name;
}

// Half the workspace and its centre, from the box that the arm reports; a cube about the origin if that box
// is implausible.
void describe_reach(const OpenHapticsApi& api, double max_reach, ArmProperties& arm) {
    const Doubles box = get_doubles(api, get_usable_box);
    arm.description.half_workspace = Vec3(max_reach);
    const Vec3 low = mm * Vec3(box[0], box[1], box[2]), high = mm * Vec3(box[3], box[4], box[5]);
    const Vec3 half = 0.5 * (high - low), centre = 0.5 * (low + high);
    if (!finite(half) || std::min({half.x, half.y, half.z}) <= 0.0 || !(glm::length(centre) < max_reach))
        return;
    arm.description.half_workspace = glm::min(half, Vec3(max_reach));
    arm.centre = centre;
}

ArmProperties describe_arm(const OpenHapticsApi& api) {
    ArmProperties arm;
    const std::string model = reported_text(api, get_model);
    const ModelLimits& bounds = *std::find_if(models.begin(), models.end(), [&](const ModelLimits& m) {
        return model.find(m.mark) != std::string::npos;
    });
    arm.senses_rotation = get_integer(api, get_senses) >= 6;
    arm.calibration_style = static_cast<unsigned>(get_integer(api, get_calibration_style));
    Description& d = arm.description;
    d.name = model.empty() ? arm_name : fmt::format("{} ({})", arm_name, model);
    d.id = "openhaptics:0";
    d.model = model;
    d.serial = reported_text(api, get_serial);
    d.senses_rotation = arm.senses_rotation;
    d.renders = {true, true, true, false, false, false};
    d.limits.force = limit(get_doubles(api, get_max_force)[0], bounds.force);
    d.limits.torque = 0.0;
    d.limits.stiffness = limit(1e3 * get_doubles(api, get_max_stiffness)[0], bounds.stiffness);
    d.limits.torsion = 0.0;
    d.limits.damping = bounds.damping;
    d.limits.angular_damping = 0.0;
    d.limits.delay = 2;  // a command waits in the mailbox for the next frame
    d.rate = 1.0 / frame_time;
    d.buttons = max_buttons;
    describe_reach(api, bounds.reach, arm);
    if (!arm.senses_rotation) d.remarks.emplace_back("senses no rotation: the tool keeps its orientation");
    // The library expects torques of the gimbal's motors, and the directions of these are not confirmed: a
    // wrong sign would push the hand instead of resisting it.
    d.remarks.emplace_back(get_integer(api, get_renders) >= 6
                               ? "its torque is not used: torques are rendered as forces on the handle"
                               : "renders no torque: torques are rendered as forces on the handle");
    if (const double lasting = get_doubles(api, get_lasting_force)[0];
        lasting > 0.0 && lasting < d.limits.force)
        d.remarks.push_back(
            fmt::format("renders {:.2g} N without a break; a greater force warms the motors, and fades until "
                        "they are cool",
                        lasting));
    return arm;
}

class OpenHapticsArm final : public DeviceDriver {
  public:
    OpenHapticsArm(const OpenHapticsApi& api, unsigned id, const ArmProperties& arm, Timer timer)
        : api_(api), id_(id), arm_(arm), timer_(std::move(timer)), frames_(api, id, arm, timer_) {}
    OpenHapticsArm(const OpenHapticsArm&) = delete;
    OpenHapticsArm& operator=(const OpenHapticsArm&) = delete;
    ~OpenHapticsArm() override {
        frames_.release();
        if (report_.calibration == calibrated) wait_for(release_timeout, [&] { return report_.released; });
        api_.disable(force_output);
        api_.stop_scheduler();
        api_.unschedule(callback_);
        api_.disable_device(id_);
        gravest_error(api_);
    }

    // Starts the scheduler and calibrates. Call once.
    Status start() {
        gravest_error(api_);  // discards errors of queries that an older version lacks
        callback_ = api_.schedule(FrameCallback::run, &frames_, highest_priority);
        api_.start_scheduler();
        wait_for(start_timeout, [&] { return report_.calibration == calibrated || report_.fault != 0; });
        if (report_.fault != 0) return failure("it cannot be started", report_.fault);
        if (report_.calibration == calibrated) return {};
        if (report_.calibration == 0) return failure("its scheduler does not run", 0);
        const std::string what = arm_.description.name + " is not calibrated";
        if ((arm_.calibration_style & style_inkwell) != 0)
            return fail(unprepared_device_error(
                what, "its stylus in the inkwell: push it in, and it is calibrated at the next attempt",
                {DeviceNeed::inkwell, {}}));
        return fail(ErrorCode::no_device, what,
                    "an arm that was calibrated with the vendor's program Touch_Diagnostic");
    }

    [[nodiscard]] const Description& description() const override { return arm_.description; }

    [[nodiscard]] DeviceHealth health() const override {
        return {report_.calibration == calibrated, report_.heat, report_.cooling};
    }

    Result<std::optional<Sample>> read(double timeout) override {
        wait_for(timeout, [&] { return report_.number != read_ || report_.fault != 0; });
        if (report_.fault != 0) return fail(lost());
        if (timer_.now() - report_.time > open_haptics::max_frame_age) api_.disable(force_output);
        if (report_.number == read_) return std::optional<Sample>{};
        read_ = report_.number;
        return std::optional<Sample>(report_.sample);
    }

    Status write(const force::OutputCommand& command) override {
        const force::OutputLimits& limits = arm_.description.limits;
        frames_.commands.write({{force::clamp_length(command.force, limits.force),
                                 force::clamp_length(command.torque, limits.torque)},
                                timer_.now()});
        update_report();
        if (report_.fault != 0) return fail(lost());
        return {};
    }

  private:
    [[nodiscard]] Error lost() const {
        return arm_error(api_, arm_.description.name, "its forces have ended", report_.fault);
    }
    [[nodiscard]] Status failure(const char* problem, unsigned code) const {
        return fail(arm_error(api_, arm_.description.name, problem, code));
    }

    void update_report() {
        if (frames_.reports.update()) report_ = frames_.reports.latest();
    }

    // Waits at most `timeout` s until `is_done()` holds for the latest report.
    template <class IsDone>
    void wait_for(double timeout, const IsDone& is_done) {
        const double until = timer_.now() + timeout;
        for (update_report(); !is_done(); update_report()) {
            const double left = until - timer_.now();
            if (left <= 0.0) return;
            timer_.wait(std::min(left, poll_time));
        }
    }

    OpenHapticsApi api_;
    unsigned id_;
    ArmProperties arm_;
    Timer timer_;
    FrameCallback frames_;
    FrameReport report_;
    unsigned long callback_ = 0;
    std::uint64_t read_ = 0;  // number of the last sample that was returned
};

// Null is the default arm. Some versions accept only a name for it, and these names differ.
Result<unsigned> init_arm(const OpenHapticsApi& api) {
    unsigned error = 0;
    for (const char* name : {static_cast<const char*>(nullptr), "Default PHANToM", "Default Device"}) {
        gravest_error(api);
        const unsigned id = api.init_device(name);
        error = gravest_error(api);
        if (id != no_arm && error == 0) return id;
        if (id != no_arm) api.disable_device(id);
        if (error == already_initiated || error == no_licence) break;
    }
    return fail(arm_error(api, arm_name, "it cannot be opened", error));
}

}  // namespace

}  // namespace open_haptics

std::vector<std::filesystem::path> open_haptics_libraries() {
    std::vector<std::filesystem::path> candidates;
    for (const char* name : {"libHD.so.3.4", "libHD.so.3.0"}) {
        if (const char* sdk = std::getenv("OH_SDK_BASE"); sdk != nullptr && *sdk != '\0')
            candidates.push_back(std::filesystem::path(sdk) / "lib" / name);
        candidates.push_back(std::filesystem::path("/usr/lib") / name);
        candidates.emplace_back(name);
    }
    return candidates;
}

Result<OpenHapticsApi> load_open_haptics(const std::vector<std::filesystem::path>& candidates) {
    Result<VendorLibrary> library = VendorLibrary::open(candidates);
    if (!library) {
        Error error = library.error();
        if (error.code == ErrorCode::no_device)
            error.expected = "OpenHaptics 3.4 and the driver of the arm, with libHD.so.3.4 in /usr/lib";
        return fail(std::move(error));
    }
    OpenHapticsApi api;
    api.library = library->path();
    library->find("hdInitDevice", api.init_device);
    library->find("hdDisableDevice", api.disable_device);
    library->find("hdBeginFrame", api.begin_frame);
    library->find("hdEndFrame", api.end_frame);
    library->find("hdGetDoublev", api.get_doubles);
    library->find("hdGetIntegerv", api.get_integers);
    library->find("hdGetString", api.get_string);
    library->find("hdSetDoublev", api.set_doubles);
    library->find("hdEnable", api.enable);
    library->find("hdDisable", api.disable);
    library->find("hdGetError", api.get_error);
    library->find("hdGetErrorString", api.get_error_text);
    library->find("hdCheckCalibration", api.check_calibration);
    library->find("hdUpdateCalibration", api.update_calibration);
    library->find("hdStartScheduler", api.start_scheduler);
    library->find("hdStopScheduler", api.stop_scheduler);
    library->find("hdScheduleAsynchronous", api.schedule);
    library->find("hdUnschedule", api.unschedule);
    BOLT_TRY(library->check());
    return api;
}

Result<std::unique_ptr<DeviceDriver>> open_open_haptics(const OpenHapticsApi& api, Timer timer) {
    BOLT_TRY_ASSIGN(const unsigned id, open_haptics::init_arm(api));
    const open_haptics::ArmProperties properties = open_haptics::describe_arm(api);
    auto arm = std::make_unique<open_haptics::OpenHapticsArm>(api, id, properties, std::move(timer));
    BOLT_TRY(arm->start());
    return std::unique_ptr<DeviceDriver>(std::move(arm));
}

}  // namespace bolt::device
