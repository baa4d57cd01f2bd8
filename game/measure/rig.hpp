// The description of a test rig: where the columns of its files are, and how to compute torque and angle from
// them. It is a JSON file whose members content/schema/rig.schema.json describes:
//
//   {"format": "boltwright rig 1", "title": "Wrench with a force sensor", "direction": "tighten",
//    "time": {"rate_Hz": 1000},
//    "torque": {"column": "Fx", "unit": "N", "lever_mm": 250, "low_pass_Hz": 20, "resolution": 0.1},
//    "angle": {"column": "encoder", "unit": "deg"}}
//
// Quantities are in SI units here: rad, s, Hz, N·m or, for a force at the grip, N.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/joint/published.hpp"

namespace bolt::measure {

// The position of a value in the description, for messages; line 0: the description does not have it.
struct RigPosition {
    int line = 0, column = 0;
};

// Value in the unit `unit_name` = ±(gain · number + offset); times `unit` it is in SI units.
struct Channel {
    std::string column;
    std::string unit_name;
    double unit = 1.0;
    double gain = 1.0;
    double offset = 0.0;  // in the unit `unit_name`
    bool reversed = false;
    double low_pass = 0.0;              // Hz; 0: no filter
    double resolution = 0.0;            // SI; 0: unknown
    double uncertainty = 0.0;           // SI, standard uncertainty (k = 1) that does not depend on the value
    double relative_uncertainty = 0.0;  // standard, as a share of the value
    RigPosition position;               // of the channel
    RigPosition unit_position, reversed_position;

    [[nodiscard]] double value(double number) const {
        return (reversed ? -unit : unit) * (gain * number + offset);
    }
};

struct TorqueChannel {
    Channel channel;               // torque in N·m, or force in N
    double lever = 0.0;            // m; 0: the channel is a torque
    double lever_uncertainty = 0;  // m, standard
    // s at the beginning of a run in which the rig is at rest; the mean torque of this time is subtracted.
    double tare = 0.0;

    // Torque / value of the channel.
    [[nodiscard]] double factor() const { return lever > 0.0 ? lever : 1.0; }
};

struct TimeSource {
    std::string column;        // empty: samples come at `rate`
    double unit = 1.0;         // s, unit of the column
    double rate = 0.0;         // Hz; 0: there is a column
    double longest_gap = 0.0;  // s; a longer gap between samples is an error; 0: five times the median step
};

struct AnglePoint {
    double time = 0.0;   // s
    double angle = 0.0;  // rad
};

enum class AngleKind {
    column,       // of the file of the run
    second_file,  // a column of another file, with its own times
    speed,        // constant from the end of the tare on
    points        // angles at given times, straight in between
};

struct AngleSource {
    AngleKind kind = AngleKind::column;
    Channel channel;                 // column and second_file
    std::string ending;              // second_file: replaces the ending of the run's file name
    TimeSource second_time;          // second_file
    double delay = 0.0;              // s, added to the times of the second file
    double speed = 0.0;              // rad/s in the direction of the rig
    std::vector<AnglePoint> points;  // times strictly ascending
    double largest_step = 0.0;       // rad between two samples of a column; 0: see import_checks.hpp
    RigPosition position;
};

struct TableFormat {
    char separator = ',';
    bool decimal_comma = false;
    int lines_before_header = 0;
    int lines_after_header = 0;
};

struct Rig {
    std::string file;  // of the description
    std::string title, source;
    joint::Direction direction = joint::Direction::tighten;
    std::string thread;          // "M8"; empty: not given
    std::string property_class;  // "8.8"; empty: not given
    double bolt_length = 0.0;    // m; 0: not given
    TableFormat table;
    TimeSource time;
    TorqueChannel torque;
    AngleSource angle;
    std::string cycle_column;  // empty: each file is a run

    // An error at a place of the description.
    [[nodiscard]] Error error(RigPosition position, std::string what, std::string expected) const;
};

// A description without mistakes, or all mistakes of the file in its order, each with file, line and column.
struct LoadedRig {
    Rig rig;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `file` is used in messages.
LoadedRig parse_rig(std::string_view text, const std::string& file);
LoadedRig load_rig(const std::filesystem::path& path);

// The unit at the end of a column's name, such as "Torque [N.mm]", "Fx (kN)" or "angle_deg", as the rig's
// description spells it; empty if the name has none.
std::string unit_in_name(std::string_view column);

}  // namespace bolt::measure
