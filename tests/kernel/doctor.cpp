// `boltwright doctor` with named devices, called as a user calls it.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <thread>

#include "engine/base/file.hpp"
#include "engine/base/process.hpp"
#include "tests/kernel/guest.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

// A running doctor and its output so far.
class Doctor {
  public:
    explicit Doctor(const std::vector<std::string>& options) {
        std::vector<std::string> words{"boltwright", "doctor"};
        words.insert(words.end(), options.begin(), options.end());
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        child_ = fork();
        if (child_ != 0) return;
        if (std::freopen(file, "w", stdout) == nullptr || dup2(STDOUT_FILENO, STDERR_FILENO) < 0) _exit(126);
        execvp("boltwright", arguments.data());
        _exit(127);
    }
    Doctor(const Doctor&) = delete;
    Doctor& operator=(const Doctor&) = delete;
    ~Doctor() {
        if (child_ > 0) kill(child_, SIGKILL), waitpid(child_, nullptr, 0);
    }

    [[nodiscard]] static std::string output() {
        return read_file(file, 1U << 20U, ErrorCode::failed).value_or(std::string());
    }
    [[nodiscard]] bool prints(const std::string& words, double seconds = 10.0) const {
        return holds_within([&] { return output().find(words) != std::string::npos; }, seconds);
    }
    int wait_for_exit() {
        int status = -1;
        waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int interrupt() {
        kill(child_, SIGINT);
        return wait_for_exit();
    }

  private:
    static constexpr const char* file = "/tmp/output";
    pid_t child_ = -1;
};

// The cover without contact models, because their preparation takes seconds on the virtual machine.
std::string assembly_without_models() {
    std::ifstream original("/content/assemblies/cover-m8/assembly.json");
    std::filesystem::create_directories("/tmp/bare");
    std::ofstream copy("/tmp/bare/assembly.json");
    const std::regex node("\"node\": \"[^\"]*\", ");
    for (std::string line; std::getline(original, line);)
        if (!line.starts_with("  \"model") && !line.starts_with("  \"contact_model"))
            copy << std::regex_replace(line, node, "") << '\n';
    return "/tmp/bare";
}

const char* const pucks = "256f:c62e";
const char* const boards = "1209:ffb0";

emulate::Uhid plug_board() { return attach(std::make_unique<emulate::EmulatedWheel>()); }

// Moves the emulated hand at the board and returns the motor torque, N·m.
double turn_board(const emulate::Uhid& board, double hand, std::uint32_t buttons) {
    double torque = 0.0;
    with<emulate::EmulatedWheel>(board, [&](emulate::EmulatedWheel& w) {
        w.hand = hand;
        w.hand_stiffness = 10.0;
        w.buttons = buttons;
        torque = w.torque();
    });
    return torque;
}

}  // namespace

