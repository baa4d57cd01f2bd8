#include "haptics/device/pid_force.hpp"

namespace bolt::device {

namespace {

constexpr double tell_again = 0.1;                  // s
constexpr double start_again = 0.25 * effect_life;  // s
constexpr int most_questions = 60;                  // until an effect is loaded; as many as Linux asks

Status send(HidTransport& line, const PidMessage& message) {
    if (message.bytes.empty()) return {};
    return message.kind == ReportKind::feature ? line.send_feature(message.bytes) : line.write(message.bytes);
}

Result<std::int64_t> load(HidTransport& line, const PidLayout& layout) {
    // Devices without a "create" or "block load" report have fixed effect blocks; use the first.
    const std::int64_t first = layout.force.block ? std::max<std::int64_t>(layout.force.block->low, 1) : 1;
    if (layout.create.bytes.empty()) return first;
    BOLT_TRY(send(line, layout.create));
    if (layout.loaded.bytes.empty()) return first;
    for (int i = 0; i < most_questions; ++i) {
        std::vector<std::uint8_t> answer = layout.loaded.bytes;
        BOLT_TRY_ASSIGN(const auto got, line.get_feature(answer));
        BOLT_TRY_ASSIGN(const auto block, parse_block_load(layout, got));
        if (block) return *block;
    }
    return fail(ErrorCode::no_device, "the device does not report the block of a new effect",
                "a reply to \"block load\" (PID)");
}

}  // namespace

Status PidForce::start(HidTransport& line, double now) {
    // Some devices keep a centring spring after a reset.
    for (const PidMessage* m : {&layout_.reset, &layout_.stop_all, &layout_.enable, &layout_.gain})
        BOLT_TRY(send(line, *m));
    BOLT_TRY_ASSIGN(const auto block, load(line, layout_));
    select_block(layout_, block);
    set_magnitude(layout_, 0.0);
    begun_ = true;
    for (const PidMessage* m : {&layout_.set, &layout_.force, &layout_.start}) BOLT_TRY(send(line, *m));
    sent_ = layout_.force.bytes;
    sent_at_ = started_at_ = now;
    return {};
}

Status PidForce::update(HidTransport& line, double share, double now) {
    set_magnitude(layout_, share);
    if (now - started_at_ >= start_again) {
        BOLT_TRY(send(line, layout_.start));
        started_at_ = now;
    }
    if (layout_.force.bytes == sent_ && now - sent_at_ < tell_again) return {};
    BOLT_TRY(send(line, layout_.force));
    sent_ = layout_.force.bytes;
    sent_at_ = now;
    return {};
}

void PidForce::stop(HidTransport& line) {
    if (!begun_) return;
    begun_ = false;
    set_magnitude(layout_, 0.0);
    // Send all three even if one fails.
    for (const PidMessage* m : {&layout_.force, &layout_.stop, &layout_.free, &layout_.stop_all})
        static_cast<void>(send(line, *m));
}

}  // namespace bolt::device
