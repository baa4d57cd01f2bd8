#include "haptics/device/plugin_arms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <sstream>

#include "engine/base/file.hpp"
#include "haptics/device/plugin/arm_process.hpp"

namespace bolt::device {

namespace {

constexpr int max_plugin_arms = 16;            // of one plug-in
constexpr double slowest_rate = 500.0;         // 1/s
constexpr double fastest_rate = 1000.0;        // 1/s, of calls of exchange()
constexpr double farthest_position = 2.0;      // m
constexpr double calibration_interval = 0.01;  // s between two calls of calibrate()
constexpr double calibration_time = 90.0;      // s for an arm that moves by itself
constexpr double time_for_user = 0.5;          // s until the user must act or wait

// Force, torque and stiffness: the largest of the arms in docs/decisions.md. Torsion, damping and angular
// damping: the defaults of OutputLimits, which are those of an arm of that class. Reach: more than that of
// any arm on a table.
struct PluginLimit {
    const char* name;
    double bw_arm_info_v1::*reported;
    double force::OutputLimits::*used;
    double max;
    const char* unit;
};
constexpr std::array plugin_limits{
    PluginLimit{"force", &bw_arm_info_v1::max_force, &force::OutputLimits::force, 70.0, "N"},
    PluginLimit{"torque", &bw_arm_info_v1::max_torque, &force::OutputLimits::torque, 3.1, "N·m"},
    PluginLimit{"stiffness", &bw_arm_info_v1::max_stiffness, &force::OutputLimits::stiffness, 8000.0, "N/m"},
    PluginLimit{"torsional stiffness", &bw_arm_info_v1::max_torsion, &force::OutputLimits::torsion, 40.0,
                "N·m/rad"},
    PluginLimit{"damping", &bw_arm_info_v1::max_damping, &force::OutputLimits::damping, 20.0, "N·s/m"},
    PluginLimit{"angular damping", &bw_arm_info_v1::max_angular_damping,
                &force::OutputLimits::angular_damping, 0.1, "N·m·s/rad"},
};
constexpr double max_reach = 1.0;  // m

// Sets the limits to the reported values, each at most its PluginLimit::max.
Status take_limits(const bw_arm_info_v1& info, Description& d) {
    for (const PluginLimit& limit : plugin_limits) {
        const double reported = info.*limit.reported;
        if (!std::isfinite(reported) || reported < 0.0)
            return fail(ErrorCode::no_device,
                        fmt::format("its largest {} is {:g} {}", limit.name, reported, limit.unit),
                        "a finite number that is not negative");
        if (reported > limit.max)
            d.remarks.push_back(fmt::format("reports a {} of {:g} {}; Boltwright uses {:g} {} at most",
                                            limit.name, reported, limit.unit, limit.max, limit.unit));
        d.limits.*limit.used = std::min(reported, limit.max);
    }
    return {};
}

// Fails if forces or torques are rendered with a limit of 0. Resets the limits of what is not rendered.
Status check_axes(Description& d) {
    const auto any = [&](std::size_t first) {
        return d.renders[first] || d.renders[first + 1] || d.renders[first + 2];
    };
    const bool forces = any(0), torques = any(3);
    if (forces && (d.limits.force == 0.0 || d.limits.stiffness == 0.0))
        return fail(ErrorCode::no_device, "it renders forces, but its largest force or stiffness is 0",
                    "both above 0, or no force axis in bw_arm_info_v1.axes");
    if (torques && (d.limits.torque == 0.0 || d.limits.torsion == 0.0))
        return fail(ErrorCode::no_device,
                    "it renders torques, but its largest torque or torsional stiffness is 0",
                    "both above 0, or no torque axis in bw_arm_info_v1.axes");
    if (!forces) {
        d.limits.force = d.limits.damping = 0.0;
        d.limits.stiffness = force::OutputLimits{}.stiffness;
    }
    if (!torques) d.limits.torque = d.limits.torsion = d.limits.angular_damping = 0.0;
    if (forces && !torques)
        d.remarks.emplace_back("renders no torque: torques are rendered as forces on the handle");
    return {};
}

Status take_timing(const bw_arm_info_v1& info, Description& d) {
    if (!std::isfinite(info.rate) || info.rate < slowest_rate)
        return fail(ErrorCode::no_device, fmt::format("it sends {:g} samples a second", info.rate),
                    fmt::format("{:g} or more", slowest_rate));
    d.rate = std::min(info.rate, fastest_rate);
    // A command waits for the next call of exchange().
    const int own_delay = static_cast<int>(std::ceil(1e3 / d.rate));
    const int max_delay = 3 - own_delay;
    if (info.delay < 0 || info.delay > max_delay)
        return fail(ErrorCode::no_device, fmt::format("its delay is {} ms", info.delay),
                    fmt::format("0 to {} ms at {:g} samples a second", max_delay, d.rate));
    d.limits.delay = info.delay + own_delay;
    return {};
}

Status take_reach(const bw_arm_info_v1& info, Description& d) {
    for (int i = 0; i < 3; ++i) {
        const double reach = info.half_workspace[i];
        if (!std::isfinite(reach) || reach <= 0.0)
            return fail(ErrorCode::no_device, fmt::format("its reach along {} is {:g} m", "xyz"[i], reach),
                        "a finite number above 0");
        d.half_workspace[i] = std::min(reach, max_reach);
    }
    return {};
}

Result<Description> describe_plugin_arm(const bw_arm_info_v1& info, const std::filesystem::path& plugin,
                                        int index) {
    Description d;
    d.name = clean_text({info.name, ::strnlen(info.name, sizeof info.name)});
    if (d.name.empty()) d.name = plugin_name(plugin);
    d.id = plugin_arm_id(plugin, index);
    d.model = d.name;
    for (std::size_t i = 0; i < d.renders.size(); ++i) d.renders[i] = (info.axes >> i & 1U) != 0;
    BOLT_TRY(take_limits(info, d));
    BOLT_TRY(check_axes(d));
    BOLT_TRY(take_timing(info, d));
    BOLT_TRY(take_reach(info, d));
    if (info.buttons < 0 || info.buttons > 32)
        return fail(ErrorCode::no_device, fmt::format("it has {} buttons", info.buttons), "0 to 32");
    d.buttons = info.buttons;
    d.senses_gripper = (info.flags & BW_ARM_SENSES_GRIPPER) != 0;
    d.senses_rotation = (info.flags & BW_ARM_SENSES_ROTATION) != 0;
    if (!d.senses_rotation) d.remarks.emplace_back("senses no rotation: the tool keeps its orientation");
    return d;
}

// Returns the fault of a state; null: none.
const char* fault_of(const bw_arm_state_v1& state, const Pose& pose) {
    if (!finite(pose.position) || glm::length(pose.position) > farthest_position)
        return "it reports a position that is not within 2 m";
    // Also true for NaN.
    if (!(std::abs(glm::dot(pose.orientation, pose.orientation) - 1.0) < 1e-2))
        return "it reports an orientation that is no unit quaternion";
    if (!std::isfinite(state.gripper)) return "it reports an opening of its gripper that is not finite";
    return state.size == sizeof state ? nullptr : "it has overwritten bw_arm_state_v1.size";
}

class PluginArm final : public DeviceDriver {
  public:
    PluginArm(ArmProcess process, Description description, bool senses_rotation, Timer timer)
        : process_(std::move(process)),
          description_(std::move(description)),
          senses_rotation_(senses_rotation),
          timer_(std::move(timer)),
          next_(timer_.now()) {}

