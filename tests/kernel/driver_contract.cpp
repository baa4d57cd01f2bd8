#include "tests/device/driver_contract.hpp"

#include "tests/kernel/guest.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

void kept(const std::string& id, std::unique_ptr<emulate::HidDevice> device,
          const std::function<void(emulate::HidDevice&)>& moves) {
    CAPTURE(id);
    auto plug = std::make_unique<emulate::Uhid>(plugged(std::move(device)));
    listed(id);
    check_driver_contract(factory_for(id), [&] { plug->with(moves); });
    check_unplugged(factory_for(id), [&] { plug.reset(); });
}

}  // namespace

TEST_CASE("Kernel: all drivers keep the driver contract") {
    const auto push = [](emulate::HidDevice& d) { dynamic_cast<emulate::Puck&>(d).share[0] = 0.5; };
    const auto turn = [](emulate::HidDevice& d) {
        auto& wheel = dynamic_cast<emulate::Wheel&>(d);
        wheel.hand_stiffness = 10.0;
        wheel.hand += 0.01;
    };
    kept("256f:c62e", std::make_unique<emulate::Puck>(), push);
    kept("1209:ffb0", std::make_unique<emulate::Wheel>(), turn);
    kept("1234:5678", std::make_unique<emulate::Wheel>(emulate::WheelOptions{.board = false}), turn);
}
