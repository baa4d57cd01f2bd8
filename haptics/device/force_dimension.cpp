#include "haptics/device/force_dimension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "haptics/device/vendor_library.hpp"

namespace bolt::device {

namespace {

// dhdc.h: error codes of a device that cannot be reached, and positions in the array of dhdGetStatus.
constexpr int error_communication = 2, error_no_device = 5, error_timeout = 7, error_not_ready = 12,
              error_in_use = 20;
constexpr std::size_t status_force = 5, status_cause = 14, status_room = 32;
constexpr std::array brake_causes{"",
                                  "its button was pressed",
                                  "it moved too fast",
                                  "its watchdog received no force in time",
                                  "the program asked for it",
                                  "the USB cable was unplugged",
                                  "the dead-man switch was released"};

constexpr int time_guard = 1;        // result: the device has sent nothing new
constexpr double period = 1e-3;      // s between two samples
constexpr int status_interval = 20;  // samples between two queries of the status
// rad, of a fully open gripper: the limit of CHAI3D (CDeltaDevices) for omega.7, sigma.7 and lambda.7.
constexpr double gripper_range = to_radians(30.0);

// The vendor's frame has x to the user, y to the right and z up.
Vec3 from_vendor_frame(const Vec3& theirs) { return {theirs.y, theirs.z, theirs.x}; }
Vec3 to_vendor_frame(const Vec3& ours) { return {ours.z, ours.x, ours.y}; }

Quat from_vendor_frame(const double rotation[3][3]) {
    glm::dmat3 matrix(1.0);  // columns: the grip's axes as we define them, in our frame
    for (int column = 0; column < 3; ++column) {
        Vec3 unit(0.0);
        unit[column] = 1.0;
        const Vec3 axis = to_vendor_frame(unit);
        Vec3 turned(0.0);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) turned[i] += rotation[i][j] * axis[j];
        matrix[column] = from_vendor_frame(turned);
    }
    return glm::normalize(glm::quat_cast(matrix));
}

Error arm_error(const ForceDimensionApi& api, const std::string& name, const char* problem) {
    const int code = api.get_error();
    const char* text = api.get_error_text();
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("{}: {}: {}", name, problem, text != nullptr ? text : "no reason given");
    error.expected = code == error_in_use ? "an arm that no other program uses"
                                          : "an arm that is switched on and connected by USB";
    error.lost = code == error_communication || code == error_no_device || code == error_timeout ||
                 code == error_not_ready;
    return error;
}

// Force, torque, stiffness and half the workspace of CHAI3D (CDeltaDevices), by the numbers of dhdc.h.
// Damping is not published; these are low values of ours, not measured on arms. With 15 N·s/m the steps of a
// Falcon's encoders (64 µm) change the force by up to 14 % of the greatest force in a millisecond; with
// 5 N·s/m, by up to 9 % (bolt-arm-validation). Arms of an unknown number get the smallest values of the arms
// with the same joints.
struct ModelLimits {
    int type;
    const char* name;
    double force, torque, stiffness, damping, reach;
};
constexpr std::array models{
    ModelLimits{63, "delta.3", 20.0, 0.0, 5000.0, 15.0, 0.15},
    ModelLimits{33, "omega.3", 12.0, 0.0, 5000.0, 15.0, 0.075},
    ModelLimits{34, "omega.6", 12.0, 0.0, 5000.0, 15.0, 0.075},
    ModelLimits{36, "omega.6 (left)", 12.0, 0.0, 5000.0, 15.0, 0.075},
    ModelLimits{35, "omega.7", 12.0, 0.0, 5000.0, 15.0, 0.075},
    ModelLimits{37, "omega.7 (left)", 12.0, 0.0, 5000.0, 15.0, 0.075},
    ModelLimits{104, "sigma.7", 12.0, 0.2, 4000.0, 15.0, 0.075},
    ModelLimits{105, "sigma.7 (left)", 12.0, 0.2, 4000.0, 15.0, 0.075},
    ModelLimits{108, "lambda.7", 12.0, 0.2, 8000.0, 15.0, 0.11},
    ModelLimits{109, "lambda.7 (left)", 12.0, 0.2, 8000.0, 15.0, 0.11},
    ModelLimits{60, "Falcon", 8.0, 0.0, 3000.0, 5.0, 0.04},
};

ModelLimits limits_of_joints(bool wrist, bool active) {
    if (active) return {0, "arm, 6 joints with motors (sigma or lambda)", 12.0, 0.2, 4000.0, 15.0, 0.075};
    if (wrist) return {0, "arm with a wrist (omega.6 or omega.7)", 12.0, 0.0, 5000.0, 15.0, 0.075};
    return {0, "arm (delta.3, omega.3 or Falcon)", 8.0, 0.0, 3000.0, 5.0, 0.04};
}

// The text that the library reports; printable ASCII, because it is printed on terminals.
std::string reported_name(const ForceDimensionApi& api, char id) {
    const char* reported = api.get_name != nullptr ? api.get_name(id) : nullptr;
    std::string name = reported != nullptr ? std::string(std::string_view(reported).substr(0, 60)) : "";
    std::erase_if(name, [](char c) { return c < ' ' || c > '~'; });
    return name;
}

std::string reported_serial(const ForceDimensionApi& api, char id) {
    unsigned short serial = 0;
    if (api.get_serial == nullptr || api.get_serial(&serial, id) < 0) return {};
    return fmt::format("{}", serial);
}

Description describe_arm(const ForceDimensionApi& api, char id, int index) {
    Description d;
    const bool wrist = api.has_wrist(id), active = api.has_active_wrist(id);
    const int type = api.get_type != nullptr ? api.get_type(id) : -1;
    const auto known =
        std::find_if(models.begin(), models.end(), [&](const ModelLimits& m) { return m.type == type; });
    const ModelLimits bounds = known != models.end() ? *known : limits_of_joints(wrist, active);
    const bool renders_torque = active && bounds.torque > 0.0;
    d.name = fmt::format("Force Dimension {}", bounds.name);
    d.id = fmt::format("force-dimension:{}", index);
    d.model = reported_name(api, id);
    if (d.model.empty() && known != models.end()) d.model = known->name;
    d.serial = reported_serial(api, id);
    d.senses_rotation = wrist;
    d.renders = {true, true, true, renders_torque, renders_torque, renders_torque};
    d.limits.force = bounds.force;
    d.limits.torque = renders_torque ? bounds.torque : 0.0;
    d.limits.stiffness = bounds.stiffness;
    d.limits.torsion = renders_torque ? 2.0 : 0.0;
    d.limits.damping = bounds.damping;
    d.limits.angular_damping = renders_torque ? 0.01 : 0.0;
    d.rate = 1.0 / period;
    d.half_workspace = Vec3(bounds.reach);
    d.buttons = 8;
    d.senses_gripper = api.has_gripper != nullptr && api.get_gripper_angle != nullptr && api.has_gripper(id);
    if (!wrist) d.remarks.emplace_back("senses no rotation: the tool keeps its orientation");
    if (!renders_torque)
        d.remarks.emplace_back("renders no torque: torques are rendered as forces on the handle");
    if (api.compensate_gravity == nullptr)
        d.remarks.emplace_back("its library does not compensate the weight of the arm: install the SDK 3.17");
    return d;
}

class ForceDimensionArm final : public DeviceDriver {
  public:
    ForceDimensionArm(const ForceDimensionApi& api, char id, int index, Timer timer)
        : api_(api),
          id_(id),
          timer_(std::move(timer)),
          description_(describe_arm(api, id, index)),
          next_(timer_.now()) {}
    ForceDimensionArm(const ForceDimensionArm&) = delete;
    ForceDimensionArm& operator=(const ForceDimensionArm&) = delete;
    ~ForceDimensionArm() override {
        (void)send({});
        api_.brake(id_);
        api_.close(id_);
    }

