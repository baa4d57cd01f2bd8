#include "haptics/device/six_axis.hpp"

#include <algorithm>

namespace bolt::device {

namespace {

constexpr std::uint16_t generic_desktop = 0x01, button_page = 0x09;
constexpr std::uint16_t first_axis = 0x30;  // X, Y, Z, Rx, Ry, Rz
constexpr std::uint16_t most_buttons = 32;

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
    for (std::uint16_t number = 1; number <= most_buttons; ++number)
        if (const Field* button = find_field(descriptor, ReportKind::input, {button_page, number});
            button != nullptr && !button->array)
            layout.buttons.push_back(*button);
    return layout;
}

bool take_report(const SixAxisLayout& layout, std::span<const std::uint8_t> report, SixAxisState& state) {
    std::uint8_t id = 0;
    if (layout.numbered) {
        if (report.empty()) return false;
        id = report.front();
        report = report.subspan(1);
    }
    bool told = false;
    for (std::size_t i = 0; i < layout.axes.size(); ++i) {
        const Field& axis = layout.axes[i];
        if (axis.report != id) continue;
        const auto value = value_of(axis, report);
        if (!value) continue;
        state.share[i] = share_of(axis, *value);
        told = true;
    }
    for (const Field& button : layout.buttons) {
        if (button.report != id) continue;
        const auto value = value_of(button, report);
        if (!value) continue;
        const std::uint32_t bit = 1U << (button.usage.id - 1U);
        state.buttons = *value != 0 ? state.buttons | bit : state.buttons & ~bit;
        told = true;
    }
    return told;
}

}  // namespace bolt::device
