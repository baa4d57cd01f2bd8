// The driver of OpenHaptics' arms, on an emulated library: the library, the arm's report, opening and
// samples.
#include "haptics/device/open_haptics.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>

#include "haptics/device/arms.hpp"
#include "tests/device/open_haptics_bench.hpp"
#include "tests/support/folder.hpp"

namespace device_open_haptics_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;
using Bench = OpenHapticsBench;

namespace {

constexpr unsigned needs_update = 0x5001, needs_inkwell = 0x5002;
constexpr EmulatedHdHand frictionless{0.5, 300.0, 12.0, 0.0};
constexpr EmulatedHdReport touch{"Touch", 6, 3, {-80, -50, -50, 80, 70, 70}, 0.5, 3.3, 0.88};
constexpr EmulatedHdReport premium{
    "PHANTOM Premium 1.5 6DOF", 6, 6, {-120, -100, -80, 120, 100, 80}, 3.5, 37.5, 6.2};

}  // namespace

TEST_CASE("OpenHaptics: an absent library and a missing function are errors with a remedy") {
    const auto absent = load_open_haptics({"/nowhere/libHD.so.3.4", "libHD-that-is-nowhere.so.3.4"});
    REQUIRE_FALSE(absent);
    CHECK(absent.error().code == ErrorCode::no_device);
    CHECK(
        absent.error().message() ==
        "libHD-that-is-nowhere.so.3.4 is not installed; expected OpenHaptics 3.4 and the driver of the arm, "
        "with libHD.so.3.4 in /usr/lib");
    const auto other = load_open_haptics({"libm.so.6"});
    REQUIRE_FALSE(other);
    CHECK(other.error().what.find("libm.so.6 has no hdInitDevice, hdDisableDevice") == 0);
    CHECK(other.error().code != ErrorCode::no_device);
    const auto broken = load_open_haptics({"/etc/passwd", "libHD-that-is-nowhere.so.3.0"});
    REQUIRE_FALSE(broken);
    CHECK(broken.error().what.find("passwd cannot be loaded: ") == 0);
}

TEST_CASE(
    "OpenHaptics: version 3.4 is searched before 3.0, in the SDK, in /usr/lib and in the loader's path") {
    setenv("OH_SDK_BASE", "/sdk", 1);
    const auto candidates = open_haptics_libraries();
    unsetenv("OH_SDK_BASE");
    const std::vector<std::filesystem::path> expected{"/sdk/lib/libHD.so.3.4", "/usr/lib/libHD.so.3.4",
                                                      "libHD.so.3.4",          "/sdk/lib/libHD.so.3.0",
                                                      "/usr/lib/libHD.so.3.0", "libHD.so.3.0"};
    CHECK(candidates == expected);
}

TEST_CASE("OpenHaptics: an arm is listed without a call that reserves it") {
    Bench bench;
    const Folder sdk;
    std::filesystem::create_directory(sdk / "lib");
    const std::filesystem::path link = sdk / "lib/libHD.so.3.4";
    std::filesystem::create_symlink(BOLT_EMULATED_OPEN_HAPTICS, link);
    setenv("OH_SDK_BASE", sdk.path().c_str(), 1);
    std::vector<ListedDevice> arms;
    for (const ArmBackend& backend : arm_backends())
        if (backend.name == "openhaptics") arms = backend.list();
    unsetenv("OH_SDK_BASE");
    REQUIRE(arms.size() == 1);
    CHECK(arms[0].id == "openhaptics:0");
    CHECK(arms[0].name == "OpenHaptics arm");
    CHECK(arms[0].path == link);
    CHECK_FALSE(arms[0].error);
    CHECK(bench.arm.initialisations() == 0);
}

