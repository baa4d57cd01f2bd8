// Keeps a wheel's one constant force alive over a line, and takes it away at the end.
#pragma once

#include "haptics/device/hid_line.hpp"
#include "haptics/device/pid.hpp"

namespace bolt::device {

class PidForce {
  public:
    explicit PidForce(PidLayout layout) : layout_(std::move(layout)) {}

    // Takes the device over from whoever used it before: all effects stopped, ours made and started at zero.
    Status begin(HidLine& line, double now);
    // −1 … 1 of what the device can, to the left. Sends what is new, and now and then what is not: the effect
    // is given a short life, and there are devices that let a force die of themselves.
    Status push(HidLine& line, double share, double now);
    // As far as it still can be told.
    void end(HidLine& line);

  private:
    PidLayout layout_;
    std::vector<std::uint8_t> sent_;
    double sent_at_ = 0.0, started_at_ = 0.0;
    bool begun_ = false;
};

}  // namespace bolt::device
