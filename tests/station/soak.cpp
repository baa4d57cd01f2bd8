// Two hours at a station whose devices and glove fail in every way that we know, at random, in virtual time.
// Two hours by default; BOLTWRIGHT_SOAK_SECONDS and BOLTWRIGHT_SOAK_SEED say otherwise. Under a sanitizer ten
// minutes.
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

using namespace bolt;
using namespace bolt::station;
using device::InjectedFault;

namespace {

constexpr double dt = 1e-3;
constexpr double gone = 0.020;        // s until no force is left
constexpr double said = 1.0;          // s until it is said
constexpr double usable_again = 2.0;  // s from plugging in
constexpr double thinks = 0.5;        // s after the glove is back in which nothing falls
constexpr int looks = 50;             // ticks between two of the hand at its glove: its closing costs most
constexpr double done = 1.5;          // s after which a hand that closed or opened has taken or let go

bool nothing(const force::OutputCommand& c) { return c.force == Vec3(0.0) && c.torque == Vec3(0.0); }

bool mutes(InjectedFault what) {
    return what == InjectedFault::unplugged || what == InjectedFault::silent ||
           what == InjectedFault::not_a_number;
}

// A device of the station, what befalls it, and whether the promises are kept.
struct Watched {
    test::VirtualLine line;
    Random random;
    device::FaultInterval trouble{InjectedFault::silent, -1.0,
                                  -1.0};  // the newest; in the past if there is none now
    double sound_since = 0.0;             // when the last one ended
    double undisturbed = 0.0;             // when nothing any more kept a write from going through
    bool again = true;                    // usable since then
    std::array<std::uint64_t, device::injected_fault_count> counts{};
    double longest_back = 0.0;  // s from the end of a mishap to being usable
    double longest_lost = 0.0, longest_let_go = 0.0, longest_hung = 0.0;  // s that a force stayed

    Watched(device::SimulatedDeviceOptions design, std::uint64_t seed)
        : line(std::move(design)), random(seed) {}

    void live(double now) {
        if (now >= trouble.until && now > sound_since + 0.1 && random.chance(dt / 4.0)) {
            const auto kind = static_cast<InjectedFault>(random.bits() % device::injected_fault_count);
            // A millisecond to three seconds, as many short ones as long ones.
            const double lasts = 1e-3 * std::exp(random.uniform() * std::log(3000.0));
            trouble = {kind, now, now + lasts};
            line.thing.inject(trouble);
            ++counts[static_cast<std::size_t>(kind)];
            again = false;
        }
        if (now < trouble.until) {
            sound_since = trouble.until;
            if (trouble.what == InjectedFault::stuck || trouble.what == InjectedFault::slow)
                undisturbed = trouble.until + device::slow_write_time;
        }
        line.until(now);
    }
};

struct Tally {
    std::uint64_t ticks = 0, forces = 0, releases = 0, hangs = 0, jumps = 0, engaged = 0, allocations = 0,
                  glove_frames = 0;
    std::uint64_t failures = 0;
    std::string first;
    std::uint64_t turned = 0;  // ticks in which the wheel felt the bolt
    double longest_glove = 0.0;
    std::uint64_t taken = 0, let_go = 0, lost_in_grasp = 0, opened_meanwhile = 0;
    double longest_untold = 0.0;  // s of a lost glove with the wrench in the hand

