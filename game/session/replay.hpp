// Replays a session: the recorded inputs go through the same servo, and each output is compared with the
// recorded one.
#pragma once

#include <functional>

#include "game/session/lesson_session.hpp"
#include "game/session/session_file.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::session {

// The initial state of a recorded lesson: its assembly from the recorded text, its models from the files that
// exist now. Fails if the session does not hold enough (format 1), or if a contact model is missing or has
// changed.
Result<Prepared> prepare_again(const session::Reader& session);

struct Moment {
    const servo::Setup& setup;
    const servo::State& state;
    const lesson::Lesson& lesson;  // with the events of this tick
    const servo::Input& input;
    const servo::Output& output;
    double time = 0.0;  // s, after the tick
};

struct Replayed {
    std::uint64_t ticks = 0;
    std::uint64_t wrong = 0;  // ticks whose output differs from the recorded one
    std::uint64_t first_wrong = 0;
};

// Replays each tick from the initial state `at`; `visit` returns whether to continue.
Result<Replayed> replay(const session::Reader& session, Prepared at,
                        const std::function<bool(const Moment&)>& visit);

// The recorded hand of a session as a device that repeats its motion (haptics/device/virtual_devices.hpp), in
// the assembly's frame. For a station with an identity workspace mapping whose tool starts at `first`.

struct RecordedHand {
    device::Description description;  // with the limits of the recorded device
    device::Recording recording;      // ticks without a fresh sample are gaps
    Pose first;
};

// Bits of its buttons.
inline constexpr std::uint32_t button_held = 1, button_stop = 2, button_reset = 4;

// Reads the whole session into memory, 40 bytes for each tick. Fails if it is damaged or has no tick.
Result<RecordedHand> replay_device(const Reader& session);

}  // namespace bolt::session
