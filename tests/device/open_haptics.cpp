// The driver of OpenHaptics' arms, on an emulated library.
#include "haptics/device/open_haptics.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>

#include "haptics/device/arms.hpp"
#include "haptics/device/vendor_library.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/support/folder.hpp"
#include "tools/emulate/arms/open_haptics.h"

namespace device_open_haptics_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

constexpr double let_go = 0.02;  // s, the longest time from a fault to a hand without force
constexpr unsigned needs_update = 0x5001, needs_inkwell = 0x5002;
constexpr EmulatedHdHand frictionless{0.5, 300.0, 12.0, 0.0};
constexpr EmulatedHdReport touch{"Touch", 6, 3, {-80, -50, -50, 80, 70, 70}, 0.5, 3.3, 0.88};
constexpr EmulatedHdReport premium{
    "PHANTOM Premium 1.5 6DOF", 6, 6, {-120, -100, -80, 120, 100, 80}, 3.5, 37.5, 6.2};

struct Controls {
    decltype(emu_hd_reset)* reset = nullptr;
    decltype(emu_hd_own_clock)* own_clock = nullptr;
    decltype(emu_hd_advance)* advance = nullptr;
    decltype(emu_hd_hand)* hand = nullptr;
    decltype(emu_hd_intend)* intend = nullptr;
    decltype(emu_hd_turn)* turn = nullptr;
    decltype(emu_hd_report)* report = nullptr;
    decltype(emu_hd_buttons)* buttons = nullptr;
    decltype(emu_hd_calibration)* calibration = nullptr;
    decltype(emu_hd_inkwell)* inkwell = nullptr;
    decltype(emu_hd_only_name)* only_name = nullptr;
    decltype(emu_hd_unplug)* unplug = nullptr;
    decltype(emu_hd_in_use)* in_use = nullptr;
    decltype(emu_hd_licensed)* licensed = nullptr;
    decltype(emu_hd_heat)* heat = nullptr;
    decltype(emu_hd_speed_limit)* speed_limit = nullptr;
    decltype(emu_hd_corrupt)* corrupt = nullptr;
    decltype(emu_hd_raise)* raise = nullptr;
    decltype(emu_hd_late)* late = nullptr;
    decltype(emu_hd_switch_off)* switch_off = nullptr;
    decltype(emu_hd_force)* force = nullptr;
    decltype(emu_hd_open)* open = nullptr;
    decltype(emu_hd_running)* running = nullptr;
    decltype(emu_hd_initialisations)* initialisations = nullptr;
    decltype(emu_hd_refused)* refused = nullptr;
};

// An emulated arm whose clock is the driver's.
struct Bench {
    OpenHapticsApi api;
    Controls arm;
    double now = 0.0;
    Timer timer = advancing_timer(now, arm.advance);

    Bench() {
        const std::vector<std::filesystem::path> path{BOLT_EMULATED_OPEN_HAPTICS};
        const auto loaded = load_open_haptics(path);
        REQUIRE_MESSAGE(loaded, (loaded ? "" : loaded.error().message()));
        api = *loaded;
        auto library = VendorLibrary::open(path);
        REQUIRE(library);
        library->find("emu_hd_reset", arm.reset);
        library->find("emu_hd_own_clock", arm.own_clock);
        library->find("emu_hd_advance", arm.advance);
        library->find("emu_hd_hand", arm.hand);
        library->find("emu_hd_intend", arm.intend);
        library->find("emu_hd_turn", arm.turn);
        library->find("emu_hd_report", arm.report);
        library->find("emu_hd_buttons", arm.buttons);
        library->find("emu_hd_calibration", arm.calibration);
        library->find("emu_hd_inkwell", arm.inkwell);
        library->find("emu_hd_only_name", arm.only_name);
        library->find("emu_hd_unplug", arm.unplug);
        library->find("emu_hd_in_use", arm.in_use);
        library->find("emu_hd_licensed", arm.licensed);
        library->find("emu_hd_heat", arm.heat);
        library->find("emu_hd_speed_limit", arm.speed_limit);
        library->find("emu_hd_corrupt", arm.corrupt);
        library->find("emu_hd_raise", arm.raise);
        library->find("emu_hd_late", arm.late);
        library->find("emu_hd_switch_off", arm.switch_off);
        library->find("emu_hd_force", arm.force);
        library->find("emu_hd_open", arm.open);
        library->find("emu_hd_running", arm.running);
        library->find("emu_hd_initialisations", arm.initialisations);
        library->find("emu_hd_refused", arm.refused);
        REQUIRE(library->check());
        arm.reset();
    }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;
    ~Bench() { arm.reset(); }

