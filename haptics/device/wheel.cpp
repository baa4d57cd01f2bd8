#include "haptics/device/wheel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/device/report_descriptor.hpp"
#include "haptics/device/usb_force_feedback.hpp"

namespace bolt::device::open_ffboard {

namespace {

void put_little_endian(std::span<std::uint8_t> at, std::uint64_t value) {
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint64_t get_little_endian(std::span<const std::uint8_t> at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < at.size(); ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
    return value;
}

}  // namespace

std::array<std::uint8_t, report_bytes> encode_message(const WheelMessage& message) {
    std::array<std::uint8_t, report_bytes> bytes{};
    const std::span<std::uint8_t> all(bytes);
    bytes[0] = report_id;
    bytes[1] = static_cast<std::uint8_t>(message.type);
    put_little_endian(all.subspan(2, 2), message.class_id);
    bytes[4] = message.instance;
    put_little_endian(all.subspan(5, 4), message.command);
    put_little_endian(all.subspan(9, 8), static_cast<std::uint64_t>(message.data));
    put_little_endian(all.subspan(17, 8), message.address);
    return bytes;
}

std::optional<WheelMessage> decode_message(std::span<const std::uint8_t> report) {
    if (report.size() < report_bytes || report[0] != report_id) return std::nullopt;
    WheelMessage m;
    m.type = static_cast<MessageType>(report[1]);
    m.class_id = static_cast<std::uint16_t>(get_little_endian(report.subspan(2, 2)));
    m.instance = report[4];
    m.command = static_cast<std::uint32_t>(get_little_endian(report.subspan(5, 4)));
    m.data = static_cast<std::int64_t>(get_little_endian(report.subspan(9, 8)));
    m.address = get_little_endian(report.subspan(17, 8));
    return m;
}

std::optional<std::int64_t> reply_value(Command command, const WheelMessage& message) {
    if (message.type != MessageType::request || message.class_id != axis_class || message.instance != 0 ||
        message.command != static_cast<std::uint32_t>(command))
        return std::nullopt;
    return message.data;
}

}  // namespace bolt::device::open_ffboard

namespace bolt::device {

namespace {

constexpr Usage steering{0x02, 0xc8}, joystick_x{0x01, 0x30}, wheel{0x01, 0x38};

}  // namespace

Result<WheelAxis> wheel_axis(const ReportDescriptor& descriptor) {
    WheelAxis layout;
    layout.numbered = descriptor.numbered;
    const ReportField* axis = nullptr;
    for (const Usage usage : {steering, joystick_x, wheel})
        if (axis == nullptr) axis = find_field(descriptor, ReportKind::input, usage);
    if (axis == nullptr || axis->array || axis->relative || axis->high <= axis->low)
        return fail(ErrorCode::no_device, "the device does not report its angle",
                    "a wheel whose reports contain a steering or x axis");
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
    const double normalized = normalized_value(layout.axis, *value);
    state.deflection = layout.axis.low < 0 ? normalized : 2.0 * normalized - 1.0;
    return true;
}

namespace {

constexpr double wheel_rate = 1000.0;     // 1/s
constexpr double rest_timeout = 0.25;     // s
constexpr double reply_timeout = 0.1;     // s, for a reply of a board during opening
constexpr double position_retry = 0.005;  // s until an unanswered request of the encoder position is repeated
constexpr double position_interval = 0.004;  // s between requests that only check that the board is alive
constexpr int max_attempts = 3;
constexpr std::int64_t max_degrees = 65535;  // largest range that a board can report
constexpr int max_wheel_reports = 256;       // reports per read

// The common part of wheels and boards: transport, axis and force.
struct WheelCore {
    std::unique_ptr<HidTransport> transport;
    WheelAxis axis;
    UsbForceFeedback force;
    Description description;
    WheelConfig config;
    SecondsClock clock;
    double available = 0.0;  // N·m at a share of 1
    WheelState state;

    Status write(const force::OutputCommand& command) {
        double torque = glm::dot(command.torque, config.axis);
        if (!std::isfinite(torque)) torque = 0.0;
        torque = std::clamp(torque, -description.limits.torque, description.limits.torque);
        const double share = available > 0.0 ? torque / available : 0.0;
        // Our torque is positive to the right, the effect's to the left.
        return force.update(*transport, config.reversed ? share : -share, clock());
    }

