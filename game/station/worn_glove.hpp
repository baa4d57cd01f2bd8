// A glove on a hand whose pose a headset measures: the glove measures the fingers, the headset the wrist. The
// hand feels no force, so it takes the wrench by closing, as a hand without a glove does. At an arm
// station::HandThread does this instead: there the fingers close on the wrench that the arm holds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/measured_hand.hpp"

namespace bolt::station_setup {

// The fingers in one frame.
struct WornFingers {
    hand::Skeleton joints;  // in the frame of the wrist
    hand::Side side = hand::Side::right;
    double closed_share = 0.0;  // 0 (open) … 1 (a fist), from closed_share()
    bool measured = false;      // the glove has sent at least one sample
    bool lost = false;          // the glove sends no valid samples; the fingers stay as they were last
};

// The share by which the four fingers are closed, 0 … 1: the mean of their flexion at MCP and PIP, relative
// to a fist (hand::closed_hand_angles).
double closed_share(const hand::Angles& angles);

class WornGlove {
  public:
    // Returns immediately; the glove is opened by the driver's thread.
    static WornGlove start(const std::filesystem::path& port, hand::GloveWearer wearer);

    // Call once a frame.
    void update();
    [[nodiscard]] const WornFingers& fingers() const { return fingers_; }
    std::vector<std::string> fault_messages();

  private:
    WornGlove(hand::GloveDriver driver, hand::GloveWearer wearer);

    hand::GloveDriver driver_;
    hand::GloveWearer wearer_;
    hand::MeasuredHand measured_;
    WornFingers fingers_;
    std::uint64_t sample_ = 0;  // number of the last one
};

}  // namespace bolt::station_setup
