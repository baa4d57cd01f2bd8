// The gloved hand at a station: it grasps the tool by closing on it, holds it while the glove is lost, and
// releases it by opening. A thread of its own runs it at the glove's rate, because hand::update_grasp is too
// slow for the servo tick.
//
// The device that moves the tool is the only source of the hand's position: the tool moves along with the
// open hand, and forces start when the hand has closed on the tool.
#pragma once

#include <string>

#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/grasp.hpp"
#include "haptics/hand/measured_hand.hpp"
#include "haptics/servo/io.hpp"

namespace bolt::station {

struct HandSetup {
    hand::GloveWearer wearer;
    collision::ToolShape tool;
    Pose wrist;  // in the frame of the commanded tool
    hand::GraspOptions grasp;
};

// In the assembly's frame.
struct ToolPoses {
    Pose commanded_tool;    // from the device that moves the tool
    Pose constrained_tool;  // the pose that contacts permit
};

struct HandState {
    hand::MeasuredHand gloved;
    hand::GraspState grasp;
    std::uint64_t number = 0;  // of the last glove sample
};

// One step of dt with the latest sample of the glove, which may be the same sample as in the last step. Pure,
// no allocation.
hand::GraspEvent update_hand(const HandSetup& setup, HandState& state, const hand::GloveSample& sample,
                             const ToolPoses& tool, double dt);

// The servo's grip of this hand.
constexpr servo::Grip grip_of(const HandState& state) {
    return state.grasp.held ? servo::Grip::wrench : servo::Grip::none;
}

// For display, in the frame of the tool: combine it with servo::Output::constrained_tool of any tick.
struct DisplayedHand {
    hand::Skeleton finger_joints;
    hand::Side side = hand::Side::right;
    bool has_angles = false;          // the glove has sent the angles of the finger joints at least once
    bool held = false, lost = false;  // the hand holds the tool; the glove is lost
};
DisplayedHand displayed_hand(const HandSetup& setup, const HandState& state);

struct HandStatus {
    bool held = false, lost = false;  // the hand holds the tool; the glove is lost
};
// Messages on faults: the glove is lost, reports a fault, or is not of the side for which it was calibrated.
std::vector<std::string> messages(const HandStatus& hand, hand::Side calibrated_side,
                                  const hand::GloveReport& report);

// Runs the gloved hand on its own thread, between the threads of the glove and the servo. set_tool() and
// grip() never wait.
class HandThread {
  public:
    // Owns the driver and reads its samples.
    static HandThread start(hand::GloveDriver driver, HandSetup setup);

    HandThread(HandThread&&) noexcept;
    HandThread& operator=(HandThread&&) noexcept;
    ~HandThread();  // stops the thread

    // For the servo thread.
    void set_tool(const ToolPoses& tool);
    [[nodiscard]] servo::Grip grip() const;

    // Call each of these from one thread only.
    const DisplayedHand& displayed();
    std::vector<std::string> fault_messages();
    const hand::GloveReport& report();  // for the thread that calls fault_messages()

  private:
    struct Shared;
    explicit HandThread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::station
