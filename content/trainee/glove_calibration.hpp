// A trainee's calibration of a glove, kept as a JSON file: made once, read at every lesson.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "haptics/hand/measured_hand.hpp"

namespace bolt::content {

struct GloveCalibration {
    std::string trainee;  // as it wants to be called
    std::string glove;    // which one: its port's lasting name, or what the owner calls it; may be empty
    hand::Side hand = hand::Side::right;
    std::size_t sensors = 18;    // 18 or 22
    std::string date;            // "2026-11-22", when it was made
    double quality = 0.0;        // 0 … 1, Calibrated::figure; 0 where nothing told it (a vendor's file)
    double hand_length = 0.189;  // m, wrist to the tip of the middle finger
    hand::Calibration calibration;
};

// Errors name `file`, line and column of what is wrong.
Result<GloveCalibration> parse_glove_calibration(std::string_view text, const std::string& file);
// The same bytes for the same calibration.
std::string glove_calibration_text(const GloveCalibration& calibration);

Result<GloveCalibration> load_glove_calibration(const std::filesystem::path& path);
// What stood there stays whole if this fails.
Status save_glove_calibration(const std::filesystem::path& path, const GloveCalibration& calibration);

// Where a trainee's calibration is kept in a folder: a name of its own for every trainee and hand, of letters
// that every file system takes.
std::filesystem::path glove_calibration_path(const std::filesystem::path& folder, std::string_view trainee,
                                             hand::Side hand);

}  // namespace bolt::content
