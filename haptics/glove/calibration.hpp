// From a glove's numbers to a trainee's angles: a line a sensor, angle = gain × (raw − offset), as the
// vendor's own software has it. Found from poses that the trainee takes, with a figure of how good it is.
//
// Angles are rad. Bending towards the palm is positive, 0 with the hand flat; abductions are 0 with the
// fingers side by side and positive apart, the thumb's 0 at the index; thumb roll is 0 with the thumb in the
// palm's plane and positive across it; palm arch positive hollow; wrist pitch positive towards the palm,
// wrist yaw towards the thumb.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/glove/sensors.hpp"

namespace bolt::glove {

struct Line {
    double gain = 0.0;    // rad a count
    double offset = 0.0;  // counts at 0 rad
};

constexpr double angle(const Line& line, double raw) { return line.gain * (raw - line.offset); }

struct Calibration {
    BySensor<std::optional<Line>> lines;  // none: not calibrated, or a sensor that the glove has not
};

// What a trainee is asked to do, in this order.
enum class Posture : std::uint8_t { flat, fist, spread, thumb_across };
inline constexpr std::size_t poses = 4;

// The angle that a sensor's joint has in a pose; none where people differ too much or nothing is asked of it.
// Chosen near what goniometry books call normal ranges; a hand differs from them by 10 to 15 degrees.
std::optional<double> angle_in(Posture pose, Sensor sensor);

// What the glove gave while one pose was held.
struct Held {
    Posture pose = Posture::flat;
    std::vector<BySensor<std::uint8_t>> samples;
};

struct SensorQuality {
    double span = 0.0;       // counts between the poses
    double trembling = 0.0;  // rad, standard deviation while poses were held
    double off = 0.0;        // rad, greatest distance of a pose from the line
};

struct Calibrated {
    Calibration calibration;
    BySensor<SensorQuality> quality;
    // 1: every sensor as good as gloves are; 0: at least one of no use. The worst sensor decides.
    double figure = 0.0;
    std::vector<std::string> remarks;  // what to do better, in words for the trainee; empty: nothing
};

// Each of these halves the figure: a span of so few counts, so much trembling.
inline constexpr double poor_span = 12.0;
inline constexpr double poor_trembling = 3.0 * pi / 180.0;

// Each sensor's line through the medians of its poses, least squares. An error: no flat hand or no fist among
// them, or no sample of a pose.
Result<Calibrated> calibrate(std::span<const Held> held);

}  // namespace bolt::glove