TEST_CASE(
    "OpenHaptics: keeps the contract of drivers and the rules of the library, with three and six motors") {
    for (const EmulatedHdReport& report : {touch, premium}) {
        CAPTURE(report.model);
        Bench bench;
        bench.arm.report(report);
        check_driver_contract([&] { return bench.open(); }, [] {});
        CHECK(bench.arm.refused() == 0);
        check_unplugged([&] { return bench.open(); }, [&] { bench.arm.unplug(1); });
        CHECK(bench.arm.refused() == 0);
        CHECK(bench.arm.running() == 0);
        CHECK(bench.arm.open() == 0);
    }
}

TEST_CASE("OpenHaptics: the vendor's millimetres are metres from the middle of the reach, its axes ours") {
    Bench bench;
    bench.arm.hand(frictionless);
    auto device = bench.opened();
    const Vec3 centre(0.0, 0.01, 0.01);
    for (const Vec3& place : {Vec3(0.05, 0, 0), Vec3(0, 0.05, 0), Vec3(0, 0, 0.05)}) {
        bench.arm.intend(place.x, place.y, place.z);
        const Sample sample = bench.read(*device, 2.0);
        CHECK(glm::distance(sample.pose.position, place - centre) < 6e-5);
    }
    // A quarter turn about the axis to the user.
    const double gimbal[3] = {0, 0, 0};
    const double quarter[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    bench.arm.turn(gimbal, quarter);
    const Sample turned = bench.read(*device, 0.01);
    CHECK(glm::distance(turned.pose.orientation * Vec3(1, 0, 0), Vec3(0, 1, 0)) < 1e-9);
    // A force moves the hand in its direction: 3 N against 300 N/m.
    bench.arm.intend(0, 0, 0);
    bench.read(*device, 2.0);
    for (const Vec3& force : {Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 3)}) {
        REQUIRE(bench.drive(*device, {force, {}}, 2.0));
        CHECK(glm::distance(bench.read(*device, 0.001).pose.position, force / 300.0 - centre) < 6e-5);
    }
}

TEST_CASE("OpenHaptics: an arm with six motors gets forces only") {
    Bench bench;
    bench.arm.report(premium);
    auto device = bench.opened();
    CHECK(device->description().limits.torque == 0.0);
    CHECK(device->description().remarks.front().find("its torque is not used") == 0);
    REQUIRE(bench.drive(*device, {Vec3(1, 0, 0), Vec3(0.02, 0.02, 0.02)}, 0.01));
    CHECK(bench.torque_now() == Vec3(0.0));
    CHECK(bench.force_now() == doctest::Approx(1.0));
    CHECK(bench.arm.refused() == 0);
}

TEST_CASE("OpenHaptics: limits are those that the arm reports, and at most those of its model") {
    Bench bench;
    const auto description = [&](const EmulatedHdReport& report) {
        bench.arm.report(report);
        return bench.opened()->description();
    };
    const Description known = description(touch);
    CHECK(known.name == "OpenHaptics arm (Touch)");
    CHECK(known.limits.force == 3.3);
    CHECK(known.limits.torque == 0.0);
    CHECK(known.limits.stiffness == 400.0);
    CHECK(glm::distance(known.half_workspace, Vec3(0.075, 0.06, 0.06)) < 1e-12);
    CHECK(known.remarks.size() == 2);
    CHECK(known.remarks.back().find("renders 0.88 N without a break") == 0);
    const Description weak = description({"Touch", 3, 3, {-60, -40, -30, 60, 40, 30}, 0.2, 2.0, 2.0});
    CHECK(weak.limits.force == 2.0);
    CHECK(weak.limits.stiffness == doctest::Approx(200.0));
    CHECK(glm::distance(weak.half_workspace, Vec3(0.06, 0.04, 0.03)) < 1e-12);
    CHECK(weak.remarks.front() == "senses no rotation: the tool keeps its orientation");
    CHECK(description(premium).limits.force == 8.5);
    CHECK(description({"PHANTOM Premium 3.0 6DOF", 6, 6, {}, 9, 99, 9}).limits.force == 22.0);
    // Absurd values, in wrong units or not numbers, of a model that nobody knows.
    for (const double absurd : {1e9, -1.0, bolt::nan, std::numeric_limits<double>::infinity()}) {
        CAPTURE(absurd);
        const Description d = description(
            {nullptr, 6, 6, {-absurd, -absurd, -absurd, absurd, absurd, absurd}, absurd, absurd, absurd});
        CHECK(d.name == "OpenHaptics arm");
        CHECK(d.limits.force == 3.3);
        CHECK(d.limits.torque == 0.0);
        CHECK(d.limits.stiffness == 400.0);
        CHECK(d.half_workspace == Vec3(0.075));
    }
    CHECK(description({"\x1b[31mTouch\n", 6, 3, {}, 0.5, 3.3, 0.88}).name == "OpenHaptics arm ([31mTouch)");
}