    Result<std::unique_ptr<DeviceDriver>> open() { return open_open_haptics(api, timer); }
    std::unique_ptr<DeviceDriver> opened() {
        auto device = open();
        REQUIRE_MESSAGE(device, (device ? "" : device.error().message()));
        return std::move(*device);
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
    // Writes `command` each millisecond and reads; whether the device still works after `seconds`.
    bool drive(DeviceDriver& device, const force::OutputCommand& command, double seconds) {
        for (const double until = now + seconds; now < until;) {
            if (!device.write(command)) return false;
            const double next = now + 1e-3;
            while (now < next)
                if (!device.read(next - now)) return false;
        }
        return true;
    }
    [[nodiscard]] std::array<double, 6> wrench_now() const {
        std::array<double, 6> wrench{};
        arm.force(wrench.data());
        return wrench;
    }
    [[nodiscard]] Vec3 force_vector() const {
        const auto wrench = wrench_now();
        return {wrench[0], wrench[1], wrench[2]};
    }
    [[nodiscard]] double force_now() const { return glm::length(force_vector()); }
    [[nodiscard]] Vec3 torque_now() const {
        const auto wrench = wrench_now();
        return {wrench[3], wrench[4], wrench[5]};
    }
};

const force::OutputCommand two_newton{Vec3(0, 2, 0), {}};

// Holds 2 N, causes the fault and keeps commanding 2 N. The hand must be free in time.
template <class Cause>
void check_lets_go(Bench& bench, DeviceDriver& device, const Cause& cause) {
    REQUIRE(bench.drive(device, two_newton, 0.05));
    REQUIRE(bench.force_now() == doctest::Approx(2.0));
    cause();
    const double until = bench.now + let_go;
    bench.drive(device, two_newton, let_go);
    bench.timer.wait(until - bench.now);  // a lost arm refuses commands
    CHECK(bench.force_now() == 0.0);
}

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
    for (const ArmVendor& vendor : arm_vendors())
        if (vendor.name == "openhaptics") arms = vendor.list();
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
    CHECK(device->describe().limits.torque == 0.0);
    CHECK(device->describe().remarks.front().find("its torque is not used") == 0);
    REQUIRE(bench.drive(*device, {Vec3(1, 0, 0), Vec3(0.02, 0.02, 0.02)}, 0.01));
    CHECK(bench.torque_now() == Vec3(0.0));
    CHECK(bench.force_now() == doctest::Approx(1.0));
    CHECK(bench.arm.refused() == 0);
}

TEST_CASE("OpenHaptics: limits are those that the arm reports, and at most those of its model") {
    Bench bench;
    const auto description = [&](const EmulatedHdReport& report) {
        bench.arm.report(report);
        return bench.opened()->describe();
    };
    const Description known = description(touch);
    CHECK(known.name == "OpenHaptics arm (Touch)");
    CHECK(known.limits.force == 3.3);
    CHECK(known.limits.torque == 0.0);
    CHECK(known.limits.stiffness == 400.0);
    CHECK(glm::distance(known.reach, Vec3(0.075, 0.06, 0.06)) < 1e-12);
    CHECK(known.remarks.size() == 2);
    CHECK(known.remarks.back().find("renders 0.88 N without a break") == 0);
    const Description weak = description({"Touch", 3, 3, {-60, -40, -30, 60, 40, 30}, 0.2, 2.0, 2.0});
    CHECK(weak.limits.force == 2.0);
    CHECK(weak.limits.stiffness == doctest::Approx(200.0));
    CHECK(glm::distance(weak.reach, Vec3(0.06, 0.04, 0.03)) < 1e-12);
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
        CHECK(d.reach == Vec3(0.075));
    }
    CHECK(description({"\x1b[31mTouch\n", 6, 3, {}, 0.5, 3.3, 0.88}).name == "OpenHaptics arm ([31mTouch)");
}

