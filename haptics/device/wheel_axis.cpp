#include "haptics/device/wheel_axis.hpp"

#include "haptics/device/button_fields.hpp"

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

}  // namespace bolt::device
