// A measured torque–angle record, from a CSV file.
//
// The first line that is neither blank nor a comment (#) names the columns. `angle_deg` and `torque_Nm` must
// be there, `cycle` may be: it tells several runs in one file apart. Other columns are left alone.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/joint/published.hpp"

namespace bolt::analysis {

struct Cycle {
    std::string name;            // as in the file; empty if the file has no cycles
    int line = 0;                // of its first sample
    std::vector<double> angle;   // rad, as counted by the rig
    std::vector<double> torque;  // N·m, tightening positive
};

struct Measured {
    std::string file;
    std::string source;  // who measured it: named wherever the data is shown; may be empty
    joint::Direction direction = joint::Direction::tighten;  // loosening if the torques are negative
    std::vector<Cycle> cycles;                               // in the order of the file

    [[nodiscard]] std::size_t samples() const;
};

inline constexpr std::size_t least_samples = 5;  // of a cycle

// `file` is for messages and for knowing the published data sets by their names.
Result<Measured> parse_measured(std::string_view text, std::string_view file);
Result<Measured> read_measured(const std::filesystem::path& path);

}  // namespace bolt::analysis