    [[nodiscard]] const Description& description() const override { return description_; }
    [[nodiscard]] DeviceHealth health() const override { return {true, {}, false}; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double now = timer_.now();
        const double until = now + timeout;
        if (!process_.exchanging()) {
            if (next_ > until) {
                timer_.wait(timeout);
                return std::optional<Sample>{};
            }
            if (next_ > now) timer_.wait(next_ - now);
            next_ = std::max(next_ + 1.0 / description_.rate, timer_.now());  // late samples are left out
            if (const Status begun = process_.begin_exchange(command_); !begun) return lost(begun.error());
        }
        const auto reply = process_.finish_exchange(std::max(until - timer_.now(), 0.0));
        if (!reply) return lost(reply.error());
        if (!*reply || (*reply)->result == BW_ARM_NO_SAMPLE) return std::optional<Sample>{};
        return sample((*reply)->state);
    }

    // Takes effect with the next exchange.
    Status write(const force::OutputCommand& command) override {
        force::OutputCommand sent;
        if (finite(command.force) && finite(command.torque)) sent = clamp_to_limits(description_, command);
        command_ = {sizeof command_, 0, {}, {}};
        for (int i = 0; i < 3; ++i) {
            command_.force[i] = sent.force[i];
            command_.torque[i] = sent.torque[i];
        }
        return {};
    }

