// USB's force feedback (page "Physical Interface", PID): one constant force, kept running for as long as the
// device is open. Bytes only; pid_force.hpp sends them.
//
// USB-IF, Device Class Definition for Physical Interface Devices 1.0; what devices leave out or do otherwise
// is known from Linux' hid-pidff.c.
#pragma once

#include <vector>

#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

// s that a force lasts without being started again: so long it outlives a program that was killed.
constexpr double effect_life = 1.0;

struct PidMessage {
    ReportKind kind = ReportKind::output;
    std::vector<std::uint8_t> bytes;  // id in front; empty: the device knows no such message
    std::optional<Field> block;       // which effect is meant
};

struct PidLayout {
    PidMessage reset, stop_all, enable;  // of the device
    PidMessage gain;                     // all of it
    PidMessage create;                   // an effect of constant force
    PidMessage loaded;                   // to be asked for: where the effect was put, and whether
    PidMessage set;                      // the effect: for its life, from the right
    PidMessage force;                    // how strong it is
    PidMessage start, stop, free;        // the effect
    Field magnitude;                     // in `force`
    std::optional<Field> status;         // in `loaded`
    std::int64_t loaded_well = 0;
};

// An error: it has no constant force, or none that goes both ways.
Result<PidLayout> pid_layout(const ReportDescriptor& descriptor);

// From the answer to `loaded`: the effect's number. None: not loaded yet. An error: there is no room.
Result<std::optional<std::int64_t>> loaded_block(const PidLayout& layout,
                                                 std::span<const std::uint8_t> answer);

// Everything from now on is about this effect.
void use_block(PidLayout& layout, std::int64_t block);

// −1 … 1 of what the device can; positive turns to the left, the force "coming from the right".
void put_share(PidLayout& layout, double share);

}  // namespace bolt::device
