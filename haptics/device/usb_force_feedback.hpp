// USB force feedback (usage page "Physical Interface Device", PID) with one constant force: its messages, and
// UsbForceFeedback, which sends them.
//
// Source: USB-IF, Device Class Definition for Physical Interface Devices 1.0. Where real
// devices deviate, this code does as Linux' hid-pidff.c.
#pragma once

#include <vector>

#include "haptics/device/hid_transport.hpp"
#include "haptics/device/report_descriptor.hpp"

namespace bolt::device {

// Duration of the effect in s unless restarted, and so the longest time that a force outlives a killed
// program.
constexpr double effect_life = 1.0;

// A report to the device. An effect, such as a constant force, occupies a block of the device's memory, and
// messages name the effect by the index of its block.
struct ForceFeedbackMessage {
    ReportKind kind = ReportKind::output;
    std::vector<std::uint8_t> bytes;   // begins with the id; empty: the device has no such message
    std::optional<ReportField> block;  // field that holds the block's index; none: the message has none
};

struct ForceFeedbackLayout {
    ForceFeedbackMessage reset, stop_all, enable;  // device control
    ForceFeedbackMessage gain;                     // device gain
    ForceFeedbackMessage create;                   // creates a constant-force effect
    ForceFeedbackMessage block_load;         // feature to read: block index and status of the new effect
    ForceFeedbackMessage set_effect;         // effect parameters: duration and direction (from the right)
    ForceFeedbackMessage set_force;          // magnitude of the constant force
    ForceFeedbackMessage start, stop, free;  // start and stop the effect; free its block
    ReportField magnitude;                   // in `set_force`
    std::optional<ReportField> status;       // in `block_load`
    std::int64_t load_success = 0;           // value of `status` after a successful load
};

// Fails if the device has no constant force, or one whose magnitude has a single sign.
Result<ForceFeedbackLayout> force_feedback_layout(const ReportDescriptor& descriptor);

// Parses the `block_load` report: the block index, nullopt if loading is not complete, an error if memory is
// full.
Result<std::optional<std::int64_t>> parse_block_load(const ForceFeedbackLayout& layout,
                                                     std::span<const std::uint8_t> reply);

// Writes the block index into all messages of the effect.
void select_block(ForceFeedbackLayout& layout, std::int64_t block);

// `share` is −1 … 1 of full scale; positive turns to the left (the force comes from the right).
void set_magnitude(ForceFeedbackLayout& layout, double share);

// Runs the constant-force effect of a wheel: creates, updates, restarts and stops it.
class UsbForceFeedback {
  public:
    explicit UsbForceFeedback(ForceFeedbackLayout layout) : layout_(std::move(layout)) {}

    // Resets the device, stops all effects of earlier users, then creates the effect and starts it at zero.
    Status start(HidTransport& transport, double now);
    // `share` is −1 … 1 of full scale, positive to the left. Sends changes at once, and repeats the value
    // before the effect's duration ends; some devices also drop a force that is not refreshed.
    Status update(HidTransport& transport, double share, double now);
    // Best effort: ignores write errors.
    void stop(HidTransport& transport);

  private:
    ForceFeedbackLayout layout_;
    std::vector<std::uint8_t> sent_;
    double sent_at_ = 0.0, started_at_ = 0.0;
    bool begun_ = false;
};

}  // namespace bolt::device
