// A trainee's calibration of a glove, stored as a JSON file that every lesson reads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "haptics/hand/measured_hand.hpp"

namespace bolt::content {

struct GloveCalibration {
    std::string trainee;  // the person's code; in files of older programs the typed name
    std::string glove;    // the persistent name of its port, or the owner's name for it; may be empty
    hand::Side hand = hand::Side::right;
    std::size_t sensors = 18;    // 18 or 22
    std::string date;            // of the calibration, as "2026-11-22"
    double quality = 0.0;        // 0 … 1, CalibrationResult::score; 0 if unknown (a vendor's file)
    double hand_length = 0.189;  // m, wrist to the tip of the middle finger
    hand::Calibration calibration;
};

// Errors name `file`, line and column.
Result<GloveCalibration> parse_glove_calibration(std::string_view text, const std::string& file);
// Deterministic: equal calibrations give equal bytes.
std::string glove_calibration_text(const GloveCalibration& calibration);

Result<GloveCalibration> load_glove_calibration(const std::filesystem::path& path);
// An existing file is unchanged if this fails.
Status save_glove_calibration(const std::filesystem::path& path, const GloveCalibration& calibration);

// Path of a trainee's calibration in a folder: unique for each trainee and hand, with characters that every
// file system accepts.
std::filesystem::path glove_calibration_path(const std::filesystem::path& folder, std::string_view trainee,
                                             hand::Side hand);

}  // namespace bolt::content
