// The driver of Force Dimension's arms, on an emulated library.
#include "haptics/device/force_dimension.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "haptics/device/connected_devices.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/support/emulated_arms.hpp"

namespace device_force_dimension_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

// An emulated arm whose clock is the driver's.
struct Bench {
    ForceDimensionApi api;
    ForceDimensionControls arm;
    double now = 0.0;
    Timer timer = advancing_timer(now, arm.advance);

    Bench() {
        const auto loaded = load_force_dimension({BOLT_EMULATED_FORCE_DIMENSION});
        REQUIRE_MESSAGE(loaded, (loaded ? "" : loaded.error().message()));
        api = *loaded;
        arm.reset();
        arm.initialized(1);
    }
    Result<std::unique_ptr<DeviceDriver>> open(bool may_move = false, double mass = 0.0) {
        return open_force_dimension(api, {0, may_move, mass}, timer);
    }
    // Reads for `seconds`, and returns the last sample.
    Sample read(DeviceDriver& device, double seconds) {
        Sample last;
        for (const double until = now + seconds; now < until;) {
            const auto sample = device.read(0.005);
            REQUIRE_MESSAGE(sample, (sample ? "" : sample.error().message()));
            if (*sample) last = **sample;
        }
        return last;
    }
    [[nodiscard]] double force_now() const {
        std::array<double, 6> force{};
        arm.force(force.data());
        return glm::length(Vec3(force[0], force[1], force[2]));
    }
};

}  // namespace

TEST_CASE("Force Dimension: an absent library and a missing function are errors with a remedy") {
    const auto absent = load_force_dimension({"/nowhere/libdrd.so.3", "libdrd-that-is-nowhere.so.3"});
    REQUIRE_FALSE(absent);
    CHECK(absent.error().code == ErrorCode::no_device);
    CHECK(
        absent.error().message() ==
        "libdrd-that-is-nowhere.so.3 is not installed; expected the Force Dimension SDK, with its folder in "
        "FDSDK or libdrd.so.3 in /usr/local/lib");
    const auto other = load_force_dimension({"libm.so.6"});
    REQUIRE_FALSE(other);
    CHECK(other.error().what.find("libm.so.6 has no dhdGetDeviceCount, drdOpenID") == 0);
    // A file that is no library for this computer.
    const auto broken = load_force_dimension({"/etc/passwd"});
    REQUIRE_FALSE(broken);
    CHECK(broken.error().what.find("invalid ELF header") != std::string::npos);
    CHECK(broken.error().expected == "the vendor's library for this kind of computer");
    CHECK(broken.error().code != ErrorCode::no_device);
}

TEST_CASE("Force Dimension: the library is searched in the SDK, in /usr/local and in the loader's path") {
    const auto candidates = force_dimension_libraries();
    REQUIRE(candidates.size() >= 2);
    CHECK(candidates.back() == "libdrd.so.3");
}

TEST_CASE("Force Dimension: keeps the contract of drivers, with and without motors in the wrist") {
    for (const bool active : {false, true}) {
        CAPTURE(active);
        Bench bench;
        bench.arm.active_wrist(active ? 1 : 0);
        check_driver_contract([&] { return bench.open(); }, [] {});
        check_unplugged([&] { return bench.open(); }, [&] { bench.arm.unplug(1); });
    }
}

TEST_CASE("Force Dimension: the vendor's frame has x to the user, y to the right and z up") {
    Bench bench;
    auto opened = bench.open();
    REQUIRE(opened);
    const std::array<std::pair<Vec3, Vec3>, 3> axes{{{{0.05, 0, 0}, {0, 0, 0.05}},    // to the user
                                                     {{0, 0.05, 0}, {0.05, 0, 0}},    // to the right
                                                     {{0, 0, 0.05}, {0, 0.05, 0}}}};  // up
    for (const auto& [theirs, ours] : axes) {
        bench.arm.intend(theirs.x, theirs.y, theirs.z);
        const Sample sample = bench.read(**opened, 2.0);
        CHECK(glm::distance(sample.pose.position, ours) < 2e-5);
    }
    // A quarter turn about the vendor's x axis, which is ours z.
    const double quarter[3][3] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    bench.arm.turn(quarter);
    const Sample turned = bench.read(**opened, 0.01);
    CHECK(glm::distance(turned.pose.orientation * Vec3(1, 0, 0), Vec3(0, 1, 0)) < 1e-9);
    // A force moves the hand in its direction: 3 N against 300 N/m.
    bench.arm.intend(0, 0, 0);
    bench.read(**opened, 2.0);
    for (const Vec3 force : {Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 3)}) {
        Sample sample;
        for (int i = 0; i < 2000; ++i) {
            REQUIRE((*opened)->write({force, {}}));
            sample = bench.read(**opened, 1e-3);
        }
        CHECK(glm::distance(sample.pose.position, force / 300.0) < 2e-5);
    }
}

