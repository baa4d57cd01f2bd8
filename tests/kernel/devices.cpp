// `boltwright devices` as a user calls it.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "engine/base/file.hpp"
#include "engine/base/process.hpp"
#include "tests/kernel/guest.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

struct CommandOutput {
    int exit_code = -1;
    std::string text;
    [[nodiscard]] bool has(const std::string& words) const { return text.find(words) != std::string::npos; }
};

CommandOutput run_devices(std::vector<std::string> options = {}) {
    std::vector<std::string> command{"boltwright", "devices"};
    command.insert(command.end(), options.begin(), options.end());
    const Result<ProgramResult> finished = run_program(command, Capture::output_and_errors);
    return finished ? CommandOutput{finished->exit_code, finished->output}
                    : CommandOutput{-1, finished.error().message()};
}

}  // namespace

TEST_CASE("Kernel, devices: without devices the command reports that, and fails only if a device was named") {
    const CommandOutput all = run_devices();
    CHECK_MESSAGE(all.exit_code == 0, all.text);
    CHECK(all.has("none; connect a force-feedback arm"));
    const CommandOutput one = run_devices({"--device", "256f:c62e"});
    CHECK(one.exit_code == 4);
    CHECK(one.has("no device 256f:c62e"));
}

TEST_CASE("Kernel, devices: lists devices and their capabilities") {
    const auto puck = attach(std::make_unique<emulate::EmulatedPuck>());
    const auto board =
        attach(std::make_unique<emulate::EmulatedWheel>(emulate::EmulatedWheelOptions{.serial = "AB12"}));
    wait_for_device("256f:c62e");
    wait_for_device("1209:ffb0:AB12");
    const CommandOutput all = run_devices();
    CHECK_MESSAGE(all.exit_code == 0, all.text);
    CHECK(all.has("256f:c62e  Emulated SpaceMouse  /dev/hidraw"));
    CHECK(all.has("1209:ffb0:AB12  Emulated OpenFFBoard  /dev/hidraw"));
    CHECK(!all.has("cannot be used"));
    const CommandOutput a_puck = run_devices({"--device", "256f:c62e", "--seconds", "0.2"});
    CHECK_MESSAGE(a_puck.exit_code == 0, a_puck.text);
    CHECK(a_puck.has("renders no force"));
    const CommandOutput a_board = run_devices({"--device", "1209:ffb0:AB12", "--seconds", "0.2"});
    CHECK_MESSAGE(a_board.exit_code == 0, a_board.text);
    CHECK(a_board.has("2.0 N·m"));
    CHECK(a_board.has("1080 degrees"));
    const auto rigged = [](const std::string& members) {
        REQUIRE(write_file("/tmp/rig.json", "{\"format\": \"boltwright rig 1\", " + members + "}"));
        return run_devices({"--device", "1209:ffb0:AB12", "--seconds", "0.2", "--rig", "/tmp/rig.json"});
    };
    const CommandOutput a_rig = rigged(R"("full_torque_Nm": 8, "most_torque_Nm": 1.5)");
    CHECK_MESSAGE(a_rig.exit_code == 0, a_rig.text);
    CHECK(a_rig.has("1.5 N·m"));
    const CommandOutput no_rig = rigged(R"("most_torque_Nm": 400)");
    CHECK(no_rig.exit_code == 3);
    CHECK(no_rig.has("/tmp/rig.json:1:"));
    const CommandOutput near = run_devices({"--device", "256f:c62d"});
    CHECK(near.exit_code == 4);
    CHECK(near.has("256f:c62e"));
}

TEST_CASE("Kernel, devices: bolt-emulate plugs in an emulated device") {
    for (const auto& [kind, id] :
         {std::pair{"puck", "256f:c62e"}, {"board", "1209:ffb0"}, {"wheel", "1234:5678"}}) {
        CAPTURE(kind);
        const pid_t child = fork();
        if (child == 0) {
            execl("/bin/bolt-emulate", "bolt-emulate", kind, nullptr);
            _exit(127);
        }
        wait_for_device(id);
        const CommandOutput one = run_devices({"--device", id, "--seconds", "0.5"});
        CHECK_MESSAGE(one.exit_code == 0, one.text);
        CHECK(!one.has("at rest"));  // an emulated hand moves it
        kill(child, SIGTERM);
        int status = -1;
        waitpid(child, &status, 0);
        CHECK(status == 0);
        CHECK(holds_within([] { return list_devices().empty(); }));
    }
    CHECK(holds_unprivileged([] {
        const auto refused = run_program({"bolt-emulate", "puck"}, Capture::output_and_errors);
        return refused && refused->exit_code == 4 && refused->output.find("root") != std::string::npos;
    }));
}

TEST_CASE("Kernel, devices: missing permission comes with a remedy") {
    const auto puck = attach(std::make_unique<emulate::EmulatedPuck>());
    REQUIRE(chmod(wait_for_device("256f:c62e").path.c_str(), 0600) == 0);
    CHECK(holds_unprivileged([] {
        const CommandOutput all = run_devices();
        return all.exit_code == 0 && all.has("cannot be used") && all.has("60-boltwright.rules");
    }));
    CHECK(holds_unprivileged([] {
        const CommandOutput one = run_devices({"--device", "256f:c62e"});
        return one.exit_code == 4 && one.has("Permission denied") && one.has("60-boltwright.rules");
    }));
}
