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

// Minutes at the ZQ350 as a servo sees them: a simulated arm presses and slides the wrench along the casing,
// hits it, sweeps through rows of bolts, goes onto nuts and turns them, and gives way to what it feels.

namespace bolt::bench {

struct Servo {
    servo::Setup setup;
    servo::State state;
};

// How the device differs from the usual one.
struct Device {
    double dt = 1e-3;      // s, of a tick
    double encoder = 0.0;  // m, a step of it; 0: as fine as numbers are
    bool renders_torque = true;
};

Result<Servo> make_servo(const Device& device);

// The state at the beginning again, what is touched included.
void restart(Servo& servo);

// What the arm's device sends while the servo runs, for so many seconds. The same for the same seed.
std::vector<servo::Input> make_path(Servo& servo, const Device& device, double seconds, std::uint64_t seed);

namespace {

constexpr double mm = 1e-3;
constexpr double fastest = 0.5, fastest_turn = 3.0;  // m/s, rad/s: of a hand that holds a wrench

// The next target of the hand, and the duration.
struct Leg {
    Pose to;
    double seconds = 0.0;
    std::int16_t guide = -1;
};

Vec3 random_direction(Random& random) {
    return glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(1e-9, 0, 0));
}

// A tool whose handle is along `x` and whose normal is `z`.
Quat lying(const Vec3& x, const Vec3& z) {
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

class Hand {
  public:
    Hand(const Servo& servo, std::uint64_t seed)
        : servo_(servo),
          touch_(*servo.state.tool_contact),
          seen_(collision::make_narrow_phase(touch_.world, touch_.wrench)),
          random_(seed) {
        const collision::Solid& still = touch_.world.shapes[touch_.world.bodies[0].shape].solid;
        middle_ = still.middle;
        high_ = still.box.high.y + 0.1;
        half_ = 0.5 * (still.box.high - still.box.low);
    }

    [[nodiscard]] Pose begin() const { return {Vec3(middle_.x, high_, middle_.z), Quat(1, 0, 0, 0)}; }

    // The next segment from the present pose.
    std::vector<Leg> plan(const Pose& now) {
        const double what = random_.uniform();
        std::vector<Leg> legs;
        if (what < 0.4)
            at_a_nut(legs);
        else if (what < 0.75)
            along_the_casing(legs);
        else
            through_a_row(legs);
        // Over all obstacles to the start.
        std::vector<Leg> way;
        if (!legs.empty()) {
            const Pose& first = legs.front().to;
            const Vec3 up(now.position.x, high_, now.position.z),
                over(first.position.x, high_, first.position.z);
            way.push_back({{up, now.orientation}, 0.3});
            way.push_back({{over, first.orientation}, 0.5, legs.front().guide});
        }
        way.insert(way.end(), legs.begin(), legs.end());
        return way;
    }

  private:
    void at_a_nut(std::vector<Leg>& legs) {
        const auto joint = static_cast<std::int16_t>(random_.bits() % servo_.setup.nuts.size());
        const servo::NutGeometry& nut = servo_.setup.nuts[static_cast<std::size_t>(joint)];
        const double angle = servo_.state.joints[static_cast<std::size_t>(joint)].nut.angle;
        const Vec3 home = servo::nut_centre(nut, angle);
        std::optional<Quat> fits;
        for (int turn = 0; turn < 6 && !fits; ++turn) {
            const double handle = angle + servo_.setup.wrench.head_angle + turn * pi / 3.0;
            const Quat lies = lying(std::cos(handle) * nut.e1 - std::sin(handle) * nut.e2, nut.axis);
            if (free({home + 25 * mm * nut.axis, lies})) fits = lies;
        }
        if (!fits) return;
        const Quat misfit = glm::angleAxis(to_radians(random_.uniform(-4.0, 4.0)), nut.axis);
        const Vec3 aside = random_.uniform(0.0, 0.8 * mm) * random_direction(random_);
        legs.push_back({{home + 40 * mm * nut.axis, *fits}, 0.4, joint});
        legs.push_back({{home - 2 * mm * nut.axis + aside, misfit * *fits}, 0.6, joint});
        legs.push_back({{home, *fits}, 0.3, joint});
        for (int i = 0; i < 3; ++i) {
            const Quat about = glm::angleAxis(-to_radians(random_.uniform(-10.0, 40.0)), nut.axis);
            const Quat tilt = rotation(to_radians(random_.uniform(0.0, 3.0)) * random_direction(random_));
            const Vec3 pull = random_.uniform(0.0, 4 * mm) * random_direction(random_);
            legs.push_back(
                {{home + pull, glm::normalize(tilt * about * *fits)}, random_.uniform(0.4, 1.2), joint});
        }
        legs.push_back({{home, *fits}, 0.5});
        legs.push_back({{home + 40 * mm * nut.axis, *fits}, 0.4});
    }

    // Against the casing from outside, on along it while pressing, and off.
    void along_the_casing(std::vector<Leg>& legs) {
        const collision::Solid& casing = touch_.world.shapes[touch_.world.bodies[0].shape].solid;
        for (int tries = 0; tries < 50; ++tries) {
            const std::size_t t = random_.bits() % casing.mesh.triangles.size();
            const auto [a, b, c] = collision::corners(casing.mesh, t);
            const Vec3 at = (a + b + c) / 3.0, out = glm::normalize(Vec3(casing.mesh.face_normals[t]));
            const Vec3 on_tool =
                touch_.wrench.samples.samples[random_.bits() % touch_.wrench.samples.samples.size()].at;
            const Quat turn = glm::normalize(rotation(3.0 * random_.uniform() * random_direction(random_)));
            const auto place = [&](const Vec3& p) { return Pose{p - turn * on_tool, turn}; };
            if (!free(place(at + 20 * mm * out))) continue;
            const Vec3 along =
                random_.uniform(20.0, 80.0) * mm * glm::normalize(glm::cross(out, random_direction(random_)));
            legs.push_back({place(at + 20 * mm * out), 0.3});
            const double speed = random_.uniform(0.05, 0.5);
            legs.push_back({place(at - random_.uniform(5.0, 25.0) * mm * out), 40 * mm / speed});
            legs.push_back({place(at - 10 * mm * out + along), 1.0});
            legs.push_back({place(at - 10 * mm * out - along), 1.5});
            legs.push_back({place(at + 20 * mm * out), 0.3});
            return;
        }
    }

    // From one side of the machine to the other at the height of its bolts.
    void through_a_row(std::vector<Leg>& legs) {
        const servo::NutGeometry& nut = servo_.setup.nuts[random_.bits() % servo_.setup.nuts.size()];
        const Vec3 across = random_.chance(0.5) ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
        const double way = 0.12, height = random_.uniform(-10.0, 25.0) * mm;
        const Quat lies = glm::normalize(
            rotation(0.3 * random_direction(random_)) *
            lying(glm::normalize(nut.e1 * random_.normal() + nut.e2 * random_.normal()), nut.axis));
        const Vec3 at = nut.seat + height * nut.axis;
        const double seconds = 2.0 * way / random_.uniform(0.1, 0.5);
        legs.push_back({{at - way * across + 0.05 * nut.axis, lies}, 0.3});
        legs.push_back({{at - way * across, lies}, 0.3});
        legs.push_back({{at + way * across, lies}, seconds});
        legs.push_back({{at + way * across + 0.05 * nut.axis, lies}, 0.3});
    }

    bool free(const Pose& pose) {
        std::array<collision::Contact, 1> any;
        return collision::find_contacts(touch_.world, touch_.wrench, pose, 2 * mm, seen_, any).count == 0;
    }

    const Servo& servo_;
    const servo::ToolContact& touch_;
    collision::NarrowPhaseState seen_;
    Random random_;
    Vec3 middle_{0.0}, half_{0.0};
    double high_ = 0.0;
};

servo::DeviceSample sample_of(const Pose& pose, double encoder) {
    servo::DeviceSample sample;
    for (int i = 0; i < 3; ++i) {
        const double p = encoder > 0.0 ? encoder * std::round(pose.position[i] / encoder) : pose.position[i];
        sample.position[i] = static_cast<float>(p);
    }
    const Quat& q = pose.orientation;
    const std::array<double, 4> wxyz{q.w, q.x, q.y, q.z};
    for (std::size_t i = 0; i < 4; ++i) sample.orientation[i] = static_cast<float>(wxyz[i]);
    return sample;
}

}  // namespace

Result<Servo> make_servo(const Device& device) {
    content::Loaded loaded = content::load_assembly("zq350");
    if (!loaded.ok()) return fail(loaded.errors.front());
    force::OutputLimits limits;
    if (!device.renders_torque) limits.torque = 0.0;
    Servo servo;
    servo.setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, limits, 1, device.dt);
    Result<std::optional<servo::ToolContact>> touch =
        session::load_tool_contact(loaded.assembly, servo.setup);
    if (!touch) return fail(touch.error());
    if (!touch->has_value()) return fail(ErrorCode::bad_content, "zq350 has nothing to bump into");
    servo.state = servo::initial_state(servo.setup);
    servo.state.tool_contact = std::move(*touch);
    return servo;
}

