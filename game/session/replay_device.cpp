#include "game/session/replay_device.hpp"

#include <memory>

#include "game/session/device_text.hpp"

namespace bolt::session {

namespace {

struct Sample {
    servo::DeviceSample device;
    std::uint32_t buttons = 0;
    std::uint64_t tick = 0;
};

Pose pose_of(const servo::DeviceSample& s) {
    const Quat q(static_cast<double>(s.orientation[0]), static_cast<double>(s.orientation[1]),
                 static_cast<double>(s.orientation[2]), static_cast<double>(s.orientation[3]));
    return {Vec3(s.position[0], s.position[1], s.position[2]), glm::normalize(q)};
}

}  // namespace

Result<RecordedHand> replay_device(const Reader& session) {
    const auto samples = std::make_shared<std::vector<Sample>>();
    samples->reserve(session.tick_count());
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t first, std::span<const TickRecord> ticks) {
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            const TickRecord& tick = ticks[i];
            if ((tick.flags & flag_silent) != 0) continue;
            const std::uint32_t buttons = ((tick.flags & flag_enabled) != 0 ? button_held : 0) |
                                          ((tick.flags & flag_stop) != 0 ? button_stop : 0) |
                                          ((tick.flags & flag_reset) != 0 ? button_reset : 0);
            samples->push_back({tick.device, buttons, first + i});
        }
    }));
    if (samples->empty())
        return fail(ErrorCode::failed, session.file() + ": has no ticks with a fresh device sample",
                    "a session that was played");

    RecordedHand hand;
    device::Description& d = hand.description;
    d.name = "the hand of " + session.file();
    d.id = "recording";
    d.sensing = device::Sensing::pose;
    if (const auto limits = limits_of(session.header().device)) d.limits = *limits;
    for (std::size_t i = 0; i < 6; ++i) d.renders[i] = (i < 3 ? d.limits.force : d.limits.torque) > 0.0;
    d.rate = 1.0 / session.header().dt;
    d.buttons = 3;
    hand.first = pose_of(samples->front().device);
    hand.recording = [samples, dt = session.header().dt](std::size_t i) -> std::optional<device::Sample> {
        if (i >= samples->size()) return std::nullopt;
        const Sample& now = (*samples)[i];
        device::Sample sample;
        sample.pose = pose_of(now.device);
        sample.buttons = now.buttons;
        sample.time = static_cast<double>(now.tick) * dt;
        return sample;
    };
    return hand;
}

}  // namespace bolt::session