TEST_CASE("Force Dimension: an arm that is not calibrated moves only if it may") {
    Bench bench;
    bench.arm.initialized(0);
    const auto refused = bench.open();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message().find(
              "has to move by itself to find its position, and may not; expected free room around it, then "
              "`boltwright devices --device force-dimension:0 --yes`") != std::string::npos);
    CHECK(bench.arm.moved_by_itself() == 0);
    CHECK(bench.arm.open() == 0);
    CHECK(bench.open(true));
    CHECK(bench.arm.moved_by_itself() == 1);
    CHECK(bench.open());
    CHECK(bench.arm.moved_by_itself() == 1);
}

TEST_CASE("Force Dimension: the arm itself limits the force, and closing it releases the force and brakes") {
    Bench bench;
    auto opened = bench.open();
    REQUIRE(opened);
    CHECK(bench.arm.braked() == 0);
    REQUIRE((*opened)->write({Vec3(100, 0, 0), {}}));
    CHECK(bench.force_now() == doctest::Approx((*opened)->description().limits.force));
    opened->reset();
    CHECK(bench.force_now() == 0.0);
    CHECK(bench.arm.braked() == 1);
    CHECK(bench.arm.open() == 0);
}

TEST_CASE(
    "Force Dimension: an arm that brakes because it was too fast is lost at once, and can be opened again") {
    Bench bench;
    bench.arm.speed_limit(0.5);
    auto opened = bench.open();
    REQUIRE(opened);
    bench.arm.intend(0.2, 0, 0);  // pulled away with 60 N
    const double begun = bench.now;
    Result<std::optional<Sample>> sample = std::optional<Sample>{};
    while (sample && bench.now < begun + 1.0) {
        REQUIRE((*opened)->write({Vec3(0, 0, 2), {}}));
        sample = (*opened)->read(0.005);
    }
    REQUIRE_FALSE(sample);
    CHECK(sample.error().lost);
    CHECK(sample.error().message().find(
              "has braked: it moved too fast; expected a hand that moves it slowly") != std::string::npos);
    CHECK(bench.force_now() == 0.0);
    opened->reset();
    bench.arm.intend(0, 0, 0);
    CHECK(bench.open());
}

TEST_CASE("Force Dimension: an arm that another program uses names that") {
    Bench bench;
    bench.arm.in_use(1);
    const auto refused = bench.open();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().expected == "an arm that no other program uses");
}

TEST_CASE(
    "Force Dimension: the limits are those of the model, and the smallest of its joints if it is unknown") {
    struct Row {
        int type;
        const char* name;
        double force, torque, stiffness, reach;
        bool active;
    };
    for (const Row& row :
         {Row{63, "delta.3", 20.0, 0.0, 5000.0, 0.15, false},
          Row{34, "omega.6", 12.0, 0.0, 5000.0, 0.075, false},
          Row{105, "sigma.7 (left)", 12.0, 0.2, 4000.0, 0.075, true},
          Row{108, "lambda.7", 12.0, 0.2, 8000.0, 0.11, true},
          Row{60, "Falcon", 8.0, 0.0, 3000.0, 0.04, false},
          Row{999, "arm, 6 joints with motors (sigma or lambda)", 12.0, 0.2, 4000.0, 0.075, true},
          Row{-1, "arm with a wrist (omega.6 or omega.7)", 12.0, 0.0, 5000.0, 0.075, false}}) {
        CAPTURE(row.type);
        Bench bench;
        bench.arm.active_wrist(row.active ? 1 : 0);
        bench.arm.model(row.type, nullptr, -1);
        const auto opened = bench.open();
        REQUIRE(opened);
        const Description& d = (*opened)->description();
        check_description(d);
        CHECK(d.name == std::string("Force Dimension ") + row.name);
        CHECK(d.limits.force == row.force);
        CHECK(d.limits.torque == row.torque);
        CHECK(d.limits.stiffness == row.stiffness);
        CHECK(d.half_workspace == Vec3(row.reach));
        CHECK(d.serial.empty());
    }
}

