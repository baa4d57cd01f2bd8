#include "haptics/station/station.hpp"

#include <array>
#include <atomic>
#include <string>

#include "engine/base/lock_free.hpp"
#include "haptics/station/gloved_hand.hpp"

namespace bolt::station {

namespace {

constexpr double driver_timeout = 0.5;         // s; no read or write of a driver blocks longer
constexpr std::size_t recorded_ticks = 32768;  // 33 s at 1 kHz until the recorder must read them
constexpr std::size_t commands_per_tick = 16;  // further ones wait for the next tick

}  // namespace

struct Station::Shared {
    DeviceLayout layout;
    servo::Setup setup;
    servo::State state;
    StationState station;
    std::optional<device::DeviceThread> mover, wheel;
    std::optional<hand::GloveDriver> glove;
    std::optional<HandThread> hand;
    TripleBuffer<StationControls> controls;
    double controls_age = 0.0;  // s since the last controls arrived
    SpscRing<StationCommand> commands{command_queue_capacity};
    TripleBuffer<StationTick> latest_tick;
    StationLinkStats stats;  // of the servo thread
    TripleBuffer<StationLinkStats> link_stats;
    SpscRing<StationTick> ticks{recorded_ticks};
    std::atomic<std::uint64_t> lost_ticks{0};
    // Last member: destroyed first, so it stops before the data are destroyed.
    std::optional<servo::ServoThread> thread;