    void must(bool so, const std::string& what, double now) {
        if (so) return;
        if (failures++ == 0) first = fmt::format("at {:.3f} s: {}", now, what);
    }
};

Layout arm_and_wheel() {
    Layout layout;
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
          plan_(test::hand_at_bar()) {}

    Tally run(double seconds) {
        const auto ticks = static_cast<std::uint64_t>(seconds / dt);
        std::size_t used = 0;
        for (std::uint64_t i = 0; i < ticks; ++i) {
            now_ = static_cast<double>(i) * dt;
            wish();
            arm_.live(now_);
            wheel_.live(now_);
            if (i % 5 == 0) talk();
            if (i % looks == 0) grip();
            if (now_ >= hangs_until_) serve();
            watch();
            all_is_well_again();
            if (i == ticks / 4) used = mallinfo2().uordblks;
        }
        const std::size_t at_end = mallinfo2().uordblks;
        tally_.must(at_end <= used + 65536, fmt::format("{} bytes at a quarter, {} at the end", used, at_end),
                    now_);
        return tally_;
    }

    Watched& arm() { return arm_; }
    Watched& wheel() { return wheel_; }

  private:
    // What the hand does: to the first nut, some seconds on it, away, over and over.
    device::Sample reach() {
        const servo::NutGeometry& nut = setup_.nuts[0];
        const double phase = std::fmod(now_, 20.0);
        const double height = phase < 2.0 ? 0.1 : phase < 17.0 ? 0.0 : 0.1;
        const Vec3 at = servo::nut_centre(nut, servo_.joints[0].nut.angle) + height * nut.axis;
        const Pose& tool = state_.workspace.tool;
        const double azimuth = setup_.wrench.head_angle + servo_.joints[0].nut.angle;
        const servo::ToolPose wanted = servo::pose_of(test::tool_at(nut, at, azimuth));
        const Vec3 turn =
            state_.output.joint >= 0
                ? Vec3(0.0)
                : rotation_vector(glm::normalize(wanted.orientation * glm::conjugate(tool.orientation)));
        device::Sample meant;
        const Pose& hand = state_.hand;
        meant.pose.position = hand.position + force::clamp_length(at - tool.position, 0.02);
        meant.pose.orientation = glm::normalize(rotation(force::clamp_length(turn, 0.1)) * hand.orientation);
        return meant;
    }
    // Tightens to 120 N·m, loosens to nothing.
    device::Sample turn() {
        if (state_.output.wrench_torque > 120.0 && direction_ > 0.0) direction_ = -1.0;
        if (servo_.joints[0].nut.angle < 0.3 && direction_ < 0.0) direction_ = 1.0;
        if (now_ > turned_at_) wheel_at_ += direction_ * 1.0 * (now_ - turned_at_);
        turned_at_ = now_;
        device::Sample meant;
        meant.turn = wheel_at_;
        return meant;
    }

    void wish() {
        controls_.grip = servo::Grip::wrench;
        if (random_.chance(dt / 10.0)) {
            controls_.dead_man = !controls_.dead_man;
            if (!controls_.dead_man) released_ = now_;
            tally_.releases += controls_.dead_man ? 0 : 1;
        }
        controls_.clutch =
            random_.chance(dt / 20.0) ? !controls_.clutch : controls_.clutch && !random_.chance(dt / 0.3);
        if (now_ > hangs_until_ + 1.0 && random_.chance(dt / 30.0)) {
            ++tally_.hangs;
            hang_begins_ = now_;
            hangs_until_ = now_ + random_.uniform(0.001, 0.3);
        }
    }

    void serve() {
        StationInputs heard;
        heard.mover = arm_.line.snapshot();
        heard.wheel = wheel_.line.snapshot();
        heard.controls = controls_;
        heard.hand_grip = grip_of(hand_);
        heard.missed = static_cast<std::uint64_t>((now_ - ticked_) / dt + 0.5) - (tally_.ticks > 0 ? 1 : 0);
        ticked_ = now_;
        const test::Forbidden forbidden =
            test::forbidden_in([&] { answer_ = station::tick(layout_, setup_, state_, servo_, heard); });
        tally_.allocations += static_cast<std::uint64_t>(forbidden.all());
        arm_.line.command(answer_.mover);
        wheel_.line.command(answer_.wheel);
        ++tally_.ticks;
        if (!nothing(answer_.mover)) ++tally_.forces;
        if (!nothing(answer_.wheel)) ++tally_.turned;
        if (state_.output.joint >= 0) ++tally_.engaged;
    }

    void talk() {
        if (now_ > glove_until_ && random_.chance(5e-3 / 10.0)) {
            glove_until_ = now_ + random_.uniform(0.01, 3.0);
            glove_cut_ = random_.chance(0.5);
        }
        const bool troubled = now_ < glove_until_;
        glove_.stalled = troubled && !glove_cut_;
        std::vector<std::uint8_t> heard = glove_.advance(said_, now_);
        if (troubled && glove_cut_) heard.clear();
        const std::uint64_t before = tally_.glove_frames;
        said_ = conversation_.update(heard, now_, [&](const hand::GloveFrame& frame) {
            sample_ = {frame, ++tally_.glove_frames, now_};
        });
        if (troubled && glove_cut_) said_.clear();
        if (troubled || before != tally_.glove_frames) glove_heard_ = now_;
        tally_.longest_glove = std::max(tally_.longest_glove, now_ - glove_heard_);
    }

    // The hand opens now and then, for as long as it takes to be seen; it does not know how the glove is.
    void live_in_glove() {
        if (now_ > hand_until_) {
            open_ = !open_;
            hand_until_ = now_ + (open_ ? random_.uniform(0.5, 4.0) : random_.uniform(1.0, 20.0));
            moved_at_ = now_;
            if (open_ && hand_.grip.held && hand_.grip.lost) ++tally_.opened_meanwhile;
        }
        glove_.raw = open_ ? raw_open_ : raw_closed_;
    }

    void grip() {
        live_in_glove();
        const bool held = hand_.grip.held, lost = hand_.grip.lost, fresh = sample_.number != hand_.number;
        const ToolPoses place{state_.workspace.tool, state_.output.tool};
        hand::GraspEvent told{};
        const test::Forbidden forbidden =
            test::forbidden_in([&] { told = update_hand(plan_, hand_, sample_, place, looks * dt); });
        tally_.allocations += static_cast<std::uint64_t>(forbidden.all());
        tally_.taken += told == hand::GraspEvent::grasped ? 1 : 0;
        tally_.let_go += told == hand::GraspEvent::released ? 1 : 0;
        tally_.lost_in_grasp += told == hand::GraspEvent::glove_lost && held ? 1 : 0;

        const hand::GraspState& now = hand_.grip;
        if (fresh) frame_at_ = now_;
        if (fresh && lost) back_at_ = now_;
        const bool dropped = held && !now.held;
        tally_.must(!dropped || (fresh && !lost), "the wrench falls and the glove is lost", now_);
        tally_.must(!dropped || now_ - back_at_ > thinks, "the wrench falls as the glove is back", now_);
        // The newest frame may be of before it closed.
        tally_.must(!dropped || open_ || now_ - moved_at_ < 0.1, "the wrench falls out of a closed hand",
                    now_);
        // A frame may come out of a line that is already lost.
        const double quiet = now_ - frame_at_;
        if (now.held) {
            const auto told_now = messages({now.held, now.lost}, plan_.wearer.hand.side, {});
            const bool so = !told_now.empty() && told_now[0].find("stays in your hand") != std::string::npos;
            if (!so) tally_.longest_untold = std::max(tally_.longest_untold, quiet);
        }
        tally_.must(!now.has_frame || quiet <= said || now.lost, "the glove is lost and nobody says so",
                    now_);
        const double sound = now_ - std::max({moved_at_, back_at_, glove_until_ + usable_again});
        tally_.must(sound <= 0.0 || !now.lost, "the glove is back and is said to be lost", now_);
        if (sound > done)
            tally_.must(now.held != open_, open_ ? "an open hand holds" : "a closed hand holds nothing",
                        now_);
    }

    void watch() {
        const bool hangs = now_ < hangs_until_;
        const force::Fault fault = state_.output.fault;
        if (fault == force::Fault::none) faulty_since_ = now_;
        if (fault == force::Fault::jumped && fault_ != fault) ++tally_.jumps;
        fault_ = fault;
        for (Watched* w : {&arm_, &wheel_}) {
            const char* who = w == &arm_ ? "arm" : "wheel";
            const device::FaultInterval& t = w->trouble;
            const force::OutputCommand has = w->line.thing.rendered();
            const force::OutputCommand& ordered = w == &arm_ ? answer_.mover : answer_.wheel;
            const auto is = [&](const char* what) { return fmt::format("{} {}", who, what); };
            const force::OutputLimits& limits = (w == &arm_ ? layout_.mover : layout_.wheel)->limits;
            if (glm::length(has.force) > limits.force * 1.0001 ||
                glm::length(has.torque) > limits.torque * 1.0001)
                tally_.must(false, is("renders more than it can"), now_);
            // A line may be a turn ahead of the servo.
            if (now_ < t.until && w->line.now() < t.until) {
                const double since = now_ - t.from;
                if (mutes(t.what) && !nothing(has)) w->longest_lost = std::max(w->longest_lost, since);
                if (mutes(t.what) && since > gone && !nothing(has))
                    tally_.must(false, is("is lost and has a force"), now_);
                if (t.what == InjectedFault::stuck && since > gone && !hangs && !nothing(ordered))
                    tally_.must(false, is("is stuck and a force is ordered"), now_);
                if (mutes(t.what) && since > said && w->line.report().trouble.empty())
                    tally_.must(false, is("is lost and nobody says so"), now_);
                if (t.what == InjectedFault::stuck && since > said && w == &arm_ && !hangs &&
                    w->line.report().trouble.empty() && state_.output.fault == force::Fault::none &&
                    state_.output.joint < 0)
                    tally_.must(false, is("is stuck and nobody says so"), now_);
            } else if (!w->again) {
                if (w->line.report().state == device::DeviceState::usable && w->line.snapshot().usable) {
                    w->again = true;
                    w->longest_back = std::max(w->longest_back, now_ - t.until);
                } else if (now_ - w->sound_since > usable_again) {
                    tally_.must(false, is("is plugged in and not usable"), now_);
                }
            }
            if (now_ > w->undisturbed) {
                if (!controls_.dead_man && !hangs && !nothing(has))
                    w->longest_let_go = std::max(w->longest_let_go, now_ - released_);
                const double hung = now_ - std::max(hang_begins_, w->undisturbed);
                if (hangs && !nothing(has)) w->longest_hung = std::max(w->longest_hung, hung);
                if (now_ - faulty_since_ > gone && !hangs && !nothing(has))
                    tally_.must(false, is("has a force that is held off"), now_);
                if (!controls_.dead_man && now_ - released_ > gone && !hangs && !nothing(has))
                    tally_.must(false, is("has a force without the dead-man"), now_);
                if (hangs && hung > gone && !nothing(has))
                    tally_.must(false, is("has a force and the servo hangs"), now_);
            }
        }
    }
    void all_is_well_again() {
        const double since = std::max({arm_.sound_since, wheel_.sound_since, hangs_until_});
        if (now_ - since > usable_again && state_.output.fault != force::Fault::none)
            tally_.must(false, fmt::format("all is well and \"{}\"", force::name(state_.output.fault)), now_);
    }

    double now_ = 0.0, ticked_ = 0.0, released_ = -1.0;
    double hangs_until_ = -1.0, hang_begins_ = -1.0, faulty_since_ = 0.0;
    force::Fault fault_ = force::Fault::none;
    double wheel_at_ = 0.0, turned_at_ = 0.0, direction_ = 1.0;
    // Before the devices, whose hands look at them.
    Layout layout_;
    servo::Setup setup_;
    servo::State servo_;
    State state_;
    Watched arm_, wheel_;
    Random random_;
    emulate::Glove glove_;
    hand::GloveSession conversation_;
    HandSetup plan_;
    HandState hand_;
    hand::GloveSample sample_;
    const hand::PerSensor<std::uint8_t> raw_open_ = test::raw_open(), raw_closed_ = test::raw_closed();
    bool open_ = true;  // the hand in the glove
    double moved_at_ = 0.0, hand_until_ = 3.0;
    double frame_at_ = 0.0, back_at_ = -1.0;  // of the glove, after it was lost
    std::vector<std::uint8_t> said_;
    double glove_until_ = -1.0, glove_heard_ = 0.0;
    bool glove_cut_ = false;
    StationControls controls_{.dead_man = true};
    DeviceCommands answer_;
    Tally tally_;
};

std::uint64_t seed() {
    const char* wanted = std::getenv("BOLTWRIGHT_SOAK_SEED");
    return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 1;
}

double seconds() {
    if (const char* wanted = std::getenv("BOLTWRIGHT_SOAK_SECONDS")) return std::atof(wanted);
    return test::sanitized ? 600.0 : 7200.0;
}

}  // namespace

