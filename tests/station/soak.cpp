// A soak test in virtual time: a station whose devices and glove fail at random in all known ways. It lasts
// one hour, under a sanitizer five minutes; BOLTWRIGHT_SOAK_SECONDS and BOLTWRIGHT_SOAK_SEED change duration
// and seed.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <malloc.h>

#include <cstdlib>
#include <deque>

#include "engine/base/random.hpp"
#include "haptics/hand/glove_protocol.hpp"
#include "tests/station/gloved.hpp"
#include "tests/station/support.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/sanitized.hpp"
#include "tools/emulate/glove.hpp"

namespace station_soak_test {

using namespace bolt;
using namespace bolt::station;
using device::InjectedFault;

namespace {

constexpr double dt = 1e-3;
constexpr double force_timeout = 0.020;   // s from a fault until the force is zero
constexpr double report_timeout = 1.0;    // s from a fault until it is reported
constexpr double recovery_timeout = 2.0;  // s from plugging in until a device is usable
constexpr double no_release_time = 0.5;   // s after the glove's return in which nothing is released
constexpr int hand_interval = 50;      // ticks between updates of the hand, whose finger closure is expensive
constexpr double grasp_timeout = 1.5;  // s after which a closed or opened hand has grasped or released

bool is_zero(const force::OutputCommand& c) { return c.force == Vec3(0.0) && c.torque == Vec3(0.0); }

bool mutes(InjectedFault what) {
    return what == InjectedFault::unplugged || what == InjectedFault::silent ||
           what == InjectedFault::not_a_number;
}

// A device of the station with its random faults, and the limits that it must keep.
struct MonitoredDevice {
    test::VirtualLine line;
    Random random;
    device::FaultInterval fault{InjectedFault::silent, -1.0, -1.0};  // the latest one; it may be over
    double healthy_since = 0.0;                                      // s, end of the latest fault
    double undisturbed = 0.0;  // s, time from which no fault delays a write
    bool recovered = true;     // usable since the end of the latest fault
    std::array<std::uint64_t, device::injected_fault_count> counts{};
    double longest_recovery = 0.0;  // s from the end of a fault until it is usable
    // s for which a force remained after the loss of the device, the release of the dead-man switch, or a
    // hang of the servo
    double longest_lost = 0.0, longest_released = 0.0, longest_hung = 0.0;

    MonitoredDevice(device::ScriptedDeviceOptions design, std::uint64_t seed)
        : line(std::move(design)), random(seed) {}

    void advance(double now) {
        if (now >= fault.until && now > healthy_since + 0.1 && random.chance(dt / 4.0)) {
            const auto kind = static_cast<InjectedFault>(random.bits() % device::injected_fault_count);
            // 1 ms to 3 s, uniform in the logarithm.
            const double lasts = 1e-3 * std::exp(random.uniform() * std::log(3000.0));
            fault = {kind, now, now + lasts};
            line.thing.inject(fault);
            ++counts[static_cast<std::size_t>(kind)];
            recovered = false;
        }
        if (now < fault.until) {
            healthy_since = fault.until;
            if (fault.what == InjectedFault::stuck || fault.what == InjectedFault::slow)
                undisturbed = fault.until + device::slow_write_time;
        }
        line.until(now);
    }
};

struct SoakStatistics {
    std::uint64_t ticks = 0, forces = 0, releases = 0, hangs = 0, engaged = 0, allocations = 0,
                  glove_frames = 0;
    std::uint64_t failures = 0;
    std::string first;
    std::uint64_t turned = 0;  // ticks in which the wheel rendered a torque
    double longest_glove = 0.0;
    double largest_step = 0.0;  // m that the commanded tool moved in a tick
    std::uint64_t grasped = 0, released = 0, lost_in_grasp = 0, opened_meanwhile = 0;
    double longest_unreported = 0.0;  // s without a message about a lost glove while the wrench is held

