#include "haptics/device/haply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <system_error>
#include <thread>

#include "engine/base/lock_free.hpp"
#include "engine/base/steady_seconds.hpp"
#include "haptics/device/haply_messages.hpp"

namespace bolt::device {

namespace {

constexpr double exchange_period = 1e-3;   // s between two exchanges
constexpr double answer_wait = 5e-3;       // s between two checks for a stop request
constexpr double answer_timeout = 0.5;     // s without an answer until the service counts as lost
constexpr double connect_timeout = 1.0;    // s, of an arm that is opened
constexpr double version_timeout = 0.2;    // s
constexpr double command_lifetime = 0.02;  // s after which a force becomes zero
constexpr double poll_interval = 2e-4;     // s between two polls for a new state
constexpr int max_events = 16;             // that are read between two exchanges
constexpr int event_port_offset = 10020 - 10001;
constexpr int old_http_port_offset = 10000 - 10001;  // of services before 3.5

Error not_running(std::string_view reason) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("the Haply service does not answer: {}", reason);
    error.expected = "the Haply service, which Haply Hub starts, or its ADDRESS:PORT in BOLTWRIGHT_HAPLY";
    return error;
}

Error not_calibrated(const std::string& arm) {
    return unprepared_device_error(
        fmt::format("Haply Inverse3 {} is not calibrated", arm),
        "an arm that was placed into its inkwell and calibrated, as its light shows",
        {DeviceNeed::inkwell, {}});
}

// Waits for the first message of a connection. nullopt: it did not come in time.
Result<std::optional<HaplyInventory>> read_inventory(WebSocket& socket, double timeout) {
    BOLT_TRY_ASSIGN(const std::optional<std::string> message, socket.receive(timeout));
    if (!message) return std::optional<HaplyInventory>{};
    return parse_haply_inventory(*message).map(
        [](HaplyInventory inventory) { return std::optional<HaplyInventory>(std::move(inventory)); });
}

// Services from 3.5 on answer at the port of the states, older ones at the port before it.
bool has_old_messages(const SocketAddress& states) {
    for (const int offset : {0, old_http_port_offset}) {
        SocketAddress address = states;
        address.port = static_cast<std::uint16_t>(address.port + offset);
        const Result<std::string> answer = http_get(address, "/version", version_timeout);
        const std::optional<bool> old = answer ? is_old_haply_version(*answer) : std::nullopt;
        if (old) return *old;
    }
    return false;
}

// Damping is not published; this is a low value of ours, not measured on an arm.
Description describe_arm(const HaplyArmEntry& arm, const HaplyGripEntry* grip, int index) {
    Description d;
    d.name = fmt::format("Haply Inverse3 {}", arm.id);
    d.id = fmt::format("haply:{}", index);
    d.model = "Inverse3";
    d.serial = arm.id;
    d.senses_rotation = grip != nullptr;
    d.renders = {true, true, true, false, false, false};
    d.limits.force = 10.0;
    d.limits.torque = 0.0;
    d.limits.stiffness = 1000.0;
    d.limits.torsion = 0.0;
    d.limits.damping = 5.0;
    d.limits.angular_damping = 0.0;
    d.limits.delay = 3;  // mailbox, message, the arm's own tick
    d.rate = 1.0 / exchange_period;
    d.half_workspace = Vec3(0.1);
    d.buttons = grip == nullptr ? 0 : grip->wireless ? 3 : 1;
    if (grip == nullptr)
        d.remarks.emplace_back("has no VerseGrip, so it senses no rotation: the tool keeps its orientation");
    d.remarks.emplace_back("renders no torque: torques are rendered as forces on the handle");
    return d;
}

struct Connection {
    WebSocket states;
    std::optional<WebSocket> events;  // the service may have none
    HaplyArmEntry arm;
    std::optional<HaplyGripEntry> grip;
    bool old_messages = false;

    [[nodiscard]] const HaplyGripEntry* grip_or_null() const { return grip ? &*grip : nullptr; }
};

struct TimedForce {
    Vec3 force{0.0};    // N, our frame
    double time = 0.0;  // s, when it was written
};

struct TimedState {
    HaplyState state;
    double time = 0.0;  // s, when it was received
};

class HaplyArm final : public DeviceDriver {
  public:
    HaplyArm(Connection connection, int index, Timer timer)
        : connection_(std::move(connection)),
          timer_(std::move(timer)),
          description_(describe_arm(connection_.arm, connection_.grip_or_null(), index)) {}
    HaplyArm(const HaplyArm&) = delete;
    HaplyArm& operator=(const HaplyArm&) = delete;
    ~HaplyArm() override = default;  // the thread ends first, with a message that has no force

