// Arms of plug-ins, each in a process of its own: faults, calibration, closing, and the list of arms.
#include "haptics/device/plugin_arms.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <utility>

#include "haptics/device/arms.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/device/device_thread.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/device/plugin_bench.hpp"
#include "tests/support/eventually.hpp"

namespace device_plugin_arms_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;
using Bench = PluginBench;
namespace fs = std::filesystem;

TEST_CASE("Plug-in: the sample arm keeps the contract of drivers") {
    check_driver_contract(
        [] {
            return open_plugin_arm({plugins / "sample_arm.so", 0, false}, steady_timer());
        },
        [] {});
}

TEST_CASE("Plug-in: an arm that is unplugged is lost, and names a remedy") {
    const Bench bench;
    check_unplugged([&] { return bench.open(); }, [&] { bench.show("unplugged"); });
    CHECK(message(bench.open()) ==
          "the plug-in faulty_arm: open: the arm is unplugged; expected an arm that is switched on and "
          "connected");
}

TEST_CASE(
    "Plug-in: a pose that is not finite, far away or not turned by a unit quaternion is a lost device") {
    const Bench bench;
    for (const char* fault : {"NaN", "far away"}) {
        CAPTURE(fault);
        bench.show("");
        const auto opened = bench.open();
        REQUIRE(opened);
        CHECK(read_many(**opened));
        bench.show(fault);
        const auto sample = read_many(**opened);
        REQUIRE_FALSE(sample);
        CHECK(sample.error().lost);
        CHECK(sample.error().message() ==
              "the plug-in faulty_arm: it reports a position that is not within 2 m; expected a pose as "
              "boltwright_arm.h describes it");
    }
}

TEST_CASE("Plug-in: only an arm that senses rotation turns the tool, by a unit quaternion") {
    const Bench bench;
    auto opened = bench.open_with("bad turn");  // which the sample arm does not sense
    REQUIRE(opened);
    const auto sample = read_many(**opened);
    REQUIRE(sample);
    CHECK(sample->pose.orientation == Quat(1, 0, 0, 0));
    opened->reset();
    opened = bench.open_with("senses rotation");
    REQUIRE(opened);
    const auto turned = read_many(**opened);
    REQUIRE(turned);
    CHECK(glm::distance(turned->pose.orientation * Vec3(1, 0, 0), Vec3(0, 1, 0)) < 1e-9);
    bench.show("bad turn");
    const auto bad = read_many(**opened);
    REQUIRE_FALSE(bad);
    CHECK(bad.error().lost);
    CHECK(bad.error().what == "the plug-in faulty_arm: it reports an orientation that is no unit quaternion");
}

TEST_CASE("Plug-in: the opening of a gripper counts only on an arm that senses it, clamped and finite") {
    const Bench bench;
    auto opened = bench.open_with("");  // the arm reports an opening of 0.25
    REQUIRE(opened);
    CHECK_FALSE((*opened)->description().senses_gripper);
    auto sample = read_many(**opened);
    REQUIRE(sample);
    CHECK(sample->gripper == 1.0);
    opened->reset();
    opened = bench.open_with("senses gripper");
    REQUIRE(opened);
    CHECK((*opened)->description().senses_gripper);
    sample = read_many(**opened);
    REQUIRE(sample);
    CHECK(sample->gripper == 0.25);
    bench.show("wide gripper");
    sample = read_many(**opened);
    REQUIRE(sample);
    CHECK(sample->gripper == 1.0);
    bench.show("NaN gripper");
    const auto bad = read_many(**opened);
    REQUIRE_FALSE(bad);
    CHECK(bad.error().lost);
    CHECK(bad.error().what ==
          "the plug-in faulty_arm: it reports an opening of its gripper that is not finite");
}

TEST_CASE("Plug-in: buttons that the arm does not have are not pressed") {
    const Bench bench;
    const auto opened = bench.open_with("all buttons");
    REQUIRE(opened);
    const auto sample = read_many(**opened);
    REQUIRE(sample);
    CHECK(sample->buttons == 1);
}

