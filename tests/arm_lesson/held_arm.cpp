#include "tests/arm_lesson/held_arm.hpp"

#include <doctest/doctest.h>

#include "haptics/device/force_dimension.hpp"
#include "haptics/device/haply_messages.hpp"
#include "haptics/device/open_haptics.hpp"
#include "haptics/device/simulated_arm.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/support/emulated_arms.hpp"
#include "tools/emulate/arms/haply_model.hpp"

namespace bolt::test {

namespace {

// The controls of an emulated library and the clock of its arm, s.
template <class Controls>
struct ArmAndTime {
    double now = 0.0;
    Controls controls;
};

constexpr Vec3 touch_centre(0.0, 0.01, 0.01);  // m, of the box that the emulated Touch reports
constexpr unsigned fault_of_the_arm = 0x300, too_much_force = 0x201;

// A direction in our axes from the vendor's, which have x to the user, y to the right and z up, and back.
Vec3 ours(const double v[3]) { return {v[1], v[2], v[0]}; }
Vec3 theirs(const Vec3& v) { return {v.z, v.x, v.y}; }

}  // namespace

namespace {

struct HaplyArmAndTime {
    double now = 0.0;
    emulate::HaplyArmModel model{{}};
};

// One message and its answer each millisecond, as the driver does.
class MessagedHaply final : public device::DeviceDriver {
  public:
    MessagedHaply(std::shared_ptr<HaplyArmAndTime> arm, device::Timer timer, device::HaplyInventory inventory)
        : arm_(std::move(arm)), timer_(std::move(timer)), inventory_(std::move(inventory)) {
        // As haply.cpp describes an Inverse3.
        description_.name = "Haply Inverse3";
        description_.id = "haply:0";
        description_.renders = {true, true, true, false, false, false};
        description_.limits.force = 10.0;
        description_.limits.torque = description_.limits.torsion = 0.0;
        description_.limits.stiffness = 1000.0;
        description_.limits.damping = 5.0;
        description_.limits.angular_damping = 0.0;
        description_.limits.delay = 3;
        description_.half_workspace = Vec3(0.1);
        description_.buttons = 3;
    }

    [[nodiscard]] const device::Description& description() const override { return description_; }

    Result<std::optional<device::Sample>> read(double timeout) override {
        timer_.wait(std::min(timeout, 1e-3));
        const auto answer =
            arm_->model.answer(device::haply_force_message(inventory_.arms.front(), force_, false));
        if (!answer)
            return fail(device::lost_device_error("the service closed the connection", "the service"));
        if (answer->empty()) return std::optional<device::Sample>{};
        BOLT_TRY_ASSIGN(const auto state, device::parse_haply_state(*answer, inventory_.arms.front(),
                                                                    &inventory_.grips.front()));
        device::Sample sample;
        sample.pose = {state.position, state.orientation.value_or(Quat(1.0, 0.0, 0.0, 0.0))};
        sample.velocity = state.velocity;
        sample.buttons = state.buttons;
        sample.time = timer_.now();
        return std::optional<device::Sample>(sample);
    }
    Status write(const force::OutputCommand& command) override {
        force_ = force::clamp_length(command.force, description_.limits.force);
        return {};
    }

