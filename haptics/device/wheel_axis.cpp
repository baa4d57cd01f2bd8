#include "haptics/device/wheel_axis.hpp"

namespace bolt::device {

namespace {

constexpr Usage steering{0x02, 0xc8}, joystick_x{0x01, 0x30}, wheel{0x01, 0x38};
constexpr std::uint16_t button_page = 0x09, most_buttons = 32;

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
    for (std::uint16_t number = 1; number <= most_buttons; ++number)
        if (const Field* button = find_field(descriptor, ReportKind::input, {button_page, number});
            button != nullptr && !button->array)
            layout.buttons.push_back(*button);
    return layout;
}

bool take_report(const WheelAxis& layout, std::span<const std::uint8_t> report, WheelState& state) {
    std::uint8_t id = 0;
    if (layout.numbered) {
        if (report.empty()) return false;
        id = report.front();
        report = report.subspan(1);
    }
    for (const Field& button : layout.buttons) {
        if (button.report != id) continue;
        const auto value = value_of(button, report);
        if (!value) continue;
        const std::uint32_t bit = 1U << (button.usage.id - 1U);
        state.buttons = *value != 0 ? state.buttons | bit : state.buttons & ~bit;
    }
    if (layout.axis.report != id) return false;
    const auto value = value_of(layout.axis, report);
    if (!value) return false;
    const double share = share_of(layout.axis, *value);
    state.share = layout.axis.low < 0 ? share : 2.0 * share - 1.0;
    return true;
}

}  // namespace bolt::device
