#include "game/station/worn_glove.hpp"

#include <algorithm>

#include "engine/base/steady_seconds.hpp"
#include "haptics/hand/grasp.hpp"
#include "haptics/station/gloved_hand.hpp"

namespace bolt::station_setup {

double closed_share(const hand::Angles& angles) {
    const hand::FingerAngles full = hand::closed_hand_angles(1.0).fingers[0];
    double sum = 0.0;
    for (const hand::FingerAngles& finger : angles.fingers)
        sum += 0.5 * (finger.mcp / full.mcp + finger.pip / full.pip);
    return std::clamp(sum / static_cast<double>(angles.fingers.size()), 0.0, 1.0);
}

WornGlove::WornGlove(hand::GloveDriver driver, hand::GloveWearer wearer)
    : driver_(std::move(driver)), wearer_(std::move(wearer)) {
    fingers_.side = wearer_.hand.side;
    fingers_.joints = hand::joints(wearer_.hand, measured_.angles, {});
}

WornGlove WornGlove::start(const std::filesystem::path& port, hand::GloveWearer wearer) {
    return {hand::GloveDriver::start(port), std::move(wearer)};
}

void WornGlove::update() {
    const hand::GloveSample& sample = driver_.sample();
    if (sample.number != sample_) {
        sample_ = sample.number;
        hand::update(measured_, wearer_, sample.frame, sample.time);
        fingers_.joints = hand::joints(wearer_.hand, measured_.angles, {});
        fingers_.closed_share = closed_share(measured_.angles);
        fingers_.measured = true;
    }
    fingers_.lost = fingers_.measured && steady_seconds() - sample.time > hand::GraspOptions{}.silence;
}

std::vector<std::string> WornGlove::fault_messages() {
    return station::messages({false, fingers_.lost}, wearer_.hand.side, driver_.report());
}

}  // namespace bolt::station_setup