    bool tick(const servo::Deadline& deadline) {
        StationInputs inputs;
        if (mover) inputs.mover = mover->snapshot();
        if (wheel) inputs.wheel = wheel->snapshot();
        controls_age =
            controls.update() ? 0.0 : controls_age + setup.dt * (1.0 + static_cast<double>(deadline.missed));
        inputs.controls = controls.latest();
        inputs.controls_age = controls_age;
        std::array<StationCommand, commands_per_tick> received;
        std::size_t count_received = 0;
        while (count_received < received.size() && commands.pop(received[count_received])) ++count_received;
        inputs.commands = std::span(received).first(count_received);
        if (hand) inputs.hand_grip = hand->grip();
        inputs.missed = deadline.missed;
        const StationStep done = step(layout, setup, station, state, inputs, deadline.number);
        const DeviceCommands& output = done.commands;
        if (mover) mover->command(output.mover, true);
        if (wheel) wheel->command(output.wheel, true);
        record_tick(stats.mover, station.mover, output.mover);
        record_tick(stats.wheel, station.wheel, output.wheel);
        link_stats.write(stats);
        if (hand)
            hand->set_tool({tool_of_gloved_hand(layout, setup, station, inputs.controls),
                            station.resting_wrench.value_or(station.output.constrained_tool)});
        latest_tick.write(done.tick);
        if (!done.paused && !ticks.push(done.tick)) lost_ticks.fetch_add(1, std::memory_order_relaxed);
        return true;
    }
};

Station::Station(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Station::Station(Station&&) noexcept = default;
Station& Station::operator=(Station&&) noexcept = default;
Station::~Station() = default;

namespace {

Status open(const device::DeviceFactory& factory, const StationOptions& options,
            std::optional<device::DeviceThread>& thread, std::optional<device::Description>& description) {
    if (!factory) return {};
    BOLT_TRY_ASSIGN(auto started, device::DeviceThread::start(factory, options.device_threads));
    thread = std::move(started);
    BOLT_TRY_ASSIGN(auto found, thread->wait_until_open(options.open_timeout, options.on_preparation));
    description = *found;
    return {};
}

// Time constant with which a grasped wrench moves into the palm. Chosen: as fast as a hand regrasps.
constexpr double absolute_return_time = 0.1;  // s

force::WorkspaceMap make_workspace(const DeviceLayout& layout, const StationOptions& options) {
    force::WorkspaceMap map;
    map.rotation = glm::normalize(options.workspace.rotation);
    if (!layout.mover || layout.mover->sensing != device::Sensing::pose) return map;
    const Vec3 reach = force::rotated_half_workspace(map.rotation, layout.mover->half_workspace);
    map.scale = options.workspace.scale.value_or(force::fitted_scale(reach, options.handle_length));
    if (options.workspace.absolute) map.return_time = absolute_return_time;
    // With a power ratio of 1/scale, a force has the same magnitude on the tool and on the hand.
    map.power_ratio = options.workspace.power_ratio.value_or(1.0 / map.scale);
    return map;
}

}  // namespace

Result<DeviceLayout> make_layout(const StationOptions& options, std::optional<device::Description> mover,
                                 std::optional<device::Description> wheel) {
    DeviceLayout layout;
    layout.mover = std::move(mover);
    if (layout.mover) layout.mover->limits = force::lowered(layout.mover->limits, options.mover_limit_bounds);
    layout.wheel = std::move(wheel);
    layout.mover_buttons = options.mover_buttons;
    layout.wheel_buttons = options.wheel_buttons;
    layout.home = options.home;
    BOLT_TRY(check(layout));
    layout.workspace = make_workspace(layout, options);
    return layout;
}

Result<Station> Station::start(StationOptions options) {
    auto shared = std::make_unique<Shared>();
    Shared& s = *shared;
    std::optional<device::Description> mover, wheel;
    BOLT_TRY(open(options.mover, options, s.mover, mover));
    BOLT_TRY(open(options.wheel, options, s.wheel, wheel));
    BOLT_TRY_ASSIGN(auto layout, make_layout(options, std::move(mover), std::move(wheel)));
    s.layout = std::move(layout);
    if (options.hand && options.glove.empty())
        return fail(ErrorCode::no_device, "station: the gloved hand has no glove",
                    "the serial port of the glove");
    if (options.hand) s.layout.wrist = options.hand->wrist;
    if (options.hand)
        s.hand = HandThread::start(hand::GloveDriver::start(options.glove), std::move(*options.hand));
    else if (!options.glove.empty())
        s.glove = hand::GloveDriver::start(options.glove);

    s.setup = options.make_setup(limits_of(s.layout), 1.0 / options.servo.rate);
    if (options.make_state) {
        BOLT_TRY_ASSIGN(auto state, options.make_state(s.setup));
        s.state = std::move(state);
    } else {
        s.state = servo::initial_state(s.setup);
    }
    s.station = initial_state(s.layout);
    s.controls.write(options.controls);

    BOLT_TRY_ASSIGN(auto thread,
                    servo::ServoThread::start(
                        options.servo, [&s](const servo::Deadline& deadline) { return s.tick(deadline); }));
    s.thread = std::move(thread);
    return Station(std::move(shared));
}

void Station::set_controls(const StationControls& controls) { shared_->controls.write(controls); }

Status Station::send(const StationCommand& command) {
    if (shared_->commands.push(command)) return {};
    return fail(ErrorCode::failed,
                "station: the command queue is full: the servo thread has executed none of the last " +
                    std::to_string(shared_->commands.capacity()) + " commands",
                "a running servo thread");
}

const StationTick& Station::latest_tick() {
    shared_->latest_tick.update();
    return shared_->latest_tick.latest();
}

bool Station::next_tick(StationTick& tick) { return shared_->ticks.pop(tick); }
std::uint64_t Station::lost_ticks() const { return shared_->lost_ticks.load(std::memory_order_relaxed); }

std::vector<std::string> Station::fault_messages() {
    std::vector<std::string> messages;
    for (auto* thread : {&shared_->mover, &shared_->wheel}) {
        if (!thread->has_value()) continue;
        const device::DeviceStatus& status = (*thread)->status();
        if (!status.fault_message.empty()) messages.push_back(status.fault_message);
        if (status.state == device::DeviceState::usable && (*thread)->blocked_for() > driver_timeout)
            messages.push_back(status.description->name +
                               ": has not answered for 0.5 s; expected a device that answers: "
                               "unplug it and plug it in again");
    }
    const StationTick& tick = latest_tick();
    // The device's own report describes its silence better.
    const force::Fault fault = tick.output.fault;
    if (tick.input.dead_man && fault != force::Fault::none &&
        (fault != force::Fault::silent || messages.empty()))
        messages.emplace_back(force::message_for(fault));
    if (shared_->glove && shared_->glove->report().fault_message[0] != '\0')
        messages.emplace_back(shared_->glove->report().fault_message.data());
    if (shared_->hand)
        for (std::string& message : shared_->hand->fault_messages()) messages.push_back(std::move(message));
    return messages;
}

const device::DeviceStatus* Station::mover_status() {
    return shared_->mover ? &shared_->mover->status() : nullptr;
}
const device::DeviceStatus* Station::wheel_status() {
    return shared_->wheel ? &shared_->wheel->status() : nullptr;
}
const hand::GloveReport* Station::glove_report() {
    return shared_->hand ? &shared_->hand->report() : shared_->glove ? &shared_->glove->report() : nullptr;
}
const StationLinkStats& Station::link_stats() {
    shared_->link_stats.update();
    return shared_->link_stats.latest();
}
const DisplayedHand* Station::hand() { return shared_->hand ? &shared_->hand->displayed() : nullptr; }
const DeviceLayout& Station::layout() const { return shared_->layout; }
const servo::Setup& Station::setup() const { return shared_->setup; }
hand::GloveDriver* Station::glove() { return shared_->glove ? &*shared_->glove : nullptr; }
servo::ServoThread& Station::servo() { return *shared_->thread; }
void Station::stop() { shared_->thread->stop(); }

}  // namespace bolt::station