TEST_CASE(
    "Kernel, doctor: a trial of puck and board reports their roles, the torque of a tight nut, and "
    "unplugging") {
    auto puck = std::make_unique<emulate::Uhid>(attach(std::make_unique<emulate::EmulatedPuck>()));
    auto board = std::make_unique<emulate::Uhid>(plug_board());
    wait_for_device(pucks);
    wait_for_device(boards);
    Doctor doctor({assembly_without_models(), "--device", boards, "--device", pucks, "--seconds", "600"});
    REQUIRE_MESSAGE(doctor.prints("For 600 s", 60.0), Doctor::output());
    for (const char* words :
         {"Emulated SpaceMouse: moves the tool", "Emulated OpenFFBoard: turns the wrench on its bolt",
          "only while button 1 of Emulated SpaceMouse or button 1 of Emulated OpenFFBoard"})
        CHECK_MESSAGE(Doctor::output().find(words) != std::string::npos, words);

    // Rocked without a held button, and with one.
    double free = 0.0, held = 0.0;
    const auto rock = [&](std::uint32_t buttons, double& most) {
        for (int i = 0; i < 100; ++i) {
            most = std::max(most, std::abs(turn_board(*board, i % 40 < 20 ? 0.1 : -0.1, buttons)));
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    };
    rock(0, free);
    CHECK(free == 0.0);
    rock(1, held);
    CHECK(held > 0.2);
    CHECK(held < 2.01);
    CHECK(holds_within([&] { return turn_board(*board, 0.0, 0) == 0.0; }, 0.05));

    board.reset();
    CHECK(doctor.prints("there is no device 1209:ffb0; expected a connected device"));
    board = std::make_unique<emulate::Uhid>(plug_board());
    CHECK(doctor.prints("resolved: there is no device 1209:ffb0"));
    puck.reset();
    CHECK(doctor.prints("there is no device 256f:c62e; expected a connected device"));
    CHECK(doctor.interrupt() == 1);
    const std::string output = Doctor::output();
    for (const char* words :
         {"of at most 2 N·m", "the button was held for", "renders no force", "Servo at 1000 ticks a second",
          "because\n  there is no device 256f:c62e",
          "there is no device 1209:ffb0; expected a connected device; `boltwright devices` lists them (from"})
        CHECK_MESSAGE(output.find(words) != std::string::npos, words);
    CHECK(output.find("largest torque 0.00 N·m") == std::string::npos);
    MESSAGE(output);
}

TEST_CASE("Kernel, doctor: a station without faults passes") {
    const auto puck = attach(std::make_unique<emulate::EmulatedPuck>());
    const auto board = plug_board();
    wait_for_device(pucks);
    wait_for_device(boards);
    // Housekeeping of the guest's kernel can occupy its only processor for tens of milliseconds, once: a
    // device of the same guest is silent meanwhile.
    int code = 1;
    std::string output;
    for (int attempt = 0; attempt < 3 && code != 0; ++attempt) {
        Doctor doctor({assembly_without_models(), "--device", boards, "--device", pucks, "--seconds", "3"});
        code = doctor.wait_for_exit();
        output = Doctor::output();
        if (code != 0) MESSAGE("attempt ", attempt, " failed:\n", output);
    }
    CHECK_MESSAGE(code == 0, output);
    for (const char* words :
         {"largest torque 0.00 N·m", "the button was never held", "This station is good enough"})
        CHECK_MESSAGE(output.find(words) != std::string::npos, output);
}

TEST_CASE("Kernel, doctor: problems are reported before the trial starts, with a remedy") {
    const auto output_of = [](std::vector<std::string> options, int code) {
        options.insert(options.begin(), "cover-m8");
        Doctor doctor(options);
        CHECK(doctor.wait_for_exit() == code);
        return Doctor::output();
    };
    CHECK(output_of({"--device", pucks}, 4).find("no device 256f:c62e") != std::string::npos);
    const auto board = plug_board();
    const ListedDevice node = wait_for_device(boards);
    CHECK(output_of({"--device", "1209:ffb1"}, 4).find("did you mean 1209:ffb0?") != std::string::npos);
    CHECK(output_of({"--seconds", "0"}, 4).find("boltwright doctor --device 1209:ffb0 tries") !=
          std::string::npos);  // no Vulkan here
    REQUIRE(write_file("/tmp/rig.json", R"({"format": "boltwright rig 1", "most_torque_Nm": 400})"));
    CHECK(output_of({"--device", boards, "--rig", "/tmp/rig.json"}, 3).find("/tmp/rig.json:1:") !=
          std::string::npos);
    REQUIRE(chmod(node.path.c_str(), 0600) == 0);
    std::filesystem::remove("/tmp/output");
    CHECK(holds_unprivileged([] {
        const auto refused =
            run_program({"boltwright", "doctor", "cover-m8", "--device", boards}, Capture::output_and_errors);
        return refused && refused->exit_code == 4 &&
               refused->output.find("Permission denied") != std::string::npos &&
               refused->output.find("60-boltwright.rules") != std::string::npos;
    }));
}
