// The kinds of tools that are generated, their parameters, and the standard sizes, lengths and test torques.
// Frame of every tool: metres, the origin on the bolt's axis in the middle of the part that grips, +X along
// the handle, +Z along the bolt away from the members. With sockets, keys and bits the handle has a larger z
// than the part that grips.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::tool_models {

// Kinds of models. A kind that content::ToolKind has too has the same name here. `ratchet` is a ratchet with
// its socket or bit; its name on the command line is "socket".
enum class ModelKind : std::uint8_t {
    open_end_wrench,
    ring_wrench,
    combination_wrench,
    hex_key,
    ratchet,
    extension_bar,
    adaptor,
    hex_bit,
    click_torque_wrench,
    electronic_torque_wrench
};

// The dimension that the size of a kind of tool states: the width across flats of the nut or of the screw's
// socket, or the width of the tool's square drive.
enum class SizeMeasure : std::uint8_t { nut, socket_screw, drive };

struct KindInfo {
    ModelKind kind;
    std::string_view name;         // on the command line and in sessions
    std::string_view description;  // one line
    SizeMeasure measure;
};
std::span<const KindInfo> model_kinds();
const KindInfo& info_of(ModelKind kind);

// Fails if there is no such kind; the error suggests the nearest name.
Result<ModelKind> kind_named(std::string_view name);

// The head of a ratchet or a torque wrench; every other kind has only its standard head. The standard head of
// a ratchet is a socket, that of a torque wrench an open end.
enum class ModelHead : std::uint8_t { standard, open_end, socket, hex_bit };

// Metres and radians. 0: the standard value.
struct ToolParameters {
    ModelKind kind = ModelKind::open_end_wrench;
    double size = 0.0;     // across flats of the nut or the socket screw, or the width of the drive
    double opening = 0.0;  // between the flats of the tool: size + play; of keys: size
    double length = 0.0;   // from the origin to the far end
    double drive = 0.0;    // width of the square drive
    int teeth = 0;         // of the ratchet
    ModelHead head = ModelHead::standard;
    double extension = 0.0;  // length of the bar between a ratchet and its socket or bit; 0: none
    // Length that an adaptor adds, in line between a torque wrench and its open end; 0: no adaptor.
    double adaptor_length = 0.0;
    // The next four are for open ends, also those of torque wrenches. `head_angle`: between jaw and handle;
    // none: the standard value. `jaw_depth`, `jaw_tip`: from the middle of the jaw to its throat and to its
    // tips.
    std::optional<double> head_angle = {};
    double head_thickness = 0.0, jaw_depth = 0.0, jaw_tip = 0.0;
};

SizeMeasure measure_of(const ToolParameters& parameters);

// Returns true if tools of this kind measure torque.
bool is_torque_wrench(ModelKind kind);

// Returns true if the tool is a socket or a bit on the square drive of a ratchet.
bool has_ratchet(const ToolParameters& completed);

// The sizes of a kind in mm, ascending.
std::span<const double> standard_sizes(SizeMeasure measure);

// Least value of ToolParameters::length, m.
double shortest_length(const ToolParameters& parameters);

// The lengths of a hex key's arms, m: from the tip to the outside of the bend, and from there to the end.
struct KeyArms {
    double arm = 0.0, handle = 0.0;
    bool tabulated = false;  // false: interpolated between the sizes of the table
};
KeyArms key_arms(double size);  // `size`: across flats, m

// A test torque, N·m, with its origin.
enum class TorqueSource : std::uint8_t { none, tabulated, interpolated, estimated };
struct TestTorque {
    double torque = 0.0;
    TorqueSource source = TorqueSource::none;
};
TestTorque test_torque(ModelKind kind, double size);  // `size`: ToolParameters::size

// m, play of the jaws of generated tools; the shipped wrenches have the same.
inline constexpr double standard_play = 0.2e-3;
inline constexpr double longest_tool = 2.5;  // m
inline constexpr std::array ratchet_teeth = {24, 72, 90};

// Replaces zeros by standard values. Fails if a value is impossible; the error gives the valid ones.
Result<ToolParameters> completed(ToolParameters parameters);

// The dimensions in words and numbers: equal texts mean equal tools.
std::string description(const ToolParameters& completed);

}  // namespace bolt::tool_models
