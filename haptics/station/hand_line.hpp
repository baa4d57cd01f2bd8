// A gloved hand on a thread of its own, between the glove's and the servo's, and the mailboxes to both:
// nobody who writes or looks ever waits for it.
#pragma once

#include "haptics/station/hand.hpp"

namespace bolt::station {

class HandLine {
  public:
    // Takes the driver's samples from now on.
    static HandLine start(glove::Driver driver, HandPlan plan);

    HandLine(HandLine&&) noexcept;
    HandLine& operator=(HandLine&&) noexcept;
    ~HandLine();  // stops

    // For one caller: the servo.
    void place(const ToolPlace& place);
    [[nodiscard]] servo::Grip grip() const;

    // For one caller each.
    const ShownHand& shown();
    std::vector<std::string> troubles();
    const glove::Report& report();  // for the caller of troubles()

  private:
    struct Shared;
    explicit HandLine(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::station
