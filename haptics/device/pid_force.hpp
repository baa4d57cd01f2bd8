// Runs the constant-force effect of a wheel: creates, updates, restarts and stops it.
#pragma once

#include "haptics/device/hid_transport.hpp"
#include "haptics/device/pid.hpp"

namespace bolt::device {

class PidForce {
  public:
    explicit PidForce(PidLayout layout) : layout_(std::move(layout)) {}

    // Resets the device, stops all effects of earlier users, then creates ours and starts it at zero.
    Status start(HidTransport& line, double now);
    // `share` is −1 … 1 of full scale, positive to the left. Sends changes at once, and repeats the value
    // before the effect's duration ends; some devices also drop a force that is not refreshed.
    Status update(HidTransport& line, double share, double now);
    // Best effort: ignores write errors.
    void stop(HidTransport& line);

  private:
    PidLayout layout_;
    std::vector<std::uint8_t> sent_;
    double sent_at_ = 0.0, started_at_ = 0.0;
    bool begun_ = false;
};

}  // namespace bolt::device
