// The report of a plug-in about its arm, and the plug-in files that are refused.
#include <doctest/doctest.h>

#include <fstream>
#include <limits>
#include <utility>

#include "haptics/device/plugin/arm_process.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/device/plugin_bench.hpp"

namespace device_plugin_report_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;
using Bench = PluginBench;
namespace fs = std::filesystem;

namespace {

// Returns whether the mass comes to rest at `place` under `force`. It may take a while: the arm's process
// releases the force if a busy computer delays the test.
bool rests_at(DeviceDriver& device, const Vec3& force, const Vec3& place) {
    REQUIRE(device.write({force, Vec3(100.0)}));
    int at_rest = 0;
    for (int i = 0; i < 300 && at_rest < 3; ++i) {
        const Result<Sample> last = read_many(device);
        REQUIRE_MESSAGE(last, (last ? "" : last.error().message()));
        at_rest = glm::distance(last->pose.position, place) < 1e-6 ? at_rest + 1 : 0;
    }
    return at_rest == 3;
}

}  // namespace

TEST_CASE("Plug-in: the description is what the plug-in reports") {
    const auto opened = open_plugin_arm({plugins / "sample_arm.so", 0, false}, steady_timer());
    REQUIRE(opened);
    const Description& d = (*opened)->description();
    CHECK(d.name == "mass on a spring");
    CHECK(d.id == "plugin:sample_arm:0");
    CHECK(d.renders == std::array<bool, 6>{true, true, true, false, false, false});
    CHECK(d.limits.force == 10.0);
    CHECK(d.limits.torque == 0.0);
    CHECK(d.limits.stiffness == 2000.0);
    CHECK(d.limits.damping == 10.0);
    CHECK(d.limits.delay == 1);  // a command waits for the next exchange
    CHECK(d.half_workspace == Vec3(0.1));
    CHECK(d.buttons == 1);
    CHECK(d.remarks.size() == 2);
}

TEST_CASE("Plug-in: a force reaches the arm, clamped whatever is written, and axes that it lacks get none") {
    const auto opened = open_plugin_arm({plugins / "sample_arm.so", 0, false}, steady_timer());
    REQUIRE(opened);
    DeviceDriver& device = **opened;
    CHECK(rests_at(device, {0, 3, 0}, {0, 0.01, 0}));  // 300 N/m
    CHECK(rests_at(device, {1e6, 0, 0}, {10.0 / 300.0, 0, 0}));
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(rests_at(device, {nan, 5, 0}, Vec3(0.0)));
}

TEST_CASE("Plug-in: the text of NAME.conf reaches the plug-in") {
    const Folder folder;
    const fs::path plugin = folder / "stiff.so";
    fs::copy_file(plugins / "sample_arm.so", plugin);
    const auto open = [&] { return open_plugin_arm({plugin, 0, false}, steady_timer()); };
    write_text(folder / "stiff.conf", "1000\n");
    auto opened = open();
    REQUIRE(opened);
    CHECK(rests_at(**opened, {0, 0, 5}, {0, 0, 0.005}));
    write_text(folder / "stiff.conf", "soft");
    CHECK(message(open()).find("the plug-in stiff: open: the .conf file has no stiffness") == 0);
    write_text(folder / "stiff.conf", std::string(5000, '1'));
    CHECK(message(open()) ==
          "the plug-in stiff: stiff.conf has 5000 bytes; expected a text of 4095 at most, without NUL");
    fs::remove(folder / "stiff.conf");
    fs::create_directory(folder / "stiff.conf");
    CHECK(message(open()) ==
          "the plug-in stiff: stiff.conf is a folder; expected a text file that can be read");
}

TEST_CASE("Plug-in: a file that is no plug-in is refused with the reason") {
    const Folder folder;
    const auto refusal = [](const fs::path& plugin) {
        const auto count = count_plugin_arms(plugin);
        REQUIRE_FALSE(count);
        CHECK(count.error().code == ErrorCode::no_device);
        CHECK(count.error().expected ==
              "a plug-in for this kind of computer, as boltwright_arm.h describes it");
        return count.error().what;
    };
    CHECK(refusal(folder / "absent.so") == "the plug-in absent: absent.so is not installed");
    write_text(folder / "text.so", std::string(4096, 'x'));
    CHECK(refusal(folder / "text.so").find("invalid ELF header") != std::string::npos);
    // Cut off in the header, and in the middle.
    std::ifstream whole(plugins / "sample_arm.so", std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(whole)), {});
    write_text(folder / "short.so", bytes.substr(0, 40));
    CHECK(refusal(folder / "short.so").find("file too short") != std::string::npos);
    write_text(folder / "cut.so", bytes.substr(0, 3000));
    CHECK_FALSE(count_plugin_arms(folder / "cut.so"));
    // ELFCLASS32, of a computer with 32 bits.
    bytes[4] = 1;
    write_text(folder / "narrow.so", bytes);
    CHECK(refusal(folder / "narrow.so").find("wrong ELF class") != std::string::npos);
}

