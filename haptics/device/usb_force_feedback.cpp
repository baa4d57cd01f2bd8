#include "haptics/device/usb_force_feedback.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::device {

namespace {

// A usage of the page "Physical Interface Device" (PID).
constexpr Usage pid(std::uint16_t id) { return {0x0f, id}; }

constexpr Usage set_effect = pid(0x21), block_index = pid(0x22), constant_force = pid(0x26),
                duration = pid(0x50), gain = pid(0x52), axes_enable = pid(0x55), direction_enable = pid(0x56),
                direction = pid(0x57), magnitude = pid(0x70), set_constant_force = pid(0x73),
                effect_operation = pid(0x77), op_start = pid(0x79), op_stop = pid(0x7b),
                loop_count = pid(0x7c), device_gain_report = pid(0x7d), device_gain = pid(0x7e),
                block_load = pid(0x89), load_success = pid(0x8c), block_free = pid(0x90),
                enable_actuators = pid(0x97), stop_all_effects = pid(0x99), device_reset = pid(0x9a),
                create_effect = pid(0xab);

constexpr ReportKind output_kinds[] = {ReportKind::output, ReportKind::feature};

struct MessageBuilder {
    ForceFeedbackMessage message;
    std::span<std::uint8_t> body() { return std::span(message.bytes).subspan(1); }
};

MessageBuilder make_message(const ReportDescriptor& descriptor, const ReportField& field) {
    MessageBuilder m;
    m.message.kind = field.kind;
    m.message.bytes.resize(1 + report_size(descriptor, field.kind, field.report));
    m.message.bytes[0] = field.report;
    return m;
}

void set_field(MessageBuilder& m, const ReportField& field, std::int64_t value) {
    if (field.report == m.message.bytes[0]) write_value(field, value, m.body());
}

// A message that consists of one selector; empty if the device lacks it.
std::optional<MessageBuilder> selector_message(const ReportDescriptor& descriptor, Usage option,
                                               std::optional<Usage> within = std::nullopt) {
    for (const ReportKind kind : output_kinds)
        if (const auto choice = find_selector(descriptor, kind, option, within)) {
            MessageBuilder m = make_message(descriptor, choice->field);
            set_field(m, choice->field, choice->value);
            if (const ReportField* block =
                    within ? find_field(descriptor, kind, block_index, within) : nullptr;
                block != nullptr && block->report == choice->field.report)
                m.message.block = *block;
            return m;
        }
    return std::nullopt;
}

const ReportField* output_field(const ReportDescriptor& descriptor, Usage usage, Usage within) {
    for (const ReportKind kind : output_kinds)
        if (const ReportField* field = find_field(descriptor, kind, usage, within)) return field;
    return nullptr;
}

// Converts seconds to counts of a field. Fields without a unit use milliseconds, as in the standard's
// examples.
std::int64_t to_counts(const ReportField& field, double seconds) {
    constexpr std::uint32_t si_seconds = 0x1001, english_seconds = 0x1003;
    const bool has_unit = field.unit == si_seconds || field.unit == english_seconds;
    const double unit = has_unit ? std::pow(10.0, field.exponent) : 1e-3;
    double counts = std::clamp(seconds / unit, 0.0, 1e9);
    const auto physical = static_cast<double>(field.physical_high - field.physical_low);
    if (has_unit && physical > 0.0) counts *= static_cast<double>(field.high - field.low) / physical;
    return std::max<std::int64_t>(std::llround(counts), 1);
}

ForceFeedbackMessage set_effect_message(const ReportDescriptor& descriptor) {
    std::optional<MessageBuilder> m = selector_message(descriptor, constant_force, set_effect);
    if (!m) return {};
    const auto field = [&](Usage usage) {
        return find_field(descriptor, m->message.kind, usage, set_effect);
    };
    if (const ReportField* f = field(duration)) set_field(*m, *f, to_counts(*f, effect_life));
    if (const ReportField* f = field(gain)) set_field(*m, *f, f->high);
    // The first axis that can be enabled is the wheel's. Trigger button and start delay stay zero (none).
    for (const ReportField& f : descriptor.fields)
        if (f.kind == m->message.kind && f.report == m->message.bytes[0] &&
            find_field(descriptor, f.kind, f.usage, axes_enable) == &f) {
            set_field(*m, f, 1);
            break;
        }
    if (const ReportField* f = field(direction_enable)) set_field(*m, *f, 1);
    // Direction 90° from north: from the right. Devices name the slots by ordinals or by axes.
    for (const ReportField& f : descriptor.fields)
        if (f.kind == m->message.kind && find_field(descriptor, f.kind, f.usage, direction) == &f) {
            set_field(*m, f, f.low + (f.high - f.low) / 4);
            break;
        }
    return std::move(m->message);
}

}  // namespace