    // Call once after the arm was opened.
    Status enable(const ForceDimensionOptions& options) {
        BOLT_TRY(balance(options.effector_mass));
        if (!api_.is_initialized(id_)) {
            if (!options.may_move) return fail(move_permission_error(description_.name, description_.id));
            if (api_.auto_init(id_) < 0) return failure("it does not find its position");
        }
        // Ends the position control; the forces stay on.
        if (api_.stop_regulation(true, id_) < 0)
            return failure("its position control cannot be switched off");
        if (api_.set_max_force(description_.limits.force, id_) < 0 ||
            (description_.limits.torque > 0.0 && api_.set_max_torque(description_.limits.torque, id_) < 0))
            return failure("its force cannot be limited");
        if (api_.enable_force(1, id_) < 0) return failure("its motors cannot be switched on");
        return {};
    }

    [[nodiscard]] const Description& description() const override { return description_; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double now = timer_.now();
        if (next_ > now + timeout) {
            timer_.wait(timeout);
            return std::optional<Sample>{};
        }
        if (next_ > now) timer_.wait(next_ - now);
        next_ = std::max(next_ + period, timer_.now());  // late samples are left out
        if (++since_status_ >= status_interval) BOLT_TRY(check_status());
        Vec3 position(0.0);
        double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        const int result = api_.get_frame(&position.x, &position.y, &position.z, rotation, id_);
        if (result < 0) return fail(arm_error(api_, description_.name, "its position cannot be read"));
        if (result == time_guard) return std::optional<Sample>{};  // no new sample
        Sample sample;
        sample.pose = {from_vendor_frame(position), from_vendor_frame(rotation)};
        sample.buttons = api_.get_button_mask(id_);
        if (description_.senses_gripper) BOLT_TRY(read_gripper(sample));
        sample.time = timer_.now();
        // Each call computes the weight compensation for the present position, so the library must be called
        // also while the program sends no new force.
        if (!std::exchange(sent_, false)) BOLT_TRY(send(command_));
        return std::optional<Sample>(sample);
    }