TEST_CASE("Station: hours of faulty devices leave no force behind, and all devices recover") {
    Soak soak(seed());
    const Tally tally = soak.run(seconds());
    MESSAGE(
        fmt::format("{} ticks, {} with a force, {} with a torque at the wheel, {} engaged; {} glove frames",
                    tally.ticks, tally.forces, tally.turned, tally.engaged, tally.glove_frames));
    for (Watched* w : {&soak.arm(), &soak.wheel()})
        MESSAGE(fmt::format(
            "mishaps {} {} {} {} {} {}; a force stayed {:.0f} ms when lost, {:.0f} ms when let go, {:.0f} ms "
            "when "
            "the servo hung; usable again after {:.3f} s",
            w->counts[0], w->counts[1], w->counts[2], w->counts[3], w->counts[4], w->counts[5],
            1e3 * w->longest_lost, 1e3 * w->longest_let_go, 1e3 * w->longest_hung, w->longest_back));
    MESSAGE(fmt::format("{} releases, {} hangs; glove back after {:.3f} s at most", tally.releases,
                        tally.hangs, tally.longest_glove));
    MESSAGE(fmt::format(
        "the hand took {} times, let go {} times; glove lost in mid-grasp {} times ({} times it opened "
        "meanwhile), told after {:.2f} s at most",
        tally.taken, tally.let_go, tally.lost_in_grasp, tally.opened_meanwhile, tally.longest_untold));
    CHECK_MESSAGE(tally.failures == 0, tally.failures << " times, first " << tally.first);
    CHECK(tally.allocations == 0);
    CHECK(tally.longest_glove <= usable_again);
    // It was worth watching.
    CHECK(tally.forces > tally.ticks / 20);
    CHECK(tally.turned > tally.ticks / 50);
    CHECK(tally.engaged > tally.ticks / 20);
    CHECK(tally.releases > 2);
    CHECK(tally.hangs > 2);
    CHECK(tally.jumps >= soak.arm().counts[static_cast<std::size_t>(InjectedFault::jumped)] / 2);
    for (Watched* w : {&soak.arm(), &soak.wheel()})
        for (const std::uint64_t count : w->counts) CHECK(count > 2);
    CHECK(tally.glove_frames > tally.ticks / 50);
    CHECK(tally.longest_untold <= said);
    CHECK(tally.taken > 5);
    CHECK(tally.let_go > 5);
    CHECK(tally.lost_in_grasp > 5);
    CHECK(tally.opened_meanwhile > 0);
}
