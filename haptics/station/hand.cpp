#include "haptics/station/hand.hpp"

namespace bolt::station {

grip::Told hand_step(const HandPlan& plan, HandState& state, const glove::Sample& sample,
                     const ToolPlace& place, double dt) {
    const bool fresh = sample.number != state.number;
    if (fresh) {
        state.number = sample.number;
        take(state.gloved, plan.wearer, sample.frame, sample.time);
    }
    const Pose wrist = inverse(place.now) * place.wished * plan.wrist;
    return step(state.grip, plan.grip, plan.tool, plan.wearer.hand, {fresh, state.gloved.angles, wrist}, dt);
}

ShownHand shown(const HandPlan& plan, const HandState& state) {
    ShownHand shown;
    shown.joints = hand::joints(plan.wearer.hand, state.grip.closing.shown, state.grip.wrist);
    shown.side = plan.wearer.hand.side;
    shown.any = state.grip.any;
    shown.held = state.grip.held;
    shown.lost = state.grip.lost;
    return shown;
}

std::vector<std::string> words(const HandTrouble& hand, hand::Side worn, const glove::Report& report) {
    std::vector<std::string> words;
    if (hand.lost) words.emplace_back(grip::words(grip::Told::glove_lost, hand.held));
    if (report.trouble[0] != '\0') words.emplace_back(report.trouble.data());
    if (report.greetings > 0 && glove::side_of(report.identity.hand) != worn)
        words.emplace_back(worn == hand::Side::left
                               ? "the glove is a right one, calibrated is a left one: calibrate this one"
                               : "the glove is a left one, calibrated is a right one: calibrate this one");
    return words;
}

}  // namespace bolt::station