TEST_CASE(
    "Plug-in: a crash is an error that names the plug-in, the function and the signal, wherever it happens") {
    const Bench bench;
    for (const std::string function : {"open", "calibrate", "enable", "exchange"}) {
        CAPTURE(function);
        bench.show("crash in " + function);
        auto opened = bench.open();
        Error error;
        if (function == "exchange") {
            REQUIRE(opened);
            const auto sample = read_many(**opened);
            REQUIRE_FALSE(sample);
            error = sample.error();
            CHECK(error.lost);
            CHECK_FALSE((*opened)->read(0.001));  // it stays lost
        } else {
            REQUIRE_FALSE(opened);
            error = opened.error();
        }
        CHECK(error.code == ErrorCode::no_device);
        CHECK(error.message() ==
              "the plug-in faulty_arm crashed in " + function +
                  " (signal 11, Segmentation fault); expected a version of the plug-in without "
                  "this fault");
    }
    bench.show("crash in count");
    const auto counted = count_plugin_arms(bench.plugin);
    REQUIRE_FALSE(counted);
    CHECK(counted.error().what.find("crashed in count") != std::string::npos);
    bench.show("exit in enable");
    CHECK(message(bench.open()).find("it has ended its process in enable with exit code 3") !=
          std::string::npos);
    bench.show("crash in bw_arm_entry");
    CHECK(message(bench.open()).find("crashed in open (signal 11") != std::string::npos);
}

TEST_CASE("Plug-in: a function that hangs is an error, and reading never waits longer than its timeout") {
    const Bench bench;
    bench.show("hang in count");
    const auto counted = count_plugin_arms(bench.plugin);
    REQUIRE_FALSE(counted);
    CHECK(counted.error().what == "the plug-in faulty_arm: count has not returned for 2 s");
    bench.show("");
    auto opened = bench.open();
    REQUIRE(opened);
    CHECK(read_many(**opened));
    bench.show("hang in exchange");
    const Timer timer = steady_timer();
    double last_sample = timer.now();
    int timeouts = 0;
    Result<std::optional<Sample>> sample = std::optional<Sample>{};
    while (sample) {
        sample = (*opened)->read(0.002);
        if (!sample) break;
        if (*sample) last_sample = timer.now();
        timeouts = *sample ? 0 : timeouts + 1;
    }
    CHECK(sample.error().lost);
    CHECK(sample.error().what == "the plug-in faulty_arm: exchange has not returned for 0.5 s");
    CHECK(timer.now() - last_sample >= 0.5);
    CHECK(timeouts > 1);
    opened->reset();  // kills the process
    bench.show("");
    CHECK(bench.open());
}

TEST_CASE("Plug-in: an arm without a new sample sends none") {
    const Bench bench;
    const auto opened = bench.open();
    REQUIRE(opened);
    bench.show("silent");
    // Samples that were asked for before have come.
    for (int i = 0; i < 10; ++i) REQUIRE((*opened)->read(0.005));
    for (int i = 0; i < 10; ++i) {
        const auto sample = (*opened)->read(0.005);
        REQUIRE(sample);
        CHECK_FALSE(*sample);
    }
}

TEST_CASE("Plug-in: an arm that has to move by itself moves only if it may, and may take its time") {
    const Bench bench;
    CHECK(message(bench.open_with("must move")) ==
          "the plug-in faulty_arm: the arm has to move by itself to find its position, and may not; "
          "expected free room around it, then `boltwright devices --device plugin:faulty_arm:0 --yes`");
    CHECK(bench.open(true));
    CHECK(bench.open_with("busy"));
}

TEST_CASE("Plug-in: an arm that calibrates for long says so, and goes on in the same process") {
    const Bench bench;
    const OpenedArm first = bench.open_with("busy for long");
    REQUIRE_FALSE(first);
    CHECK(preparation_of(first.error()) == Preparation{DeviceNeed::wait, {}});
    CHECK(eventually([&] { return bench.open().has_value(); }));
}

TEST_CASE("Plug-in: an arm that waits for its user stays open until he has acted") {
    const Bench bench;
    for (int i = 0; i < 2; ++i)
        CHECK(message(bench.open_with("needs user")) ==
              "the plug-in faulty_arm: it waits for you: put the pen into its holder; expected a calibrated "
              "arm");
    CHECK(preparation_of(bench.open().error()) ==
          Preparation{DeviceNeed::user, "put the pen into its holder"});
    // Another process would not have seen it.
    CHECK(bench.open_with("user acts"));
    CHECK_FALSE(bench.open());
}

TEST_CASE("Plug-in: an arm without calls of the program for 50 ms renders no force") {
    const Bench bench;
    const auto opened = bench.open();
    REQUIRE(opened);
    REQUIRE((*opened)->write({Vec3(3, 0, 0), {}}));
    REQUIRE(read_many(**opened));
    bench.show("released");  // now a zero command creates the file `released`
    CHECK(eventually([&] { return fs::exists(bench.folder / "released"); }));
}

TEST_CASE("Plug-in: closing it sends a zero command and switches the motors off") {
    const Bench bench;
    auto opened = bench.open();
    REQUIRE(opened);
    REQUIRE((*opened)->write({Vec3(3, 0, 0), {}}));
    REQUIRE(read_many(**opened));
    opened->reset();
    std::ifstream log(bench.folder / "closing");
    const std::string text((std::istreambuf_iterator<char>(log)), {});
    CHECK(text == "force 0, off, close");
}

