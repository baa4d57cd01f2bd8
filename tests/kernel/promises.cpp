#include "tests/device/promises.hpp"

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
    keeps_promises(opener(id), [&] { plug->with(moves); });
    tells_that_it_is_gone(opener(id), [&] { plug.reset(); });
}

}  // namespace

TEST_CASE("the drivers keep what every driver has to keep, under the kernel") {
    const auto push = [](emulate::HidDevice& d) { dynamic_cast<emulate::Puck&>(d).share[0] = 0.5; };
    const auto turn = [](emulate::HidDevice& d) {
        auto& wheel = dynamic_cast<emulate::Wheel&>(d);
        wheel.hand_stiffness = 10.0;
        wheel.hand += 0.01;
    };
    kept("256f:c62e", std::make_unique<emulate::Puck>(), push);
    kept("1209:ffb0", std::make_unique<emulate::Wheel>(), turn);
    kept("1234:5678", std::make_unique<emulate::Wheel>(emulate::WheelDesign{.board = false}), turn);
}