    void require(bool ok, const std::string& what, double now) {
        if (ok) return;
        if (failures++ == 0) first = fmt::format("at {:.3f} s: {}", now, what);
    }
};

DeviceLayout arm_and_wheel() {
    DeviceLayout layout;
    layout.mover = test::arm();
    layout.wheel = test::wheel_of(8.0);
    layout.home.position = Vec3(0.0, 0.15, 0.0);
    return layout;
}

class Soak {
  public:
    explicit Soak(std::uint64_t seed)
        : layout_(arm_and_wheel()),
          setup_(test::two_joints(limits_of(layout_))),
          servo_(servo::initial_state(setup_)),
          state_(initial_state(layout_)),
          arm_({test::arm(), [this](double) { return reach(); }, device::HandImpedance{}, {}}, 4 * seed),
          wheel_({test::wheel_of(8.0),
                  [this](double) { return turn(); },
                  device::HandImpedance{0.3, 300.0, 10.0, 0.01, 30.0, 0.5},
                  {}},
                 4 * seed + 1),
          random_(4 * seed + 2),
          glove_({.sensors = 22, .faults = {1e-4, 1e-4, 1e-4}, .seed = 4 * seed + 3}),
          hand_setup_(test::hand_at_bar()) {}

    SoakStatistics run(double seconds) {
        const auto ticks = static_cast<std::uint64_t>(seconds / dt);
        std::size_t used = 0;
        for (std::uint64_t i = 0; i < ticks; ++i) {
            now_ = static_cast<double>(i) * dt;
            update_controls();
            arm_.advance(now_);
            wheel_.advance(now_);
            if (i % 5 == 0) update_glove();
            if (i % hand_interval == 0) update_gloved_hand();
            if (now_ >= hangs_until_) tick_station();
            check_devices();
            check_recovery();
            if (i == ticks / 4) used = mallinfo2().uordblks;
        }
        const std::size_t at_end = mallinfo2().uordblks;
        statistics_.require(at_end <= used + 65536,
                            fmt::format("{} bytes after a quarter of the time, {} at the end", used, at_end),
                            now_);
        return statistics_;
    }

    MonitoredDevice& arm() { return arm_; }
    MonitoredDevice& wheel() { return wheel_; }

  private:
    // Motion of the hand: to the first nut, some seconds on it, and away, repeatedly.
    device::Sample reach() {
        const servo::NutGeometry& nut = setup_.nuts[0];
        const double phase = std::fmod(now_, 20.0);
        const double height = phase < 2.0 ? 0.1 : phase < 17.0 ? 0.0 : 0.1;
        const Vec3 at = servo::nut_centre(nut, servo_.joints[0].nut.angle) + height * nut.axis;
        const Pose& tool = state_.workspace.commanded_tool;
        const double azimuth = setup_.wrench.head_angle + servo_.joints[0].nut.angle;
        const servo::ToolPose wanted = servo::tool_pose(test::tool_at(nut, at, azimuth));
        const Vec3 turn =
            state_.output.joint >= 0 ? Vec3(0.0) : turn_between(tool.orientation, wanted.orientation);
        device::Sample sample;
        const Pose& hand = state_.mover_pose;
        sample.pose.position = hand.position + force::clamp_length(at - tool.position, 0.02);
        sample.pose.orientation = glm::normalize(rotation(force::clamp_length(turn, 0.1)) * hand.orientation);
        return sample;
    }
    // Tightens to 120 N·m and loosens, repeatedly.
    device::Sample turn() {
        if (state_.output.wrench_torque > 120.0 && direction_ > 0.0) direction_ = -1.0;
        if (servo_.joints[0].nut.angle < 0.3 && direction_ < 0.0) direction_ = 1.0;
        if (now_ > turned_at_) wheel_at_ += direction_ * 1.0 * (now_ - turned_at_);
        turned_at_ = now_;
        device::Sample sample;
        sample.angle = wheel_at_;
        return sample;
    }

    void update_controls() {
        controls_.grip = servo::Grip::wrench;
        if (random_.chance(dt / 10.0)) {
            controls_.dead_man = !controls_.dead_man;
            if (!controls_.dead_man) released_ = now_;
            statistics_.releases += controls_.dead_man ? 0 : 1;
        }
        controls_.clutch =
            random_.chance(dt / 20.0) ? !controls_.clutch : controls_.clutch && !random_.chance(dt / 0.3);
        if (now_ > hangs_until_ + 1.0 && random_.chance(dt / 30.0)) {
            ++statistics_.hangs;
            hang_begins_ = now_;
            hangs_until_ = now_ + random_.uniform(0.001, 0.3);
        }
    }

