// Keeps one device usable: opens it, reopens it with exponential backoff after a loss or silence, reports the
// problem in plain text, and releases the force when commands stop. Its only effects are the device's and the
// timer's; device_thread.hpp runs it on a thread.
#pragma once

#include <cstdint>

#include "engine/base/function_ref.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

struct SupervisorOptions {
    double first_retry_delay = 0.05, max_retry_delay = 1.0;  // s between two attempts to open; doubles
    // s without a new command until the force is released; with one poll and one write at most 20 ms.
    double command_timeout = 0.015;
    double silence = 0.25;      // s without a valid sample until this is reported
    double reopen_after = 1.0;  // s of silence until the device is reopened
};

// The force to render. Commands issued before the device was opened are never rendered.
struct ForceCommand {
    force::OutputCommand command;
    bool enabled = false;
    std::uint64_t number = 0;  // a new number marks a new command
};

enum class DeviceState : std::uint8_t {
    absent,  // not open
    silent,  // open, but sends no valid samples
    usable,
};

struct DeviceReport {
    DeviceState state = DeviceState::absent;
    std::string trouble;                             // plain text with a remedy; empty: none
    std::shared_ptr<const Description> description;  // from the last opening; null: never opened
    std::uint64_t openings = 0, refusals = 0;        // successful and failed attempts to open
    std::uint64_t losses = 0;                        // closed after a read or write error
    std::uint64_t silences = 0;                      // closed after reopen_after s of silence
    std::uint64_t samples = 0, malformed = 0;
    std::uint64_t writes = 0;
    std::uint64_t lapses = 0;  // command timeouts while a force was rendered
};

class DeviceSupervisor {
  public:
    DeviceSupervisor(DeviceFactory open, Timer timer, const SupervisorOptions& options = {});
    DeviceSupervisor(const DeviceSupervisor&) = delete;
    DeviceSupervisor& operator=(const DeviceSupervisor&) = delete;
    ~DeviceSupervisor();  // closes

    // Waits a few milliseconds at most for a sample or for the next attempt to open, then writes the command
    // that `order` returns. nullopt: no new valid sample.
    std::optional<Sample> poll(FunctionRef<ForceCommand()> order);

    // Releases the force if possible and closes the device.
    void close();

    [[nodiscard]] const DeviceReport& report() const { return report_; }

  private:
    bool try_open(std::uint64_t number);
    Status write(const ForceCommand& order, double now);
    void handle_loss(const Error& error);
    void track_silence(bool heard, double now);
    [[nodiscard]] bool is_valid(const Sample& sample) const;
    [[nodiscard]] bool expects_samples() const;

    DeviceFactory open_;
    Timer timer_;
    SupervisorOptions options_;
    DeviceReport report_;
    std::unique_ptr<Device> device_;
    double read_timeout_ = 0.0;
    double retry_delay_ = 0.0, next_try_ = 0.0;  // s
    double last_sample_ = 0.0;                   // time of the last valid sample
    std::uint64_t command_number_ = 0;           // of the newest command
    double command_time_ = 0.0;                  // when that command was first seen
    bool rendering_ = false;                     // the last write was not zero
    bool may_hold_force_ = false;                // a force may remain: no zero has been written since
};

}  // namespace bolt::device
