// A rig's description and a file of runs, separated by a NUL: any bytes give errors with a text, or runs
// whose numbers are finite and whose record can be read back, never a crash.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "game/analysis/measured.hpp"
#include "game/measure/import.hpp"

namespace {

using namespace bolt;

void expect(bool condition) {
    if (!condition) std::abort();
}

void check_run(const measure::RigRun& run) {
    expect(run.time.size() == run.torque.size() && run.angle.size() == run.torque.size() &&
           run.u_torque.size() == run.torque.size());
    for (std::size_t i = 0; i < run.torque.size(); ++i)
        expect(std::isfinite(run.time[i]) && std::isfinite(run.angle[i]) && std::isfinite(run.torque[i]) &&
               run.u_torque[i] >= 0.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view input(reinterpret_cast<const char*>(data), size);
    const std::size_t end = std::min(input.find('\0'), input.size());
    const measure::LoadedRig loaded = measure::parse_rig(input.substr(0, end), "rig.json");
    for (const Error& error : loaded.errors) expect(error.line >= 1 && !error.what.empty());
    if (!loaded.ok()) return 0;
    const std::string text(input.substr(std::min(end + 1, size)));
    const auto runs = measure::import_runs(loaded.rig, {"run.csv", text, "second.csv", text});
    if (!runs) {
        expect(!runs.error().what.empty() && !runs.error().expected.empty() && !runs.error().file.empty());
        return 0;
    }
    for (const measure::RigRun& run : *runs) check_run(run);
    expect(!measure::summary_text(loaded.rig, *runs).empty());
    (void)analysis::parse_measured(measure::record_csv(loaded.rig, *runs), "record.csv");
    return 0;
}
