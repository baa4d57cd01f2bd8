#include "haptics/station/hand_line.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "engine/base/triple_buffer.hpp"

namespace bolt::station {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto look_every = std::chrono::milliseconds(2);  // for a sample: so much later it is at most
constexpr double step_every = 0.02;  // s, of a glove that says nothing: the tool goes on without it

double since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

}  // namespace

struct HandLine::Shared {
    Shared(glove::Driver d, HandPlan p) : driver(std::move(d)), plan(std::move(p)) {}

    glove::Driver driver;
    HandPlan plan;
    TripleBuffer<ToolPlace> place;
    TripleBuffer<ShownHand> shown;
    std::atomic<bool> held{false}, lost{false};
    std::jthread thread;  // the last member: it stops first

    void run(const std::stop_token& stop) {
        HandState state;
        for (auto last = Clock::now(); !stop.stop_requested();) {
            const glove::Sample& sample = driver.sample();
            const double dt = since(last);
            if (sample.number == state.number && dt < step_every) {
                std::this_thread::sleep_for(look_every);
                continue;
            }
            last = Clock::now();
            place.update();
            hand_step(plan, state, sample, place.latest(), dt);
            held.store(state.grip.held, std::memory_order_relaxed);
            lost.store(state.grip.lost, std::memory_order_release);
            shown.write(station::shown(plan, state));
        }
    }
};

HandLine::HandLine(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
HandLine::HandLine(HandLine&&) noexcept = default;
HandLine& HandLine::operator=(HandLine&&) noexcept = default;
HandLine::~HandLine() = default;

HandLine HandLine::start(glove::Driver driver, HandPlan plan) {
    auto shared = std::make_unique<Shared>(std::move(driver), std::move(plan));
    ShownHand first;
    first.side = shared->plan.wearer.hand.side;  // known before the glove has said anything
    shared->shown.write(first);

    shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    return HandLine(std::move(shared));
}

void HandLine::place(const ToolPlace& place) { shared_->place.write(place); }

servo::Grip HandLine::grip() const {
    return shared_->held.load(std::memory_order_relaxed) ? servo::Grip::wrench : servo::Grip::none;
}

const ShownHand& HandLine::shown() {
    shared_->shown.update();
    return shared_->shown.latest();
}

const glove::Report& HandLine::report() { return shared_->driver.report(); }

std::vector<std::string> HandLine::troubles() {
    HandTrouble trouble;
    trouble.lost = shared_->lost.load(std::memory_order_acquire);
    trouble.held = shared_->held.load(std::memory_order_relaxed);
    return words(trouble, shared_->plan.wearer.hand.side, shared_->driver.report());
}

}  // namespace bolt::station
