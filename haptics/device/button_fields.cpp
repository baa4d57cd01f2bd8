#include "haptics/device/button_fields.hpp"

namespace bolt::device {

namespace {

constexpr std::uint16_t button_page = 0x09, most_buttons = 32;

}  // namespace

std::vector<Field> find_button_fields(const ReportDescriptor& descriptor) {
    std::vector<Field> buttons;
    for (std::uint16_t number = 1; number <= most_buttons; ++number)
        if (const Field* button = find_field(descriptor, ReportKind::input, {button_page, number});
            button != nullptr && !button->array)
            buttons.push_back(*button);
    return buttons;
}

bool decode_buttons(const std::vector<Field>& buttons, std::uint8_t id, std::span<const std::uint8_t> report,
                    std::uint32_t& pressed) {
    bool told = false;
    for (const Field& button : buttons) {
        if (button.report != id) continue;
        const auto value = value_of(button, report);
        if (!value) continue;
        const std::uint32_t bit = 1U << (button.usage.id - 1U);
        pressed = *value != 0 ? pressed | bit : pressed & ~bit;
        told = true;
    }
    return told;
}

std::optional<std::uint8_t> strip_report_id(bool numbered, std::span<const std::uint8_t>& report) {
    if (!numbered) return std::uint8_t{0};
    if (report.empty()) return std::nullopt;
    const std::uint8_t id = report.front();
    report = report.subspan(1);
    return id;
}

}  // namespace bolt::device
