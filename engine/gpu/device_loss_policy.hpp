// Decides whether to restart after the GPU was lost. The system resets a hanging driver and it works again,
// but a device that is lost again shortly after a restart would be lost forever.
#pragma once

#include <optional>

namespace bolt::gpu {

class DeviceLossPolicy {
  public:
    // Reports a loss at time `now` (s). Returns true if the device should be created again.
    bool should_restart(double now) {
        const bool worked = !last_ || now - *last_ >= min_interval;
        last_ = now;
        return worked;
    }
    static constexpr double min_interval = 10.0;  // s

  private:
    std::optional<double> last_;
};

}  // namespace bolt::gpu
