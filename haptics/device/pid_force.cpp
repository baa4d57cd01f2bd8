#include "haptics/device/pid_force.hpp"

namespace bolt::device {

namespace {

constexpr double tell_again = 0.1;                  // s
constexpr double start_again = 0.25 * effect_life;  // s
constexpr int most_questions = 60;                  // until an effect is loaded; as many as Linux asks

Status send(HidLine& line, const PidMessage& message) {
    if (message.bytes.empty()) return {};
    return message.kind == ReportKind::feature ? line.send_feature(message.bytes) : line.write(message.bytes);
}

Result<std::int64_t> load(HidLine& line, const PidLayout& layout) {
    // Without a report that creates effects, or one that tells where, effects have fixed places: the first.
    const std::int64_t first = layout.force.block ? std::max<std::int64_t>(layout.force.block->low, 1) : 1;
    if (layout.create.bytes.empty()) return first;
    if (Status sent = send(line, layout.create); !sent) return fail(sent.error());
    if (layout.loaded.bytes.empty()) return first;
    for (int i = 0; i < most_questions; ++i) {
        std::vector<std::uint8_t> answer = layout.loaded.bytes;
        const auto got = line.get_feature(answer);
        if (!got) return fail(got.error());
        const auto block = loaded_block(layout, *got);
        if (!block) return fail(block.error());
        if (*block) return **block;
    }
    return fail(ErrorCode::no_device, "the device does not say where it put an effect",
                "an answer to USB's \"block load\"");
}

}  // namespace

Status PidForce::begin(HidLine& line, double now) {
    // A reset alone may leave a spring that pulls to the middle, of the device's own.
    for (const PidMessage* m : {&layout_.reset, &layout_.stop_all, &layout_.enable, &layout_.gain})
        if (Status sent = send(line, *m); !sent) return sent;
    const Result<std::int64_t> block = load(line, layout_);
    if (!block) return fail(block.error());
    use_block(layout_, *block);
    put_share(layout_, 0.0);
    begun_ = true;
    for (const PidMessage* m : {&layout_.set, &layout_.force, &layout_.start})
        if (Status sent = send(line, *m); !sent) return sent;
    sent_ = layout_.force.bytes;
    sent_at_ = started_at_ = now;
    return {};
}

Status PidForce::push(HidLine& line, double share, double now) {
    put_share(layout_, share);
    if (now - started_at_ >= start_again) {
        if (Status sent = send(line, layout_.start); !sent) return sent;
        started_at_ = now;
    }
    if (layout_.force.bytes == sent_ && now - sent_at_ < tell_again) return {};
    if (Status sent = send(line, layout_.force); !sent) return sent;
    sent_ = layout_.force.bytes;
    sent_at_ = now;
    return {};
}

void PidForce::end(HidLine& line) {
    if (!begun_) return;
    begun_ = false;
    put_share(layout_, 0.0);
    // Each on its own: what one fails to do the next may.
    for (const PidMessage* m : {&layout_.force, &layout_.stop, &layout_.free, &layout_.stop_all})
        static_cast<void>(send(line, *m));
}

}  // namespace bolt::device