TEST_CASE("Plug-in: a library without the entry, another version, a short and an empty table are refused") {
    const Bench bench;
    const fs::path other = bench.folder / "other.so";
    fs::copy_file(BOLT_EMULATED_FORCE_DIMENSION, other);
    const auto no_entry = count_plugin_arms(other);
    REQUIRE_FALSE(no_entry);
    CHECK(no_entry.error().what.find("has no bw_arm_entry") != std::string::npos);
    for (const auto& row : std::initializer_list<std::pair<const char*, const char*>>{
             {"old",
              "the plug-in faulty_arm: bw_arm_entry(1) returns no functions; expected a plug-in made with "
              "this version of boltwright_arm.h"},
             {"short", "the plug-in faulty_arm: its bw_arm_v1 has a size of 40 bytes; expected 72 or more"},
             {"empty",
              "the plug-in faulty_arm: its bw_arm_v1 lacks a function; expected all eight of "
              "boltwright_arm.h"}}) {
        const auto& fault = row.first;
        const auto& text = row.second;
        CAPTURE(fault);
        CHECK(message(bench.open_with(fault)) == text);
    }
}

TEST_CASE("Plug-in: reports that are not finite, negative or contradictory are refused") {
    const Bench bench;
    for (const auto& row : std::initializer_list<std::pair<const char*, const char*>>{
             {"infinite force", "its largest force is inf N; expected a finite number that is not negative"},
             {"negative torque",
              "its largest torque is -1 N·m; expected a finite number that is not negative"},
             {"no stiffness",
              "its largest force or stiffness is 0; expected both above 0, or no force axis in "
              "bw_arm_info_v1.axes"},
             {"slow", "it sends 50 samples a second; expected 500 or more"},
             {"late", "its delay is 3 ms; expected 0 to 2 ms at 1000 samples a second"},
             {"no reach", "its reach along y is 0 m; expected a finite number above 0"},
             {"buttons", "it has 33 buttons; expected 0 to 32"},
             {"odd", "calibrate returns 99; expected a result as boltwright_arm.h describes it"}}) {
        const auto& fault = row.first;
        const auto& text = row.second;
        CAPTURE(fault);
        const std::string refusal = message(bench.open_with(fault));
        CAPTURE(refusal);
        CHECK(refusal.find("the plug-in faulty_arm: ") == 0);
        CHECK(refusal.find(text) != std::string::npos);
    }
}

TEST_CASE("Plug-in: limits beyond those of any arm are reduced, with a remark each") {
    const Bench bench;
    const auto opened = bench.open_with("strong");
    REQUIRE_MESSAGE(opened, message(opened));
    const Description& d = (*opened)->description();
    check_description(d);
    CHECK(d.limits.force == 70.0);
    CHECK(d.limits.torque == 3.1);
    CHECK(d.limits.stiffness == 8000.0);
    CHECK(d.limits.torsion == 40.0);
    CHECK(d.limits.damping == 20.0);
    CHECK(d.limits.angular_damping == 0.1);
    CHECK(d.half_workspace == Vec3(1.0, 0.1, 0.1));
    CHECK(d.rate == 1000.0);
    CHECK(d.remarks.at(0) == "reports a force of 500 N; Boltwright uses 70 N at most");
}

TEST_CASE("Plug-in: an arm without axes of force renders none, whatever limits it reports") {
    const Bench bench;
    const auto opened = bench.open_with("input only");
    REQUIRE_MESSAGE(opened, message(opened));
    check_description((*opened)->description());
    CHECK((*opened)->description().limits.force == 0.0);
    CHECK((*opened)->description().limits.stiffness > 0.0);
    CHECK(rests_at(**opened, {5, 0, 0}, Vec3(0.0)));
}

TEST_CASE("Plug-in: a name without an end is cut, and texts are made readable") {
    const Bench bench;
    const auto opened = bench.open_with("long name");
    REQUIRE(opened);
    CHECK((*opened)->description().name == std::string(64, 'x'));
    CHECK(clean_text("Größe \u4e2d \U0001f527") == "Größe \u4e2d \U0001f527");
    CHECK(clean_text("a\nb\x1b[1m\x7f") == "a?b?[1m?");
    // A byte that continues nothing, an overlong slash, half of a pair, the end in a character.
    CHECK(clean_text("\x80|\xc0\xaf|\xed\xa0\x80|\xe4\xb8") == "?|??|???|??");
    CHECK(clean_text("\xf4\x90\x80\x80\xf0\x8f\xbf\xbf") == "????????");
}

}  // namespace device_plugin_report_test
