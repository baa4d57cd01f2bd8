#include "haptics/device/wheel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/device/pid.hpp"
#include "haptics/device/report_descriptor.hpp"

namespace bolt::device::board {

namespace {

void put(std::span<std::uint8_t> at, std::uint64_t value) {
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t take(std::span<const std::uint8_t> at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < at.size(); ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
    return value;
}

}  // namespace

std::array<std::uint8_t, report_bytes> encode_message(const Message& message) {
    std::array<std::uint8_t, report_bytes> bytes{};
    const std::span<std::uint8_t> all(bytes);
    bytes[0] = report_id;
    bytes[1] = static_cast<std::uint8_t>(message.type);
    put(all.subspan(2, 2), message.of_class);
    bytes[4] = message.instance;
    put(all.subspan(5, 4), message.command);
    put(all.subspan(9, 8), static_cast<std::uint64_t>(message.data));
    put(all.subspan(17, 8), message.address);
    return bytes;
}

std::optional<Message> decode_message(std::span<const std::uint8_t> report) {
    if (report.size() < report_bytes || report[0] != report_id) return std::nullopt;
    Message m;
    m.type = static_cast<Type>(report[1]);
    m.of_class = static_cast<std::uint16_t>(take(report.subspan(2, 2)));
    m.instance = report[4];
    m.command = static_cast<std::uint32_t>(take(report.subspan(5, 4)));
    m.data = static_cast<std::int64_t>(take(report.subspan(9, 8)));
    m.address = take(report.subspan(17, 8));
    return m;
}

std::optional<std::int64_t> reply_value(Command question, const Message& message) {
    if (message.type != Type::request || message.of_class != axis_class || message.instance != 0 ||
        message.command != static_cast<std::uint32_t>(question))
        return std::nullopt;
    return message.data;
}

}  // namespace bolt::device::board

namespace bolt::device {

namespace {

constexpr Usage steering{0x02, 0xc8}, joystick_x{0x01, 0x30}, wheel{0x01, 0x38};

}  // namespace

Result<WheelAxis> wheel_axis(const ReportDescriptor& descriptor) {
    WheelAxis layout;
    layout.numbered = descriptor.numbered;
    const Field* axis = nullptr;
    for (const Usage usage : {steering, joystick_x, wheel})
        if (axis == nullptr) axis = find_field(descriptor, ReportKind::input, usage);
    if (axis == nullptr || axis->array || axis->relative || axis->high <= axis->low)
        return fail(ErrorCode::no_device, "the device does not say how far it is turned",
                    "a wheel whose reports hold its steering or x axis");
    layout.axis = *axis;
    layout.buttons = find_button_fields(descriptor);
    return layout;
}

bool decode_report(const WheelAxis& layout, std::span<const std::uint8_t> report, WheelState& state) {
    const auto id = strip_report_id(layout.numbered, report);
    if (!id) return false;
    decode_buttons(layout.buttons, *id, report, state.buttons);
    if (layout.axis.report != *id) return false;
    const auto value = value_of(layout.axis, report);
    if (!value) return false;
    const double share = normalized_value(layout.axis, *value);
    state.share = layout.axis.low < 0 ? share : 2.0 * share - 1.0;
    return true;
}

namespace {

constexpr double usual_rate = 1000.0;    // 1/s
constexpr double believed_rest = 0.25;   // s
constexpr double answer_patience = 0.1;  // s for an answer of a board while it is opened
constexpr double ask_again = 0.005;      // s, for the encoder, if no answer came
constexpr double live_every = 0.004;     // s, for the encoder, where only the board's life is of interest
constexpr int most_tries = 3;
constexpr std::int64_t most_degrees = 65535;  // what a board has room for
constexpr int most_at_once = 256;             // reports in one read

// The common part of wheels and boards: transport, axis and force.
struct WheelCore {
    std::unique_ptr<HidTransport> line;
    WheelAxis axis;
    PidForce force;
    Description description;
    WheelConfig config;
    Clock clock;
    double available = 0.0;  // N·m at a share of 1
    WheelState state;

