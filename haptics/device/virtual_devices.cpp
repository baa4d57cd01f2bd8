#include "haptics/device/virtual_devices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/lock_free.hpp"

namespace bolt::device {

namespace {

struct TimedInput {
    PuckInput input;
    double time = 0.0;  // s
};

Vec3 quadratic_response(const Vec3& deflection, double fastest) {
    Vec3 speed(0.0);
    for (int i = 0; i < 3; ++i) {
        const double s = std::clamp(deflection[i], -1.0, 1.0);
        speed[i] = fastest * s * std::abs(s);
    }
    return speed;
}

}  // namespace

struct VirtualPuck::Shared {
    VirtualPuckOptions options;
    Timer timer;
    Description description;
    TripleBuffer<TimedInput> inputs;
};

namespace {

template <class Shared>
class VirtualPuckDevice final : public DeviceDriver {
  public:
    explicit VirtualPuckDevice(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

    [[nodiscard]] const Description& description() const override { return shared_->description; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double period = 1.0 / shared_->options.rate;
        const double due = last_ + period - shared_->timer.now();
        shared_->timer.wait(std::clamp(due, 0.0, timeout));
        if (due > timeout) return std::optional<Sample>{};
        Sample sample;
        sample.time = last_ = shared_->timer.now();
        shared_->inputs.update();
        const TimedInput& latest_input = shared_->inputs.latest();
        if (sample.time - latest_input.time < shared_->options.input_timeout) {
            sample.velocity = quadratic_response(latest_input.input.along, shared_->options.speed);
            sample.angular_velocity =
                quadratic_response(latest_input.input.about, shared_->options.angular_speed);
            sample.buttons = latest_input.input.buttons;
        }
        return sample;
    }

    Status write(const force::OutputCommand& /*command*/) override { return {}; }

  private:
    std::shared_ptr<Shared> shared_;
    double last_ = 0.0;  // s
};

}  // namespace

VirtualPuck::VirtualPuck(const VirtualPuckOptions& options, Timer timer)
    : shared_(std::make_shared<Shared>()) {
    shared_->options = options;
    shared_->timer = std::move(timer);
    shared_->inputs.write({{}, shared_->timer.now() - options.input_timeout});
    Description& d = shared_->description;
    d.name = "mouse and keyboard";
    d.id = "puck";
    d.sensing = Sensing::velocity;
    d.limits.force = d.limits.torque = 0.0;
    d.rate = options.rate;
    d.buttons = 32;
}
VirtualPuck::VirtualPuck(VirtualPuck&&) noexcept = default;
VirtualPuck& VirtualPuck::operator=(VirtualPuck&&) noexcept = default;
VirtualPuck::~VirtualPuck() = default;

void VirtualPuck::set_input(const PuckInput& input) { shared_->inputs.write({input, shared_->timer.now()}); }

DeviceFactory VirtualPuck::factory() {
    return [shared = shared_]() -> Result<std::unique_ptr<DeviceDriver>> {
        return std::make_unique<VirtualPuckDevice<Shared>>(shared);
    };
}

namespace {

class RecordedDevice final : public DeviceDriver {
  public:
    RecordedDevice(Description description, RecordedSamples recording, Timer timer)
        : description_(std::move(description)),
          recording_(std::move(recording)),
          timer_(std::move(timer)),
          next_(recording_(0)) {
        if (next_) start_ = timer_.now() - next_->time;
    }

    [[nodiscard]] const Description& description() const override { return description_; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double until = timer_.now() + timeout;
        const double due = next_ ? start_ + next_->time : last_.time + 1.0 / description_.rate;
        if (due > until) {
            timer_.wait(timeout);
            return std::optional<Sample>{};
        }
        if (due > timer_.now()) timer_.wait(due - timer_.now());
        const double now = timer_.now();
        if (!next_) last_.buttons = 0, last_.velocity = last_.angular_velocity = Vec3(0.0);
        // If several samples are due, return the latest, as a device does that is polled late.
        while (next_ && start_ + next_->time <= now) {
            last_ = *next_;
            next_ = recording_(++index_);
        }
        last_.time = now;
        return last_;
    }

    Status write(const force::OutputCommand& /*command*/) override { return {}; }

  private:
    Description description_;
    RecordedSamples recording_;
    Timer timer_;
    std::optional<Sample> next_;
    std::size_t index_ = 0;
    double start_ = 0.0;  // s of the clock at the recording's time 0
    Sample last_;
};

}  // namespace

DeviceFactory recorded(Description description, RecordedSamples recording, Timer timer) {
    return [description = std::move(description), recording = std::move(recording),
            timer = std::move(timer)]() -> Result<std::unique_ptr<DeviceDriver>> {
        if (!recording(0))
            return fail(ErrorCode::failed, "the recording has no samples", "a session with ticks");
        return std::make_unique<RecordedDevice>(description, recording, timer);
    };
}

namespace {

constexpr double max_step_time = 0.5e-3;  // s
// s without a read or write after which the hand jumps to the intended pose.
constexpr double idle_reset = 0.05;

tl::unexpected<Error> unplugged(const Description& description) {
    return fail(lost_device_error(description.name + " is not plugged in", "a connected device"));
}

}  // namespace

class ScriptedDevice::Connection final : public DeviceDriver {
  public:
    explicit Connection(ScriptedDevice& device) : device_(device), due_(device.timer_.now()) {}
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    ~Connection() override { device_.command_ = {}; }

