// Replays a session: the recorded inputs go through the same servo, and each output is compared with the
// recorded one.
#pragma once

#include <functional>

#include "game/session/lesson_session.hpp"
#include "game/session/session_file.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::session {

// Restores the initial state of a recorded lesson: its assembly from the recorded text, its models from the
// present files. Fails if the session lacks data (format 1), or if a contact model is missing or has changed.
Result<SessionSetup> restore_setup(const SessionReader& session);

// The state after a replayed tick.
struct ReplayTick {
    const servo::Setup& setup;
    const servo::State& state;
    const lesson::Lesson& lesson;  // with the events of this tick
    const servo::TickInput& input;
    const servo::Output& output;
    double time = 0.0;  // s, after the tick
};

struct ReplayResult {
    std::uint64_t ticks = 0;
    std::uint64_t mismatches = 0;      // ticks whose output differs from the recorded one
    std::uint64_t first_mismatch = 0;  // number of ticks before the first of them; 0 also without one
};

using VisitTick = std::function<bool(const ReplayTick&)>;  // false: stop

// Replays each tick from the initial state `start`. Before each `visit` it runs tick_systems on `world`, in
// which the caller has created the entities by world::add_haptics().
Result<ReplayResult> replay(const SessionReader& session, SessionSetup start,
                            const world::WriteHaptics& world, const VisitTick& visit);
// As above, in a new world.
Result<ReplayResult> replay(const SessionReader& session, SessionSetup start, const VisitTick& visit);

// The recorded hand of a session as a device that repeats its motion (haptics/device/virtual_devices.hpp), in
// the assembly's frame. The station that uses it must map the device's poses to the tool unchanged, and its
// tool must start at `first`.
struct RecordedHand {
    device::Description description;    // with the limits of the recorded device
    device::RecordedSamples recording;  // ticks without a fresh sample are gaps
    Pose first;
};

// Bits of the recorded device's buttons: dead-man switch, emergency stop, and the reset that releases it.
inline constexpr std::uint32_t button_dead_man = 1, button_stop = 2, button_reset = 4;

// Reads the whole session into memory, 40 bytes for each tick. Fails if it is damaged or has no tick with
// a fresh sample.
Result<RecordedHand> replay_device(const SessionReader& session);

}  // namespace bolt::session