    void tick_station() {
        StationInputs inputs;
        inputs.mover = arm_.line.snapshot();
        inputs.wheel = wheel_.line.snapshot();
        inputs.controls = controls_;
        inputs.hand_grip = grip_of(hand_);
        inputs.missed =
            static_cast<std::uint64_t>((now_ - ticked_) / dt + 0.5) - (statistics_.ticks > 0 ? 1 : 0);
        ticked_ = now_;
        const test::Forbidden forbidden =
            test::forbidden_in([&] { commands_ = station::tick(layout_, setup_, state_, servo_, inputs); });
        statistics_.allocations += static_cast<std::uint64_t>(forbidden.all());
        arm_.line.command(commands_.mover);
        wheel_.line.command(commands_.wheel);
        ++statistics_.ticks;
        if (!is_zero(commands_.mover)) ++statistics_.forces;
        if (!is_zero(commands_.wheel)) ++statistics_.turned;
        if (state_.output.joint >= 0) ++statistics_.engaged;
    }

    void update_glove() {
        if (now_ > glove_until_ && random_.chance(5e-3 / 10.0)) {
            glove_until_ = now_ + random_.uniform(0.01, 3.0);
            glove_cut_ = random_.chance(0.5);
        }
        const bool troubled = now_ < glove_until_;
        glove_.stalled = troubled && !glove_cut_;
        std::vector<std::uint8_t> inputs = glove_.advance(to_glove_, now_);
        if (troubled && glove_cut_) inputs.clear();
        const std::uint64_t before = statistics_.glove_frames;
        to_glove_ = session_.update(inputs, now_, [&](const hand::GloveFrame& frame) {
            sample_ = {frame, ++statistics_.glove_frames, now_};
        });
        if (troubled && glove_cut_) to_glove_.clear();
        if (troubled || before != statistics_.glove_frames) glove_heard_ = now_;
        statistics_.longest_glove = std::max(statistics_.longest_glove, now_ - glove_heard_);
    }

    // Opens and closes the hand at random times, independently of the glove's state.
    void move_hand() {
        if (now_ > hand_until_) {
            open_ = !open_;
            hand_until_ = now_ + (open_ ? random_.uniform(0.5, 4.0) : random_.uniform(1.0, 20.0));
            moved_at_ = now_;
            if (open_ && hand_.grasp.held && hand_.grasp.lost) ++statistics_.opened_meanwhile;
        }
        glove_.raw = open_ ? raw_open_ : raw_closed_;
    }

    void update_gloved_hand() {
        move_hand();
        const bool held = hand_.grasp.held, lost = hand_.grasp.lost, fresh = sample_.number != hand_.number;
        const ToolPoses place{state_.workspace.commanded_tool, state_.output.constrained_tool};
        hand::GraspEvent event{};
        const test::Forbidden forbidden = test::forbidden_in(
            [&] { event = update_hand(hand_setup_, hand_, sample_, place, hand_interval * dt); });
        statistics_.allocations += static_cast<std::uint64_t>(forbidden.all());
        statistics_.grasped += event == hand::GraspEvent::grasped ? 1 : 0;
        statistics_.released += event == hand::GraspEvent::released ? 1 : 0;
        statistics_.lost_in_grasp += event == hand::GraspEvent::glove_lost && held ? 1 : 0;

        const hand::GraspState& now = hand_.grasp;
        if (fresh) frame_at_ = now_;
        if (fresh && lost) back_at_ = now_;
        const bool dropped = held && !now.held;
        statistics_.require(!dropped || (fresh && !lost), "the wrench is released while the glove is lost",
                            now_);
        statistics_.require(!dropped || now_ - back_at_ > no_release_time,
                            "the wrench is released right after the glove's return", now_);
        // The latest frame may precede the closing.
        statistics_.require(!dropped || open_ || now_ - moved_at_ < 0.1, "a closed hand releases the wrench",
                            now_);
        // A frame sent before the loss may still arrive.
        const double quiet = now_ - frame_at_;
        if (now.held) {
            const auto current_messages = messages({now.held, now.lost}, hand_setup_.wearer.hand.side, {});
            const bool ok = !current_messages.empty() &&
                            current_messages[0].find("stays in your hand") != std::string::npos;
            if (!ok) statistics_.longest_unreported = std::max(statistics_.longest_unreported, quiet);
        }
        statistics_.require(!now.has_frame || quiet <= report_timeout || now.lost,
                            "a lost glove is not reported", now_);
        const double settled_for = now_ - std::max({moved_at_, back_at_, glove_until_ + recovery_timeout});
        statistics_.require(settled_for <= 0.0 || !now.lost, "a returned glove is reported as lost", now_);
        if (settled_for > grasp_timeout)
            statistics_.require(
                now.held != open_,
                open_ ? "an open hand holds the wrench" : "a closed hand does not hold the wrench", now_);
    }

