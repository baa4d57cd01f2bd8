// Runs the gloved hand on its own thread between those of the glove and the servo. All calls are wait-free.
#pragma once

#include "haptics/station/gloved_hand.hpp"

namespace bolt::station {

class HandThread {
  public:
    // Owns the driver and reads its samples.
    static HandThread start(hand::GloveDriver driver, HandSetup setup);

    HandThread(HandThread&&) noexcept;
    HandThread& operator=(HandThread&&) noexcept;
    ~HandThread();  // stops

    // For the servo thread.
    void set_tool(const ToolPoses& tool);
    [[nodiscard]] servo::Grip grip() const;

    // For one calling thread each.
    const DisplayedHand& displayed();
    std::vector<std::string> troubles();
    const hand::GloveReport& report();  // for the thread that calls troubles()

  private:
    struct Shared;
    explicit HandThread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::station
