// Packets of ART's DTrack: ASCII lines of one measurement, such as
//
//   fr 21753
//   ts 39596.024831
//   6dcal 2
//   6d 1 [0 1.0][326.8 -187.2 109.5 -160 -3.7 -7.1][-0.941 -0.339 -0.019 0.334 -0.933 0.138 -0.064 0.123
//   0.99]
//
// A body in a 6d line has an id and a quality, its position in mm and three angles (which are not used), and
// the columns of its rotation matrix. A body that the cameras do not see is missing or has the quality -1.
//
// A flystick is a body with buttons that the user holds. The line
//
//   6df2 1 1 [0 1.000 6 2][-228.5 1834.2 261.4][0.97 0.12 -0.19 -0.11 0.99 0.07 0.20 -0.05 0.98][5 0.00 1.00]
//
// has the number of calibrated flysticks and the number of flysticks that follow. Each flystick has its id,
// quality, number of buttons, number of analogue controllers, position, matrix, buttons (as bits of integers,
// 32 in each, the first button in the lowest bit) and the values of the controllers. The older line 6df has
// the number of flysticks, and of each [id quality buttons][position and three angles][matrix].
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::tracking {

struct DtrackBody {
    int id = 0;
    double quality = 0.0;  // 0 to 1
    Pose pose;             // in the tracker's frame, m
};

struct DtrackFlystick {
    int id = 0;
    std::optional<Pose> pose;             // in the tracker's frame, m; none: not seen, or invalid
    std::uint32_t buttons = 0;            // the first 32; the first is bit 0
    double stick_x = 0.0, stick_y = 0.0;  // −1 … 1, of the first two controllers; 0 without them
};

struct DtrackFrame {
    std::uint32_t number = 0;              // of the measurement
    std::optional<double> time;            // s, on the tracker's clock
    std::optional<int> calibrated_bodies;  // number of bodies that the tracker is calibrated for
    std::vector<DtrackBody> bodies;
    std::vector<DtrackFlystick> flysticks;
    // Bodies and flysticks whose values are no pose: not finite, too far away, or no rotation.
    int invalid_bodies = 0;
};

// A packet with more bodies, or with more flysticks, is damaged.
inline constexpr std::size_t max_dtrack_bodies = 256;
// The largest error of a dot product of two columns of a rotation matrix. Packets may have few digits.
inline constexpr double rotation_tolerance = 0.01;

// None if the packet is damaged: no frame number, or a malformed fr, ts, 6dcal, 6d, 6df or 6df2 line. Other
// lines, such as those of markers (3d), are skipped.
std::optional<DtrackFrame> parse_dtrack(std::string_view packet);

// The body with this id; null: it is not tracked.
const DtrackBody* find_body(const DtrackFrame& frame, int id);
// The flystick with this id; null: the packet has none.
const DtrackFlystick* find_flystick(const DtrackFrame& frame, int id);

}  // namespace bolt::tracking