    [[nodiscard]] Sample sample(double turn) const {
        Sample s;
        s.angle = turn;
        s.buttons = state.buttons;
        s.time = clock();
        return s;
    }
};

Result<WheelCore> make_core(std::unique_ptr<HidTransport> transport, const ReportDescriptor& descriptor,
                            std::string name, std::string id, const WheelConfig& config, SecondsClock clock) {
    BOLT_TRY_ASSIGN(auto axis, wheel_axis(descriptor));
    BOLT_TRY_ASSIGN(auto layout, force_feedback_layout(descriptor));
    WheelCore core{std::move(transport),
                   std::move(axis),
                   UsbForceFeedback(std::move(layout)),
                   {},
                   config,
                   std::move(clock),
                   config.full_torque,
                   {}};
    Description& d = core.description;
    d.name = std::move(name);
    d.id = std::move(id);
    d.sensing = Sensing::angle;
    d.axis = config.axis;
    d.limits.force = 0.0;
    d.limits.delay = 2;
    // Below the stiffness that the wheel's own damping stabilises: b/τ with 0.1 N·m·s/rad and a 3 ms round
    // trip.
    d.limits.torsion = 20.0;
    d.rate = wheel_rate;
    d.buttons = static_cast<int>(core.axis.buttons.size());
    return core;
}

void describe_torque(WheelCore& core) {
    Description& d = core.description;
    d.limits.torque = std::min(core.config.max_torque, core.available);
    for (int i = 0; i < 3; ++i)
        d.renders[static_cast<std::size_t>(3 + i)] =
            d.limits.torque > 0.0 && std::abs(core.config.axis[i]) > 0.01;
    d.remarks.push_back(
        fmt::format("renders at most {:.1f} N·m, assuming that the motor gives {:.1f} N·m at full drive; a "
                    "wheel configuration file (--rig) can change this",
                    d.limits.torque, core.available));
}

class Wheel : public DeviceDriver {
  public:
    explicit Wheel(WheelCore core) : core_(std::move(core)), last_report_(core_.clock()) {}
    ~Wheel() override { core_.force.stop(*core_.transport); }

    [[nodiscard]] const Description& description() const override { return core_.description; }

    Result<std::optional<Sample>> read(double timeout) override {
        for (int i = 0; i < max_wheel_reports; ++i) {
            BOLT_TRY_ASSIGN(const auto report, core_.transport->read(i == 0 ? timeout : 0.0));
            if (report.empty()) break;
            const std::uint32_t buttons_before = core_.state.buttons;
            const bool has_angle = decode_report(core_.axis, report, core_.state);
            has_angle_ = has_angle_ || has_angle;
            // Buttons in a report of their own must take effect on a wheel at rest too.
            if (has_angle || core_.state.buttons != buttons_before) last_report_ = core_.clock();
        }
        if (!has_angle_ || core_.clock() - last_report_ > rest_timeout) return std::nullopt;
        return core_.sample(core_.state.deflection * 0.5 * core_.config.range);
    }

    Status write(const force::OutputCommand& command) override { return core_.write(command); }

  private:
    WheelCore core_;
    double last_report_;
    bool has_angle_ = false;
};

class OpenFfboard : public DeviceDriver {
  public:
    OpenFfboard(WheelCore core, double range) : core_(std::move(core)), range_(range) {}
    ~OpenFfboard() override { core_.force.stop(*core_.transport); }

    [[nodiscard]] const Description& description() const override { return core_.description; }

    Result<std::optional<Sample>> read(double timeout) override {
        timeout = std::min(timeout, position_interval);  // a request may have to be repeated
        const double begun = core_.clock();
        const double since = begun - requested_at_;
        // Replies delay axis reports, so request no more than needed.
        if (since >= (reply_pending_ ? position_retry : has_counts() ? 0.0 : position_interval)) {
            const auto command = open_ffboard::encode_message(
                {.command = static_cast<std::uint32_t>(open_ffboard::Command::position)});
            BOLT_TRY(core_.transport->write(command));
            requested_at_ = begun;
            reply_pending_ = true;
        }
        bool has_sample = false;
        for (int i = 0; i < max_wheel_reports; ++i) {
            const double left = has_sample ? 0.0 : std::max(begun + timeout - core_.clock(), 0.0);
            BOLT_TRY_ASSIGN(const auto report, core_.transport->read(left));
            if (report.empty()) break;
            if (const auto message = open_ffboard::decode_message(report)) {
                const auto counts = reply_value(open_ffboard::Command::position, *message);
                if (!counts) continue;
                reply_pending_ = false;
                counts_ = static_cast<double>(*counts);
                has_sample = has_sample || has_axis_ || has_counts();
            } else if (decode_report(core_.axis, report, core_.state)) {
                has_axis_ = true;
                has_sample = has_sample || !has_counts();
            }
        }
        if (!has_sample) return std::nullopt;
        return core_.sample(has_counts() ? counts_ / core_.config.counts_per_turn * 2.0 * pi
                                         : core_.state.deflection * 0.5 * range_);
    }

