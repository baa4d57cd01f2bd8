// The needs of an arm before it can be opened: permission to move, its duration, and the report.
#include "haptics/device/preparation.hpp"

#include <doctest/doctest.h>

#include "haptics/device/connected_devices.hpp"
#include "haptics/device/device_thread.hpp"
#include "tests/device/support.hpp"
#include "tests/support/emulated_arms.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/folder.hpp"

namespace device_preparation_test {

using namespace bolt;
using namespace bolt::device;
namespace fs = std::filesystem;

namespace {

// The emulated library of Force Dimension, where the program searches it.
struct InstalledLibrary {
    test::Folder folder;
    test::EnvironmentVariable sdk{"FDSDK", folder.path().c_str()};
    test::ForceDimensionControls arm;

    InstalledLibrary() {
        const fs::path place = folder / "lib/release/lin-x86_64-gcc";
        fs::create_directories(place);
        fs::create_symlink(BOLT_EMULATED_FORCE_DIMENSION, place / "libdrd.so.3");
        arm.reset();
    }
    ~InstalledLibrary() { arm.reset(); }
    InstalledLibrary(const InstalledLibrary&) = delete;
    InstalledLibrary& operator=(const InstalledLibrary&) = delete;

    // The arm is switched off and on again: it has forgotten its position.
    void power_cycle() const {
        arm.unplug(1);
        arm.unplug(0);
        arm.initialized(0);
    }
};

constexpr const char* arm_id = "force-dimension:0";

// Polls for `seconds` of virtual time, or until it is usable.
void poll(DeviceSupervisor& supervisor, VirtualTime& time, double seconds) {
    const double until = time.now + seconds;
    while (time.now < until && supervisor.status().state != DeviceState::usable)
        supervisor.poll([] { return ForceCommand{}; });
}

}  // namespace

TEST_CASE("Move permission: it holds for one attempt, and giving it twice gives it once") {
    MovePermission permission;
    CHECK_FALSE(permission.acquire());
    permission.grant();
    permission.grant();
    CHECK(permission.active());
    CHECK(permission.acquire());
    CHECK(permission.active());
    permission.grant();  // the user presses the key again while the arm moves
    permission.end();
    CHECK_FALSE(permission.active());
    CHECK_FALSE(permission.acquire());
}

TEST_CASE("Preparation: an arm moves when it is permitted, and asks again after it was switched off") {
    const InstalledLibrary library;
    OpenOptions options;
    options.permission = std::make_shared<MovePermission>();
    VirtualTime time;
    DeviceSupervisor supervisor(factory_for(arm_id, options), virtual_timer(time));
    poll(supervisor, time, 3.0);
    CHECK(supervisor.status().state == DeviceState::absent);
    CHECK(supervisor.status().preparation == Preparation{DeviceNeed::permission, {}});
    CHECK(supervisor.status().failed_openings > 2);
    CHECK(library.arm.moved_by_itself() == 0);

    options.permission->grant();
    poll(supervisor, time, 3.0);
    CHECK(supervisor.status().state != DeviceState::absent);
    CHECK(supervisor.status().preparation == Preparation{});
    CHECK(library.arm.moved_by_itself() == 1);
    CHECK_FALSE(options.permission->active());

    library.power_cycle();
    for (int i = 0; i < 100; ++i) supervisor.poll([] { return ForceCommand{}; });
    CHECK(supervisor.status().losses == 1);
    poll(supervisor, time, 3.0);
    CHECK(supervisor.status().preparation.need == DeviceNeed::permission);
    CHECK(library.arm.moved_by_itself() == 1);
}

TEST_CASE("Preparation: a permission that an attempt did not need is used up") {
    const InstalledLibrary library;
    library.arm.initialized(1);
    OpenOptions options;
    options.permission = std::make_shared<MovePermission>();
    options.permission->grant();
    const DeviceFactory open = factory_for(arm_id, options);
    CHECK(open());
    library.power_cycle();
    CHECK_FALSE(open());
    CHECK(library.arm.moved_by_itself() == 0);
}

TEST_CASE("Preparation: waiting for it does not count as time in which the device must open") {
    std::atomic<bool> prepared = false;
    const auto state = std::make_shared<test::Written>();
    const DeviceFactory ready = test::opens(state, steady_timer());
    const auto start = [&] {
        return DeviceThread::start([&]() -> Result<std::unique_ptr<DeviceDriver>> {
            if (prepared) return ready();
            return fail(
                unprepared_device_error("an arm is calibrated", "a sign", {DeviceNeed::user, "wave"}));
        });
    };
    auto thread = start();
    REQUIRE(thread);
    std::string asked;
    int calls = 0;
    const auto opened = thread->wait_until_open(0.5, [&](const Preparation& needed) {
        if (needed.need == DeviceNeed::none) return true;
        asked = needed.instruction;
        prepared = ++calls > 250;  // more than a second
        return true;
    });
    REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
    CHECK(asked == "wave");

    prepared = false;
    auto refused = start();
    REQUIRE(refused);
    const auto given_up = refused->wait_until_open(
        60.0, [](const Preparation& needed) { return needed.need == DeviceNeed::none; });
    REQUIRE_FALSE(given_up);
    CHECK(preparation_of(given_up.error()) == Preparation{DeviceNeed::user, "wave"});
    CHECK(given_up.error().message() == "an arm is calibrated; expected a sign");
}

}  // namespace device_preparation_test
