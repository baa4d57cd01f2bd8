#include "haptics/device/six_axis.hpp"

#include <algorithm>

#include "haptics/device/button_fields.hpp"

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

}  // namespace bolt::device