TEST_CASE(
    "OpenHaptics: the force is limited, ends with the commands, and is released when the arm is closed") {
    Bench bench;
    auto device = bench.opened();
    REQUIRE(bench.drive(*device, {Vec3(100, 0, 0), {}}, 0.05));
    CHECK(bench.force_now() == doctest::Approx(3.3));
    // The device thread hangs: no further calls.
    for (int i = 0; i < 15; ++i) bench.timer.wait(1e-3);
    CHECK(bench.force_now() == doctest::Approx(3.3));
    for (int i = 0; i < 5; ++i) bench.timer.wait(1e-3);
    CHECK(bench.force_now() == 0.0);
    // It comes back with the next command.
    REQUIRE(bench.drive(*device, two_newton, 0.005));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    const double closing = bench.now;
    device.reset();
    CHECK(bench.now - closing < let_go);
    CHECK(bench.force_now() == 0.0);
    CHECK(bench.arm.running() == 0);
    CHECK(bench.arm.open() == 0);
    CHECK(bench.arm.refused() == 0);
}

TEST_CASE(
    "OpenHaptics: warm motors end the force until they are cool; the arm stays open and the force grows "
    "slowly") {
    Bench bench;
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] { bench.arm.heat(1.0); });
    REQUIRE(bench.drive(*device, two_newton, 3.0));
    CHECK(bench.force_now() == 0.0);
    bench.arm.heat(0.8);  // no error any more, and not yet cool
    REQUIRE(bench.drive(*device, two_newton, 3.0));
    CHECK(bench.force_now() == 0.0);
    bench.arm.heat(0.5);
    double greatest_step = 0.0;
    for (int i = 0; i < 600; ++i) {
        const double before = bench.force_now();
        REQUIRE(bench.drive(*device, two_newton, 1e-3));
        greatest_step = std::max(greatest_step, bench.force_now() - before);
    }
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(greatest_step < 0.02);
}

TEST_CASE("OpenHaptics: the force of hot motors fades before the library warns, and the condition tells") {
    Bench bench;
    auto device = bench.opened();
    CHECK(device->describe().model == "Touch");
    CHECK(device->describe().serial == "2001-0042");
    REQUIRE(bench.drive(*device, two_newton, 1.0));
    CHECK(device->condition().calibrated == true);
    CHECK(device->condition().heat == 0.0);
    bench.arm.heat(0.85);
    REQUIRE(bench.drive(*device, two_newton, 0.5));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(is_warm(device->condition()));
    bench.arm.heat(0.97);
    REQUIRE(bench.drive(*device, two_newton, 0.05));
    CHECK(bench.force_now() == 0.0);
    CHECK(device->condition().cooling);
    CHECK(device->condition().heat == 0.97);
    bench.arm.heat(0.6);
    REQUIRE(bench.drive(*device, two_newton, 0.7));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK_FALSE(device->condition().cooling);
}

TEST_CASE("OpenHaptics: an arm that is too fast or forced too hard rests for half a second and stays open") {
    for (const unsigned error : {0x201U, 0x202U, 0x203U}) {
        CAPTURE(error);
        Bench bench;
        auto device = bench.opened();
        check_lets_go(bench, *device, [&] { bench.arm.raise(error); });
        REQUIRE(bench.drive(*device, two_newton, 0.3));
        CHECK(bench.force_now() == 0.0);
        REQUIRE(bench.drive(*device, two_newton, 1.0));
        CHECK(bench.force_now() == doctest::Approx(2.0));
        bench.arm.switch_off();  // the library disables the forces, and refuses them from then on
        REQUIRE(bench.drive(*device, two_newton, 0.3));
        CHECK(bench.force_now() == 0.0);
        REQUIRE(bench.drive(*device, two_newton, 1.0));
        CHECK(bench.force_now() == doctest::Approx(2.0));
    }
    // A hand that is pulled away with 60 N.
    Bench bench;
    bench.arm.speed_limit(0.5);
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] {
        bench.arm.intend(0.2, 0, 0);
        REQUIRE(bench.drive(*device, two_newton, 0.005));  // until it is too fast
    });
    REQUIRE(bench.drive(*device, two_newton, 3.0));
    CHECK(bench.force_now() == doctest::Approx(2.0));
}

