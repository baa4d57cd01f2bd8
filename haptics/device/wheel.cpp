#include "haptics/device/wheel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/device/board_request.hpp"
#include "haptics/device/pid_force.hpp"
#include "haptics/device/wheel_axis.hpp"

namespace bolt::device {

namespace {

constexpr double usual_rate = 1000.0;    // 1/s
constexpr double believed_rest = 0.25;   // s
constexpr double answer_patience = 0.1;  // s for an answer of a board while it is opened
constexpr double ask_again = 0.005;      // s, for the encoder, if no answer came
constexpr double live_every = 0.004;     // s, for the encoder, where only the board's life is of interest
constexpr int most_tries = 3;
constexpr std::int64_t most_degrees = 65535;  // what a board has room for
constexpr int most_at_once = 256;             // reports in one read

// What wheels and boards have in common: a line, an axis, a force.
struct Hub {
    std::unique_ptr<HidLine> line;
    WheelAxis axis;
    PidForce force;
    Description description;
    Rig rig;
    Clock clock;
    double available = 0.0;  // N·m at a share of 1
    WheelState state;

    Status write(const force::OutputCommand& command) {
        double torque = glm::dot(command.torque, rig.axis);
        if (!std::isfinite(torque)) torque = 0.0;
        torque = std::clamp(torque, -description.limits.torque, description.limits.torque);
        const double share = available > 0.0 ? torque / available : 0.0;
        // To the right is positive for us, to the left for the effect.
        return force.push(*line, rig.reversed ? share : -share, clock());
    }

    [[nodiscard]] Sample sample(double turn) const {
        Sample s;
        s.turn = turn;
        s.buttons = state.buttons;
        s.time = clock();
        return s;
    }
};

Result<Hub> make_hub(std::unique_ptr<HidLine> line, const ReportDescriptor& descriptor, std::string name,
                     std::string id, const Rig& rig, Clock clock) {
    Result<WheelAxis> axis = wheel_axis(descriptor);
    if (!axis) return fail(axis.error());
    Result<PidLayout> layout = pid_layout(descriptor);
    if (!layout) return fail(layout.error());
    Hub hub{std::move(line),
            std::move(*axis),
            PidForce(std::move(*layout)),
            {},
            rig,
            std::move(clock),
            rig.full_torque,
            {}};
    Description& d = hub.description;
    d.name = std::move(name);
    d.id = std::move(id);
    d.sensing = Sensing::turn;
    d.axis = rig.axis;
    d.limits.force = 0.0;
    d.limits.delay = 2;
    // Under what a wheel's own damping takes: b/τ with 0.1 N·m·s/rad and 3 ms there and back.
    d.limits.torsion = 20.0;
    d.rate = usual_rate;
    d.buttons = static_cast<int>(hub.axis.buttons.size());
    return hub;
}

void describe_torque(Hub& hub) {
    Description& d = hub.description;
    d.limits.torque = std::min(hub.rig.most_torque, hub.available);
    for (int i = 0; i < 3; ++i)
        d.renders[static_cast<std::size_t>(3 + i)] =
            d.limits.torque > 0.0 && std::abs(hub.rig.axis[i]) > 0.01;
    d.remarks.push_back(
        fmt::format("renders at most {:.1f} N·m, taking it that the motor gives {:.1f} N·m when all is asked "
                    "of it; a rig "
                    "file says otherwise",
                    d.limits.torque, hub.available));
}

class Wheel : public Device {
  public:
    explicit Wheel(Hub hub) : hub_(std::move(hub)), told_(hub_.clock()) {}
    ~Wheel() override { hub_.force.end(*hub_.line); }

    [[nodiscard]] const Description& describe() const override { return hub_.description; }

    Result<std::optional<Sample>> read(double patience) override {
        for (int i = 0; i < most_at_once; ++i) {
            const auto report = hub_.line->read(i == 0 ? patience : 0.0);
            if (!report) return fail(report.error());
            if (report->empty()) break;
            if (!take_report(hub_.axis, *report, hub_.state)) continue;
            told_ = hub_.clock();
            known_ = true;
        }
        if (!known_ || hub_.clock() - told_ > believed_rest) return std::nullopt;
        return hub_.sample(hub_.state.share * 0.5 * hub_.rig.range);
    }

    Status write(const force::OutputCommand& command) override { return hub_.write(command); }

  private:
    Hub hub_;
    double told_;
    bool known_ = false;
};

class OpenFfboard : public Device {
  public:
    OpenFfboard(Hub hub, double range) : hub_(std::move(hub)), range_(range) {}
    ~OpenFfboard() override { hub_.force.end(*hub_.line); }

    [[nodiscard]] const Description& describe() const override { return hub_.description; }

