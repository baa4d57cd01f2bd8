#include "tools/emulate/puck.hpp"

#include <algorithm>
#include <cmath>

#include "tools/emulate/hid_device.hpp"

namespace bolt::emulate {

namespace {

constexpr double puck_period = 0.008;  // s
constexpr double counts = 350.0;       // at full deflection

Bytes descriptor(bool single_report) {
    DescriptorBuilder d;
    d.page(1).usage(8).begin(1);
    d.begin(0).id(1).range(-350, 350);
    if (single_report) {
        d.usages(0x30, 0x35).fields(6, 16).input(2).end();
    } else {
        d.usages(0x30, 0x32).fields(3, 16).input(6).end();
        d.begin(0).id(2).usages(0x33, 0x35).fields(3, 16).input(6).end();
    }
    d.begin(2).id(3).page(9).usages(1, 2).range(0, 1).fields(2, 1).input(2).fields(14, 1).input(3).end();
    return d.end().out;
}

}  // namespace

EmulatedPuck::EmulatedPuck(const EmulatedPuckOptions& options)
    : single_report_(options.single_report), faults_(options.faults), random_(options.faults.seed) {
    description_ =
        single_report_
            ? HidDescription{0x256f, 0xc62e, "Emulated SpaceMouse", options.serial, descriptor(true)}
            : HidDescription{0x046d, 0xc626, "Emulated SpaceNavigator", options.serial, descriptor(false)};
}

std::vector<Bytes> EmulatedPuck::advance(double now) {
    std::vector<Bytes> out;
    for (; next_ <= now; next_ += puck_period) {
        if (next_ < now - 1.0) next_ = now - 1.0;  // drop reports older than 1 s
        if (stalled) continue;
        const bool deflected =
            std::any_of(deflection.begin(), deflection.end(), [](double s) { return s != 0.0; });
        if (deflected || was_deflected_) {
            Bytes report{1};
            for (std::size_t i = 0; i < deflection.size(); ++i) {
                const auto v =
                    static_cast<std::int16_t>(std::lround(std::clamp(deflection[i], -1.0, 1.0) * counts));
                if (i == 3 && !single_report_) {
                    out.push_back(report);
                    report = {2};
                }
                report.push_back(static_cast<std::uint8_t>(v & 0xff));
                report.push_back(static_cast<std::uint8_t>(v >> 8 & 0xff));
            }
            out.push_back(report);
        }
        was_deflected_ = deflected;
        if (buttons != last_buttons_) out.push_back({3, static_cast<std::uint8_t>(buttons & 3U), 0});
        last_buttons_ = buttons;
    }
    return with_faults(std::move(out), faults_, random_);
}

}  // namespace bolt::emulate