    [[nodiscard]] const Description& description() const override { return device_.options_.description; }

    Result<std::optional<Sample>> read(double timeout) override {
        wait_if_stuck();
        const double until = device_.timer_.now() + timeout;
        if (device_.is_active(InjectedFault::silent) || due_ > until) {
            device_.timer_.wait(timeout);
            if (device_.is_unplugged()) return unplugged(description());
            return std::optional<Sample>{};
        }
        device_.timer_.wait(due_ - device_.timer_.now());
        if (device_.is_unplugged()) return unplugged(description());
        device_.advance();
        // Missed samples are skipped.
        due_ = std::max(due_, device_.now_.time - 1.0 / description().rate) + 1.0 / description().rate;
        Sample sample = device_.now_;
        if (device_.is_active(InjectedFault::not_a_number))
            sample.pose.position.y = sample.velocity.y = sample.angle =
                std::numeric_limits<double>::quiet_NaN();
        if (device_.is_active(InjectedFault::jumped)) {
            sample.pose.position += Vec3(0.5, 0.0, 0.0);
            sample.angle += 3.0;
        }
        return sample;
    }

    Status write(const force::OutputCommand& command) override {
        wait_if_stuck();
        if (device_.is_active(InjectedFault::slow)) device_.timer_.wait(slow_write_time);
        if (device_.is_unplugged()) return unplugged(description());
        device_.advance();
        const force::OutputLimits& limits = description().limits;
        device_.command_ = {force::clamp_length(command.force, limits.force),
                            force::clamp_length(command.torque, limits.torque)};
        return {};
    }

  private:
    void wait_if_stuck() {
        while (const FaultInterval* stuck = device_.find(InjectedFault::stuck))
            device_.timer_.wait(stuck->until - device_.timer_.now() + 1e-9);
    }

    ScriptedDevice& device_;
    double due_;  // s, of the next sample
};

ScriptedDevice::ScriptedDevice(ScriptedDeviceOptions design, Timer timer)
    : options_(std::move(design)), timer_(std::move(timer)) {
    time_ = timer_.now();
    advance();
}

DeviceFactory ScriptedDevice::factory() {
    return [this]() -> Result<std::unique_ptr<DeviceDriver>> {
        if (is_unplugged()) return unplugged(options_.description);
        advance();
        return std::make_unique<Connection>(*this);
    };
}

void ScriptedDevice::inject(const FaultInterval& fault) {
    std::erase_if(options_.faults, [now = timer_.now()](const FaultInterval& t) { return t.until < now; });
    options_.faults.push_back(fault);
}

const FaultInterval* ScriptedDevice::find(InjectedFault what) const {
    const double now = timer_.now();
    const auto found = std::find_if(
        options_.faults.begin(), options_.faults.end(),
        [&](const FaultInterval& t) { return t.what == what && t.from <= now && now < t.until; });
    return found == options_.faults.end() ? nullptr : &*found;
}

bool ScriptedDevice::is_active(InjectedFault what) const { return find(what) != nullptr; }

// Returns true while unplugged. Without power the motors also lose their command.
bool ScriptedDevice::is_unplugged() {
    if (!is_active(InjectedFault::unplugged)) return false;
    command_ = {};
    return true;
}

force::OutputCommand ScriptedDevice::rendered() const {
    return is_active(InjectedFault::unplugged) ? force::OutputCommand{} : command_;
}

// Advances the hand to the current time.
void ScriptedDevice::advance() {
    const double now = timer_.now();
    if (!options_.hand || !begun_ || now - time_ > idle_reset) {
        now_ = options_.script(now);
        velocity_ = angular_velocity_ = Vec3(0.0);
        turn_rate_ = 0.0;
        begun_ = true;
    } else if (now > time_) {
        const auto steps = static_cast<int>(std::ceil((now - time_) / max_step_time));
        const double dt = (now - time_) / steps;
        const Sample intended = options_.script(now);
        for (int i = 0; i < steps; ++i) step(intended, dt);
        now_.velocity = intended.velocity;
        now_.angular_velocity = intended.angular_velocity;
        now_.buttons = intended.buttons;
    }
    time_ = now_.time = now;
}

// Semi-implicit Euler; stable for much stiffer springs at this step.
void ScriptedDevice::step(const Sample& intended, double dt) {
    const HandImpedance& hand = *options_.hand;
    const force::OutputCommand force = rendered();
    if (options_.description.sensing == Sensing::angle) {
        const double torque = hand.torsion * (intended.angle - now_.angle) -
                              hand.angular_damping * turn_rate_ +
                              glm::dot(force.torque, options_.description.axis);
        turn_rate_ += torque / hand.inertia * dt;
        now_.angle += turn_rate_ * dt;
        return;
    }
    const Vec3 input =
        hand.stiffness * (intended.pose.position - now_.pose.position) - hand.damping * velocity_;
    velocity_ += (input + force.force) / hand.mass * dt;
    now_.pose.position += velocity_ * dt;
    const Vec3 off = turn_between(now_.pose.orientation, intended.pose.orientation);
    const Vec3 twist = hand.torsion * off - hand.angular_damping * angular_velocity_;
    angular_velocity_ += (twist + force.torque) / hand.inertia * dt;
    now_.pose.orientation = glm::normalize(rotation(angular_velocity_ * dt) * now_.pose.orientation);
}

}  // namespace bolt::device