    Status write(const force::OutputCommand& command) {
        double torque = glm::dot(command.torque, config.axis);
        if (!std::isfinite(torque)) torque = 0.0;
        torque = std::clamp(torque, -description.limits.torque, description.limits.torque);
        const double share = available > 0.0 ? torque / available : 0.0;
        // Our torque is positive to the right, the effect's to the left.
        return force.update(*line, config.reversed ? share : -share, clock());
    }

    [[nodiscard]] Sample sample(double turn) const {
        Sample s;
        s.turn = turn;
        s.buttons = state.buttons;
        s.time = clock();
        return s;
    }
};

Result<WheelCore> make_hub(std::unique_ptr<HidTransport> line, const ReportDescriptor& descriptor,
                           std::string name, std::string id, const WheelConfig& config, Clock clock) {
    BOLT_TRY_ASSIGN(auto axis, wheel_axis(descriptor));
    BOLT_TRY_ASSIGN(auto layout, pid_layout(descriptor));
    WheelCore hub{std::move(line), std::move(axis),  PidForce(std::move(layout)), {},
                  config,          std::move(clock), config.full_torque,          {}};
    Description& d = hub.description;
    d.name = std::move(name);
    d.id = std::move(id);
    d.sensing = Sensing::turn;
    d.axis = config.axis;
    d.limits.force = 0.0;
    d.limits.delay = 2;
    // Below the stiffness that the wheel's own damping stabilises: b/τ with 0.1 N·m·s/rad and a 3 ms round
    // trip.
    d.limits.torsion = 20.0;
    d.rate = usual_rate;
    d.buttons = static_cast<int>(hub.axis.buttons.size());
    return hub;
}

void describe_torque(WheelCore& hub) {
    Description& d = hub.description;
    d.limits.torque = std::min(hub.config.max_torque, hub.available);
    for (int i = 0; i < 3; ++i)
        d.renders[static_cast<std::size_t>(3 + i)] =
            d.limits.torque > 0.0 && std::abs(hub.config.axis[i]) > 0.01;
    d.remarks.push_back(fmt::format(
        "renders at most {:.1f} N·m, assuming that the motor gives {:.1f} N·m at full drive; a rig "
        "file can change this",
        d.limits.torque, hub.available));
}

class Wheel : public Device {
  public:
    explicit Wheel(WheelCore hub) : hub_(std::move(hub)), told_(hub_.clock()) {}
    ~Wheel() override { hub_.force.stop(*hub_.line); }

    [[nodiscard]] const Description& describe() const override { return hub_.description; }

    Result<std::optional<Sample>> read(double timeout) override {
        for (int i = 0; i < most_at_once; ++i) {
            BOLT_TRY_ASSIGN(const auto report, hub_.line->read(i == 0 ? timeout : 0.0));
            if (report.empty()) break;
            if (!decode_report(hub_.axis, report, hub_.state)) continue;
            told_ = hub_.clock();
            known_ = true;
        }
        if (!known_ || hub_.clock() - told_ > believed_rest) return std::nullopt;
        return hub_.sample(hub_.state.share * 0.5 * hub_.config.range);
    }

    Status write(const force::OutputCommand& command) override { return hub_.write(command); }

  private:
    WheelCore hub_;
    double told_;
    bool known_ = false;
};

class OpenFfboard : public Device {
  public:
    OpenFfboard(WheelCore hub, double range) : hub_(std::move(hub)), range_(range) {}
    ~OpenFfboard() override { hub_.force.stop(*hub_.line); }

    [[nodiscard]] const Description& describe() const override { return hub_.description; }

    Result<std::optional<Sample>> read(double timeout) override {
        timeout = std::min(timeout, live_every);  // it may have to be asked again
        const double begun = hub_.clock();
        const double since = begun - asked_at_;
        // Replies delay axis reports, so request no more than needed.
        if (since >= (waits_ ? ask_again : has_counts() ? 0.0 : live_every)) {
            const auto question =
                board::encode_message({.command = static_cast<std::uint32_t>(board::Command::position)});
            BOLT_TRY(hub_.line->write(question));
            asked_at_ = begun;
            waits_ = true;
        }
        bool news = false;
        for (int i = 0; i < most_at_once; ++i) {
            const double left = news ? 0.0 : std::max(begun + timeout - hub_.clock(), 0.0);
            BOLT_TRY_ASSIGN(const auto report, hub_.line->read(left));
            if (report.empty()) break;
            if (const auto message = board::decode_message(report)) {
                const auto counts = reply_value(board::Command::position, *message);
                if (!counts) continue;
                waits_ = false;
                counts_ = static_cast<double>(*counts);
                news = news || told_ || has_counts();
            } else if (decode_report(hub_.axis, report, hub_.state)) {
                told_ = true;
                news = news || !has_counts();
            }
        }
        if (!news) return std::nullopt;
        return hub_.sample(has_counts() ? counts_ / hub_.config.counts_per_turn * 2.0 * pi
                                        : hub_.state.share * 0.5 * range_);
    }