    Status write(const force::OutputCommand& command) override { return core_.write(command); }

  private:
    [[nodiscard]] bool has_counts() const { return core_.config.counts_per_turn > 0.0; }

    WheelCore core_;
    double range_, counts_ = 0.0;
    double requested_at_ = -1.0;
    bool reply_pending_ = false;  // a position request is not answered yet
    bool has_axis_ = false;       // an axis report has arrived
};

// nullopt: no reply.
Result<std::optional<std::int64_t>> query_setting(WheelCore& core, open_ffboard::Command command) {
    for (int i = 0; i < max_attempts; ++i) {
        const auto bytes = open_ffboard::encode_message({.command = static_cast<std::uint32_t>(command)});
        BOLT_TRY(core.transport->write(bytes));
        const double until = core.clock() + reply_timeout;
        for (int n = 0; n < max_wheel_reports; ++n) {
            BOLT_TRY_ASSIGN(const auto report, core.transport->read(std::max(until - core.clock(), 0.0)));
            if (report.empty()) break;
            if (const auto message = open_ffboard::decode_message(report)) {
                if (const auto reply = reply_value(command, *message)) return reply;
            } else {
                decode_report(core.axis, report, core.state);
            }
        }
    }
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<DeviceDriver>> make_wheel(std::unique_ptr<HidTransport> transport,
                                                 const ReportDescriptor& descriptor, std::string name,
                                                 std::string id, const WheelConfig& config,
                                                 SecondsClock clock) {
    BOLT_TRY_ASSIGN(auto core, make_core(std::move(transport), descriptor, std::move(name), std::move(id),
                                         config, std::move(clock)));
    core.description.silent_at_rest = true;
    describe_torque(core);
    core.description.remarks.push_back(
        fmt::format("assumed to turn {:.0f} degrees from stop to stop", to_degrees(config.range)));
    BOLT_TRY(core.force.start(*core.transport, core.clock()));
    return std::make_unique<Wheel>(std::move(core));
}

Result<std::unique_ptr<DeviceDriver>> make_open_ffboard(std::unique_ptr<HidTransport> transport,
                                                        const ReportDescriptor& descriptor, std::string name,
                                                        std::string id, const WheelConfig& config,
                                                        SecondsClock clock) {
    BOLT_TRY_ASSIGN(auto core, make_core(std::move(transport), descriptor, std::move(name), std::move(id),
                                         config, std::move(clock)));
    const auto degrees = query_setting(core, open_ffboard::Command::degrees);
    if (!degrees) return fail(degrees.error());
    if (!*degrees || **degrees <= 0 || **degrees > max_degrees)
        return fail(ErrorCode::no_device,
                    fmt::format("{} does not report the range of its axis", core.description.name),
                    "an OpenFFBoard whose main class is a force feedback wheel, with commands over HID");
    const auto power = query_setting(core, open_ffboard::Command::power);
    if (!power) return fail(power.error());
    // If the power is unknown, assume full power: the rendered torque is then too weak, never too strong.
    const double power_share =
        *power ? std::clamp(static_cast<double>(**power) / open_ffboard::full_power, 0.0, 1.0) : 1.0;
    core.available = config.full_torque * power_share;
    describe_torque(core);
    if (core.available <= 0.0)
        core.description.remarks.emplace_back(
            "its power is set to zero; set it with OpenFFBoard's configurator");
    if (config.counts_per_turn <= 0.0)
        core.description.remarks.push_back(fmt::format(
            "turns {} degrees from stop to stop; enter the encoder's counts per turn for an unlimited angle",
            **degrees));
    BOLT_TRY(core.force.start(*core.transport, core.clock()));
    return std::make_unique<OpenFfboard>(std::move(core), to_radians(static_cast<double>(**degrees)));
}

}  // namespace bolt::device