void restart(Servo& servo) {
    servo::ToolContact touch = std::move(*servo.state.tool_contact);
    touch.narrow_phase = collision::make_narrow_phase(touch.world, touch.wrench);
    touch.god_object = {};
    touch.seated_joint = -1;
    touch.last_step = {};
    touch.in_hand = false;
    touch.touched = {};
    servo.state = servo::initial_state(servo.setup);
    servo.state.tool_contact = std::move(touch);
}

std::vector<servo::Input> make_path(Servo& servo, const Device& device, double seconds, std::uint64_t seed) {
    const double dt = servo.setup.dt;
    const auto ticks = static_cast<std::size_t>(seconds / dt);
    // A hand that leans on the tool.
    const trainees::Impedance impedance{.force = 15.0, .torque = 1.5};
    trainees::Arm arm;
    Hand hand(servo, seed);
    std::vector<servo::Input> inputs;
    inputs.reserve(ticks);
    Pose meant = hand.begin();
    servo::Output felt;
    while (inputs.size() < ticks)
        for (const Leg& leg : hand.plan(meant)) {
            const Pose from = meant;
            const double turn = glm::length(
                rotation_vector(glm::normalize(leg.to.orientation * glm::conjugate(from.orientation))));
            const double least =
                1.875 * std::max(glm::length(leg.to.position - from.position) / fastest, turn / fastest_turn);
            const int steps = std::max(1, static_cast<int>(std::max(leg.seconds, least) / dt));
            for (int i = 1; i <= steps && inputs.size() < ticks; ++i) {
                const double t = static_cast<double>(i) / steps;
                const double s = minimum_jerk(t);
                meant = {glm::mix(from.position, leg.to.position, s),
                         glm::slerp(from.orientation, leg.to.orientation, s)};
                servo::Input input;
                input.enabled = true;
                input.grip = servo::Grip::wrench;
                input.guide = leg.guide;
                input.device = sample_of(
                    trainees::follow(impedance, arm, meant, {felt.force, felt.torque}, felt.joint >= 0, dt),
                    device.encoder);
                inputs.push_back(input);
                felt = servo::tick(servo.setup, servo.state, input);
            }
        }
    return inputs;
}

}  // namespace bolt::bench