  private:
    static tl::unexpected<Error> lost(Error error) {
        error.lost = true;
        return fail(std::move(error));
    }

    Result<std::optional<Sample>> sample(const bw_arm_state_v1& state) {
        Sample sample;
        sample.pose.position = {state.position[0], state.position[1], state.position[2]};
        if (senses_rotation_)
            sample.pose.orientation =
                Quat(state.orientation[0], state.orientation[1], state.orientation[2], state.orientation[3]);
        if (const char* fault = fault_of(state, sample.pose))
            return lost(process_.error(fault, "a pose as boltwright_arm.h describes it"));
        sample.pose.orientation = glm::normalize(sample.pose.orientation);
        const std::uint64_t buttons = (std::uint64_t{1} << static_cast<unsigned>(description_.buttons)) - 1;
        sample.buttons = state.buttons & static_cast<std::uint32_t>(buttons);
        if (description_.senses_gripper) sample.gripper = std::clamp(state.gripper, 0.0, 1.0);
        sample.time = timer_.now();
        return std::optional<Sample>(sample);
    }

    ArmProcess process_;
    Description description_;
    bool senses_rotation_;
    Timer timer_;
    bw_arm_command_v1 command_{sizeof(bw_arm_command_v1), 0, {}, {}};
    double next_;  // s, time of the next exchange
};

}  // namespace

struct UnfinishedCalibration {
    ArmProcess process;
    double since = 0.0;  // s, when its calibration began
};

class UnfinishedCalibrations {
  public:
    std::optional<UnfinishedCalibration> take(const std::string& id) {
        const std::lock_guard lock(mutex_);
        const auto found = arms_.find(id);
        if (found == arms_.end()) return {};
        std::optional<UnfinishedCalibration> arm(std::move(found->second));
        arms_.erase(found);
        return arm;
    }
    void keep(const std::string& id, UnfinishedCalibration arm) {
        const std::lock_guard lock(mutex_);
        arms_.insert_or_assign(id, std::move(arm));
    }

