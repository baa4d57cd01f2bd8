// Benchmark of the whole servo tick (contact, nut and joint, guiding, coupling, output stage) with 12 joints
// on the ZQ350, over ten minutes of a simulated arm in contact. The counters are microseconds of CPU time.
// p50 … max: of the ticks of one run; best_*: of the shortest time of each tick in five runs, which excludes
// interruptions. step, step_torque: the greatest change of force and torque in a millisecond, as a fraction
// of the device's limit.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "engine/base/result.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/human_model.hpp"
#include "haptics/servo/tick.hpp"
#include "tools/bench/harness.hpp"

namespace bolt::bench {

struct ServoFixture {
    servo::Setup setup;
    servo::State state;
};

// Properties of the device.
struct DeviceModel {
    double dt = 1e-3;      // s, tick period
    double encoder = 0.0;  // m, resolution of the position; 0: unlimited
    bool renders_torque = true;
};

namespace {

constexpr double max_speed = 0.5, max_turn_speed = 3.0;  // m/s, rad/s: limits of a hand that holds a wrench

// The next target of the hand, and the least duration.
struct MotionTarget {
    Pose to;
    double seconds = 0.0;
    std::int16_t guided_joint = -1;
};

Vec3 any_direction(Random& random) {
    return glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(1e-9, 0, 0));
}

// Returns the orientation of a tool with its handle along `x` and its normal along `z`.
Quat tool_orientation(const Vec3& x, const Vec3& z) {
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

// Plans the motions of a hand: it puts the wrench onto nuts and turns them, presses and slides it along the
// casing, and sweeps through rows of bolts.
class MotionPlanner {
  public:
    MotionPlanner(const ServoFixture& servo, std::uint64_t seed)
        : servo_(servo),
          contact_(*servo.state.tool_contact),
          narrow_phase_(collision::make_narrow_phase(contact_.world, contact_.wrench)),
          random_(seed) {
        const collision::Solid& still = contact_.world.shapes[contact_.world.bodies[0].shape].solid;
        middle_ = still.middle;
        high_ = still.box.high.y + 0.1;
    }

    [[nodiscard]] Pose begin() const { return {Vec3(middle_.x, high_, middle_.z), Quat(1, 0, 0, 0)}; }

    // Plans the next sequence of motions from the pose `now`.
    std::vector<MotionTarget> plan_next(const Pose& now) {
        const double choice = random_.uniform();
        std::vector<MotionTarget> task;
        if (choice < 0.4)
            plan_nut(task);
        else if (choice < 0.75)
            plan_slide(task);
        else
            plan_sweep(task);
        // Move above all obstacles to the start.
        std::vector<MotionTarget> motions;
        if (!task.empty()) {
            const Pose& first = task.front().to;
            const Vec3 up(now.position.x, high_, now.position.z),
                over(first.position.x, high_, first.position.z);
            motions.push_back({{up, now.orientation}, 0.3});
            motions.push_back({{over, first.orientation}, 0.5, task.front().guided_joint});
        }
        motions.insert(motions.end(), task.begin(), task.end());
        return motions;
    }

  private:
    void plan_nut(std::vector<MotionTarget>& motions) {
        const auto joint = static_cast<std::int16_t>(random_.bits() % servo_.setup.nuts.size());
        const servo::NutGeometry& nut = servo_.setup.nuts[static_cast<std::size_t>(joint)];
        const double angle = servo_.state.joints[static_cast<std::size_t>(joint)].nut.angle;
        const Vec3 home = servo::nut_centre(nut, angle);
        std::optional<Quat> fitting;
        for (int turn = 0; turn < 6 && !fitting; ++turn) {
            const double handle = angle + servo_.setup.wrench.head_angle + turn * pi / 3.0;
            const Quat orientation =
                tool_orientation(std::cos(handle) * nut.e1 - std::sin(handle) * nut.e2, nut.axis);
            if (free({home + 25 * mm * nut.axis, orientation})) fitting = orientation;
        }
        if (!fitting) return;
        const Quat misfit = glm::angleAxis(to_radians(random_.uniform(-4.0, 4.0)), nut.axis);
        const Vec3 aside = random_.uniform(0.0, 0.8 * mm) * any_direction(random_);
        motions.push_back({{home + 40 * mm * nut.axis, *fitting}, 0.4, joint});
        motions.push_back({{home - 2 * mm * nut.axis + aside, misfit * *fitting}, 0.6, joint});
        motions.push_back({{home, *fitting}, 0.3, joint});
        for (int i = 0; i < 3; ++i) {
            const Quat about = glm::angleAxis(-to_radians(random_.uniform(-10.0, 40.0)), nut.axis);
            const Quat tilt = rotation(to_radians(random_.uniform(0.0, 3.0)) * any_direction(random_));
            const Vec3 pull = random_.uniform(0.0, 4 * mm) * any_direction(random_);
            motions.push_back(
                {{home + pull, glm::normalize(tilt * about * *fitting)}, random_.uniform(0.4, 1.2), joint});
        }
        motions.push_back({{home, *fitting}, 0.5});
        motions.push_back({{home + 40 * mm * nut.axis, *fitting}, 0.4});
    }

    // Presses against the casing from outside, slides along it and leaves.
    void plan_slide(std::vector<MotionTarget>& motions) {
        const collision::Solid& casing = contact_.world.shapes[contact_.world.bodies[0].shape].solid;
        for (int tries = 0; tries < 50; ++tries) {
            const std::size_t t = random_.bits() % casing.mesh.triangles.size();
            const auto [a, b, c] = collision::corners(casing.mesh, t);
            const Vec3 at = (a + b + c) / 3.0, out = glm::normalize(Vec3(casing.mesh.face_normals[t]));
            const Vec3 on_tool =
                contact_.wrench.samples.samples[random_.bits() % contact_.wrench.samples.samples.size()].at;
            const Quat turn = glm::normalize(rotation(3.0 * random_.uniform() * any_direction(random_)));
            const auto pose_at = [&](const Vec3& p) { return Pose{p - turn * on_tool, turn}; };
            if (!free(pose_at(at + 20 * mm * out))) continue;
            const Vec3 along =
                random_.uniform(20.0, 80.0) * mm * glm::normalize(glm::cross(out, any_direction(random_)));
            motions.push_back({pose_at(at + 20 * mm * out), 0.3});
            const double speed = random_.uniform(0.05, 0.5);
            motions.push_back({pose_at(at - random_.uniform(5.0, 25.0) * mm * out), 40 * mm / speed});
            motions.push_back({pose_at(at - 10 * mm * out + along), 1.0});
            motions.push_back({pose_at(at - 10 * mm * out - along), 1.5});
            motions.push_back({pose_at(at + 20 * mm * out), 0.3});
            return;
        }
    }

    // Moves from one side of the machine to the other at the height of its bolts.
    void plan_sweep(std::vector<MotionTarget>& motions) {
        const servo::NutGeometry& nut = servo_.setup.nuts[random_.bits() % servo_.setup.nuts.size()];
        const Vec3 across = random_.chance(0.5) ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
        const double distance = 0.12, height = random_.uniform(-10.0, 25.0) * mm;
        const Quat orientation = glm::normalize(
            rotation(0.3 * any_direction(random_)) *
            tool_orientation(glm::normalize(nut.e1 * random_.normal() + nut.e2 * random_.normal()),
                             nut.axis));
        const Vec3 at = nut.seat + height * nut.axis;
        const double seconds = 2.0 * distance / random_.uniform(0.1, 0.5);
        motions.push_back({{at - distance * across + 0.05 * nut.axis, orientation}, 0.3});
        motions.push_back({{at - distance * across, orientation}, 0.3});
        motions.push_back({{at + distance * across, orientation}, seconds});
        motions.push_back({{at + distance * across + 0.05 * nut.axis, orientation}, 0.3});
    }

    bool free(const Pose& pose) {
        std::array<collision::Contact, 1> any;
        return collision::find_contacts(contact_.world, contact_.wrench, pose, 2 * mm, narrow_phase_, any)
                   .count == 0;
    }

    const ServoFixture& servo_;
    const servo::ToolContact& contact_;
    collision::NarrowPhaseState narrow_phase_;
    Random random_;
    Vec3 middle_{0.0};
    double high_ = 0.0;
};

servo::CommandedTool command_of(const Pose& pose, double encoder) {
    servo::CommandedTool commanded;
    for (int i = 0; i < 3; ++i) {
        const double p = encoder > 0.0 ? encoder * std::round(pose.position[i] / encoder) : pose.position[i];
        commanded.position[i] = static_cast<float>(p);
    }
    const Quat& q = pose.orientation;
    const std::array<double, 4> wxyz{q.w, q.x, q.y, q.z};
    for (std::size_t i = 0; i < 4; ++i) commanded.orientation[i] = static_cast<float>(wxyz[i]);
    return commanded;
}

Result<ServoFixture> make_servo(const DeviceModel& device) {
    content::LoadedAssembly loaded = content::load_assembly("zq350");
    if (!loaded.ok()) return fail(loaded.errors.front());
    force::OutputLimits limits;
    if (!device.renders_torque) limits.torque = 0.0;
    ServoFixture servo;
    servo.setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, limits, 1, device.dt);
    Result<std::optional<servo::ToolContact>> contact =
        session::load_tool_contact(loaded.assembly, servo.setup);
    if (!contact) return fail(contact.error());
    if (!contact->has_value())
        return fail(ErrorCode::bad_content, "zq350: has no contact model", "one of each of its parts");
    servo.state = servo::initial_state(servo.setup);
    servo.state.tool_contact = std::move(*contact);
    return servo;
}

// Resets the servo and its contact state.
void reset(ServoFixture& servo) {
    servo::ToolContact contact = std::move(*servo.state.tool_contact);
    contact.narrow_phase = collision::make_narrow_phase(contact.world, contact.wrench);
    contact.god_object = {};
    contact.joint_at_head = -1;
    contact.last_step = {};
    contact.in_hand = false;
    contact.touched = {};
    servo.state = servo::initial_state(servo.setup);
    servo.state.tool_contact = std::move(contact);
}

// Returns the device samples of a simulated arm that yields to the rendered force while the servo runs. The
// result is the same for the same seed.
std::vector<servo::TickInput> make_path(ServoFixture& servo, const DeviceModel& device, double seconds,
                                        std::uint64_t seed) {
    const double dt = servo.setup.dt;
    const auto ticks = static_cast<std::size_t>(seconds / dt);
    // The impedance of a hand that leans on the tool.
    const trainees::Impedance impedance{.max_force = 15.0, .max_torque = 1.5};
    trainees::HandDeflection arm;
    MotionPlanner hand(servo, seed);
    std::vector<servo::TickInput> inputs;
    inputs.reserve(ticks);
    Pose target = hand.begin();
    servo::Output output;
    while (inputs.size() < ticks)
        for (const MotionTarget& leg : hand.plan_next(target)) {
            const Pose from = target;
            const double turn = glm::length(turn_between(from.orientation, leg.to.orientation));
            const double least = 1.875 * std::max(glm::length(leg.to.position - from.position) / max_speed,
                                                  turn / max_turn_speed);
            const int steps = std::max(1, static_cast<int>(std::max(leg.seconds, least) / dt));
            for (int i = 1; i <= steps && inputs.size() < ticks; ++i) {
                const double t = static_cast<double>(i) / steps;
                const double s = minimum_jerk(t);
                target = {glm::mix(from.position, leg.to.position, s),
                          glm::slerp(from.orientation, leg.to.orientation, s)};
                servo::TickInput input;
                input.dead_man = true;
                input.grip = servo::Grip::wrench;
                input.guided_joint = leg.guided_joint;
                input.commanded_tool = command_of(
                    trainees::step_deflection(impedance, arm, target, {output.force, output.torque},
                                              output.joint >= 0, dt),
                    device.encoder);
                inputs.push_back(input);
                output = servo::tick(servo.setup, servo.state, input);
            }
        }
    return inputs;
}

}  // namespace

}  // namespace bolt::bench

