// Keys as a puck in the hand: where nothing but a keyboard moves the tool of a station.
#pragma once

#include <bitset>
#include <span>

#include "engine/platform/input.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::trainer {

// W A S D away, to the left, nearer and to the right, Q and E down and up; left and right turn the tool about
// the upright, up and down tip it, page up and down roll it; the space bar is the puck's button.
class Pushing {
  public:
    // Takes in what was pressed and let go of. A window that has lost the keyboard pushes nothing.
    void take(std::span<const platform::Event> events);
    [[nodiscard]] device::PuckInput push() const;
    [[nodiscard]] bool closes() const;  // the space bar is down

  private:
    std::bitset<256> down_;
};

}  // namespace bolt::trainer