  private:
    std::mutex mutex_;
    std::map<std::string, UnfinishedCalibration> arms_;
};

std::shared_ptr<UnfinishedCalibrations> make_unfinished_calibrations() {
    return std::make_shared<UnfinishedCalibrations>();
}

namespace {

// Polls calibrate() every 10 ms until it is done, or the user must act or wait. An arm that moves by
// itself gets calibration_time, as the interface promises.
Result<PluginReply> calibrate(ArmProcess& process, bool may_move, bool may_wait, const Timer& timer) {
    const double began = timer.now();
    for (;;) {
        BOLT_TRY_ASSIGN(const PluginReply reply, process.call(PluginCall::calibrate, may_move ? 1 : 0));
        const bool busy = reply.result == BW_ARM_BUSY;
        const bool without_pause = busy && (may_move || !may_wait);
        const double time = without_pause ? calibration_time : time_for_user;
        const bool goes_on = busy || reply.result == BW_ARM_NEEDS_USER;
        if (!goes_on || timer.now() - began > time) return reply;
        timer.wait(calibration_interval);
    }
}

// `too_late`: the calibration has taken longer than calibration_time.
Error calibration_error(const ArmProcess& process, const PluginReply& reply, const std::string& id,
                        bool too_late) {
    Error error;
    switch (reply.result) {
        case BW_ARM_NEEDS_USER: {
            const std::string text = clean_text({reply.text, ::strnlen(reply.text, sizeof reply.text)});
            error = process.error("it waits for you: " + text, "a calibrated arm");
            set_preparation(error, {DeviceNeed::user, text});
            return error;
        }
        case BW_ARM_MUST_MOVE: {
            const Error immobile = move_permission_error("the arm", id);
            error = process.error(immobile.what, immobile.expected);
            error.detail = immobile.detail;
            return error;
        }
        case BW_ARM_BUSY:
            if (too_late)
                return process.error(
                    fmt::format("the arm has not found its position in {:g} s", calibration_time),
                    "an arm that can move freely");
            error = process.error("the arm is calibrating", "a calibrated arm: wait until it has finished");
            set_preparation(error, {DeviceNeed::wait, {}});
            return error;
        default:
            return process.error(fmt::format("calibrate returns {}", reply.result),
                                 "a result as boltwright_arm.h describes it");
    }
}

}  // namespace

std::vector<std::filesystem::path> plugin_folders() {
    std::vector<std::filesystem::path> folders;
    if (const char* given = std::getenv("BOLTWRIGHT_ARM_PLUGINS")) {
        std::istringstream list(given);
        for (std::string folder; std::getline(list, folder, ':');)
            if (!folder.empty()) folders.emplace_back(folder);
    }
    if (const auto data = user_data_folder()) folders.push_back(*data / "arms");
    folders.emplace_back("/usr/lib/boltwright/arms");
    return folders;
}

std::vector<std::filesystem::path> find_plugins(const std::vector<std::filesystem::path>& folders) {
    std::map<std::string, std::filesystem::path> found;
    for (const std::filesystem::path& folder : folders) {
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
            if (entry.path().extension() == ".so") found.try_emplace(plugin_name(entry.path()), entry.path());
    }
    std::vector<std::filesystem::path> plugins;
    for (const auto& [name, path] : found) plugins.push_back(path);
    return plugins;
}

std::string plugin_arm_id(const std::filesystem::path& plugin, int index) {
    return fmt::format("plugin:{}:{}", plugin_name(plugin), index);
}

Result<int> count_plugin_arms(const std::filesystem::path& plugin) {
    BOLT_TRY_ASSIGN(ArmProcess process, ArmProcess::start(plugin));
    BOLT_TRY_ASSIGN(const PluginReply reply, process.call(PluginCall::count));
    return std::min(reply.result, max_plugin_arms);
}

Result<std::unique_ptr<DeviceDriver>> open_plugin_arm(const PluginArmOptions& options, Timer timer) {
    const std::string id = plugin_arm_id(options.plugin, options.index);
    std::optional<UnfinishedCalibration> arm = options.unfinished_calibrations
                                                   ? options.unfinished_calibrations->take(id)
                                                   : std::optional<UnfinishedCalibration>();
    if (!arm) {
        BOLT_TRY_ASSIGN(auto started, ArmProcess::start(options.plugin));
        BOLT_TRY(started.call(PluginCall::open, options.index));
        arm.emplace(UnfinishedCalibration{std::move(started), timer.now()});
    }
    ArmProcess& process = arm->process;
    BOLT_TRY_ASSIGN(const PluginReply about, process.call(PluginCall::info));
    Result<Description> description = describe_plugin_arm(about.info, options.plugin, options.index);
    if (!description) return fail(process.error(description.error().what, description.error().expected));
    const bool may_wait = options.unfinished_calibrations != nullptr;
    BOLT_TRY_ASSIGN(const PluginReply calibrated, calibrate(process, options.may_move, may_wait, timer));
    if (calibrated.result != BW_ARM_DONE) {
        const bool too_late = !may_wait || options.may_move || timer.now() - arm->since > calibration_time;
        Error error = calibration_error(process, calibrated, id, too_late);
        if (calibrated.result == BW_ARM_NEEDS_USER) arm->since = timer.now();
        const DeviceNeed need = preparation_of(error).need;
        if (may_wait && (need == DeviceNeed::user || need == DeviceNeed::wait))
            options.unfinished_calibrations->keep(id, std::move(*arm));
        return fail(std::move(error));
    }
    BOLT_TRY(process.call(PluginCall::enable, 1));
    const bool senses_rotation = (about.info.flags & BW_ARM_SENSES_ROTATION) != 0;
    return std::make_unique<PluginArm>(std::move(process), std::move(*description), senses_rotation,
                                       std::move(timer));
}

}  // namespace bolt::device
