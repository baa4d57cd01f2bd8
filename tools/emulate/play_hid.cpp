#include "tools/emulate/play_hid.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "engine/base/console.hpp"
#include "engine/base/math.hpp"
#include "haptics/device/hid_transport.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/uhid.hpp"
#include "tools/emulate/wheel.hpp"

namespace bolt::emulate {

namespace {

constexpr double period = 4.0;  // s of the hand's motion
constexpr double pushed = 0.5;  // share of a puck's travel
constexpr double rocked = 0.5;  // rad of a wheel
constexpr double grip = 5.0;    // N·m/rad
constexpr double felt = 0.05;   // N·m: so much less or more is told

template <class Device>
Status play(std::unique_ptr<Device> device, const std::function<bool()>& ended,
            const std::function<Status(Device&, double)>& move) {
    const HidDescription design = device->design();
    BOLT_TRY_ASSIGN(auto plug, Uhid::plug_in(std::move(device)));
    Status said = print(fmt::format("{:04x}:{:04x}  {}\n", design.vendor, design.product, design.name));
    while (said && !ended()) {
        plug.with([&](HidDevice& d) {
            said = move(dynamic_cast<Device&>(d), 2.0 * pi / period * device::steady_seconds());
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return said;
}

}  // namespace

Status play_puck(const std::function<bool()>& ended) {
    return play<Puck>(std::make_unique<Puck>(), ended, [](Puck& puck, double phase) -> Status {
        puck.share = {pushed * std::cos(phase), pushed * std::sin(phase), 0.0, 0.0, 0.0, 0.0};
        return {};
    });
}

Status play_wheel(bool board, const std::function<bool()>& ended) {
    WheelOptions design;
    design.board = board;
    double told = 0.0;
    return play<Wheel>(std::make_unique<Wheel>(design), ended, [&](Wheel& wheel, double phase) -> Status {
        wheel.hand_stiffness = grip;
        wheel.hand = rocked * std::sin(phase);
        if (std::abs(wheel.torque() - told) < felt) return {};
        told = wheel.torque();
        return print(fmt::format("torque {:.2f} N·m\n", told));
    });
}

}  // namespace bolt::emulate