    Status write(const force::OutputCommand& command) override { return hub_.write(command); }

  private:
    [[nodiscard]] bool has_counts() const { return hub_.config.counts_per_turn > 0.0; }

    WheelCore hub_;
    double range_, counts_ = 0.0;
    double asked_at_ = -1.0;
    bool waits_ = false;  // for an answer
    bool told_ = false;   // its axis, at least once
};

// nullopt: no reply.
Result<std::optional<std::int64_t>> ask(WheelCore& hub, board::Command question) {
    for (int i = 0; i < most_tries; ++i) {
        const auto bytes = board::encode_message({.command = static_cast<std::uint32_t>(question)});
        BOLT_TRY(hub.line->write(bytes));
        const double until = hub.clock() + answer_patience;
        for (int n = 0; n < most_at_once; ++n) {
            BOLT_TRY_ASSIGN(const auto report, hub.line->read(std::max(until - hub.clock(), 0.0)));
            if (report.empty()) break;
            if (const auto message = board::decode_message(report)) {
                if (const auto answer = reply_value(question, *message)) return answer;
            } else {
                decode_report(hub.axis, report, hub.state);
            }
        }
    }
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<Device>> make_wheel(std::unique_ptr<HidTransport> line,
                                           const ReportDescriptor& descriptor, std::string name,
                                           std::string id, const WheelConfig& config, Clock clock) {
    BOLT_TRY_ASSIGN(auto hub, make_hub(std::move(line), descriptor, std::move(name), std::move(id), config,
                                       std::move(clock)));
    hub.description.silent_at_rest = true;
    describe_torque(hub);
    hub.description.remarks.push_back(
        fmt::format("taken to turn {:.0f} degrees from stop to stop", to_degrees(config.range)));
    BOLT_TRY(hub.force.start(*hub.line, hub.clock()));
    return std::make_unique<Wheel>(std::move(hub));
}

Result<std::unique_ptr<Device>> make_open_ffboard(std::unique_ptr<HidTransport> line,
                                                  const ReportDescriptor& descriptor, std::string name,
                                                  std::string id, const WheelConfig& config, Clock clock) {
    BOLT_TRY_ASSIGN(auto hub, make_hub(std::move(line), descriptor, std::move(name), std::move(id), config,
                                       std::move(clock)));
    const auto degrees = ask(hub, board::Command::degrees);
    if (!degrees) return fail(degrees.error());
    if (!*degrees || **degrees <= 0 || **degrees > most_degrees)
        return fail(ErrorCode::no_device,
                    fmt::format("{} does not say how far its axis turns", hub.description.name),
                    "an OpenFFBoard whose main class is a force feedback wheel, with commands over HID");
    const auto power = ask(hub, board::Command::power);
    if (!power) return fail(power.error());
    // If the power is unknown, assume full power: the rendered torque is then too weak, never too strong.
    const double let = *power ? std::clamp(static_cast<double>(**power) / board::full_power, 0.0, 1.0) : 1.0;
    hub.available = config.full_torque * let;
    describe_torque(hub);
    if (hub.available <= 0.0)
        hub.description.remarks.emplace_back(
            "its power is set to nothing; OpenFFBoard's configurator sets it");
    if (config.counts_per_turn <= 0.0)
        hub.description.remarks.push_back(fmt::format(
            "turns {} degrees from stop to stop; tell the encoder's counts per turn for turns without end",
            **degrees));
    BOLT_TRY(hub.force.start(*hub.line, hub.clock()));
    return std::make_unique<OpenFfboard>(std::move(hub), to_radians(static_cast<double>(**degrees)));
}

}  // namespace bolt::device