    Status write(const force::OutputCommand& command) override {
        command_ = command;
        sent_ = true;
        return send(command);
    }

    [[nodiscard]] DeviceHealth health() const override { return {true, {}, false}; }

  private:
    Status read_gripper(Sample& sample) const {
        double angle = 0.0;
        if (api_.get_gripper_angle(&angle, id_) < 0) return failure("its gripper cannot be read");
        sample.gripper = std::clamp(std::abs(angle) / gripper_range, 0.0, 1.0);
        return {};
    }

    // Lets the library hold the weight of the arm and of what is mounted on it, also while it finds its
    // position.
    Status balance(double effector_mass) {
        if (effector_mass > 0.0 && api_.set_mounted_mass != nullptr &&
            api_.set_mounted_mass(effector_mass, id_) < 0)
            return failure("the mass of its handle cannot be set");
        if (api_.compensate_gravity != nullptr && api_.compensate_gravity(1, id_) < 0)
            return failure("its weight cannot be compensated");
        return {};
    }

    Status send(const force::OutputCommand& command) {
        const Vec3 force = to_vendor_frame(command.force);
        const Vec3 torque = description_.limits.torque > 0.0 ? to_vendor_frame(command.torque) : Vec3(0.0);
        if (api_.set_forces(force.x, force.y, force.z, torque.x, torque.y, torque.z, 0.0, id_) < 0)
            return failure("its force cannot be set");
        return {};
    }

    [[nodiscard]] Status failure(const char* problem) const {
        return fail(arm_error(api_, description_.name, problem));
    }