TEST_CASE(
    "Force Dimension: model and serial number are what it reports, and a library without them is used too") {
    Bench bench;
    bench.arm.model(34, "omega.6\x1b[31m", 4711);
    {
        const auto opened = bench.open();
        REQUIRE(opened);
        CHECK((*opened)->description().model == "omega.6[31m");
        CHECK((*opened)->description().serial == "4711");
        CHECK((*opened)->health().calibrated == true);
        CHECK_FALSE((*opened)->health().heat);
    }
    bench.api.get_type = nullptr;
    bench.api.get_name = nullptr;
    bench.api.get_serial = nullptr;
    bench.api.compensate_gravity = nullptr;
    bench.api.set_mounted_mass = nullptr;
    const auto old = bench.open(false, 0.1);
    REQUIRE(old);
    CHECK((*old)->description().name == "Force Dimension arm with a wrist (omega.6 or omega.7)");
    CHECK((*old)->description().model.empty());
    CHECK((*old)->description().remarks.back().find("does not compensate the weight") != std::string::npos);
}

TEST_CASE(
    "Force Dimension: the weight of the arm and of its handle is held, also while it moves without force") {
    for (const double known : {0.0, 0.15}) {
        CAPTURE(known);
        Bench bench;
        bench.arm.weight(0.2, 0.15);
        const auto opened = bench.open(false, known);
        REQUIRE(opened);
        bench.read(**opened, 2.0);
        bench.arm.intend(0.0, 0.0, 0.05);  // 300 N/m pull it up, where it weighs more
        const double height = bench.read(**opened, 3.0).pose.position.y;
        // The weight that the library does not know grows by a tenth with each centimetre.
        const double unknown = 9.81 * (0.15 - known);
        CHECK(std::abs(height - (300.0 * 0.05 - unknown) / (300.0 + 10.0 * unknown)) < 2e-4);
    }
}

TEST_CASE("Force Dimension: the over-speed threshold stays that of the factory") {
    Bench bench;
    { REQUIRE(bench.open(true)); }
    CHECK(bench.arm.speed_limit_changes() == 0);
}

TEST_CASE("Force Dimension: a mounted mass that is not plausible is an error") {
    const ListedDevice listed{"libdrd.so.3", "force-dimension:0", "arm", DeviceKind::arm, {}};
    for (const double mass : {-0.1, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
        OpenOptions options;
        options.effector_mass = mass;
        const auto refused = open(listed, options);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().code == ErrorCode::usage);
        CHECK(refused.error().message().find("force-dimension:0 is") != std::string::npos);
        CHECK(refused.error().expected == "0 to 1 kg");
    }
}

TEST_CASE("Force Dimension: buttons") {
    Bench bench;
    auto opened = bench.open();
    REQUIRE(opened);
    bench.arm.buttons(5);
    CHECK(bench.read(**opened, 0.01).buttons == 5);
}

TEST_CASE("Force Dimension: a gripper is read as a share of its range, of a left hand too") {
    constexpr int omega6 = 34, omega7 = 35, omega7_left = 37;
    Bench bench;
    bench.arm.gripper(0.25);
    for (const int type : {omega7, omega7_left}) {
        CAPTURE(type);
        bench.arm.model(type, "omega.7", 1);
        auto opened = bench.open();
        REQUIRE(opened);
        CHECK((*opened)->description().senses_gripper);
        CHECK(bench.read(**opened, 0.01).gripper == doctest::Approx(0.25).epsilon(1e-4));
        bench.arm.gripper(7.0);
        CHECK(bench.read(**opened, 0.01).gripper == 1.0);
        bench.arm.gripper(0.25);
    }
    bench.arm.model(omega6, "omega.6", 1);
    auto opened = bench.open();
    REQUIRE(opened);
    CHECK_FALSE((*opened)->description().senses_gripper);
    CHECK(bench.read(**opened, 0.01).gripper == 1.0);
}

}  // namespace device_force_dimension_test