    // Call once.
    Status start() {
        try {
            thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
        } catch (const std::system_error& error) {
            return fail(ErrorCode::failed, fmt::format("cannot start the arm's thread: {}", error.what()),
                        "a system that permits another thread");
        }
        return {};
    }

    [[nodiscard]] const Description& description() const override { return description_; }

    // Always calibrated: an arm that loses its calibration counts as lost.
    [[nodiscard]] DeviceHealth health() const override { return {true, {}, false}; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double end = timer_.now() + timeout;
        while (true) {
            if (lost_.load(std::memory_order_acquire)) return fail(error_);
            if (states_.update()) return std::optional<Sample>(sample(states_.latest()));
            const double left = end - timer_.now();
            if (left <= 0.0) return std::optional<Sample>{};
            timer_.wait(std::min(left, poll_interval));
        }
    }

    Status write(const force::OutputCommand& command) override {
        if (lost_.load(std::memory_order_acquire)) return fail(error_);
        const bool valid = finite(command.force);
        forces_.write({valid ? force::clamp_length(command.force, description_.limits.force) : Vec3(0.0),
                       timer_.now()});
        return {};
    }

  private:
    static Sample sample(const TimedState& received) {
        Sample s;
        s.pose.position = received.state.position;
        s.pose.orientation = *received.state.orientation;
        s.velocity = received.state.velocity;
        s.buttons = received.state.buttons;
        s.time = received.time;
        return s;
    }

    // The thread's function.
    void run(const std::stop_token& stop) {
        using Clock = std::chrono::steady_clock;
        constexpr auto step =
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(exchange_period));
        Clock::time_point next = Clock::now();
        while (!stop.stop_requested()) {
            std::this_thread::sleep_until(next);
            next = std::max(next + step, Clock::now());  // late exchanges are left out
            Status status = check_events();
            if (status) status = exchange(current_force(), stop);
            if (status) continue;
            error_ = status.error();
            error_.code = ErrorCode::no_device;
            error_.lost = true;
            lost_.store(true, std::memory_order_release);
            break;
        }
        // Sends zero force although the service, by its documentation, releases the force when messages stop.
        // Waits for the answer, because closing a connection with unread answers may drop sent messages.
        if (send(Vec3(0.0))) (void)connection_.states.receive(answer_wait);
    }

    Vec3 current_force() {
        forces_.update();
        const TimedForce& latest = forces_.latest();
        return timer_.now() - latest.time < command_lifetime ? latest.force : Vec3(0.0);
    }

    Status send(const Vec3& force) {
        ++unanswered_;
        return connection_.states.send(haply_force_message(connection_.arm, force, connection_.old_messages),
                                       answer_timeout);
    }

    // Sends a force and waits for the answer. A late answer ends the force.
    Status exchange(const Vec3& force, const std::stop_token& stop) {
        BOLT_TRY(send(force));
        const double begun = steady_seconds();
        bool released = false;
        while (unanswered_ > 0 && !stop.stop_requested()) {
            BOLT_TRY_ASSIGN(const std::optional<std::string> message,
                            connection_.states.receive(answer_wait));
            const double waited = steady_seconds() - begun;
            if (message) {
                --unanswered_;
                BOLT_TRY(publish(*message));
            } else if (waited >= answer_timeout) {
                return fail(lost_device_error("the Haply service no longer answers",
                                              fmt::format("an answer within {:g} s", answer_timeout)));
            } else if (waited >= command_lifetime && !released) {
                released = true;
                BOLT_TRY(send(Vec3(0.0)));
            }
        }
        return {};
    }

    Status publish(const std::string& message) {
        BOLT_TRY_ASSIGN(HaplyState state,
                        parse_haply_state(message, connection_.arm, connection_.grip_or_null()));
        if (!state.orientation) state.orientation = orientation_;
        orientation_ = *state.orientation;
        states_.write({state, timer_.now()});
        return {};
    }