TEST_CASE("OpenHaptics: a transform that is not a number ends the force and yields no sample") {
    Bench bench;
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] { bench.arm.corrupt(1); });
    const auto sample = device->read(0.05);
    REQUIRE(sample);
    CHECK_FALSE(*sample);
    bench.arm.corrupt(0);
    REQUIRE(bench.drive(*device, two_newton, 1.0));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(is_valid(device->describe(), bench.read(*device, 0.01)));
}

TEST_CASE("OpenHaptics: faults of the arm end the force, and the arm is lost") {
    for (const unsigned fault : {0x300U, 0x302U, 0x304U, 0x402U}) {
        CAPTURE(fault);
        Bench bench;
        auto device = bench.opened();
        // Errors lie on a stack; a harmless one on top must not hide the fault.
        check_lets_go(bench, *device, [&] {
            bench.arm.raise(fault);
            bench.arm.heat(1.0);
            CHECK_FALSE(bench.drive(*device, two_newton, 0.0025));
            bench.arm.heat(0.0);
        });
        const auto sample = device->read(0.005);
        REQUIRE_FALSE(sample);
        CHECK(sample.error().lost);
        CHECK(sample.error().code == ErrorCode::no_device);
        CHECK_FALSE(device->write(two_newton));
        for (int i = 0; i < 1000; ++i) {
            CHECK_FALSE(device->write(two_newton));
            bench.timer.wait(1e-3);
        }
        CHECK(bench.force_now() == 0.0);
        device.reset();
        CHECK(bench.open());  // as the supervisor does
    }
    Bench bench;
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] { bench.arm.unplug(1); });
    const auto sample = device->read(0.005);
    REQUIRE_FALSE(sample);
    CHECK(sample.error().message() ==
          "OpenHaptics arm (Touch): its forces have ended: communication error; expected an arm that is "
          "switched "
          "on, connected, and set up with the vendor's program Touch_Setup");
}

TEST_CASE("OpenHaptics: a late tick delays samples; after a very late one the force grows from zero") {
    Bench bench;
    auto device = bench.opened();
    REQUIRE(bench.drive(*device, two_newton, 0.05));
    bench.arm.late(0.01);
    const auto none = device->read(0.008);
    REQUIRE(none);
    CHECK_FALSE(*none);
    REQUIRE(bench.drive(*device, two_newton, 0.05));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    // The library keeps rendering the last force while its thread hangs.
    bench.arm.late(0.2);
    const double late = bench.now;
    while (bench.force_now() > 0.0 && bench.now < late + 0.15)
        REQUIRE(bench.drive(*device, two_newton, 1e-3));
    CHECK(bench.now - late < let_go);
    REQUIRE(bench.drive(*device, two_newton, 0.25));
    CHECK(bench.force_now() > 0.0);
    CHECK(bench.force_now() < 1.0);
    REQUIRE(bench.drive(*device, two_newton, 0.6));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(bench.arm.refused() == 0);
    CHECK(bench.read(*device, 0.005).time > bench.now - 0.003);
    bench.arm.late(10.0);
    const double closing = bench.now;
    device.reset();
    CHECK(bench.now - closing < let_go + 1e-3);
    CHECK(bench.force_now() == 0.0);
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
          "OpenHaptics arm (Touch) is not calibrated; expected its stylus in the inkwell: push it "
          "in, and "
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
