#include "haptics/station/gloved_hand.hpp"

namespace bolt::station {

hand::GraspEvent update_hand(const HandSetup& setup, HandState& state, const hand::GloveSample& sample,
                             const ToolPoses& tool, double dt) {
    const bool fresh = sample.number != state.number;
    if (fresh) {
        state.number = sample.number;
        hand::update(state.gloved, setup.wearer, sample.frame, sample.time);
    }
    const Pose wrist = inverse(tool.actual) * tool.commanded * setup.wrist;
    return hand::update_grasp(state.grip, setup.grip, setup.tool, setup.wearer.hand,
                              {fresh, state.gloved.angles, wrist}, dt);
}

DisplayedHand display(const HandSetup& setup, const HandState& state) {
    DisplayedHand shown;
    shown.joints = hand::joints(setup.wearer.hand, state.grip.closure.angles, state.grip.wrist);
    shown.side = setup.wearer.hand.side;
    shown.has_frame = state.grip.has_frame;
    shown.held = state.grip.held;
    shown.lost = state.grip.lost;
    return shown;
}

std::vector<std::string> messages(const HandStatus& hand, hand::Side worn, const hand::GloveReport& report) {
    std::vector<std::string> messages;
    if (hand.lost) messages.emplace_back(hand::message_for(hand::GraspEvent::glove_lost, hand.held));
    if (report.trouble[0] != '\0') messages.emplace_back(report.trouble.data());
    if (report.handshakes > 0 && report.identity.hand != worn)
        messages.emplace_back(
            worn == hand::Side::left
                ? "the glove is a right one, the calibration is for a left one; calibrate this glove"
                : "the glove is a left one, the calibration is for a right one; calibrate this glove");
    return messages;
}

}  // namespace bolt::station