    // Fails if an event states that the arm renders no more force.
    Status check_events() {
        for (int i = 0; i < max_events && connection_.events; ++i) {
            const auto message = connection_.events->receive(0.0);
            if (!message) connection_.events.reset();
            if (!message || !*message) break;
            if (const auto loss = loss_in_haply_event(**message, connection_.arm))
                return fail(lost_device_error(description_.name + " " + *loss,
                                              "an arm that is connected by USB and moved slowly"));
        }
        return {};
    }

    Connection connection_;  // used by the thread only, once it runs
    Timer timer_;
    Description description_;
    // Used by the thread.
    Quat orientation_{1.0, 0.0, 0.0, 0.0};  // the latest one
    int unanswered_ = 0;                    // messages whose answers have not come yet
    TripleBuffer<TimedForce> forces_{{Vec3(0.0), -1e9}};
    TripleBuffer<TimedState> states_;
    Error error_;  // written by the thread before lost_
    std::atomic<bool> lost_{false};
    std::jthread thread_;  // last, so that it ends before the other members
};

}  // namespace

Result<HaplyService> haply_service() {
    HaplyService service;
    const char* named = std::getenv("BOLTWRIGHT_HAPLY");
    if (named == nullptr || *named == '\0') return service;
    const std::string_view text = named;
    const std::size_t colon = std::min(text.rfind(':'), text.size());
    const std::string_view digits = text.substr(std::min(colon + 1, text.size()));
    int port = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    const bool valid = error == std::errc() && end == digits.data() + digits.size() && colon > 0 &&
                       port > 0 && port <= 65535 - event_port_offset;
    if (!valid)
        return fail(ErrorCode::usage, fmt::format("BOLTWRIGHT_HAPLY is '{}'", text),
                    "ADDRESS:PORT, for example 127.0.0.1:10001");
    std::string host(text.substr(0, colon));
    if (host == "localhost") host = "127.0.0.1";
    service.states = {host, static_cast<std::uint16_t>(port)};
    service.events = {host, static_cast<std::uint16_t>(port + event_port_offset)};
    return service;
}

Result<std::vector<HaplyListing>> list_haply(const HaplyService& service, double timeout) {
    const double end = steady_seconds() + timeout;
    std::vector<HaplyListing> listed;
    // Another program may use this port: without a message there is no arm, and no error.
    Result<WebSocket> socket = WebSocket::connect(service.states, timeout);
    if (!socket) return listed;
    const auto inventory = read_inventory(*socket, std::max(end - steady_seconds(), 0.0));
    if (!inventory && inventory.error().code == ErrorCode::no_device) return listed;
    BOLT_TRY(inventory);
    if (!*inventory) return listed;
    for (const HaplyArmEntry& arm : (*inventory)->arms) {
        listed.push_back({arm.id, {}});
        if (!arm.calibrated) listed.back().error = not_calibrated(arm.id);
    }
    return listed;
}

Result<std::unique_ptr<DeviceDriver>> open_haply(const HaplyService& service, int index, Timer timer) {
    Result<WebSocket> socket = WebSocket::connect(service.states, connect_timeout);
    if (!socket) return fail(not_running(socket.error().what));
    BOLT_TRY_ASSIGN(const auto inventory, read_inventory(*socket, connect_timeout));
    if (!inventory) return fail(not_running(service.states.text() + ": sends no list of its devices"));
    const auto i = static_cast<std::size_t>(std::max(index, 0));
    if (i >= inventory->arms.size())
        return fail(lost_device_error(fmt::format("the Haply service has no arm {}", index),
                                      "an Inverse3 that is switched on and connected by USB"));
    Connection connection{std::move(*socket), {}, inventory->arms[i], {}};
    if (!connection.arm.calibrated) return fail(not_calibrated(connection.arm.id));
    if (i < inventory->grips.size()) connection.grip = inventory->grips[i];
    connection.old_messages = has_old_messages(service.states);
    if (Result<WebSocket> events = WebSocket::connect(service.events, version_timeout))
        connection.events = std::move(*events);
    auto arm = std::make_unique<HaplyArm>(std::move(connection), index, std::move(timer));
    BOLT_TRY(arm->start());
    return std::unique_ptr<DeviceDriver>(std::move(arm));
}

}  // namespace bolt::device