TEST_CASE("Plug-in: closing it lets an exchange that has begun return") {
    const Bench bench;
    auto opened = bench.open_with("20 ms");
    REQUIRE(opened);
    REQUIRE((*opened)->write({Vec3(3, 0, 0), {}}));
    const auto sample = (*opened)->read(0.001);
    REQUIRE(sample);
    CHECK_FALSE(*sample);
    opened->reset();
    CHECK(fs::exists(bench.folder / "closing"));
}

TEST_CASE("Plug-in: one that damages its process or the connection is a lost device") {
    const Bench bench;
    for (const auto& row : std::initializer_list<std::pair<const char*, const char*>>{
             {"nonsense",
              "the plug-in faulty_arm: its process has sent an invalid reply (the plug-in may have "
              "overwritten memory)"},
             {"closed connection", "the plug-in faulty_arm has closed its connection in exchange"}}) {
        const auto& fault = row.first;
        const auto& text = row.second;
        CAPTURE(fault);
        bench.show("");
        const auto opened = bench.open();
        REQUIRE(opened);
        bench.show(fault);
        const auto sample = read_many(**opened);
        REQUIRE_FALSE(sample);
        CHECK(sample.error().lost);
        CHECK(sample.error().what == text);
    }
}

TEST_CASE("Plug-in: folders are searched in order, and the first plug-in of a name counts") {
    const Folder one, two;
    const EnvironmentVariable variable("BOLTWRIGHT_ARM_PLUGINS",
                                       (one.path().string() + "::" + two.path().string()).c_str());
    const EnvironmentVariable home("HOME", "/home/ada"), no_data("XDG_DATA_HOME", nullptr);
    const fs::path system = "/usr/lib/boltwright/arms";
    CHECK(plugin_folders() ==
          std::vector<fs::path>{one.path(), two.path(), "/home/ada/.local/share/boltwright/arms", system});
    {
        const EnvironmentVariable data("XDG_DATA_HOME", "/data"), none("BOLTWRIGHT_ARM_PLUGINS", nullptr);
        CHECK(plugin_folders() == std::vector<fs::path>{"/data/boltwright/arms", system});
    }
    for (const fs::path& file : {one / "b.so", two / "b.so", two / "a.so", two / "notes.txt"})
        write_text(file, "");
    CHECK(find_plugins({one.path(), "/nowhere", two.path()}) ==
          std::vector<fs::path>{two / "a.so", one / "b.so"});
}

TEST_CASE("Plug-in: arms are listed with their ids or with what is wrong, and open by their id") {
    const Bench bench;
    fs::copy_file(plugins / "sample_arm.so", bench.folder / "sample_arm.so");
    const EnvironmentVariable variable("BOLTWRIGHT_ARM_PLUGINS", bench.folder.path().c_str());
    const auto list = [&] {
        std::vector<ListedDevice> found;
        for (const ArmBackend& backend : arm_backends())
            if (backend.name == "plugin")
                for (ListedDevice& arm : backend.list())
                    if (fs::path(arm.path).parent_path() == bench.folder.path()) found.push_back(arm);
        return found;
    };
    auto arms = list();
    REQUIRE(arms.size() == 2);
    CHECK(arms[0].id == "plugin:faulty_arm:0");
    CHECK(arms[0].name == "faulty_arm, an arm of a plug-in");
    CHECK(arms[1].id == "plugin:sample_arm:0");
    CHECK(arms[1].kind == DeviceKind::arm);
    CHECK_FALSE(arms[1].error);
    CHECK(open(arms[1]));
    bench.show("many");
    CHECK(list().size() == 17);
    bench.show("unplugged");
    CHECK(list().size() == 1);
    bench.show("no count");
    arms = list();
    REQUIRE(arms.size() == 2);
    REQUIRE(arms[0].error);
    CHECK(arms[0].error->message() ==
          "the plug-in faulty_arm: count: no?USB?; expected an arm that is switched on and connected");
    CHECK_FALSE(open(arms[0]));
}

TEST_CASE("Plug-in: on its thread, a crash is a loss with its reason, and the arm is opened again") {
    const Bench bench;
    auto thread = DeviceThread::start([&] { return bench.open(); });
    REQUIRE(thread);
    REQUIRE(thread->wait_until_open(60.0));
    CHECK(eventually([&] { return thread->snapshot().usable; }));
    bench.show("crash in exchange");
    CHECK(eventually(
        [&] { return thread->status().fault_message.find("crashed in exchange") != std::string::npos; }));
    CHECK(thread->status().losses >= 1);
    bench.show("");
    CHECK(eventually([&] { return thread->snapshot().usable && thread->status().fault_message.empty(); }));
}

}  // namespace device_plugin_arms_test