namespace {

using namespace bolt;
using bench::run_or_skip;
using bench::unwrap;

constexpr int rounds = 5;

// Statistics of the rendered forces.
struct ForceStatistics {
    std::size_t ticks = 0, touching = 0, engaged = 0, faults = 0;
    double step = 0.0, torque_step = 0.0;  // N and N·m, greatest change in a millisecond

    explicit ForceStatistics(double dt) : millisecond_(static_cast<std::size_t>(std::lround(1e-3 / dt))) {}

    void add(const servo::Output& now) {
        touching += now.touched.is_none() ? 0U : 1U;
        engaged += now.joint >= 0 ? 1U : 0U;
        faults += now.fault != force::Fault::none ? 1U : 0U;
        force::OutputCommand& before = millisecond_[ticks % millisecond_.size()];
        step = std::max(step, glm::length(now.force - before.force));
        torque_step = std::max(torque_step, glm::length(now.torque - before.torque));
        before = {now.force, now.torque};
        ++ticks;
    }

  private:
    std::vector<force::OutputCommand> millisecond_;
};

void servo_tick(benchmark::State& state, const bench::DeviceModel& device, double seconds, bool touches) {
    run_or_skip(state, [&] {
        bench::ServoFixture servo = unwrap(bench::make_servo(device));
        const std::vector<servo::TickInput> inputs = bench::make_path(servo, device, seconds, 1);
        for (auto _ : state) {
            std::vector<double> first(inputs.size()), least(inputs.size(), 1e9);
            ForceStatistics forces(device.dt);
            servo::Output last;
            for (int round = 0; round < rounds; ++round) {
                bench::reset(servo);
                std::optional<servo::ToolContact> removed_contact;
                if (!touches) removed_contact = std::exchange(servo.state.tool_contact, std::nullopt);
                forces = ForceStatistics(device.dt);
                servo::Output before;
                for (std::size_t i = 0; i < inputs.size(); ++i) {
                    const double start = bench::thread_microseconds();
                    const servo::Output output = servo::tick(servo.setup, servo.state, inputs[i]);
                    const double took = bench::thread_microseconds() - start;
                    if (round == 0) first[i] = took;
                    least[i] = std::min(least[i], took);
                    forces.add(output);
                    before = output;
                }
                if (round > 0 && (before.force != last.force ||
                                  before.constrained_tool.position != last.constrained_tool.position))
                    throw std::runtime_error("the same inputs give different outputs");
                last = before;
                if (!touches) servo.state.tool_contact = std::move(removed_contact);
            }
            for (const auto& [name, share] : {std::pair("p50", 0.5), std::pair("p99", 0.99),
                                              std::pair("p99.9", 0.999), std::pair("max", 1.0)}) {
                state.counters[name] = bench::quantile(first, share);
                state.counters["best_" + std::string(name)] = bench::quantile(least, share);
            }
            const auto of_all = [&](std::size_t count) {
                return static_cast<double>(count) / static_cast<double>(forces.ticks);
            };
            state.counters["touching"] = of_all(forces.touching);
            state.counters["engaged"] = of_all(forces.engaged);
            state.counters["faults"] = of_all(forces.faults);
            state.counters["step"] = forces.step / servo.setup.limits.force;
            if (servo.setup.limits.torque > 0.0)
                state.counters["step_torque"] = forces.torque_step / servo.setup.limits.torque;
            // Find the slowest tick by CPU time.
            std::vector<std::size_t> order(inputs.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
            std::partial_sort(order.begin(), order.begin() + 1, order.end(),
                              [&](std::size_t a, std::size_t b) { return least[a] > least[b]; });
            state.SetLabel(std::to_string(inputs.size()) + " ticks; slowest by CPU time: tick " +
                           std::to_string(order[0]));
        }
    });
}

#define SERVO_TICK(name, ...) \
    BENCHMARK_CAPTURE(servo_tick, name, __VA_ARGS__)->Iterations(1)->Unit(benchmark::kMillisecond)

SERVO_TICK(at_1_kHz, bench::DeviceModel{}, 600.0, true);
// Baseline: the same hand without obstacles.
SERVO_TICK(at_1_kHz_without_contact, bench::DeviceModel{}, 600.0, false);
SERVO_TICK(at_4_kHz_encoder_27_um, (bench::DeviceModel{.dt = 0.25e-3, .encoder = 27e-6}), 120.0, true);
SERVO_TICK(at_1_kHz_force_at_the_grip, (bench::DeviceModel{.renders_torque = false}), 120.0, true);

}  // namespace