// The whole tick (contact, nut and joint, guiding, coupling, output stage) of 12 joints on the ZQ350, over
// ten minutes of a simulated arm in contact. The counters are microseconds of CPU time. p50 … max: of the
// ticks of one run; own_*: of the least time of each tick in five runs, which excludes interruptions. step,
// step_torque: the greatest change in a millisecond, as a share of the device's limit.

namespace {

using namespace bolt;
using bench::guarded;
using bench::need;

constexpr int rounds = 5;

struct Felt {
    std::size_t ticks = 0, touching = 0, engaged = 0, faults = 0;
    double step = 0.0, torque_step = 0.0;  // N, N·m in a millisecond

    explicit Felt(double dt) : millisecond_(static_cast<std::size_t>(std::lround(1e-3 / dt))) {}

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

void servo_tick(benchmark::State& state, const bench::Device& device, double seconds, bool touches) {
    guarded(state, [&] {
        bench::Servo servo = need(bench::make_servo(device));
        const std::vector<servo::Input> inputs = bench::make_path(servo, device, seconds, 1);
        for (auto _ : state) {
            std::vector<double> first(inputs.size()), least(inputs.size(), 1e9);
            Felt felt(device.dt);
            servo::Output last;
            for (int round = 0; round < rounds; ++round) {
                bench::restart(servo);
                std::optional<servo::ToolContact> apart;
                if (!touches) apart = std::exchange(servo.state.tool_contact, std::nullopt);
                felt = Felt(device.dt);
                servo::Output before;
                for (std::size_t i = 0; i < inputs.size(); ++i) {
                    const double start = bench::thread_microseconds();
                    const servo::Output output = servo::tick(servo.setup, servo.state, inputs[i]);
                    const double took = bench::thread_microseconds() - start;
                    if (round == 0) first[i] = took;
                    least[i] = std::min(least[i], took);
                    felt.add(output);
                    before = output;
                }
                if (round > 0 && (before.force != last.force || before.tool.position != last.tool.position))
                    throw std::runtime_error("the same inputs felt otherwise");
                last = before;
                if (!touches) servo.state.tool_contact = std::move(apart);
            }
            for (const auto& [name, share] : {std::pair("p50", 0.5), std::pair("p99", 0.99),
                                              std::pair("p99.9", 0.999), std::pair("max", 1.0)}) {
                state.counters[name] = bench::quantile(first, share);
                state.counters["own_" + std::string(name)] = bench::quantile(least, share);
            }
            const auto of_all = [&](std::size_t count) {
                return static_cast<double>(count) / static_cast<double>(felt.ticks);
            };
            state.counters["touching"] = of_all(felt.touching);
            state.counters["engaged"] = of_all(felt.engaged);
            state.counters["faults"] = of_all(felt.faults);
            state.counters["step"] = felt.step / servo.setup.limits.force;
            if (servo.setup.limits.torque > 0.0)
                state.counters["step_torque"] = felt.torque_step / servo.setup.limits.torque;
            // The slowest by CPU time.
            std::vector<std::size_t> order(inputs.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
            std::partial_sort(order.begin(), order.begin() + 1, order.end(),
                              [&](std::size_t a, std::size_t b) { return least[a] > least[b]; });
            state.SetLabel(std::to_string(inputs.size()) + " ticks, the slowest by its own work " +
                           std::to_string(order[0]));
        }
    });
}

#define SERVO_TICK(name, ...) \
    BENCHMARK_CAPTURE(servo_tick, name, __VA_ARGS__)->Iterations(1)->Unit(benchmark::kMillisecond)

SERVO_TICK(at_1_kHz, bench::Device{}, 600.0, true);
// Baseline: the same hand without obstacles.
SERVO_TICK(at_1_kHz_without_contact, bench::Device{}, 600.0, false);
SERVO_TICK(at_4_kHz_encoder_27_um, (bench::Device{.dt = 0.25e-3, .encoder = 27e-6}), 120.0, true);
SERVO_TICK(at_1_kHz_force_at_the_grip, (bench::Device{.renders_torque = false}), 120.0, true);

}  // namespace
