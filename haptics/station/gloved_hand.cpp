#include "haptics/station/gloved_hand.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "engine/base/lock_free.hpp"

namespace bolt::station {

hand::GraspEvent update_hand(const HandSetup& setup, HandState& state, const hand::GloveSample& sample,
                             const ToolPoses& tool, double dt) {
    const bool fresh = sample.number != state.number;
    if (fresh) {
        state.number = sample.number;
        hand::update(state.gloved, setup.wearer, sample.frame, sample.time);
    }
    const Pose wrist = inverse(tool.constrained_tool) * tool.commanded_tool * setup.wrist;
    return hand::update_grasp(state.grasp, setup.grasp, setup.tool, setup.wearer.hand,
                              {fresh, state.gloved.angles, wrist}, dt);
}

DisplayedHand displayed_hand(const HandSetup& setup, const HandState& state) {
    DisplayedHand shown;
    shown.finger_joints = hand::joints(setup.wearer.hand, state.grasp.closure.angles, state.grasp.wrist);
    shown.side = setup.wearer.hand.side;
    shown.has_angles = state.grasp.has_frame;
    shown.held = state.grasp.held;
    shown.lost = state.grasp.lost;
    return shown;
}

std::vector<std::string> messages(const HandStatus& hand, hand::Side worn, const hand::GloveReport& report) {
    std::vector<std::string> messages;
    if (hand.lost) messages.emplace_back(hand::message_for(hand::GraspEvent::glove_lost, hand.held));
    if (report.fault_message[0] != '\0') messages.emplace_back(report.fault_message.data());
    if (report.handshakes > 0 && report.identity.side != worn)
        messages.emplace_back(worn == hand::Side::left ? "glove: it is a right glove; expected the left "
                                                         "glove of the calibration, or a calibration of "
                                                         "this one"
                                                       : "glove: it is a left glove; expected the right "
                                                         "glove of the calibration, or a calibration of "
                                                         "this one");
    return messages;
}

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr auto poll_period = std::chrono::milliseconds(2);  // adds at most this delay to a sample
constexpr double max_step_time = 0.02;  // s; without a sample the hand is updated after this time

double seconds_since(SteadyClock::time_point then) {
    return std::chrono::duration<double>(SteadyClock::now() - then).count();
}

}  // namespace

struct HandThread::Shared {
    Shared(hand::GloveDriver d, HandSetup s) : driver(std::move(d)), setup(std::move(s)) {}

    hand::GloveDriver driver;
    HandSetup setup;
    TripleBuffer<ToolPoses> tool;
    TripleBuffer<DisplayedHand> displayed;
    std::atomic<bool> held{false}, lost{false};
    // Last member: destroyed first, so it stops before the data are destroyed.
    std::jthread thread;

    void run(const std::stop_token& stop) {
        HandState state;
        for (auto last = SteadyClock::now(); !stop.stop_requested();) {
            const hand::GloveSample& sample = driver.sample();
            const double dt = seconds_since(last);
            if (sample.number == state.number && dt < max_step_time) {
                std::this_thread::sleep_for(poll_period);
                continue;
            }
            last = SteadyClock::now();
            tool.update();
            update_hand(setup, state, sample, tool.latest(), dt);
            held.store(state.grasp.held, std::memory_order_relaxed);
            lost.store(state.grasp.lost, std::memory_order_release);
            displayed.write(station::displayed_hand(setup, state));
        }
    }
};

HandThread::HandThread(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
HandThread::HandThread(HandThread&&) noexcept = default;
HandThread& HandThread::operator=(HandThread&&) noexcept = default;
HandThread::~HandThread() = default;

HandThread HandThread::start(hand::GloveDriver driver, HandSetup setup) {
    auto shared = std::make_unique<Shared>(std::move(driver), std::move(setup));
    DisplayedHand first;
    first.side = shared->setup.wearer.hand.side;  // known before the first sample
    shared->displayed.write(first);

    shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    return HandThread(std::move(shared));
}

void HandThread::set_tool(const ToolPoses& tool) { shared_->tool.write(tool); }

servo::Grip HandThread::grip() const {
    return shared_->held.load(std::memory_order_relaxed) ? servo::Grip::wrench : servo::Grip::none;
}

const DisplayedHand& HandThread::displayed() {
    shared_->displayed.update();
    return shared_->displayed.latest();
}

const hand::GloveReport& HandThread::report() { return shared_->driver.report(); }

std::vector<std::string> HandThread::fault_messages() {
    HandStatus status;
    status.lost = shared_->lost.load(std::memory_order_acquire);
    status.held = shared_->held.load(std::memory_order_relaxed);
    return messages(status, shared_->setup.wearer.hand.side, shared_->driver.report());
}

}  // namespace bolt::station