    Result<std::optional<Sample>> read(double patience) override {
        patience = std::min(patience, live_every);  // it may have to be asked again
        const double begun = hub_.clock();
        const double since = begun - asked_at_;
        // Answers take the place of reports about the axis: no more of them than are wanted.
        if (since >= (waits_ ? ask_again : has_counts() ? 0.0 : live_every)) {
            const auto question =
                board::bytes_of({.command = static_cast<std::uint32_t>(board::Command::position)});
            if (Status asked = hub_.line->write(question); !asked) return fail(asked.error());
            asked_at_ = begun;
            waits_ = true;
        }
        bool news = false;
        for (int i = 0; i < most_at_once; ++i) {
            const double left = news ? 0.0 : std::max(begun + patience - hub_.clock(), 0.0);
            const auto report = hub_.line->read(left);
            if (!report) return fail(report.error());
            if (report->empty()) break;
            if (const auto message = board::message_in(*report)) {
                const auto counts = answer_to(board::Command::position, *message);
                if (!counts) continue;
                waits_ = false;
                counts_ = static_cast<double>(*counts);
                news = news || told_ || has_counts();
            } else if (take_report(hub_.axis, *report, hub_.state)) {
                told_ = true;
                news = news || !has_counts();
            }
        }
        if (!news) return std::nullopt;
        return hub_.sample(has_counts() ? counts_ / hub_.rig.counts_per_turn * 2.0 * pi
                                        : hub_.state.share * 0.5 * range_);
    }

    Status write(const force::OutputCommand& command) override { return hub_.write(command); }

  private:
    [[nodiscard]] bool has_counts() const { return hub_.rig.counts_per_turn > 0.0; }

    Hub hub_;
    double range_, counts_ = 0.0;
    double asked_at_ = -1.0;
    bool waits_ = false;  // for an answer
    bool told_ = false;   // its axis, at least once
};

// None: it does not answer.
Result<std::optional<std::int64_t>> ask(Hub& hub, board::Command question) {
    for (int i = 0; i < most_tries; ++i) {
        const auto bytes = board::bytes_of({.command = static_cast<std::uint32_t>(question)});
        if (Status asked = hub.line->write(bytes); !asked) return fail(asked.error());
        const double until = hub.clock() + answer_patience;
        for (int n = 0; n < most_at_once; ++n) {
            const auto report = hub.line->read(std::max(until - hub.clock(), 0.0));
            if (!report) return fail(report.error());
            if (report->empty()) break;
            if (const auto message = board::message_in(*report)) {
                if (const auto answer = answer_to(question, *message)) return answer;
            } else {
                take_report(hub.axis, *report, hub.state);
            }
        }
    }
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<Device>> make_wheel(std::unique_ptr<HidLine> line, const ReportDescriptor& descriptor,
                                           std::string name, std::string id, const Rig& rig, Clock clock) {
    Result<Hub> hub =
        make_hub(std::move(line), descriptor, std::move(name), std::move(id), rig, std::move(clock));
    if (!hub) return fail(hub.error());
    hub->description.rests = true;
    describe_torque(*hub);
    hub->description.remarks.push_back(
        fmt::format("taken to turn {:.0f} degrees from stop to stop", to_degrees(rig.range)));
    if (Status begun = hub->force.begin(*hub->line, hub->clock()); !begun) return fail(begun.error());
    return std::make_unique<Wheel>(std::move(*hub));
}

Result<std::unique_ptr<Device>> make_open_ffboard(std::unique_ptr<HidLine> line,
                                                  const ReportDescriptor& descriptor, std::string name,
                                                  std::string id, const Rig& rig, Clock clock) {
    Result<Hub> hub =
        make_hub(std::move(line), descriptor, std::move(name), std::move(id), rig, std::move(clock));
    if (!hub) return fail(hub.error());
    const auto degrees = ask(*hub, board::Command::degrees);
    if (!degrees) return fail(degrees.error());
    if (!*degrees || **degrees <= 0 || **degrees > most_degrees)
        return fail(ErrorCode::no_device,
                    fmt::format("{} does not say how far its axis turns", hub->description.name),
                    "an OpenFFBoard whose main class is a force feedback wheel, with commands over HID");
    const auto power = ask(*hub, board::Command::power);
    if (!power) return fail(power.error());
    // Silent about its power it is taken to have all of it: then it pulls less than meant, if anything.
    const double let = *power ? std::clamp(static_cast<double>(**power) / board::full_power, 0.0, 1.0) : 1.0;
    hub->available = rig.full_torque * let;
    describe_torque(*hub);
    if (hub->available <= 0.0)
        hub->description.remarks.emplace_back(
            "its power is set to nothing; OpenFFBoard's configurator sets it");
    if (rig.counts_per_turn <= 0.0)
        hub->description.remarks.push_back(fmt::format(
            "turns {} degrees from stop to stop; tell the encoder's counts per turn for turns without end",
            **degrees));
    if (Status begun = hub->force.begin(*hub->line, hub->clock()); !begun) return fail(begun.error());
    return std::make_unique<OpenFfboard>(std::move(*hub), to_radians(static_cast<double>(**degrees)));
}

}  // namespace bolt::device
