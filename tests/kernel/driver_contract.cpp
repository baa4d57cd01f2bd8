// The driver contract (tests/device/driver_contract.hpp) for all drivers on a real kernel.
#include "tests/device/driver_contract.hpp"

#include "tests/kernel/guest.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

void check_contract(const std::string& id, std::unique_ptr<emulate::HidDevice> device,
                    const std::function<void(emulate::HidDevice&)>& moves) {
    CAPTURE(id);
    auto plug = std::make_unique<emulate::Uhid>(attach(std::move(device)));
    wait_for_device(id);
    check_driver_contract(factory_for(id), [&] { plug->with(moves); });
    check_unplugged(factory_for(id), [&] { plug.reset(); });
}

}  // namespace

TEST_CASE("Kernel: all drivers keep the driver contract") {
    const auto push = [](emulate::HidDevice& d) {
        dynamic_cast<emulate::EmulatedPuck&>(d).deflection[0] = 0.5;
    };
    const auto turn = [](emulate::HidDevice& d) {
        auto& wheel = dynamic_cast<emulate::EmulatedWheel&>(d);
        wheel.hand_stiffness = 10.0;
        wheel.hand += 0.01;
    };
    check_contract("256f:c62e", std::make_unique<emulate::EmulatedPuck>(), push);
    check_contract("1209:ffb0", std::make_unique<emulate::EmulatedWheel>(), turn);
    check_contract("1234:5678",
                   std::make_unique<emulate::EmulatedWheel>(emulate::EmulatedWheelOptions{.board = false}),
                   turn);
}
