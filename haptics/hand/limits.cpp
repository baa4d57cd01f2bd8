#include "haptics/hand/limits.hpp"

#include <algorithm>

namespace bolt::hand {
namespace {

double within(const Span& span, double angle) {
    return std::isfinite(angle) ? std::clamp(angle, span.low, span.high) : 0.0;
}

}  // namespace

Angles clamp_to_limits(const Angles& angles) {
    Angles out;
    out.thumb = {within(thumb_roll_span, angles.thumb.roll),
                 within(thumb_abduction_span, angles.thumb.abduction),
                 within(thumb_mcp_span, angles.thumb.mcp), within(thumb_ip_span, angles.thumb.ip)};
    for (std::size_t i = 0; i < out.fingers.size(); ++i) {
        const FingerAngles& from = angles.fingers[i];
        FingerAngles& to = out.fingers[i];
        to.mcp = within(mcp_span, from.mcp);
        to.pip = within(pip_span, from.pip);
        to.dip = within(dip_span, from.dip);
        const double share = std::clamp(1.0 - to.mcp / (0.5 * pi), 0.0, 1.0);
        to.side = within({side_span.low * share, side_span.high * share}, from.side);
    }
    out.arch = within(arch_span, angles.arch);
    out.wrist_flexion = within(wrist_flexion_span, angles.wrist_flexion);
    out.wrist_side = within(wrist_side_span, angles.wrist_side);
    return out;
}

}  // namespace bolt::hand