    // An arm that has braked must be opened again, so that its force grows slowly from zero.
    Status check_status() {
        since_status_ = 0;
        std::array<int, status_room> status{};
        if (api_.get_status(status.data(), id_) < 0) return failure("its status cannot be read");
        if (status[status_force] != 0) return {};
        const auto cause = static_cast<std::size_t>(std::max(status[status_cause], 0));
        return fail(lost_device_error(
            fmt::format("{} has braked{}{}", description_.name, cause > 0 ? ": " : "",
                        cause < brake_causes.size() ? brake_causes[cause] : "unknown cause"),
            "a hand that moves it slowly"));
    }

    ForceDimensionApi api_;
    char id_;
    Timer timer_;
    Description description_;
    double next_;                   // s, time of the next sample
    force::OutputCommand command_;  // of the latest write()
    bool sent_ = false;             // a command was sent since the latest sample
    int since_status_ = 0;
};

}  // namespace

std::vector<std::filesystem::path> force_dimension_libraries() {
    constexpr const char* name = "libdrd.so.3";
    std::vector<std::filesystem::path> candidates;
    if (const char* sdk = std::getenv("FDSDK"); sdk != nullptr && *sdk != '\0')
        candidates.push_back(std::filesystem::path(sdk) / "lib/release/lin-x86_64-gcc" / name);
    candidates.push_back(std::filesystem::path("/usr/local/lib") / name);
    candidates.emplace_back(name);
    return candidates;
}

Result<ForceDimensionApi> load_force_dimension(const std::vector<std::filesystem::path>& candidates) {
    Result<VendorLibrary> library = VendorLibrary::open(candidates);
    if (!library) {
        Error error = library.error();
        if (error.code == ErrorCode::no_device)
            error.expected =
                "the Force Dimension SDK, with its folder in FDSDK or libdrd.so.3 in /usr/local/lib";
        return fail(std::move(error));
    }
    ForceDimensionApi api;
    api.library = library->path();
    library->find("dhdGetDeviceCount", api.get_device_count);
    library->find("drdOpenID", api.open_id);
    library->find("drdClose", api.close);
    library->find("drdIsInitialized", api.is_initialized);
    library->find("drdAutoInit", api.auto_init);
    library->find("drdStop", api.stop_regulation);
    library->find("dhdHasWrist", api.has_wrist);
    library->find("dhdHasActiveWrist", api.has_active_wrist);
    library->find("dhdSetMaxForce", api.set_max_force);
    library->find("dhdSetMaxTorque", api.set_max_torque);
    library->find("dhdEnableForce", api.enable_force);
    library->find("dhdStop", api.brake);
    library->find("dhdGetStatus", api.get_status);
    library->find("dhdGetPositionAndOrientationFrame", api.get_frame);
    library->find("dhdGetButtonMask", api.get_button_mask);
    library->find("dhdSetForceAndTorqueAndGripperForce", api.set_forces);
    library->find("dhdErrorGetLast", api.get_error);
    library->find("dhdErrorGetLastStr", api.get_error_text);
    library->find_optional("dhdHasGripper", api.has_gripper);
    library->find_optional("dhdGetGripperAngleRad", api.get_gripper_angle);
    library->find_optional("dhdGetSystemType", api.get_type);
    library->find_optional("dhdGetSystemName", api.get_name);
    library->find_optional("dhdGetSerialNumber", api.get_serial);
    library->find_optional("dhdSetGravityCompensation", api.compensate_gravity);
    library->find_optional("dhdSetEffectorMass", api.set_mounted_mass);
    BOLT_TRY(library->check());
    return api;
}

Result<std::unique_ptr<DeviceDriver>> open_force_dimension(const ForceDimensionApi& api,
                                                           const ForceDimensionOptions& options,
                                                           Timer timer) {
    const int id = api.open_id(static_cast<char>(options.index));
    if (id < 0) return fail(arm_error(api, "Force Dimension arm", "it cannot be opened"));
    auto arm =
        std::make_unique<ForceDimensionArm>(api, static_cast<char>(id), options.index, std::move(timer));
    BOLT_TRY(arm->enable(options));
    return std::unique_ptr<DeviceDriver>(std::move(arm));
}

}  // namespace bolt::device