  private:
    std::shared_ptr<HaplyArmAndTime> arm_;
    device::Timer timer_;
    device::HaplyInventory inventory_;
    device::Description description_;
    Vec3 force_{0.0};
};

// The service's frame has x to the right, y forward and z up.
Vec3 service_axes(const Vec3& v) { return {v.x, -v.z, v.y}; }
Vec3 our_axes(const Vec3& v) { return {v.x, v.z, -v.y}; }

}  // namespace

std::unique_ptr<HeldArm> haply_arm() {
    using emulate::HaplyFault;
    auto arm = std::make_unique<HeldArm>();
    const auto held = std::make_shared<HaplyArmAndTime>();
    arm->name = "Haply";
    arm->timer = {[held] { return held->now; },
                  [held](double seconds) {
                      held->now += seconds;
                      held->model.advance(seconds);
                  }};
    arm->open = [held, timer = arm->timer]() -> Result<std::unique_ptr<device::DeviceDriver>> {
        BOLT_TRY_ASSIGN(auto inventory, device::parse_haply_inventory(held->model.inventory()));
        if (inventory.arms.empty() || !inventory.arms.front().calibrated)
            return fail(device::lost_device_error("there is no calibrated arm", "one"));
        return std::make_unique<MessagedHaply>(held, timer, std::move(inventory));
    };
    arm->intend = [held](const Pose& pose) {
        held->model.intention = service_axes(pose.position);
        const Quat& q = pose.orientation;
        held->model.orientation = {q.w, q.x, -q.z, q.y};
    };
    arm->press = [held](std::uint32_t buttons) { held->model.buttons = buttons; };
    arm->force = [held] { return force::OutputCommand{our_axes(held->model.force()), {}}; };
    const auto fault = [&](const char* name, HaplyFault kind) {
        arm->faults.push_back({name, [held, kind] { held->model.set_fault(kind); },
                               [held] { held->model.set_fault(HaplyFault::none); }});
    };
    fault("silence", HaplyFault::silence);
    fault("nonsense", HaplyFault::nonsense);
    fault("no position", HaplyFault::null_position);
    fault("millimetres", HaplyFault::millimetres);
    fault("no unit quaternion", HaplyFault::turn);
    fault("uncalibrated", HaplyFault::uncalibrated);
    fault("missing", HaplyFault::missing);
    fault("closed", HaplyFault::close);
    return arm;
}

std::unique_ptr<HeldArm> force_dimension_arm(bool active, ArmClock clock) {
    auto arm = std::make_unique<HeldArm>();
    const auto held = std::make_shared<ArmAndTime<ForceDimensionControls>>();
    const std::shared_ptr<ForceDimensionControls> c(held, &held->controls);
    if (clock == ArmClock::virtual_time) c->reset();
    c->initialized(1);
    c->active_wrist(active ? 1 : 0);
    arm->name = active ? "Force Dimension, motors in the wrist" : "Force Dimension";
    arm->intend = [c](const Pose& pose) {
        const Vec3 at = theirs(pose.position);
        c->intend(at.x, at.y, at.z);
        double rotation[3][3];
        const Vec3 columns[] = {theirs(pose.orientation * Vec3(0, 0, 1)),
                                theirs(pose.orientation * Vec3(1, 0, 0)),
                                theirs(pose.orientation * Vec3(0, 1, 0))};
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) rotation[row][column] = columns[column][row];
        c->turn(rotation);
    };
    arm->press = [c](std::uint32_t buttons) { c->buttons(buttons); };
    arm->force = [c] {
        double out[6];
        c->force(out);
        return force::OutputCommand{ours(out), ours(out + 3)};
    };
    if (clock == ArmClock::real_time) return arm;
    const auto api = device::load_force_dimension({BOLT_EMULATED_FORCE_DIMENSION});
    REQUIRE(api);
    arm->timer = advancing_timer(held->now, c->advance);
    arm->open = [api = *api, timer = arm->timer] {
        return device::open_force_dimension(api, {0, false}, timer);
    };
    arm->faults = {{"unplugged", [c] { c->unplug(1); }, [c] { c->unplug(0); }},
                   {"braked", [c] { c->speed_limit(0.0); }, [c] { c->speed_limit(2.0); }},
                   {"stale frames", [c] { c->stale(1); }, [c] { c->stale(0); }},
                   {"not a number", [c] { c->corrupt(1); }, [c] { c->corrupt(0); }},
                   {"millimetres", [c] { c->millimetres(1); }, [c] { c->millimetres(0); }}};
    return arm;
}

