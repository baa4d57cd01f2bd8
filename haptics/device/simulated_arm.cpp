#include "haptics/device/simulated_arm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/lock_free.hpp"

namespace bolt::device {

namespace {

Vec3 quantised(const Vec3& v, double step) {
    if (step <= 0.0) return v;
    return {step * std::floor(v.x / step + 0.5), step * std::floor(v.y / step + 0.5),
            step * std::floor(v.z / step + 0.5)};
}

// Returns the velocity after time h under a force, implicit damping, and dry friction, which may stop but not
// reverse the motion.
Vec3 accelerated(const Vec3& v, const Vec3& force, double mass, double damping, double friction, double h) {
    const Vec3 free = (v + force * (h / mass)) / (1.0 + h * damping / mass);
    const double speed = glm::length(free), lost = h * friction / mass;
    return speed <= lost ? Vec3(0.0) : free * (1.0 - lost / speed);
}

}  // namespace

Pose encoder_pose(const ArmModel& arm) {
    return {quantised(arm.pose.position, arm.parameters.encoder),
            rotation(quantised(rotation_vector(arm.pose.orientation), arm.parameters.angular_encoder))};
}

void step(ArmModel& arm, const force::OutputCommand& command, double dt) {
    const HandAndArmParameters& p = arm.parameters;
    for (std::size_t i = arm.sent.size() - 1; i > 0; --i) arm.sent[i] = arm.sent[i - 1];
    arm.sent[0] = command;
    const force::OutputCommand& had = arm.sent[static_cast<std::size_t>(p.delay)];
    const int parts = static_cast<int>(std::lround(dt / 25e-6));
    const double h = dt / parts;
    for (int i = 0; i < parts; ++i) {
        const Vec3 pull =
            p.stiffness * (arm.intention.position - arm.pose.position) + p.damping * arm.intention_velocity;
        const Vec3 turn = p.angular_stiffness * rotation_vector(arm.intention.orientation *
                                                                glm::conjugate(arm.pose.orientation)) +
                          p.angular_damping * arm.intention_angular_velocity;
        arm.velocity = accelerated(arm.velocity, had.force + pull, p.mass, p.damping, p.friction, h);
        arm.angular_velocity = accelerated(arm.angular_velocity, had.torque + turn, p.inertia,
                                           p.angular_damping, p.angular_friction, h);
        arm.pose.position += h * arm.velocity;
        arm.pose.orientation = glm::normalize(rotation(h * arm.angular_velocity) * arm.pose.orientation);
        arm.energy_to_hand +=
            h * (glm::dot(had.force, arm.velocity) + glm::dot(had.torque, arm.angular_velocity));
    }
}

namespace {

constexpr double sample_period = 1e-3;   // s between two samples
constexpr int max_late_steps = 20;       // that one read makes up for; a longer delay is skipped
constexpr double rounding = 1e-9;        // s
constexpr double input_timeout = 0.25;   // s without set_motion() until the buttons count as released
constexpr double smoothing_time = 0.02;  // s in which the intention follows the mouse: about a frame
// The same for a measured hand. A headset predicts the pose for the time at which the frame is shown, at
// least a frame ahead, so this delay does not show.
constexpr double target_smoothing_time = 0.01;  // s

struct TimedMotion {
    HandMotion motion;
    double time = 0.0;  // s
};

}  // namespace

struct SimulatedArm::Shared {
    Description description;
    HandAndArmParameters parameters;
    Timer timer;
    TripleBuffer<TimedMotion> motions;
    ArmModel arm;  // of the thread that reads the device; outlives a disconnection
};

namespace {

// `commanded_intention_` is the intended pose as the mouse sets it, in steps; ArmModel::intention follows it
// smoothly.
template <class Shared>
class SimulatedArmDevice final : public DeviceDriver {
  public:
    explicit SimulatedArmDevice(std::shared_ptr<Shared> shared)
        : shared_(std::move(shared)), next_(shared_->timer.now() + sample_period) {
        shared_->motions.update();
        last_ = shared_->motions.latest().motion;
        relax();
    }
    SimulatedArmDevice(const SimulatedArmDevice&) = delete;
    SimulatedArmDevice& operator=(const SimulatedArmDevice&) = delete;
    ~SimulatedArmDevice() override = default;

    [[nodiscard]] const Description& description() const override { return shared_->description; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double due = next_ - shared_->timer.now();
        shared_->timer.wait(std::clamp(due, 0.0, timeout));
        if (due > timeout + rounding) return std::optional<Sample>{};
        const double now = shared_->timer.now();
        follow(now);
        const int late = std::min(static_cast<int>((now - next_) / sample_period), max_late_steps);
        for (int i = 0; i <= std::max(late, 0); ++i) advance();
        next_ = std::max(next_ + sample_period, now);
        const ArmModel& arm = shared_->arm;
        Sample read;
        read.pose = encoder_pose(arm);
        read.velocity = arm.velocity;
        read.angular_velocity = arm.angular_velocity;
        read.buttons = last_.buttons;
        read.gripper = last_.gripper;
        read.time = now;
        return std::optional<Sample>(read);
    }

