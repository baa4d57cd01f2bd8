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
        const Field* axis = find_field(descriptor, ReportKind::input,
                                       {generic_desktop, static_cast<std::uint16_t>(first_axis + i)});
        if (axis == nullptr || axis->array)
            return fail(ErrorCode::no_device, "the device does not report six axes",
                        "pushes along and turns about x, y and z");
        layout.axes[i] = *axis;
    }
    layout.buttons = find_button_fields(descriptor);
    return layout;
}

bool decode_report(const SixAxisLayout& layout, std::span<const std::uint8_t> report, SixAxisState& state) {
    const auto id = strip_report_id(layout.numbered, report);
    if (!id) return false;
    bool told = false;
    for (std::size_t i = 0; i < layout.axes.size(); ++i) {
        const Field& axis = layout.axes[i];
        if (axis.report != *id) continue;
        const auto value = value_of(axis, report);
        if (!value) continue;
        state.share[i] = normalized_value(axis, *value);
        told = true;
    }
    return decode_buttons(layout.buttons, *id, report, state.buttons) || told;
}

namespace {

constexpr double usual_rate = 125.0;  // 1/s; what wired ones send while they are pushed
constexpr int most_at_once = 64;      // reports that the kernel keeps for a reader

class SpaceMouse : public Device {
  public:
    SpaceMouse(std::unique_ptr<HidTransport> line, SixAxisLayout layout, Description description,
               const PuckResponse& response, Clock clock)
        : line_(std::move(line)),
          layout_(std::move(layout)),
          description_(std::move(description)),
          response_(response),
          clock_(std::move(clock)) {}

    [[nodiscard]] const Description& describe() const override { return description_; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double asked = clock_();
        if (pushed_) timeout = std::clamp(told_ + response_.silence - asked, 0.0, timeout);
        for (int i = 0; i < most_at_once; ++i) {
            BOLT_TRY_ASSIGN(const auto report, line_->read(i == 0 ? timeout : 0.0));
            if (report.empty()) break;
            if (!decode_report(layout_, report, state_)) continue;
            told_ = clock_();
            const auto moves = [&](double share) { return std::abs(share) > response_.dead_zone; };
            pushed_ = std::any_of(state_.share.begin(), state_.share.end(), moves);
            news_ = true;
        }
        const double now = clock_();
        if (!std::exchange(news_, false) && pushed_) {
            if (now < told_ + response_.silence) return std::nullopt;
            state_.share.fill(0.0);
            pushed_ = false;
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
    std::unique_ptr<HidTransport> line_;
    SixAxisLayout layout_;
    Description description_;
    PuckResponse response_;
    Clock clock_;
    SixAxisState state_;
    double told_ = 0.0;
    bool pushed_ = false, news_ = false;
};

}  // namespace

PuckRates rates_of(const SixAxisState& state, const PuckResponse& response) {
    const auto rate = [&](std::size_t axis, double most) {
        const double share = std::clamp(state.share[axis], -1.0, 1.0);
        const double felt = std::max(std::abs(share) - response.dead_zone, 0.0) / (1.0 - response.dead_zone);
        return std::copysign(most * felt * felt, share);
    };
    // 3Dconnexion: x right, y towards the user, z down.
    const double v = response.speed, w = response.turn_speed;
    return {{rate(0, v), -rate(2, v), rate(1, v)}, {rate(3, w), -rate(5, w), rate(4, w)}};
}

Result<std::unique_ptr<Device>> make_space_mouse(std::unique_ptr<HidTransport> line,
                                                 const ReportDescriptor& descriptor, std::string name,
                                                 std::string id, const PuckResponse& response, Clock clock) {
    BOLT_TRY_ASSIGN(auto layout, six_axis_layout(descriptor));
    Description description;
    description.name = std::move(name);
    description.id = std::move(id);
    description.sensing = Sensing::rate;
    description.limits.force = description.limits.torque = 0.0;
    description.rate = usual_rate;
    description.buttons = static_cast<int>(layout.buttons.size());
    return std::make_unique<SpaceMouse>(std::move(line), std::move(layout), std::move(description), response,
                                        std::move(clock));
}

}  // namespace bolt::device