std::unique_ptr<HeldArm> open_haptics_arm(ArmClock clock) {
    auto arm = std::make_unique<HeldArm>();
    const auto held = std::make_shared<ArmAndTime<OpenHapticsControls>>();
    const std::shared_ptr<OpenHapticsControls> c(held, &held->controls);
    if (clock == ArmClock::virtual_time) c->reset();
    arm->name = "OpenHaptics";
    arm->intend = [c](const Pose& pose) {
        const Vec3 at = pose.position + touch_centre;
        c->intend(at.x, at.y, at.z);
        const double gimbal[3] = {};
        double rotation[3][3];
        for (int column = 0; column < 3; ++column) {
            Vec3 unit(0.0);
            unit[column] = 1.0;
            const Vec3 turned = pose.orientation * unit;
            for (int row = 0; row < 3; ++row) rotation[row][column] = turned[row];
        }
        c->turn(gimbal, rotation);
    };
    arm->press = [c](std::uint32_t buttons) { c->buttons(static_cast<int>(buttons)); };
    arm->force = [c] {
        double out[6];
        c->force(out);
        return force::OutputCommand{{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
    };
    if (clock == ArmClock::real_time) return arm;
    const auto api = device::load_open_haptics({BOLT_EMULATED_OPEN_HAPTICS});
    REQUIRE(api);
    arm->timer = advancing_timer(held->now, c->advance);
    arm->open = [api = *api, timer = arm->timer] { return device::open_open_haptics(api, timer); };
    arm->faults = {
        {"unplugged", [c] { c->unplug(1); }, [c] { c->unplug(0); }},
        {"too fast", [c] { c->speed_limit(0.0); }, [c] { c->speed_limit(2.0); }},
        {"warm", [c] { c->heat(1.0); }, [c] { c->heat(0.0); }},
        {"saturated", [c] { c->raise(too_much_force); }, [] {}, false},
        {"a fault of the arm", [c] { c->raise(fault_of_the_arm); }, [] {}, false},
        {"not a number", [c] { c->corrupt(1); }, [c] { c->corrupt(0); }},
        {"stalled", [c] { c->late(0.5); }, [] {}},
        {"switched off", [c] { c->switch_off(); }, [] {}},
    };
    return arm;
}

namespace {

// The latest force on the hand, and pose of the arm.
struct Observed {
    force::OutputCommand command;
    Pose pose;
};

class ObservedDriver final : public device::DeviceDriver {
  public:
    ObservedDriver(std::unique_ptr<device::DeviceDriver> driver, std::shared_ptr<Observed> last)
        : driver_(std::move(driver)), last_(std::move(last)) {}
    [[nodiscard]] const device::Description& description() const override { return driver_->description(); }
    Result<std::optional<device::Sample>> read(double timeout) override {
        auto sample = driver_->read(timeout);
        if (sample && *sample) last_->pose = (*sample)->pose;
        return sample;
    }
    Status write(const force::OutputCommand& command) override {
        last_->command = command;
        return driver_->write(command);
    }

  private:
    std::unique_ptr<device::DeviceDriver> driver_;
    std::shared_ptr<Observed> last_;
};

struct SimulatedArmAndTime {
    device::VirtualTime time;
    device::SimulatedArm arm{device::simulated_arm_description(), device::simulated_arm_parameters(),
                             device::virtual_timer(time)};
    device::HandMotion motion;
    Pose intended;
};

constexpr double correction = 3e-3;  // per tick, of the error that the user sees

}  // namespace

std::unique_ptr<HeldArm> simulated_arm() {
    auto arm = std::make_unique<HeldArm>();
    const auto held = std::make_shared<SimulatedArmAndTime>();
    const auto last = std::make_shared<Observed>();
    arm->name = "Simulated arm";
    arm->timer = device::virtual_timer(held->time);
    arm->open = [held, last]() -> Result<std::unique_ptr<device::DeviceDriver>> {
        BOLT_TRY_ASSIGN(auto driver, held->arm.factory()());
        return std::make_unique<ObservedDriver>(std::move(driver), last);
    };
    // A mouse only moves the hand further; the user sees where the arm is.
    arm->intend = [held, last](const Pose& pose) {
        device::HandMotion& m = held->motion;
        const Quat turned = pose.orientation * glm::conjugate(held->intended.orientation);
        const Vec3 seen = turn_between(last->pose.orientation, pose.orientation);
        m.moved +=
            pose.position - held->intended.position + correction * (pose.position - last->pose.position);
        m.turned = glm::normalize(rotation(correction * seen) * turned * m.turned);
        held->intended = pose;
        held->arm.set_motion(m);
    };
    arm->press = [held](std::uint32_t buttons) {
        held->motion.buttons = buttons;
        held->arm.set_motion(held->motion);
    };
    arm->force = [last] { return last->command; };
    arm->braces = false;
    arm->damping = device::simulated_arm_parameters().damping;
    return arm;
}

}  // namespace bolt::test
