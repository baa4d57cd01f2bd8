// A measured torque–angle record, from a CSV file.
//
// The first line that is neither blank nor a comment (#) names the columns. `angle_deg` and `torque_Nm` are
// required; the optional `cycle` distinguishes several runs in one file. Other columns are ignored. Comments
// may give the source ("# source: ..."), and the thread, the bolt's length in mm and the property class of
// the measured joint ("# thread: M8", "# bolt_length_mm: 75", "# property_class: 8.8").
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
    int line = 0;                // of the first sample
    std::vector<double> angle;   // rad, as counted by the rig
    std::vector<double> torque;  // N·m, tightening positive
};

struct MeasuredRecord {
    std::string file;
    std::string source;          // citation, shown with the data; may be empty
    std::string thread;          // "M8", from a line "# thread: M8"; may be empty
    std::string bolt_length;     // mm, "75", from a line "# bolt_length_mm: 75"; may be empty
    std::string property_class;  // "8.8", from a line "# property_class: 8.8"; may be empty
    joint::Direction direction = joint::Direction::tighten;  // loosening if the torques are negative
    std::vector<Cycle> cycles;                               // in the order of the file

    [[nodiscard]] std::size_t samples() const;
};

inline constexpr std::size_t min_samples = 5;  // of a cycle

// `file` is used in messages and to recognise the published data sets by name.
Result<MeasuredRecord> parse_measured(std::string_view text, std::string_view file);
Result<MeasuredRecord> read_measured(const std::filesystem::path& path);

// Keeps only the runs with these names, because a record may hold runs of several joints. Empty: keeps all.
// Fails if the record has no run of a name.
Status select_runs(MeasuredRecord& record, const std::vector<std::string>& names);

}  // namespace bolt::analysis