Result<ForceFeedbackLayout> force_feedback_layout(const ReportDescriptor& descriptor) {
    ForceFeedbackLayout layout;
    const ReportField* strength = output_field(descriptor, magnitude, set_constant_force);
    if (strength == nullptr)
        return fail(ErrorCode::no_device, "the device has no constant-force effect",
                    "a wheel with USB force feedback (PID)");
    if (strength->low >= 0 || strength->high <= 0)
        return fail(ErrorCode::no_device, "the device's constant force has one sign only",
                    "a signed magnitude");
    std::optional<MessageBuilder> start = selector_message(descriptor, op_start, effect_operation);
    std::optional<MessageBuilder> stop = selector_message(descriptor, op_stop, effect_operation);
    if (!start || !stop)
        return fail(ErrorCode::no_device, "the device cannot start and stop effects",
                    "the report \"effect operation\" of USB force feedback");
    if (const ReportField* loops = find_field(descriptor, start->message.kind, loop_count, effect_operation))
        set_field(*start, *loops, 1);
    layout.start = std::move(start->message);
    layout.stop = std::move(stop->message);

    MessageBuilder force = make_message(descriptor, *strength);
    layout.magnitude = *strength;
    if (const ReportField* block = find_field(descriptor, strength->kind, block_index, set_constant_force))
        force.message.block = *block;
    layout.set_force = std::move(force.message);

    const auto control = [&](Usage option) {
        std::optional<MessageBuilder> m = selector_message(descriptor, option);
        return m ? std::move(m->message) : ForceFeedbackMessage{};
    };
    layout.reset = control(device_reset);
    layout.stop_all = control(stop_all_effects);
    layout.enable = control(enable_actuators);
    if (const ReportField* f = output_field(descriptor, device_gain, device_gain_report)) {
        MessageBuilder m = make_message(descriptor, *f);
        set_field(m, *f, f->high);
        layout.gain = std::move(m.message);
    }
    if (std::optional<MessageBuilder> m = selector_message(descriptor, constant_force, create_effect))
        layout.create = std::move(m->message);
    layout.set_effect = set_effect_message(descriptor);
    if (const ReportField* f = output_field(descriptor, block_index, block_free)) {
        MessageBuilder m = make_message(descriptor, *f);
        m.message.block = *f;
        layout.free = std::move(m.message);
    }
    if (const ReportField* f = find_field(descriptor, ReportKind::feature, block_index, block_load)) {
        MessageBuilder m = make_message(descriptor, *f);
        m.message.block = *f;
        layout.block_load = std::move(m.message);
        if (const auto success = find_selector(descriptor, ReportKind::feature, load_success, block_load)) {
            layout.status = success->field;
            layout.load_success = success->value;
        }
    }
    return layout;
}

Result<std::optional<std::int64_t>> parse_block_load(const ForceFeedbackLayout& layout,
                                                     std::span<const std::uint8_t> reply) {
    if (reply.empty() || !layout.block_load.block) return std::nullopt;
    const auto body = reply.subspan(1);
    const auto block = value_of(*layout.block_load.block, body);
    if (!block) return std::nullopt;
    if (layout.status && layout.status->array) {
        const auto status = value_of(*layout.status, body);
        if (!status || *status < layout.status->low || *status > layout.status->high) return std::nullopt;
        if (*status != layout.load_success)
            return fail(ErrorCode::no_device, "the device has no memory left for an effect",
                        "a device that no other program uses; unplug it and plug it in again");
    }
    if (*block < layout.block_load.block->low || *block > layout.block_load.block->high) return std::nullopt;
    return block;
}