    void check_devices() {
        const bool hangs = now_ < hangs_until_;
        const force::Fault fault = state_.output.fault;
        if (fault == force::Fault::none) faulty_since_ = now_;
        // A sample that is off moves no tool.
        const Vec3 tool = state_.workspace.commanded_tool.position;
        statistics_.largest_step = std::max(statistics_.largest_step, glm::distance(tool, tool_));
        tool_ = tool;
        for (MonitoredDevice* w : {&arm_, &wheel_}) {
            const char* who = w == &arm_ ? "arm" : "wheel";
            const device::FaultInterval& t = w->fault;
            const force::OutputCommand rendered = w->line.thing.rendered();
            const force::OutputCommand& command = w == &arm_ ? commands_.mover : commands_.wheel;
            const auto is = [&](const char* what) { return fmt::format("{} {}", who, what); };
            const force::OutputLimits& limits = (w == &arm_ ? layout_.mover : layout_.wheel)->limits;
            if (glm::length(rendered.force) > limits.force * 1.0001 ||
                glm::length(rendered.torque) > limits.torque * 1.0001)
                statistics_.require(false, is("exceeds its limits"), now_);
            // A device's thread may be one step ahead of the servo.
            if (now_ < t.until && w->line.now() < t.until) {
                const double since = now_ - t.from;
                if (mutes(t.what) && !is_zero(rendered)) w->longest_lost = std::max(w->longest_lost, since);
                if (mutes(t.what) && since > force_timeout && !is_zero(rendered))
                    statistics_.require(false, is("is lost and renders a force"), now_);
                if (t.what == InjectedFault::stuck && since > force_timeout && !hangs && !is_zero(command))
                    statistics_.require(false, is("is stuck and gets a force command"), now_);
                if (mutes(t.what) && since > report_timeout && w->line.status().fault_message.empty())
                    statistics_.require(false, is("is lost and not reported"), now_);
                if (t.what == InjectedFault::stuck && since > report_timeout && w == &arm_ && !hangs &&
                    w->line.status().fault_message.empty() && state_.output.fault == force::Fault::none &&
                    state_.output.joint < 0)
                    statistics_.require(false, is("is stuck and not reported"), now_);
            } else if (!w->recovered) {
                if (w->line.status().state == device::DeviceState::usable && w->line.snapshot().usable) {
                    w->recovered = true;
                    w->longest_recovery = std::max(w->longest_recovery, now_ - t.until);
                } else if (now_ - w->healthy_since > recovery_timeout) {
                    statistics_.require(false, is("is plugged in and not usable"), now_);
                }
            }
            if (now_ > w->undisturbed) {
                if (!controls_.dead_man && !hangs && !is_zero(rendered))
                    w->longest_released = std::max(w->longest_released, now_ - released_);
                const double hung = now_ - std::max(hang_begins_, w->undisturbed);
                if (hangs && !is_zero(rendered)) w->longest_hung = std::max(w->longest_hung, hung);
                if (now_ - faulty_since_ > force_timeout && !hangs && !is_zero(rendered))
                    statistics_.require(false, is("renders a force during a fault of the output"), now_);
                if (!controls_.dead_man && now_ - released_ > force_timeout && !hangs && !is_zero(rendered))
                    statistics_.require(false, is("renders a force without the dead-man switch"), now_);
                if (hangs && hung > force_timeout && !is_zero(rendered))
                    statistics_.require(false, is("renders a force while the servo hangs"), now_);
            }
        }
    }
    void check_recovery() {
        const double since = std::max({arm_.healthy_since, wheel_.healthy_since, hangs_until_});
        if (now_ - since > recovery_timeout && state_.output.fault != force::Fault::none)
            statistics_.require(false,
                                fmt::format("no device has a fault, but the output has \"{}\"",
                                            force::message_for(state_.output.fault)),
                                now_);
    }

