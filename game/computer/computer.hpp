// Checks of the computer on which the program runs. gather_facts() measures it; findings() states in words
// what is good, what is missing and what to do about it. The menu and `boltwright doctor` show the findings.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"
#include "engine/audio/sink.hpp"
#include "engine/gpu/device.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/servo/servo_thread.hpp"

namespace bolt::computer {

// The timing of an assembly's servo at one rate.
struct ServoTiming {
    double rate = 1000.0;  // ticks per second
    servo::Timing timing;
    servo::ThreadPrivileges privileges;
    servo::HostAssessment assessment;
};

// Runs the servo on a thread of its own for `seconds` at each rate (1/s), with a load like that of a lesson:
// a hand moves the wrench onto a nut and off again. Fails if the assembly cannot be loaded or the thread
// cannot be started.
Result<std::vector<ServoTiming>> time_servo(const std::string& assembly, const std::vector<double>& rates,
                                            double seconds);

struct GpuFacts {
    std::string name;
    bool software = false;  // the processor computes the pictures
};
// The GPU that draws. Fails if no device can draw.
Result<GpuFacts> find_gpu();

struct ComputerFacts {
    Result<GpuFacts> gpu;
    Result<std::string> sound;  // the name of the output
    std::vector<device::ListedDevice> devices;
    std::optional<Result<ServoTiming>> timing;  // none: not measured
    std::filesystem::path sessions;             // folder of the sessions; may not exist yet
    std::string folder_error;                   // why sessions cannot be written there; empty if they can
    double free_space = 0.0;                    // bytes, where the sessions are kept
    bool films = false;                         // FFmpeg is installed
};

struct FactsRequest {
    Result<GpuFacts> gpu;  // the GPU in use, or the result of find_gpu()
    std::filesystem::path sessions;
    std::string assembly;  // whose servo is timed
    double seconds = 0.0;  // duration of the timing; 0: none
    audio::OpenSink open_sound = audio::open_openal;
};

// Takes some tenths of a second; with timing, also its duration and the time to load the assembly. Does not
// use Vulkan, so that another thread may draw meanwhile. Writes no files.
ComputerFacts gather_facts(const FactsRequest& request);

enum class Severity : std::uint8_t {
    good,
    limited,  // lessons run, with something missing
    bad,      // lessons cannot run, or are lost
};

struct Finding {
    Severity severity = Severity::good;
    words::TextKey text = "finding.films";
    std::vector<words::TextArgument> arguments;
    std::optional<words::TextKey> remedy;
};

inline constexpr double min_free_space = 1e9;  // bytes; less is reported as Severity::bad

// The findings, the worst first.
std::vector<Finding> findings(const ComputerFacts& facts);

// One line per finding, and one per remedy.
std::string describe(const words::Words& words, const std::vector<Finding>& findings);

}  // namespace bolt::computer