void select_block(ForceFeedbackLayout& layout, std::int64_t block) {
    for (ForceFeedbackMessage* m :
         {&layout.set_effect, &layout.set_force, &layout.start, &layout.stop, &layout.free})
        if (m->block && !m->bytes.empty()) write_value(*m->block, block, std::span(m->bytes).subspan(1));
}

void set_magnitude(ForceFeedbackLayout& layout, double share) {
    const double s = std::isfinite(share) ? std::clamp(share, -1.0, 1.0) : 0.0;
    const auto max_magnitude = static_cast<double>(s < 0.0 ? -layout.magnitude.low : layout.magnitude.high);
    write_value(layout.magnitude, std::llround(s * max_magnitude),
                std::span(layout.set_force.bytes).subspan(1));
}

namespace {

constexpr double refresh_interval = 0.1;                 // s
constexpr double restart_interval = 0.25 * effect_life;  // s
constexpr int max_polls = 60;  // until an effect is loaded; the number that Linux uses

Status send(HidTransport& transport, const ForceFeedbackMessage& message) {
    if (message.bytes.empty()) return {};
    return message.kind == ReportKind::feature ? transport.send_feature(message.bytes)
                                               : transport.write(message.bytes);
}

Result<std::int64_t> load_effect(HidTransport& transport, const ForceFeedbackLayout& layout) {
    // Devices without a "create" or "block load" report have fixed effect blocks; use the first.
    const std::int64_t first =
        layout.set_force.block ? std::max<std::int64_t>(layout.set_force.block->low, 1) : 1;
    if (layout.create.bytes.empty()) return first;
    BOLT_TRY(send(transport, layout.create));
    if (layout.block_load.bytes.empty()) return first;
    for (int i = 0; i < max_polls; ++i) {
        std::vector<std::uint8_t> reply = layout.block_load.bytes;
        BOLT_TRY_ASSIGN(const auto received, transport.get_feature(reply));
        BOLT_TRY_ASSIGN(const auto block, parse_block_load(layout, received));
        if (block) return *block;
    }
    return fail(ErrorCode::no_device, "the device does not report the block of a new effect",
                "a reply to \"block load\" (PID)");
}

}  // namespace

Status UsbForceFeedback::start(HidTransport& transport, double now) {
    // Some devices keep a centring spring after a reset.
    for (const ForceFeedbackMessage* m : {&layout_.reset, &layout_.stop_all, &layout_.enable, &layout_.gain})
        BOLT_TRY(send(transport, *m));
    BOLT_TRY_ASSIGN(const auto block, load_effect(transport, layout_));
    select_block(layout_, block);
    set_magnitude(layout_, 0.0);
    begun_ = true;
    for (const ForceFeedbackMessage* m : {&layout_.set_effect, &layout_.set_force, &layout_.start})
        BOLT_TRY(send(transport, *m));
    sent_ = layout_.set_force.bytes;
    sent_at_ = started_at_ = now;
    return {};
}

Status UsbForceFeedback::update(HidTransport& transport, double share, double now) {
    set_magnitude(layout_, share);
    if (now - started_at_ >= restart_interval) {
        BOLT_TRY(send(transport, layout_.start));
        started_at_ = now;
    }
    if (layout_.set_force.bytes == sent_ && now - sent_at_ < refresh_interval) return {};
    BOLT_TRY(send(transport, layout_.set_force));
    sent_ = layout_.set_force.bytes;
    sent_at_ = now;
    return {};
}

void UsbForceFeedback::stop(HidTransport& transport) {
    if (!begun_) return;
    begun_ = false;
    set_magnitude(layout_, 0.0);
    // Send all three even if one fails.
    for (const ForceFeedbackMessage* m :
         {&layout_.set_force, &layout_.stop, &layout_.free, &layout_.stop_all})
        static_cast<void>(send(transport, *m));
}

}  // namespace bolt::device