    Status write(const force::OutputCommand& command) override {
        const force::OutputLimits& limits = shared_->description.limits;
        command_ = {force::clamp_length(command.force, limits.force),
                    force::clamp_length(command.torque, limits.torque)};
        return {};
    }

  private:
    // Adds the motion of the mouse since the last read.
    void follow(double now) {
        shared_->motions.update();
        const TimedMotion& latest = shared_->motions.latest();
        HandMotion motion = latest.motion;
        if (now - latest.time > input_timeout) {
            motion.buttons = 0;
            motion.gripper = 1.0;
        }
        if (motion.buttons == 0 && last_.buttons != 0) relax();
        commanded_intention_.position += motion.moved - last_.moved;
        commanded_intention_.orientation =
            glm::normalize(motion.turned * glm::conjugate(last_.turned) * commanded_intention_.orientation);
        if (motion.target && !last_.target) jump(*motion.target);
        if (!motion.target && last_.target) relax();
        last_ = motion;
    }

    void jump(const Pose& pose) {
        ArmModel& arm = shared_->arm;
        arm.pose = pose;
        arm.velocity = arm.angular_velocity = Vec3(0.0);
        relax();
    }

    // A hand that releases the handle, or is no longer measured, stays at the arm's pose.
    void relax() {
        ArmModel& arm = shared_->arm;
        commanded_intention_ = arm.intention = arm.pose;
        arm.intention_velocity = arm.intention_angular_velocity = Vec3(0.0);
    }

    void advance() {
        ArmModel& arm = shared_->arm;
        if (last_.target) commanded_intention_ = *last_.target;
        commanded_intention_.position =
            arm.pose.position +
            force::clamp_length(commanded_intention_.position - arm.pose.position, last_.max_deflection);
        const Vec3 ahead = turn_between(arm.pose.orientation, commanded_intention_.orientation);
        if (glm::length(ahead) > last_.max_angular_deflection)
            commanded_intention_.orientation = glm::normalize(
                rotation(force::clamp_length(ahead, last_.max_angular_deflection)) * arm.pose.orientation);
        const double yielded_share = std::min(1.0, last_.compliance_rate * sample_period);
        commanded_intention_.position += yielded_share * (arm.pose.position - commanded_intention_.position);
        const double share = sample_period / (last_.target ? target_smoothing_time : smoothing_time);
        const Vec3 step_along = share * (commanded_intention_.position - arm.intention.position),
                   step_about =
                       share * turn_between(arm.intention.orientation, commanded_intention_.orientation);
        arm.intention.position += step_along;
        arm.intention.orientation = glm::normalize(rotation(step_about) * arm.intention.orientation);
        if (last_.target) {
            arm.intention_velocity = step_along / sample_period;
            arm.intention_angular_velocity = step_about / sample_period;
        }
        step(arm, command_, sample_period);
    }

    std::shared_ptr<Shared> shared_;
    force::OutputCommand command_;
    HandMotion last_;
    Pose commanded_intention_;
    double next_;  // s, time of the next sample
};

}  // namespace

SimulatedArm::SimulatedArm(const Description& description, const HandAndArmParameters& parameters,
                           Timer timer)
    : shared_(std::make_shared<Shared>()) {
    shared_->description = description;
    shared_->parameters = parameters;
    shared_->timer = std::move(timer);
    shared_->arm.parameters = parameters;
    shared_->motions.write({{}, shared_->timer.now() - 2.0 * input_timeout});
}
SimulatedArm::SimulatedArm(SimulatedArm&&) noexcept = default;
SimulatedArm& SimulatedArm::operator=(SimulatedArm&&) noexcept = default;
SimulatedArm::~SimulatedArm() = default;

void SimulatedArm::set_motion(const HandMotion& motion) {
    shared_->motions.write({motion, shared_->timer.now()});
}

DeviceFactory SimulatedArm::factory() {
    return [shared = shared_]() -> Result<std::unique_ptr<DeviceDriver>> {
        return std::make_unique<SimulatedArmDevice<Shared>>(shared);
    };
}

Description simulated_arm_description() {
    Description d;
    d.name = "simulated arm";
    d.id = "simulated-arm";
    d.renders = {true, true, true, false, false, false};
    d.limits.force = 12.0;
    d.limits.torque = 0.0;
    d.limits.stiffness = 2000.0;
    d.limits.torsion = 0.0;
    d.limits.damping = 15.0;
    d.limits.angular_damping = 0.0;
    d.limits.ramp_up = 0.1;  // nobody can be hurt
    d.rate = 1.0 / sample_period;
    d.buttons = 8;
    d.remarks.emplace_back("renders no torque: torques are rendered as forces on the handle");
    return d;
}

Description tracked_hand_description() {
    Description d = simulated_arm_description();
    d.name = "tracked hand";
    d.id = "tracked-hand";
    d.buttons = 0;
    d.senses_gripper = true;
    d.remarks = {"renders no force: the shown hand is held back instead"};
    return d;
}

HandAndArmParameters simulated_arm_parameters() {
    HandAndArmParameters p;
    p.damping = 18.0;          // close to critical with 0.3 kg and 300 N/m
    p.angular_damping = 0.13;  // close to critical with 2e-3 kg·m² and 2 N·m/rad
    return p;
}

}  // namespace bolt::device