    double now_ = 0.0, ticked_ = 0.0, released_ = -1.0;
    double hangs_until_ = -1.0, hang_begins_ = -1.0, faulty_since_ = 0.0;
    Vec3 tool_ = arm_and_wheel().home.position;  // m, commanded at the last tick
    double wheel_at_ = 0.0, turned_at_ = 0.0, direction_ = 1.0;
    // Declared before the devices, whose hands use them.
    DeviceLayout layout_;
    servo::Setup setup_;
    servo::State servo_;
    StationState state_;
    MonitoredDevice arm_, wheel_;
    Random random_;
    emulate::EmulatedGlove glove_;
    hand::GloveSession session_;
    HandSetup hand_setup_;
    HandState hand_;
    hand::GloveSample sample_;
    const hand::PerSensor<std::uint8_t> raw_open_ = test::raw_open(), raw_closed_ = test::raw_closed();
    bool open_ = true;  // the hand
    double moved_at_ = 0.0, hand_until_ = 3.0;
    double frame_at_ = 0.0, back_at_ = -1.0;  // s, of the latest frame, and of the glove's latest return
    std::vector<std::uint8_t> to_glove_;
    double glove_until_ = -1.0, glove_heard_ = 0.0;
    bool glove_cut_ = false;
    StationControls controls_{.dead_man = true};
    DeviceCommands commands_;
    SoakStatistics statistics_;
};

std::uint64_t seed() {
    const char* wanted = std::getenv("BOLTWRIGHT_SOAK_SEED");
    return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 1;
}

double seconds() {
    if (const char* wanted = std::getenv("BOLTWRIGHT_SOAK_SECONDS")) return std::atof(wanted);
    return test::sanitized ? 300.0 : 3600.0;
}

}  // namespace

TEST_CASE("Station: an hour of faulty devices leaves no force behind, and all devices recover") {
    Soak soak(seed());
    const SoakStatistics statistics = soak.run(seconds());
    MESSAGE(fmt::format(
        "{} ticks, {} with a force, {} with a torque at the wheel, {} engaged; {} glove frames",
        statistics.ticks, statistics.forces, statistics.turned, statistics.engaged, statistics.glove_frames));
    for (MonitoredDevice* w : {&soak.arm(), &soak.wheel()})
        MESSAGE(fmt::format(
            "faults {} {} {} {} {} {}; longest force {:.0f} ms after a loss, {:.0f} ms after a release, "
            "{:.0f} ms after a hang of the servo; usable again after {:.3f} s",
            w->counts[0], w->counts[1], w->counts[2], w->counts[3], w->counts[4], w->counts[5],
            1e3 * w->longest_lost, 1e3 * w->longest_released, 1e3 * w->longest_hung, w->longest_recovery));
    MESSAGE(fmt::format("{} releases, {} hangs; glove usable again after at most {:.3f} s",
                        statistics.releases, statistics.hangs, statistics.longest_glove));
    MESSAGE(
        fmt::format("the hand grasped {} times and released {} times; glove lost during a grasp {} times "
                    "(opened meanwhile {} times), reported after at most {:.2f} s",
                    statistics.grasped, statistics.released, statistics.lost_in_grasp,
                    statistics.opened_meanwhile, statistics.longest_unreported));
    CHECK_MESSAGE(statistics.failures == 0, statistics.failures << " failures, first " << statistics.first);
    CHECK(statistics.allocations == 0);
    CHECK(statistics.longest_glove <= recovery_timeout);
    MESSAGE("the tool moved by ", 1e3 * statistics.largest_step, " mm in a tick at most");
    // Verifies that all situations occurred.
    CHECK(statistics.forces > statistics.ticks / 20);
    CHECK(statistics.turned > statistics.ticks / 50);
    CHECK(statistics.engaged > statistics.ticks / 20);
    CHECK(statistics.releases > 2);
    CHECK(statistics.hangs > 2);
    CHECK(statistics.largest_step < 0.1);
    for (MonitoredDevice* w : {&soak.arm(), &soak.wheel()})
        for (const std::uint64_t count : w->counts) CHECK(count > 2);
    CHECK(statistics.glove_frames > statistics.ticks / 50);
    CHECK(statistics.longest_unreported <= report_timeout);
    CHECK(statistics.grasped > 5);
    CHECK(statistics.released > 5);
    CHECK(statistics.lost_in_grasp > 5);
    CHECK(statistics.opened_meanwhile > 0);
}

}  // namespace station_soak_test