TEST_CASE("OpenHaptics: an arm that needs it is calibrated, without forces, before its first sample") {
    Bench bench;
    bench.arm.calibration(needs_update);
    auto device = bench.opened();
    // Before, the emulated position is 20 mm off.
    const auto first = device->read(0.005);
    REQUIRE(first);
    REQUIRE(*first);
    CHECK(glm::distance((*first)->pose.position, Vec3(0.0, -0.01, -0.01)) < 1e-9);
    CHECK(bench.arm.refused() == 0);
}

TEST_CASE("OpenHaptics: an arm that needs its inkwell says so, and is calibrated there") {
    Bench bench;
    bench.arm.calibration(needs_inkwell);
    const auto refused = bench.open();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::no_device);
    CHECK(refused.error().message() ==
          "OpenHaptics arm (Touch) is not calibrated; expected its stylus in the inkwell: push it in, and "
          "it is calibrated at the next attempt");
    CHECK(preparation_of(refused.error()).need == DeviceNeed::inkwell);
    CHECK(bench.arm.open() == 0);
    CHECK(bench.arm.running() == 0);
    bench.arm.inkwell();
    CHECK(bench.open());
    CHECK(bench.arm.refused() == 0);
}

TEST_CASE("OpenHaptics: no licence and an arm that another program uses are named") {
    Bench bench;
    bench.arm.licensed(0);
    const auto unlicensed = bench.open();
    REQUIRE_FALSE(unlicensed);
    CHECK(unlicensed.error().message() ==
          "OpenHaptics arm: it cannot be opened: invalid license; expected a licence of OpenHaptics for this "
          "computer");
    bench.arm.licensed(1);
    bench.arm.in_use(1);
    const auto used = bench.open();
    REQUIRE_FALSE(used);
    CHECK(used.error().expected == "an arm that no other program uses");
    bench.arm.in_use(0);
    CHECK(bench.open());
}

TEST_CASE("OpenHaptics: versions that know the default arm by a name only") {
    for (const char* name : {"Default PHANToM", "Default Device"}) {
        Bench bench;
        bench.arm.only_name(name);
        CHECK(bench.open());
    }
    Bench bench;
    bench.arm.only_name("my arm");
    const auto refused = bench.open();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message().find("set up with the vendor's program Touch_Setup") !=
          std::string::npos);
}

TEST_CASE("OpenHaptics: buttons") {
    Bench bench;
    auto device = bench.opened();
    bench.arm.buttons(2);
    CHECK(bench.read(*device, 0.01).buttons == 2);
}

TEST_CASE("OpenHaptics: the vendor's own thread calls the driver until it is closed") {
    Bench bench;
    bench.arm.own_clock();
    auto opened = open_open_haptics(bench.api, steady_timer());
    REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
    int samples = 0;
    double force = 0.0;
    for (int i = 0; i < 20'000 && (samples < 50 || force != 2.0); ++i) {
        REQUIRE((*opened)->write(two_newton));
        const auto sample = (*opened)->read(0.002);
        REQUIRE(sample);
        if (*sample) ++samples;
        force = bench.force_now();
    }
    CHECK(samples >= 50);
    CHECK(force == 2.0);
    opened->reset();
    CHECK(bench.force_now() == 0.0);
    CHECK(bench.arm.running() == 0);
    CHECK(bench.arm.refused() == 0);
}

}  // namespace device_open_haptics_test
