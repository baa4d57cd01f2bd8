// Rigs and their files with a known result.
#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "engine/base/random.hpp"
#include "game/measure/import.hpp"

namespace measure_test {

using namespace bolt;

inline const std::string force_rig = R"({
  "format": "boltwright rig 1",
  "title": "Wrench with a force sensor",
  "source": "these tests",
  "direction": "tighten",
  "thread": "M8",
  "time": { "column": "t", "unit": "ms" },
  "torque": {
    "column": "Fx", "unit": "N", "lever_mm": 250, "gain": 2, "offset": -1,
    "resolution": 0.2, "uncertainty": 0.4, "uncertainty_percent": 1, "lever_uncertainty_mm": 2
  },
  "angle": { "column": "phi", "unit": "deg", "resolution": 0.1 }
}
)";

inline measure::Rig parsed_rig(const std::string& text) {
    const measure::LoadedRig loaded = measure::parse_rig(text, "rig.json");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    REQUIRE(loaded.ok());
    return loaded.rig;
}

// Run-down at 0.5 N·m up to 100°, then 2 N·m/° up to 30.5 N·m at 115°, then 0.4 N·m/°.
inline double known_torque(double degrees) {
    if (degrees < 100.0) return 0.5;
    return degrees < 115.0 ? 0.5 + 2.0 * (degrees - 100.0) : 30.5 + 0.4 * (degrees - 115.0);
}

// Columns t (ms), Fx, phi for force_rig: the force sensor shows (T/0.25 m + 1)/2. 10 ms and 0.25° a row.
inline std::string force_file(const std::function<double(double)>& torque, double noise = 0.0) {
    std::string out = "t,Fx,phi\n";
    Random random(3);
    for (int i = 0; i <= 560; ++i) {
        const double angle = 0.25 * i;
        out += fmt::format("{},{:.6f},{}\n", 10 * i,
                           (torque(angle) / 0.25 + 1.0) / 2.0 + noise * random.normal(), angle);
    }
    return out;
}

inline Result<std::vector<measure::RigRun>> import_text(const std::string& rig, const std::string& file,
                                                        const std::string& second = {}) {
    return measure::import_runs(parsed_rig(rig), {"run.csv", file, "run_angle.csv", second});
}

inline measure::RigRun only_run(const Result<std::vector<measure::RigRun>>& runs) {
    if (!runs) FAIL(runs.error().message());
    REQUIRE(runs->size() == 1);
    return runs->front();
}

inline std::string message_of(const Result<std::vector<measure::RigRun>>& runs) {
    return runs ? "no error" : runs.error().message();
}

}  // namespace measure_test
