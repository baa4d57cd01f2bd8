#include "haptics/device/space_mouse.hpp"

#include <algorithm>
#include <utility>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

namespace {

constexpr std::uint16_t generic_desktop = 0x01;
constexpr std::uint16_t first_axis = 0x30;  // X, Y, Z, Rx, Ry, Rz

}  // namespace

Result<SixAxisLayout> six_axis_layout(const ReportDescriptor& descriptor) {
    SixAxisLayout layout;
    layout.numbered = descriptor.numbered;
    for (std::uint16_t i = 0; i < 6; ++i) {
        const ReportField* axis = find_field(descriptor, ReportKind::input,
                                             {generic_desktop, static_cast<std::uint16_t>(first_axis + i)});
        if (axis == nullptr || axis->array)
            return fail(ErrorCode::no_device, "the device does not report six axes",
                        "translation along and rotation about x, y and z");
        layout.axes[i] = *axis;
    }
    layout.buttons = find_button_fields(descriptor);
    return layout;
}

bool decode_report(const SixAxisLayout& layout, std::span<const std::uint8_t> report, SixAxisState& state) {
    const auto id = strip_report_id(layout.numbered, report);
    if (!id) return false;
    bool decoded = false;
    for (std::size_t i = 0; i < layout.axes.size(); ++i) {
        const ReportField& axis = layout.axes[i];
        if (axis.report != *id) continue;
        const auto value = value_of(axis, report);
        if (!value) continue;
        state.deflection[i] = normalized_value(axis, *value);
        decoded = true;
    }
    return decode_buttons(layout.buttons, *id, report, state.buttons) || decoded;
}

namespace {

constexpr double puck_rate = 125.0;   // 1/s, of wired pucks while deflected
constexpr int max_puck_reports = 64;  // size of the kernel's queue of reports

class SpaceMouse : public DeviceDriver {
  public:
    SpaceMouse(std::unique_ptr<HidTransport> transport, SixAxisLayout layout, Description description,
               const PuckResponse& response, SecondsClock clock)
        : transport_(std::move(transport)),
          layout_(std::move(layout)),
          description_(std::move(description)),
          response_(response),
          clock_(std::move(clock)) {}

    [[nodiscard]] const Description& description() const override { return description_; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double start = clock_();
        if (deflected_) timeout = std::clamp(last_report_ + response_.report_timeout - start, 0.0, timeout);
        for (int i = 0; i < max_puck_reports; ++i) {
            BOLT_TRY_ASSIGN(const auto report, transport_->read(i == 0 ? timeout : 0.0));
            if (report.empty()) break;
            if (!decode_report(layout_, report, state_)) continue;
            last_report_ = clock_();
            const auto moves = [&](double deflection) { return std::abs(deflection) > response_.dead_zone; };
            deflected_ = std::any_of(state_.deflection.begin(), state_.deflection.end(), moves);
            has_report_ = true;
        }
        const double now = clock_();
        if (!std::exchange(has_report_, false) && deflected_) {
            if (now < last_report_ + response_.report_timeout) return std::nullopt;
            state_.deflection.fill(0.0);
            deflected_ = false;
        }
        Sample sample;
        const PuckRates rates = rates_of(state_, response_);
        sample.velocity = rates.velocity;
        sample.angular_velocity = rates.angular_velocity;
        sample.buttons = state_.buttons;
        sample.time = now;
        return sample;
    }

    Status write(const force::OutputCommand&) override { return {}; }

  private:
    std::unique_ptr<HidTransport> transport_;
    SixAxisLayout layout_;
    Description description_;
    PuckResponse response_;
    SecondsClock clock_;
    SixAxisState state_;
    double last_report_ = 0.0;
    bool deflected_ = false, has_report_ = false;
};

}  // namespace

PuckRates rates_of(const SixAxisState& state, const PuckResponse& response) {
    const auto rate = [&](std::size_t axis, double max_rate) {
        const double deflection = std::clamp(state.deflection[axis], -1.0, 1.0);
        const double response_share =
            std::max(std::abs(deflection) - response.dead_zone, 0.0) / (1.0 - response.dead_zone);
        return std::copysign(max_rate * response_share * response_share, deflection);
    };
    // 3Dconnexion: x right, y towards the user, z down.
    const double v = response.speed, w = response.angular_speed;
    return {{rate(0, v), -rate(2, v), rate(1, v)}, {rate(3, w), -rate(5, w), rate(4, w)}};
}

Result<std::unique_ptr<DeviceDriver>> make_space_mouse(std::unique_ptr<HidTransport> transport,
                                                       const ReportDescriptor& descriptor, std::string name,
                                                       std::string id, const PuckResponse& response,
                                                       SecondsClock clock) {
    BOLT_TRY_ASSIGN(auto layout, six_axis_layout(descriptor));
    Description description;
    description.name = std::move(name);
    description.id = std::move(id);
    description.sensing = Sensing::velocity;
    description.limits.force = description.limits.torque = 0.0;
    description.rate = puck_rate;
    description.buttons = static_cast<int>(layout.buttons.size());
    return std::make_unique<SpaceMouse>(std::move(transport), std::move(layout), std::move(description),
                                        response, std::move(clock));
}

}  // namespace bolt::device
